//! `hydrostat simulate`: the arm in motion.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Write as _};
use std::path::Path;
use std::time::Instant as Clock;

use hydrostat::{Arm, Inputs, Instant, MotionError, MotionOptions, Simulation};
use hydrostat_figures::{MotionFrame, motion_figure, strobe_figure};
use hydrostat_files::{MotionDocument, WriteError, motion_columns, motion_row, number, read_time_loads, set_shaped};

use crate::args::{MotionFormat, SimulateArgs};
use crate::output;
use crate::progress::Progress;
use crate::request;

/// The most rows of one document.
const MOST_ROWS: f64 = 1e7;

pub(crate) fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    let arm = request::arm(&args.arm, "`hydrostat simulate`")?;
    let loads = args.input.as_deref().map(|file| ("--input", file));
    let pictures = [("--plot", args.plot.as_deref()), ("--plot-time", args.plot_time.as_deref())];
    let outputs = [("-o", args.output.as_deref()), pictures[0], pictures[1]];
    request::check_outputs(&[request::arm_input(&args.arm.file), loads], &outputs)?;
    request::check_picture(&args.picture, &pictures)?;
    let mut inputs = Inputs::default();
    if let Some(file) = &args.input {
        read_time_loads(file, &mut inputs)?;
    }
    for text in &args.vary {
        set_shaped(text, &mut inputs).map_err(|error| {
            let message = format!("--vary {error}");
            anyhow::Error::new(error).context(message)
        })?;
    }
    let every = args.every.unwrap_or(0.01 * args.until);
    if args.until / every > MOST_ROWS {
        let error =
            MotionError::Option { option: "every", value: every, expected: "longer: at most 1e7 rows are written" };
        return Err(refused(error));
    }
    let options = MotionOptions { tol: args.tol, elements: args.elements, ..MotionOptions::default() };
    let start = Clock::now();
    let mut simulation = Simulation::new(&arm, inputs, options).map_err(refused)?;
    let mut sink = Sink::new(args, &arm)?;
    let mut progress = Progress::new();
    let mut failure: Option<io::Error> = None;
    let draws = args.plot.is_some() || args.plot_time.is_some();
    let mut frames = Frames::default();
    let outcome = simulation.run(args.until, every, |at, simulation| {
        if draws {
            frames.take(at, simulation);
        }
        progress.say(|| {
            let wall = start.elapsed().as_secs_f64();
            format!(
                "{} s of {} s, {} times as fast as the clock",
                number(at.time),
                number(args.until),
                number(at.time / wall)
            )
        });
        failure = sink.take(at).err();
        failure.is_none()
    });
    drop(progress);
    if let Some(source) = failure {
        return Err(sink.error(source));
    }
    draw(args, &arm, &frames.kept)?;
    let verdict = outcome.as_ref().err().map(ToString::to_string);
    sink.end(&arm, &simulation, verdict, start.elapsed().as_secs_f64())?;
    outcome.map_err(refused)
}

/// Shapes that a strobe figure shows.
const SHAPES: usize = 24;

/// The most frames that figures keep: memory does not grow with the run.
const MOST_FRAMES: usize = 4000;

/// Frames of a run at equal times: every second one goes where there are too many.
#[derive(Default)]
struct Frames {
    kept: Vec<MotionFrame>,
    /// Rows so far, and those from one frame to the next, less one.
    rows: usize,
    skipped: usize,
}

impl Frames {
    fn take(&mut self, at: &Instant, simulation: &Simulation) {
        let row = self.rows;
        self.rows += 1;
        if !row.is_multiple_of(self.skipped + 1) {
            return;
        }
        self.kept.push(MotionFrame {
            time: at.time,
            centreline: simulation.shape().iter().map(|[_, x, y, _]| [*x, *y]).collect(),
            kinetic_energy: at.kinetic_energy,
            strain_energy: at.strain_energy,
        });
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

fn draw(args: &SimulateArgs, arm: &Arm, frames: &[MotionFrame]) -> anyhow::Result<()> {
    let page = args.picture.page();
    if let Some(file) = &args.plot {
        let title = format!("{}: shapes at equal times", arm.name);
        output::draw(&strobe_figure(frames, SHAPES, &title, &page), file, &args.picture.page)?;
    }
    if let Some(file) = &args.plot_time {
        output::draw(&motion_figure(frames, &format!("{} in motion", arm.name), &page), file, &args.picture.page)?;
    }
    Ok(())
}

/// An error of the motion in terms of the command's options.
pub(super) fn refused(error: MotionError) -> anyhow::Error {
    match error {
        MotionError::Option { option, value, expected } => {
            let message = format!("--{option}: expected a number {expected}, found {value}");
            anyhow::Error::new(error).context(message)
        }
        other => other.into(),
    }
}

/// Where the rows go.
struct Sink<'a> {
    format: MotionFormat,
    path: Option<&'a Path>,
    /// CSV grows as the motion goes on, so that what is there stays if it is broken off.
    file: Option<File>,
    rows: Vec<Instant>,
}

impl<'a> Sink<'a> {
    fn new(args: &'a SimulateArgs, arm: &Arm) -> anyhow::Result<Self> {
        let path = args.output.as_deref();
        let by_ending = match path {
            None => MotionFormat::Text,
            Some(path) if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json")) => {
                MotionFormat::Json
            }
            Some(_) => MotionFormat::Csv,
        };
        let mut out = Self { format: args.format.unwrap_or(by_ending), path, file: None, rows: Vec::new() };
        if out.format == MotionFormat::Csv {
            if let Some(path) = path {
                let file = File::create(path).map_err(|source| WriteError { path: path.to_owned(), source })?;
                out.file = Some(file);
            }
            let head = output::line(motion_columns(arm.cables.len()).join(","));
            if let Err(source) = out.write(&head) {
                return Err(out.error(source));
            }
        }
        Ok(out)
    }

    fn write(&mut self, text: &str) -> io::Result<()> {
        match &mut self.file {
            Some(file) => file.write_all(text.as_bytes()),
            None => output::print(text),
        }
    }

    fn take(&mut self, at: &Instant) -> io::Result<()> {
        match self.format {
            MotionFormat::Csv => self.write(&motion_row(at))?,
            MotionFormat::Json => self.rows.push(at.clone()),
            MotionFormat::Text => self.rows = vec![at.clone()],
        }
        Ok(())
    }

    fn error(&self, source: io::Error) -> anyhow::Error {
        match self.path {
            Some(path) => WriteError { path: path.to_owned(), source }.into(),
            None => source.into(),
        }
    }

    fn end(self, arm: &Arm, simulation: &Simulation, verdict: Option<String>, wall: f64) -> anyhow::Result<()> {
        let (statistics, estimate) = (simulation.statistics(), simulation.error_estimate());
        match self.format {
            MotionFormat::Csv => Ok(()),
            MotionFormat::Json => {
                let document = MotionDocument::new(arm, &self.rows, statistics, estimate, verdict);
                output::put(self.path, &output::line(document.to_json()))
            }
            MotionFormat::Text => {
                let Some(at) = self.rows.last() else { return Ok(()) };
                let mut text = format!(
                    "motion {}\n\nafter  {} s the tip is at ({}, {}) m, turned by {} deg, and moves at {} m/s\n",
                    arm.name,
                    number(at.time),
                    number(at.tip[0]),
                    number(at.tip[1]),
                    number(at.tip_theta.to_degrees()),
                    number(at.tip_velocity[0].hypot(at.tip_velocity[1]))
                );
                for (cable, own) in arm.cables.iter().zip(&at.cables) {
                    let _ = writeln!(
                        text,
                        "cable  {}: {} N, {} mm reeled in",
                        cable.name,
                        number(own.tension),
                        number(1e3 * own.stroke)
                    );
                }
                let _ = writeln!(
                    text,
                    "energy {} J kinetic, {} J of strain\nsteps  {} in time, {} taken back, on {} elements, in {} s: {} times as fast as the clock\n\
                     error  about {} m at the tip by the steps",
                    number(at.kinetic_energy),
                    number(at.strain_energy),
                    statistics.steps,
                    statistics.rejected,
                    statistics.elements,
                    number(wall),
                    number(at.time / wall),
                    number(estimate)
                );
                output::put(self.path, &text)
            }
        }
    }
}
