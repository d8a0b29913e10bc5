//! All equilibria of an arm under its loads.
//!
//! Seen from the tip, the equations are an initial-value problem: with theta(L) given, so are the forces and the moment
//! there, and with them the whole arm down to the angle at which its base would have to be held. The
//! equilibria for all base angles therefore lie on one curve without branches, along which theta(L) only grows, and
//! which repeats itself when theta(L) has grown by a full turn. Following that curve once round, with
//! the base angle as the parameter, meets every equilibrium there is at the base angle asked for. Only
//! where a section has no strains, or a load jumps, does the curve end: then it is followed from both ends.

use std::f64::consts::TAU;

use super::points::{PathEnd, PathError, has_a_path};
use super::step_control::StepControl;
use super::stepper::{self, Fraction, MOVED, StepOutcome};
use super::traced::{Along, Traced};
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::configuration::Configuration;
use crate::statics::engine::{Engine, Trouble};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::snap::SnapBounds;
use crate::statics::solve::{Options, Solver};
use crate::statics::stability::Stability;
use crate::statics::verdict::{SolveError, VerdictKind};

/// Base angles away from that asked for at which a solve may give the curve's first point, in turns.
const STARTS: [f64; 8] = [0.0, 0.07, -0.07, 0.18, -0.18, 0.31, -0.31, 0.46];

/// Most points of the curve.
const MOST: usize = 5000;

/// Halvings of a step of the curve that may be needed to know how often the base comes to the angle asked for.
const HALVINGS: usize = 24;

/// Points by which an extreme of the angle of the base is found.
const EXTREMES: usize = 40;

/// Points and steps in the plane.
type Point = stepper::Point<Engine>;
type Stepper<'e> = stepper::Stepper<'e, Engine>;

/// How finely the curve is followed.
const PACE: StepControl = StepControl { longest: 0.25, straightness: 0.96, most: usize::MAX, accuracy: 1e-6 };

/// One of several equilibria: in the plane, or with [`crate::SpatialConfiguration`] in space.
#[derive(Debug, Clone)]
pub struct Equilibrium<C = Configuration> {
    /// The shape.
    pub configuration: C,
    /// `None` where it is not established.
    pub stability: Option<Stability>,
}

/// The equilibria of an arm under its loads.
#[derive(Debug, Clone)]
pub struct Equilibria {
    /// In the order of theta at the tip.
    pub found: Vec<Equilibrium>,
    /// Whether these are all: the curve of equilibria was followed once round.
    pub complete: bool,
    /// Angles of the tip (rad) over which the curve was followed, where the base is at [`Equilibria::base_angles`].
    pub tip_angles: [f64; 2],
    /// Angles of the base (rad) that the ends of the curve followed belong to.
    pub base_angles: [f64; 2],
    /// Why the curve was not followed further, on its two sides; `None` on a side that was not needed.
    pub ends: [Option<PathEnd>; 2],
    /// Points of the curve.
    pub steps: usize,
}

impl Arm {
    /// All equilibria under the arm's loads, whether the path from the unloaded arm leads to them or not, each with
    /// its stability. The tip position is good to `tol` L.
    ///
    /// The search is complete where [`Equilibria::complete`] says so: equilibria for all base angles lie on one
    /// curve that closes after a full turn of the tip, and the curve was followed once round.
    ///
    /// ```
    /// use hydrostat::Arm;
    ///
    /// // A soft arm that the stream meets from the tip.
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.2;
    /// arm.flow.direction = std::f64::consts::PI;
    /// let all = arm.equilibria(1e-8).unwrap();
    /// assert!(all.complete);
    /// // Straight, bent down the stream to either side, and an unstable one between each of these.
    /// assert_eq!(all.found.len(), 5);
    /// ```
    ///
    /// # Errors
    /// [`PathError::Start`] when no equilibrium was found at any base angle, [`PathError::Support`],
    /// [`PathError::Friction`], [`PathError::Option`], and [`PathError::Stroke`]: at commanded strokes an angle of the
    /// tip leaves the tensions open, so that the equilibria for all base angles need not be one curve.
    pub fn equilibria(&self, tol: f64) -> Result<Equilibria, PathError> {
        self.equilibria_while(tol, |_| true)
    }

    /// [`Arm::equilibria`] that asks `go_on` after every point of the curve, with how many there are, and ends the
    /// search where that is false: with what was found so far, [`PathEnd::Stopped`] as its end, and the angles that it
    /// covered.
    ///
    /// ```
    /// use hydrostat::{Arm, PathEnd};
    ///
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.2;
    /// arm.flow.direction = std::f64::consts::PI;
    /// let part = arm.equilibria_while(1e-8, |points| points < 20).unwrap();
    /// assert!(!part.complete && part.steps == 20);
    /// assert_eq!(part.ends[1], Some(PathEnd::Stopped));
    /// ```
    ///
    /// # Errors
    /// Those of [`Arm::equilibria`].
    pub fn equilibria_while(&self, tol: f64, mut go_on: impl FnMut(usize) -> bool) -> Result<Equilibria, PathError> {
        if !(1e-12..=1e-3).contains(&tol) {
            return Err(PathError::Option { option: "tol", value: tol, expected: "in [1e-12, 1e-3]" });
        }
        has_a_path(self)?;
        // With unknown tensions, theta(L) does not settle the arm: what follows is not one curve.
        if let Some(cable) = self.cables.iter().find(|c| c.stroke.is_some()) {
            return Err(PathError::Stroke { cable: cable.name.clone() });
        }
        let (mut solver, turned) = start(self)?;
        let asked = SectionQuery { arm: self.clone(), turned, tol };
        let engine = solver.engine_mut();
        let base = self.base.angle + TAU * turned;
        engine.equations.vary(Parameter::BaseAngle, base, base + TAU);
        let whole = engine.state();
        let mut out = Equilibria {
            found: Vec::new(),
            complete: false,
            tip_angles: [0.0; 2],
            base_angles: [base; 2],
            ends: [None; 2],
            steps: 0,
        };
        let forwards = follow(engine, &asked, 1.0, &mut out, &mut go_on);
        out.complete = forwards.is_none();
        out.ends[1] = forwards;
        if !out.complete && forwards != Some(PathEnd::Stopped) {
            engine.restore(&whole);
            let backwards = follow(engine, &asked, -1.0, &mut out, &mut go_on);
            out.ends[0] = backwards;
        }
        out.found.sort_by(|a, b| a.configuration.tip().theta.total_cmp(&b.configuration.tip().theta));
        out.found.dedup_by(|b, a| (b.configuration.tip().theta - a.configuration.tip().theta).abs() < 1e-7);
        Ok(out)
    }
}

/// What is searched for.
struct SectionQuery {
    arm: Arm,
    /// Where the curve starts, in turns of the base from the angle asked for.
    turned: f64,
    tol: f64,
}

/// A solve that succeeds, as near the base angle asked for as there is one, and how many turns away.
fn start(arm: &Arm) -> Result<(Solver, f64), PathError> {
    let failed = |source| PathError::Start { parameter: Parameter::BaseAngle, value: arm.base.angle, source };
    let mut first = None;
    for turned in STARTS {
        let mut turned_arm = arm.clone();
        turned_arm.base.angle += TAU * turned;
        let solved = Solver::new(&turned_arm, Options { snaps: SnapBounds::NONE, ..Options::default() })
            .and_then(|mut solver| solver.solve().map(|_| solver));
        match solved {
            Ok(solver) => return Ok((solver, turned)),
            Err(error @ SolveError::NoEquilibrium(_)) => first = first.or(Some(error)),
            Err(error) => return Err(failed(error)),
        }
    }
    match first {
        Some(source) => Err(failed(source)),
        None => unreachable!("there are base angles to try"),
    }
}

/// Follows the curve from the engine's configuration, towards larger (1) or smaller (-1) angles of the tip, for a full
/// turn. What stopped it before that.
fn follow(
    engine: &mut Engine,
    asked: &SectionQuery,
    side: f64,
    out: &mut Equilibria,
    go_on: &mut impl FnMut(usize) -> bool,
) -> Option<PathEnd> {
    let unbounded = [f64::NEG_INFINITY, f64::INFINITY];
    let mut stepper = Stepper::new(engine, Along::Range, unbounded);
    let begun =
        stepper.keep_accuracy(None, &mut Fraction::Fixed(0.0), [PACE.accuracy; 2]).and_then(|()| stepper.point(0.0));
    let Ok(mut here) = begun else { return Some(PathEnd::Limit { kind: VerdictKind::NotFound, s: None }) };
    let first = here.tip_angle();
    if side > 0.0 {
        out.tip_angles = [first; 2];
        if let Some(found) = at_whole_turns(&mut stepper, asked, &here, None) {
            out.found.push(found);
        }
    }
    if side * here.dlambda_ds * here.response.nodes.last().map_or(1.0, |z| z[0]) < 0.0 {
        stepper.orientation = -stepper.orientation;
        here.dlambda_ds = -here.dlambda_ds;
    }
    let mut step = 0.05;
    while step >= 1e-8 {
        let advanced = stepper.advance(&here, step, PACE);
        // Along the curve the angle of the tip only grows: what falls back has left it.
        let grown = |next: &Point| side * (next.tip_angle() - here.tip_angle()) > -1e-9;
        let next = match advanced {
            Ok((next, StepOutcome::Regular)) if grown(&next) => next,
            Ok(_) => {
                step *= 0.4;
                continue;
            }
            Err(trouble) => {
                stepper.last_trouble = Some(trouble);
                step *= 0.4;
                continue;
            }
        };
        out.steps += 1;
        let full = side * (next.tip_angle() - first) >= TAU;
        let within = &|point: &Point| side * (point.tip_angle() - first) < TAU - 1e-6;
        let mut inner = Vec::new();
        fill_in(&mut stepper, asked, [&here, &next], HALVINGS, &mut inner);
        let points: Vec<&Point> = std::iter::once(&here).chain(&inner).chain([&next]).collect();
        for pair in points.windows(2) {
            find_between(&mut stepper, asked, [pair[0], pair[1]], within, &mut out.found);
        }
        let end = usize::from(side > 0.0);
        out.tip_angles[end] = next.tip_angle();
        out.base_angles[end] = stepper.engine.equations.value_at(next.fraction);
        if full {
            return None;
        }
        if out.steps >= MOST {
            return Some(PathEnd::MostPoints);
        }
        if !go_on(out.steps) {
            return Some(PathEnd::Stopped);
        }
        here = next;
        step = (step * 1.6).min(PACE.longest);
    }
    Some(stepper.end_at(&here))
}

/// Points of the curve between two, as many as it takes to know how often the base comes to the angle asked for between
/// them.
///
/// Along the curve the angle of the base is a function of that of the tip, whose slope is known at each point. Between
/// two points it is taken to be the cubic of both values and slopes if that meets a third point, halfway, in value and
/// slope, and rises or falls all the way. Where it does not, and may come to the angle asked for, the same is asked of
/// both halves. What is less than [`HALVINGS`] halvings of a step wide may be missed.
fn fill_in(
    stepper: &mut Stepper<'_>,
    asked: &SectionQuery,
    [a, b]: [&Point; 2],
    halvings: usize,
    out: &mut Vec<Point>,
) {
    let cubic = Cubic::between(a, b);
    if halvings == 0 || !cubic.comes_near_whole_turns(asked.turned) {
        return;
    }
    let Some(middle) = inside(stepper, [a, b], 0.5) else { return };
    if cubic.meets(&middle) {
        return;
    }
    fill_in(stepper, asked, [a, &middle], halvings - 1, out);
    out.push(middle.clone());
    fill_in(stepper, asked, [&middle, b], halvings - 1, out);
}

/// A point of the curve between two, at the fraction `x` of the way between the angles of their tips, or nearer to one
/// of them where no such tangent leads.
fn inside(stepper: &mut Stepper<'_>, [a, b]: [&Point; 2], x: f64) -> Option<Point> {
    let way = b.tip_angle() - a.tip_angle();
    for part in [1.0, 0.3, 0.1, 0.03, 0.01] {
        let mut from = [(a, part * x * way), (b, -part * (1.0 - x) * way)];
        if x > 0.5 {
            from.swap(0, 1);
        }
        let point =
            from.into_iter().find_map(|(from, by)| stepper.at_tip_angle(from, from.tip_angle() + by, PACE).ok());
        if point.is_some() {
            return point;
        }
    }
    None
}

/// The point of the curve between two, on both sides of it, at which the angle of the base is extreme.
fn extreme_between(stepper: &mut Stepper<'_>, a: &Point, b: &Point) -> Option<Point> {
    let (mut low, mut high) = (a.clone(), b.clone());
    let mut best = None;
    for k in 0..EXTREMES {
        // The zero of the slope by its values at both ends, or, at every third time, halfway, so that both come in.
        let fraction = if k % 3 == 2 { 0.5 } else { low.slope() / (low.slope() - high.slope()) };
        let fraction = if fraction.is_finite() { fraction.clamp(0.05, 0.95) } else { 0.5 };
        let point = inside(stepper, [&low, &high], fraction)?;
        let side = point.slope() * low.slope() > 0.0;
        best = Some(point.clone());
        if side {
            low = point;
        } else {
            high = point;
        }
        if (high.tip_angle() - low.tip_angle()).abs() < 1e-7 {
            break;
        }
    }
    best
}

/// The angle of the base, in turns, as a cubic of the angle of the tip between two points of the curve.
struct Cubic {
    /// At both ends: the angle of the tip (rad), that of the base, and the slope of the latter.
    ends: [[f64; 3]; 2],
}

impl Cubic {
    /// Places between the ends at which values and slopes are looked at.
    const LOOKS: u32 = 8;

    fn between(a: &Point, b: &Point) -> Self {
        Self { ends: [a, b].map(|point| [point.tip_angle(), point.fraction, point.slope()]) }
    }

    /// Value and slope at the fraction `x` of the way.
    fn at(&self, x: f64) -> [f64; 2] {
        let [[p, f, s], [q, g, t]] = self.ends;
        let (width, y) = (q - p, 1.0 - x);
        let (s, t) = (s * width, t * width);
        let value = y * y * (1.0 + 2.0 * x) * f + x * x * (1.0 + 2.0 * y) * g + x * y * (y * s - x * t);
        let slope = 6.0 * x * y * (g - f) + y * (1.0 - 3.0 * x) * s + x * (3.0 * x - 2.0) * t;
        [value, slope / width]
    }

    fn looks(&self) -> impl Iterator<Item = [f64; 2]> {
        (0..=Self::LOOKS).map(|k| self.at(f64::from(k) / f64::from(Self::LOOKS)))
    }

    /// Least and largest value.
    fn range(&self) -> [f64; 2] {
        self.looks().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [v, _]| [low.min(v), high.max(v)])
    }

    /// Whether a whole number of turns from where the curve starts, `turned` off the angle asked for, is in reach.
    fn comes_near_whole_turns(&self, turned: f64) -> bool {
        let [low, high] = self.range();
        let margin = 0.1 * (high - low);
        (high + margin + turned).floor() >= low - margin + turned
    }

    /// Whether a point on the way is where the cubic has it, and the cubic rises or falls without pause.
    fn meets(&self, point: &Point) -> bool {
        let [[p, f, _], [q, g, _]] = self.ends;
        let x = (point.tip_angle() - p) / (q - p);
        let ([value, along], [low, high]) = (self.at(x), self.range());
        let mean = (g - f) / (q - p);
        let steepest = self.looks().fold(0.0_f64, |most, [_, slope]| most.max(slope.abs()));
        (point.fraction - value).abs() <= 0.01 * (high - low)
            && (point.slope() - along).abs() <= 0.1 * steepest
            && self.looks().all(|[_, slope]| slope * mean.signum() >= 0.2 * mean.abs())
    }
}

/// The equilibria between two points: the base angle rises or falls there, or does both about an extreme.
fn find_between(
    stepper: &mut Stepper<'_>,
    asked: &SectionQuery,
    [here, next]: [&Point; 2],
    within: &impl Fn(&Point) -> bool,
    out: &mut Vec<Equilibrium>,
) {
    if !Cubic::between(here, next).comes_near_whole_turns(asked.turned) {
        return;
    }
    let extreme = if here.slope() * next.slope() < 0.0 { extreme_between(stepper, here, next) } else { None };
    let legs = match &extreme {
        Some(extreme) => vec![[here, extreme], [extreme, next]],
        None => vec![[here, next]],
    };
    for [from, to] in legs {
        for turns in whole_turns_between(asked, from, to) {
            let Some(point) = between(stepper, from, to, turns - asked.turned) else { continue };
            if within(&point)
                && let Some(found) = at_whole_turns(stepper, asked, &point, Some(turns))
            {
                out.push(found);
            }
        }
    }
}

/// Turns of the base from the angle asked for, whole ones, that lie between two points.
fn whole_turns_between(asked: &SectionQuery, a: &Point, b: &Point) -> Vec<f64> {
    let (mut low, mut high) = (a.fraction + asked.turned, b.fraction + asked.turned);
    if low > high {
        (low, high) = (high, low);
    }
    let mut out = Vec::new();
    let mut turns = low.ceil();
    // A point that is itself at a whole turn belongs to the leg that it ends.
    while turns <= high {
        if turns != a.fraction + asked.turned {
            out.push(turns);
        }
        turns += 1.0;
    }
    out
}

/// The point between two at which the base has turned to `fraction`.
fn between(stepper: &mut Stepper<'_>, a: &Point, b: &Point, fraction: f64) -> Option<Point> {
    if b.fraction == fraction {
        return Some(b.clone());
    }
    let (mut low, mut high) = (a.clone(), b.clone());
    for _ in 0..40 {
        let near = if (low.fraction - fraction).abs() < (high.fraction - fraction).abs() { &low } else { &high };
        if let Ok((point, StepOutcome::Regular)) =
            stepper.land(near, fraction, StepControl { straightness: -1.0, ..PACE })
        {
            let angle = point.tip_angle();
            let (least, most) = (low.tip_angle(), high.tip_angle());
            if (angle - least) * (angle - most) <= 1e-12 {
                return Some(point);
            }
        }
        // Near an extreme a tangent does not lead there: halve the way, by the angle of the tip.
        let middle = inside(stepper, [&low, &high], 0.5)?;
        if (middle.fraction - fraction) * (low.fraction - fraction) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    None
}

/// The configuration at a point where the base is whole turns from the angle asked for, at that angle itself. With no
/// turns given, whether the point is one.
fn at_whole_turns(
    stepper: &mut Stepper<'_>,
    asked: &SectionQuery,
    point: &Point,
    turns: Option<f64>,
) -> Option<Equilibrium> {
    let turns = turns.or_else(|| (asked.turned == 0.0 && point.fraction == 0.0).then_some(0.0))?;
    let engine = &mut *stepper.engine;
    engine.restore(&point.state);
    engine.hold(&asked.arm, TAU * turns);
    let before = engine.tip_angle();
    let estimate = settle(engine, asked.tol).ok()?;
    let after = engine.tip_angle();
    let statistics = engine.statistics(0);
    let read = Configuration::read(engine, estimate * asked.arm.length, statistics).ok();
    engine.restore(&point.state);
    let configuration = read.filter(|_| (after - before).abs() < 0.05)?;
    let stability = configuration.stability();
    Some(Equilibrium { configuration, stability })
}

fn settle(engine: &mut Engine, tol: f64) -> Result<f64, Trouble> {
    engine.newton(1e-6, 14)?;
    engine.settle(tol, First::Warm)
}

impl Point {
    /// theta at the tip, rad.
    fn tip_angle(&self) -> f64 {
        self.state.solution.nodes.last().map_or(0.0, |z| z[0])
    }

    /// The change of the fraction by that of the angle of the tip (rad) along the branch.
    fn slope(&self) -> f64 {
        self.response.nodes.last().map_or(f64::INFINITY, |z| 1.0 / z[0])
    }
}

impl Stepper<'_> {
    /// The point of the branch at which the tip has a given angle, from one nearby. There is one wherever that angle
    /// alone decides the shape, round sharp folds, too, of which no tangent at a distance knows.
    fn at_tip_angle(&mut self, here: &Point, angle: f64, control: StepControl) -> Result<Point, Trouble> {
        let d_lambda = (angle - here.tip_angle()) * here.slope();
        let mut fraction = self.predict(here, d_lambda / here.dlambda_ds);
        let from = self.engine.nodes();
        self.correct_at_tip(&mut fraction)?;
        let moved = self.engine.largest_turn_since(&from);
        if moved > MOVED {
            return Err(Trouble::Stalled(moved));
        }
        let mut fraction = Fraction::AtTip(fraction);
        self.keep_accuracy(None, &mut fraction, [control.accuracy; 2])?;
        self.engine.check_ends()?;
        self.point(fraction.value())
    }
}
