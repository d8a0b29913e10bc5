//! Paths that users ask for: equilibria over the range of one parameter, through limit points and bifurcations.

use super::contact::Contact;
use super::step_control::StepControl;
use super::stepper::{Along, Fraction, Point, StepOutcome, Stepper};
use crate::rod::arm::Arm;
use crate::rod::parameter::{Parameter, Refused};
use crate::rod::readings::Support;
use crate::statics::configuration::Configuration;
use crate::statics::engine::{Engine, Trouble};
use crate::statics::solve::{Options, Solver};
use crate::statics::stability::Stability;
use crate::statics::verdict::{SolveError, VerdictKind};

/// Elements at the start of a path: a straight arm is exact on fewer, but not its determinant.
const FEWEST: usize = 8;

/// A step in which the number of unstable directions changes by more than its events explain is repeated with shorter
/// ones down to this length: two bifurcations leave the sign of the determinant as it was.
const COUNTED: f64 = 0.01;

/// How a path is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathOptions {
    /// Error of the tip position over L that is kept at every point, in [1e-7, 1e-3].
    pub tol: f64,
    /// Longest step: root mean square of the change of theta along the arm (rad), joined with the change of the
    /// parameter over its range. In [0.001, 0.4].
    pub longest: f64,
    /// Most points.
    pub most: usize,
    /// Whether to follow the branches that cross at bifurcations, too.
    pub branches: bool,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self { tol: 1e-6, longest: 0.2, most: 1000, branches: false }
    }
}

/// What is special about a point of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Event {
    /// The parameter turns back: beyond it this shape has no neighbour, and the arm snaps.
    LimitPoint,
    /// Another branch crosses.
    Bifurcation,
    /// The cable of this index, whose stroke is commanded, goes slack.
    Slack(usize),
    /// The cable of this index, whose stroke is commanded, is taken up.
    Taut(usize),
}

impl Event {
    /// The name in results: `limit_point`, `bifurcation`, `slack` or `taut`.
    pub fn name(self) -> &'static str {
        match self {
            Self::LimitPoint => "limit_point",
            Self::Bifurcation => "bifurcation",
            Self::Slack(_) => "slack",
            Self::Taut(_) => "taut",
        }
    }

    /// The index of the cable that goes slack or taut.
    pub fn cable(self) -> Option<usize> {
        match self {
            Self::Slack(cable) | Self::Taut(cable) => Some(cable),
            Self::LimitPoint | Self::Bifurcation => None,
        }
    }
}

/// One equilibrium of a path.
#[derive(Debug, Clone)]
pub struct PathPoint {
    /// The parameter.
    pub value: f64,
    /// The shape, its arm carrying that value.
    pub configuration: Configuration,
    /// `None` where it is not established.
    pub stability: Option<Stability>,
    /// What is special about it.
    pub event: Option<Event>,
}

/// Why a path ends where it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathEnd {
    /// At the end of the range.
    ReachedEnd,
    /// Back at the start of the range, on another branch than it left from or on the way back from a limit point.
    ReachedStart,
    /// After the most points allowed.
    MostPoints,
    /// Where whoever watched it said so.
    Stopped,
    /// At what no equilibrium goes past: the kind, with the place along the arm (m) if the limit is local.
    Limit {
        /// Which limit.
        kind: VerdictKind,
        /// Where, m.
        s: Option<f64>,
    },
}

impl PathEnd {
    /// The name in results: `reached_end`, `cable_fold` and so on.
    pub fn name(self) -> &'static str {
        match self {
            Self::ReachedEnd => "reached_end",
            Self::ReachedStart => "reached_start",
            Self::MostPoints => "most_points",
            Self::Stopped => "stopped",
            Self::Limit { kind, .. } => kind.name(),
        }
    }
}

/// Equilibria in the order in which a branch meets them.
#[derive(Debug, Clone)]
pub struct Branch {
    /// Limit points and bifurcations stand among the others, in their place.
    pub points: Vec<PathPoint>,
    /// Why it ends.
    pub end: PathEnd,
    /// Value of the parameter at the bifurcation that it was switched to at.
    pub switched_at: Option<f64>,
}

/// A path of equilibria.
#[derive(Debug, Clone)]
pub struct Path {
    /// What varies.
    pub parameter: Parameter,
    /// Its range: the path starts at the first value.
    pub range: [f64; 2],
    /// The branch that the solve at the first value is on, then those switched to.
    pub branches: Vec<Branch>,
}

/// Why there is no path.
#[derive(Debug, Clone, thiserror::Error)]
pub enum PathError {
    /// The arm cannot have the value at one end of the range.
    #[error("at {}: {source}", parameter.shown(*value))]
    Value {
        /// What was to vary.
        parameter: Parameter,
        /// The value.
        value: f64,
        /// Why not.
        source: Refused,
    },
    /// An option or a range that cannot be.
    #[error("`{option}` must be {expected}, found {value}")]
    Option {
        /// Which option.
        option: &'static str,
        /// What it is.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The reading has no family of equilibria.
    #[error("`support = \"unstrained-base\"` is an initial-value problem without limit points or several equilibria")]
    Support,
    /// Cables whose stroke is commanded, where all equilibria are asked for.
    #[error(
        "cable `{cable}` has a commanded stroke: the equilibria for all base angles are one curve at given tensions \
         only; set the tension that `solve` finds"
    )]
    Stroke {
        /// The first such cable's name.
        cable: String,
    },
    /// Cables that rub: what they carry depends on how they slid.
    #[error(
        "cable `{cable}` has friction, so that its tension depends on the history of loading; paths need cables without friction"
    )]
    Friction {
        /// The first such cable's name.
        cable: String,
    },
    /// There is no equilibrium to start from.
    #[error("no equilibrium at the start of the path, {}: {source}", parameter.shown(*value))]
    Start {
        /// What was to vary.
        parameter: Parameter,
        /// The value.
        value: f64,
        /// Why not.
        source: SolveError,
    },
}

impl Arm {
    /// Whether there are paths of this arm's equilibria.
    pub(super) fn has_a_path(&self) -> Result<(), PathError> {
        if self.readings.support == Support::UnstrainedBase {
            return Err(PathError::Support);
        }
        match self.cables.iter().find(|c| c.friction > 0.0) {
            Some(cable) => Err(PathError::Friction { cable: cable.name.clone() }),
            None => Ok(()),
        }
    }

    /// Follows the equilibria of this arm while `parameter` runs from `range[0]` towards `range[1]` (units of
    /// [`Parameter::unit`]), by pseudo-arclength continuation: through limit points, where the parameter
    /// turns back, and past bifurcations, until either end of the range is reached.
    ///
    /// The path starts at the configuration that [`Arm::solve`] gives at `range[0]`. The values of limit points and
    /// bifurcations are good to 1e-6 of the range. Cables whose stroke is commanded keep it, or follow it where it is
    /// what varies; where one goes slack or taut the path has a corner, which is an event, and at which the parameter
    /// may turn back.
    ///
    /// ```
    /// use hydrostat::{Arm, Event, Parameter, PathOptions};
    ///
    /// // An arm that lies down the stream, is turned to face it and past it, and then snaps.
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.2;
    /// arm.flow.direction = std::f64::consts::PI;
    /// let path = arm.path(Parameter::BaseAngle, [1.5, -1.5], &PathOptions::default()).unwrap();
    /// let limits = path.branches[0].points.iter().filter(|p| p.event == Some(Event::LimitPoint));
    /// assert_eq!(limits.count(), 4); // into straight and out of it, on both sides
    /// ```
    ///
    /// # Errors
    /// [`PathError`].
    pub fn path(&self, parameter: Parameter, range: [f64; 2], options: &PathOptions) -> Result<Path, PathError> {
        self.path_with(parameter, range, options, |_| true)
    }

    /// [`Arm::path`] that hands every point to `watch` as it is found, and ends after the first for which that is
    /// false: with [`PathEnd::Stopped`], unless that point is the last anyway, and without the branches that were still
    /// to come.
    ///
    /// ```
    /// use hydrostat::{Arm, Parameter, PathEnd, PathOptions};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.1;
    /// let mut points = 0;
    /// let path = arm.path_with(Parameter::BaseAngle, [1.5, -1.5], &PathOptions::default(), |_| {
    ///     points += 1;
    ///     points < 5
    /// });
    /// let branch = &path.unwrap().branches[0];
    /// assert_eq!((branch.points.len(), branch.end), (5, PathEnd::Stopped));
    /// ```
    ///
    /// # Errors
    /// [`PathError`].
    pub fn path_with(
        &self,
        parameter: Parameter,
        range: [f64; 2],
        options: &PathOptions,
        mut watch: impl FnMut(&PathPoint) -> bool,
    ) -> Result<Path, PathError> {
        check(range, options)?;
        let value_error = |value, source| PathError::Value { parameter, value, source };
        let first = parameter.checked(self, range[0]).map_err(|e| value_error(range[0], e))?;
        parameter.checked(self, range[1]).map_err(|e| value_error(range[1], e))?;
        self.has_a_path()?;
        let start_error = |source| PathError::Start { parameter, value: range[0], source };
        let mut solver = Solver::new(&first, Options::with_tol(options.tol.min(1e-8))).map_err(start_error)?;
        solver.solve().map_err(start_error)?;

        let engine = solver.engine_mut();
        engine.equations.vary(parameter, range[0], range[1]);
        let control =
            StepControl { longest: options.longest, straightness: 0.97, most: usize::MAX, accuracy: options.tol };
        let mut trace = Trace {
            stepper: Stepper::new(engine, Along::Range, [0.0, 1.0]),
            control,
            most: options.most,
            watch: &mut watch,
            stopped: false,
            bifurcations: Vec::new(),
        };
        let first = if let Ok(start) = trace.start() {
            trace.from(start, None)
        } else {
            // Solved, but not as finely as a path needs: no point, and a reason.
            let end = PathEnd::Limit { kind: VerdictKind::NotFound, s: None };
            Branch { points: Vec::new(), end, switched_at: None }
        };
        let mut branches = vec![first];
        if options.branches {
            for crossing in std::mem::take(&mut trace.bifurcations) {
                branches.extend(trace.switched(&crossing));
            }
        }
        Ok(Path { parameter, range, branches })
    }
}

fn check(range: [f64; 2], options: &PathOptions) -> Result<(), PathError> {
    let refuse = |option, value, expected| Err(PathError::Option { option, value, expected });
    if !(1e-7..=1e-3).contains(&options.tol) {
        return refuse("tol", options.tol, "in [1e-7, 1e-3]");
    }
    if !(1e-3..=0.4).contains(&options.longest) {
        return refuse("longest", options.longest, "in [0.001, 0.4]");
    }
    for value in range {
        if !value.is_finite() {
            return refuse("range", value, "two finite numbers");
        }
    }
    if range[0] == range[1] {
        return refuse("range", range[1], "two different numbers");
    }
    Ok(())
}

struct Trace<'e, W> {
    stepper: Stepper<'e>,
    control: StepControl,
    /// Points that may still come.
    most: usize,
    watch: &'e mut W,
    /// Whether it said that this is enough.
    stopped: bool,
    /// Bifurcations, where the branch followed goes straight on.
    bifurcations: Vec<Point>,
}

impl<W: FnMut(&PathPoint) -> bool> Trace<'_, W> {
    /// The solve at the start of the range as a point.
    fn start(&mut self) -> Result<Point, Trouble> {
        let engine = &mut *self.stepper.engine;
        let parts = FEWEST.div_ceil(engine.solution.mesh.elements());
        if parts > 1 {
            let mesh = engine.solution.mesh.cut(parts);
            engine.move_to(mesh);
            engine.newton(1e-9, 12)?;
        }
        let tol = self.control.accuracy;
        self.stepper.keep_accuracy(None, &mut Fraction::Fixed(0.0), [tol, tol])?;
        self.stepper.first_contacts(0.0)
    }

    /// The branch from a point into the range.
    fn from(&mut self, mut here: Point, switched_at: Option<f64>) -> Branch {
        // Which side of zero the determinant is on is a matter of the branch, which way is up is not.
        if switched_at.is_none() && here.dlambda_ds < 0.0 {
            self.stepper.orientation = -self.stepper.orientation;
            here.dlambda_ds = -here.dlambda_ds;
        }
        self.stepper.begin(&mut here);
        let mut points = Vec::new();
        let end = self.collect(here, &mut points);
        Branch { points, end, switched_at }
    }

    fn collect(&mut self, mut here: Point, points: &mut Vec<PathPoint>) -> PathEnd {
        if let Some(first) = read(self.stepper.engine, &here, None)
            && let Some(end) = self.put(first, points)
        {
            return end;
        }
        let mut step = 0.05_f64.min(self.control.longest);
        while step >= 1e-8 {
            let advanced = self.stepper.advance_to_contact(&here, step, self.control);
            let (mut next, turn, contact) = match advanced {
                Ok(found) => found,
                Err(trouble) => {
                    self.stepper.last_trouble = Some(trouble);
                    step *= 0.4;
                    self.stepper.engine.restore(&here.state);
                    continue;
                }
            };
            let step_taken = if contact.is_some() { self.stepper.distance(&here, &next) } else { step };
            let event = if turn == StepOutcome::Bifurcation {
                Some(Event::Bifurcation)
            } else if next.dlambda_ds * here.dlambda_ds < 0.0 {
                Some(Event::LimitPoint)
            } else {
                None
            };
            let read_next = read(self.stepper.engine, &next, None);
            if step > COUNTED && change_of_count(points, read_next.as_ref()) > usize::from(event.is_some()) {
                step *= 0.4;
                self.stepper.engine.restore(&here.state);
                continue;
            }
            if let Some(event) = event
                && let Some(end) = self.put_event(event, &here, &mut next, step_taken, points)
            {
                return end;
            }
            if let Some(contact) = contact {
                if let Some(end) = self.put_contact(&contact, &next, points) {
                    return end;
                }
                here = contact.after;
                self.stepper.engine.restore(&here.state);
                step = step.min(0.05);
                continue;
            }
            // Corrections may have left the range: then the next step lands on its end.
            let inside = (0.0..=1.0).contains(&next.fraction);
            let end = read_next.filter(|_| inside).and_then(|read| self.put(read, points));
            if next.fraction == 1.0 {
                return PathEnd::ReachedEnd;
            }
            if next.fraction == 0.0 {
                return PathEnd::ReachedStart;
            }
            if let Some(end) = end {
                return end;
            }
            self.stepper.went(&here, &mut next);
            here = next;
            step = (step * 1.6).min(self.control.longest);
        }
        self.stepper.end_at(&here)
    }

    /// Keeps the point of an event between two points, and goes straight on through a bifurcation; why none may come
    /// after it.
    fn put_event(
        &mut self,
        event: Event,
        here: &Point,
        next: &mut Point,
        step: f64,
        points: &mut Vec<PathPoint>,
    ) -> Option<PathEnd> {
        let at = if event == Event::Bifurcation {
            self.stepper.bifurcation(here, next, step, self.control)
        } else {
            self.stepper.limit_point(here, next, step, self.control).0
        };
        if let Some(read) = read(self.stepper.engine, &at, Some(event))
            && let Some(end) = self.put(read, points)
        {
            return Some(end);
        }
        if event == Event::Bifurcation {
            self.bifurcations.push(at);
            self.stepper.orientation = -self.stepper.orientation;
            next.dlambda_ds = -next.dlambda_ds;
        }
        None
    }

    /// Keeps the point at which a cable goes slack or taut, which may be a limit point, too; why none may come after
    /// it.
    fn put_contact(&mut self, contact: &Contact, next: &Point, points: &mut Vec<PathPoint>) -> Option<PathEnd> {
        let event = if contact.slack { Event::Slack(contact.cable) } else { Event::Taut(contact.cable) };
        let turns_back = (contact.after.dlambda_ds * next.dlambda_ds < 0.0).then_some(Event::LimitPoint);
        for event in turns_back.into_iter().chain([event]) {
            if let Some(read) = read(self.stepper.engine, &contact.after, Some(event))
                && let Some(end) = self.put(read, points)
            {
                return Some(end);
            }
        }
        None
    }

    /// Keeps a point; why none may come after it.
    fn put(&mut self, point: PathPoint, points: &mut Vec<PathPoint>) -> Option<PathEnd> {
        self.stopped = !(self.watch)(&point);
        points.push(point);
        self.most = self.most.saturating_sub(1);
        if self.stopped {
            return Some(PathEnd::Stopped);
        }
        (self.most == 0).then_some(PathEnd::MostPoints)
    }

    /// The branches to both sides of a bifurcation.
    fn switched(&mut self, crossing: &Point) -> Vec<Branch> {
        let mut out = Vec::new();
        for side in [1.0, -1.0] {
            let value = self.stepper.engine.equations.value_at(crossing.fraction);
            if self.stopped {
                break;
            }
            if let Some(first) = self.stepper.switch(crossing, side, self.control) {
                out.push(self.from(first, Some(value)));
            }
        }
        out
    }
}

/// By how much the number of unstable directions at `next` differs from that at the last regular point.
fn change_of_count(points: &[PathPoint], next: Option<&PathPoint>) -> usize {
    let count = |point: &PathPoint| match point.stability {
        Some(Stability::Stable) => Some(0),
        Some(Stability::Unstable(count)) => Some(count),
        _ => None,
    };
    let last = points.iter().rev().find(|p| p.event.is_none_or(|event| event.cable().is_some()));
    match (last.and_then(count), next.and_then(count)) {
        (Some(last), Some(next)) => last.abs_diff(next),
        _ => 0,
    }
}

/// The configuration at a point.
fn read(engine: &mut Engine, point: &Point, event: Option<Event>) -> Option<PathPoint> {
    engine.restore(&point.state);
    let value = engine.equations.value_at(point.fraction);
    let statistics = engine.statistics(0);
    let length = engine.equations.units.length;
    let configuration = Configuration::read(engine, point.error * length, statistics).ok()?;
    let stability = match event {
        // There one direction is neither stable nor unstable, by its definition.
        Some(Event::LimitPoint | Event::Bifurcation) => Some(Stability::Marginal),
        // With the cables taut that are so from there on.
        Some(Event::Slack(_) | Event::Taut(_)) | None => configuration.stability(),
    };
    Some(PathPoint { value, configuration, stability, event })
}
