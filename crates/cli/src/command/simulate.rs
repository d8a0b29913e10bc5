//! `hydrostat simulate`: the arm in motion.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant as Clock};

use hydrostat::{Arm, Inputs, MotionError, MotionOptions, Simulation, SpatialSimulation};
use hydrostat_figures::{MotionFrame, motion_figure};
use hydrostat_files::{
    EventOut, SavedMotion, motion_state_beside, number, parse_time_loads, read_time_loads, set_shaped,
};

use super::motion_output::{Ending, MotionOutput, Told};
use super::motion_text;
use super::moving::Moving;
use super::slip;
use super::wrong_option;
use crate::args::{MotionFormat, ShapeTimes, SimulateArgs, StationAt};
use crate::progress::Progress;
use crate::request::WrongRequest;
use crate::{exit, input, output, request, say};

/// The most rows of one document, and of whole shapes.
const MOST_ROWS: f64 = 1e7;

/// Time between states that are kept for a run that is broken off.
const KEPT_EVERY: Duration = Duration::from_secs(5);

pub(crate) fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    input::check_once(&[("ARM", Some(Path::new(&args.arm.file))), ("--input", args.input.as_deref())])?;
    let arm = request::arm_in_space(&args.arm)?;
    let pictures = [("--plot", args.plot.as_deref()), ("--plot-time", args.plot_time.as_deref())];
    let state_file = args.file().map(motion_state_beside);
    let from_file = args.from.as_deref().map(|file| {
        let beside = motion_state_beside(file);
        if beside.exists() { beside } else { file.to_owned() }
    });
    let inputs = [
        request::arm_input(&args.arm.file),
        args.input.as_deref().map(|file| ("--input", input::source(file))),
        args.from.as_deref().map(|file| ("--from", file)),
        from_file.as_deref().map(|file| ("--from", file)),
    ];
    let outputs = [
        ("-o", args.output.as_deref()),
        ("-o", state_file.as_deref()),
        ("--shapes-output", args.shapes_output.as_deref()),
        ("--events", args.events.as_deref()),
        pictures[0],
        pictures[1],
    ];
    request::check_outputs(&inputs, &outputs)?;
    request::check_picture(&args.picture, &pictures)?;
    let loads = loads(args, &arm)?;
    let earlier = args.from.as_deref().map(SavedMotion::read).transpose()?;
    let start = earlier.as_ref().map_or(0.0, |earlier| earlier.state.time);
    let plan = Plan::new(args, &arm, start)?;
    let options = MotionOptions { tol: args.tol, elements: args.elements, ..MotionOptions::default() };
    let request = {
        let mut hasher = DefaultHasher::new();
        let typed = (&args.station, &args.shapes, args.shape_stations, args.quasi_static);
        format!("{arm:?} {loads:?} {options:?} {:?} {typed:?} {start:?}", plan.every).hash(&mut hasher);
        hasher.finish()
    };
    let resumed = resumed(args, request)?;
    let asked = Asked { args, arm: &arm, plan: &plan, request, resumed: resumed.as_ref() };
    let state = match (&resumed, earlier) {
        (Some(saved), _) => Some(saved.state.clone()),
        (None, Some(earlier)) => Some(earlier.state.under_other_loads()),
        (None, None) => None,
    };
    if arm.space.is_some() {
        let simulation = match state {
            Some(state) => SpatialSimulation::resume(&arm, loads, options, &state),
            None => SpatialSimulation::new(&arm, loads, options),
        };
        return moved(&asked, simulation.map_err(refused)?);
    }
    let simulation = match state {
        Some(state) => Simulation::resume(&arm, loads, options, &state),
        None => Simulation::new(&arm, loads, options),
    };
    moved(&asked, simulation.map_err(refused)?)
}

/// What is asked for.
struct Asked<'a> {
    args: &'a SimulateArgs,
    arm: &'a Arm,
    plan: &'a Plan,
    request: u64,
    resumed: Option<&'a SavedMotion>,
}

fn moved<M: Moving<D>, const D: usize>(asked: &Asked, mut simulation: M) -> anyhow::Result<()> {
    let Asked { args, arm, plan, request, resumed } = *asked;
    let clock = Clock::now();
    let mut equilibria = args.quasi_static.then(|| simulation.statics()).transpose().map_err(refused)?;
    let heads = M::heads(arm.cables.len(), plan.stations.len(), args.quasi_static);
    let mut output = MotionOutput::new(args, heads, M::SHAPE_HEADS, resumed, request)?;
    let mut frames = (args.plot.is_some() || args.plot_time.is_some()).then(Frames::<D>::default);
    let mut statics = Statics::<D>::default();
    let mut last = None;
    let outcome = follow(plan, &mut simulation, &mut output, |simulation, at, numbers| {
        if let Some(frames) = &mut frames {
            frames.take(|| simulation.frame(at));
        }
        if let Some(equilibria) = &mut equilibria {
            numbers.extend(statics.take(M::equilibrium(equilibria, at, arm.length)));
        }
        last = Some(at.clone());
    });
    let text = |events: &[_], told: &Told, wall: f64| {
        let mut text = M::text(arm, last.as_ref()?, events, told, wall);
        if let Some((tip, distances)) = &statics.last {
            motion_text::add_equilibrium(tip, *distances, &mut text);
        }
        Some(text)
    };
    let outcome = ended(asked, &simulation, &mut output, outcome, clock, text)?;
    if let Some(frames) = &frames {
        draw::<M, D>(args, arm, &frames.kept)?;
    }
    finish(&simulation, outcome, output.is_resumable())
}

/// Writes what is written at the end of a run that has this outcome.
fn ended<M: Moving<D>, const D: usize>(
    asked: &Asked,
    simulation: &M,
    output: &mut MotionOutput,
    outcome: Result<(), Stop>,
    clock: Clock,
    text: impl FnOnce(&[EventOut], &Told, f64) -> Option<String>,
) -> anyhow::Result<Result<(), Stop>> {
    let verdict = match &outcome {
        Ok(()) => None,
        Err(Stop::Motion(error)) => Some(error.to_string()),
        Err(Stop::User) => Some(format!("interrupted after {} s", number(simulation.time()))),
        Err(Stop::Output(_)) => Some(String::new()),
    };
    if let Err(Stop::Output(error)) = outcome {
        return Err(error);
    }
    let limit = match &outcome {
        Err(Stop::Motion(MotionError::Ended(verdict))) => Some(*verdict),
        _ => None,
    };
    let told = simulation.told();
    let ending = Ending { verdict, limit };
    output.end(asked.arm, &told, &ending, |events| text(events, &told, clock.elapsed().as_secs_f64()))?;
    Ok(outcome)
}

/// Warns, and says how the run ended.
fn finish<M: Moving<D>, const D: usize>(
    simulation: &M,
    outcome: Result<(), Stop>,
    is_resumable: bool,
) -> anyhow::Result<()> {
    for warning in simulation.told().warnings {
        say::warning(warning.message());
    }
    match outcome {
        Ok(()) => Ok(()),
        Err(Stop::Motion(error)) => Err(refused(error)),
        Err(Stop::User) => Err(WrongRequest::Interrupted(simulation.time(), is_resumable).into()),
        Err(Stop::Output(error)) => Err(error),
    }
}

/// The equilibria beside a motion, whose tips have `D` coordinates.
struct Statics<const D: usize> {
    /// Tip of the last one (m), and the last and the largest distance from one over the length.
    last: Option<([f64; D], [f64; 2])>,
}

impl<const D: usize> Default for Statics<D> {
    fn default() -> Self {
        Self { last: None }
    }
}

impl<const D: usize> Statics<D> {
    /// The numbers of a row: the tip is their start, the distance their end.
    fn take(&mut self, own: Vec<f64>) -> Vec<f64> {
        if let Some(&distance) = own.last().filter(|distance| distance.is_finite()) {
            let most = self.last.map_or(0.0, |(_, [_, most])| most);
            self.last = Some((std::array::from_fn(|k| own[k]), [distance, most.max(distance)]));
        }
        own
    }
}

/// The loads over time; those that look like a slip of the unit are named.
fn loads(args: &SimulateArgs, arm: &Arm) -> anyhow::Result<Inputs> {
    let mut loads = Inputs::default();
    let mut spans = match &args.input {
        Some(file) if input::is_standard(file) => parse_time_loads(&input::text()?, input::NAME, &mut loads)?,
        Some(file) => read_time_loads(file, &mut loads)?,
        None => Vec::new(),
    };
    for text in &args.vary {
        let span = set_shaped(text, &mut loads).map_err(|error| {
            let message = format!("--vary {error}");
            anyhow::Error::new(error).context(message)
        })?;
        spans.push(span);
    }
    slip::warn(arm, &spans);
    Ok(loads)
}

/// The interrupted run that is to go on, where there is one.
fn resumed(args: &SimulateArgs, request: u64) -> anyhow::Result<Option<SavedMotion>> {
    let Some(path) = args.output.as_deref().filter(|_| args.resume) else { return Ok(None) };
    if args.file().is_none() {
        return Err(WrongRequest::NotResumable(path.to_owned()).into());
    }
    if MotionOutput::format(args) != MotionFormat::Csv {
        return Err(WrongRequest::NotResumable(path.to_owned()).into());
    }
    if !path.exists() || !motion_state_beside(path).exists() {
        return Ok(None);
    }
    let saved = SavedMotion::read(path)?;
    if saved.request != request {
        return Err(WrongRequest::OtherRun(path.to_owned()).into());
    }
    Ok(Some(saved))
}

/// Shapes that a strobe figure shows.
const SHAPES: usize = 24;

/// The most frames that figures keep: memory does not grow with the run.
const MOST_FRAMES: usize = 4000;

/// Frames of a run at equal times: every second one goes where there are too many.
struct Frames<const D: usize> {
    kept: Vec<MotionFrame<D>>,
    /// Rows so far, and those from one frame to the next, less one.
    rows: usize,
    skipped: usize,
}

impl<const D: usize> Default for Frames<D> {
    fn default() -> Self {
        Self { kept: Vec::new(), rows: 0, skipped: 0 }
    }
}

impl<const D: usize> Frames<D> {
    fn take(&mut self, frame: impl FnOnce() -> MotionFrame<D>) {
        let row = self.rows;
        self.rows += 1;
        if !row.is_multiple_of(self.skipped + 1) {
            return;
        }
        self.kept.push(frame());
        if self.kept.len() > MOST_FRAMES {
            let mut index = 0;
            self.kept.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.skipped = 2 * self.skipped + 1;
        }
    }
}

fn draw<M: Moving<D>, const D: usize>(args: &SimulateArgs, arm: &Arm, frames: &[MotionFrame<D>]) -> anyhow::Result<()> {
    let page = args.picture.page();
    if let Some(file) = &args.plot {
        let title = format!("{}: shapes at equal times", arm.name);
        output::draw(&M::strobe(frames, SHAPES, &title, &page), file, &args.picture.page)?;
    }
    if let Some(file) = &args.plot_time {
        output::draw(&motion_figure(frames, &format!("{} in motion", arm.name), &page), file, &args.picture.page)?;
    }
    Ok(())
}

/// An error of the motion in terms of the command's options.
pub(super) fn refused(error: MotionError) -> anyhow::Error {
    match error {
        MotionError::Option { option, value, expected } => wrong_option(option, value, expected, error),
        MotionError::State { ref reason } => {
            let message = format!("--from: the earlier motion does not fit: {reason}");
            anyhow::Error::new(error).context(message)
        }
        other => other.into(),
    }
}

/// What is wanted, and when.
struct Plan {
    start: f64,
    until: f64,
    every: f64,
    /// Places of stations in the table, and of those of whole shapes, m.
    stations: Vec<f64>,
    shape: Vec<f64>,
    shapes: Option<ShapeTimes>,
}

impl Plan {
    fn new(args: &SimulateArgs, arm: &Arm, start: f64) -> anyhow::Result<Self> {
        let until = args.until;
        if until <= start {
            return Err(WrongRequest::EndsBefore { until, start }.into());
        }
        let every = args.every.unwrap_or(0.01 * (until - start));
        let few = |option, value: f64, count: f64| {
            let expected = "longer: at most 1e7 rows are written";
            if count > MOST_ROWS { Err(refused(MotionError::Option { option, value, expected })) } else { Ok(()) }
        };
        few("every", every, (until - start) / every)?;
        if let Some(ShapeTimes::Every(every)) = args.shapes {
            few("shapes", every, (until - start) / every * args.shape_stations as f64)?;
        }
        if let Some(ShapeTimes::At(times)) = &args.shapes
            && let Some(value) = times.iter().copied().find(|time| !(start..=until * (1.0 + 1e-12)).contains(time))
        {
            let expected = "from the start to the end of the motion, in s";
            return Err(refused(MotionError::Option { option: "shapes", value, expected }));
        }
        if args.shapes.is_some() && args.shapes_output.is_none() && MotionOutput::format(args) != MotionFormat::Json {
            return Err(WrongRequest::ShapesNowhere.into());
        }
        let length = arm.length;
        let place = |at: &StationAt| match *at {
            StationAt::Share(share) => Ok(share * length),
            StationAt::Length(s) if s > length * (1.0 + 1e-12) => Err(WrongRequest::PastTheTip(s, length)),
            StationAt::Length(s) => Ok(s),
        };
        let stations = args.station.iter().map(place).collect::<Result<_, _>>()?;
        let last = args.shape_stations - 1;
        let shape = (0..=last).map(|k| length * k as f64 / last as f64).collect();
        Ok(Self { start, until, every, stations, shape, shapes: args.shapes.clone() })
    }

    /// The time of row `k`, up to the end.
    fn row(&self, k: u64) -> Option<f64> {
        self.within(self.start + k as f64 * self.every, self.every)
    }

    /// The time of whole shape `k`, up to the end.
    fn shape(&self, k: u64) -> Option<f64> {
        match self.shapes.as_ref()? {
            ShapeTimes::Every(every) => self.within(self.start + k as f64 * every, *every),
            ShapeTimes::At(times) => {
                let own = times.iter().copied().filter(|time| *time >= self.start);
                own.clone().nth(usize::try_from(k).ok()?).and_then(|time| self.within(time, self.every))
            }
        }
    }

    fn within(&self, time: f64, every: f64) -> Option<f64> {
        (time <= self.until + 1e-9 * every).then_some(time)
    }

    /// How many times of a sequence are over at `time`.
    fn past(time: f64, of: impl Fn(u64) -> Option<f64>) -> u64 {
        (0..u64::MAX).find(|k| of(*k).is_none_or(|own| own > time)).unwrap_or(u64::MAX)
    }
}

/// Why a run stops before its end.
enum Stop {
    Motion(MotionError),
    User,
    Output(anyhow::Error),
}

/// Moves on from row to row and from shape to shape; `row_taken` sees every row and may lengthen its numbers.
fn follow<M: Moving<D>, const D: usize>(
    plan: &Plan,
    simulation: &mut M,
    output: &mut MotionOutput,
    mut row_taken: impl FnMut(&M, &M::At, &mut Vec<f64>),
) -> Result<(), Stop> {
    let clock = Clock::now();
    let begin = simulation.time();
    let mut progress = Progress::new();
    let interrupted = exit::flag_at_ctrl_c();
    let mut kept = Clock::now();
    let mut row = output.rows();
    let mut shape = if row == 0 { 0 } else { Plan::past(begin, |k| plan.shape(k)) };
    loop {
        let next = [plan.row(row), plan.shape(shape)];
        let Some(time) = next.into_iter().flatten().min_by(f64::total_cmp) else { return Ok(()) };
        let at = simulation.advance_to(time).map_err(Stop::Motion)?;
        output.note_events(simulation.events()).map_err(Stop::Output)?;
        if next[1] == Some(time) {
            shape += 1;
            let (lines, own) = simulation.shape(&plan.shape);
            output.take_shape(&lines, own).map_err(Stop::Output)?;
        }
        if next[0] != Some(time) {
            continue;
        }
        row += 1;
        let mut numbers = simulation.numbers(&at, &plan.stations);
        row_taken(simulation, &at, &mut numbers);
        output.take_row(numbers).map_err(Stop::Output)?;
        if interrupted.load(Ordering::Relaxed) && plan.row(row).is_some() {
            return Err(Stop::User);
        }
        if kept.elapsed() > KEPT_EVERY {
            output.keep(simulation.state()).map_err(|error| Stop::Output(error.into()))?;
            kept = Clock::now();
        }
        progress.say(|| {
            let speed = (time - begin) / clock.elapsed().as_secs_f64();
            format!("{} s of {} s, {} times as fast as the clock", number(time), number(plan.until), number(speed))
        });
    }
}
