//! The equilibria of an arm in space that curves over the rotation of its base lead to.
//!
//! In the plane one curve meets every equilibrium ([`Arm::equilibria`]). In space the equilibria for all rotations of
//! the base are a manifold of three dimensions, that of the rotations of the tip, and the map from the rotation of the
//! tip to that of the base has the degree of the unloaded arm's, one: the signs of its determinant at all equilibria of
//! one base sum to one, as long as every section has strains on the way. That tells of some lists that one is
//! missing; no list is known to be complete. Newton's method that is kept away from what is known
//! (`deflation`) looks for shapes that no curve led to.

use std::f64::consts::PI;

use super::configuration::SpatialConfiguration;
use super::engine::Engine;
use super::equations::Guess;
use super::rotation::{Vector, cross, dot, sum, times};
use super::solve::{SpatialError, SpatialSolver};
use super::tip::SpatialTip;
use crate::rod::arm::Arm;
use crate::rod::parameter::Parameter;
use crate::statics::path::{Equilibrium, Further, Met, PathEnd, PathError, follow_turns, has_a_path};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::snap::SnapBounds;
use crate::statics::solve::Options;
use crate::statics::stability::Stability;

/// Turns of the base, and the place of their axes among those of the search, at which a solve may give the first
/// equilibrium.
const STARTS: [(f64, usize); 7] = [(0.0, 0), (0.25, 0), (-0.25, 0), (0.25, 1), (-0.25, 1), (0.1, 0), (-0.1, 0)];

/// Angles of axes across the base, from its c towards its b, in parts of half a turn: the first lot is always followed,
/// the others while an equilibrium is known to be missing.
const ANGLES: [&[f64]; 3] = [
    &[0.0, 0.5, 0.25, 0.75],
    &[0.125, 0.375, 0.625, 0.875],
    &[0.0625, 0.1875, 0.3125, 0.4375, 0.5625, 0.6875, 0.8125, 0.9375],
];

/// Axes (sine of the angle between them) that are one.
const ALIKE: f64 = 1e-3;

/// Two shapes whose tips are turned by less from each other (sine) are one: the rotation of the tip gives the arm.
const SAME: f64 = 1e-5;

/// Most searches by deflation, and how far from each shape that is known they begin, in parts of its way from the
/// unloaded arm.
const DEFLATIONS: usize = 40;
const ASIDE: [f64; 2] = [-0.5, 0.5];

/// Work of one of these searches, in evaluations of a station.
const DEFLATION_WORK: usize = 200_000;

/// Most equilibria.
const MOST: usize = 60;

/// The equilibria of an arm in space that were found under its loads. There may be others.
#[derive(Debug, Clone)]
pub struct SpatialEquilibria {
    /// In the order of the tip's x, then y and z.
    pub found: Vec<Equilibrium<SpatialConfiguration>>,
    /// Curves over the turn of the base about an axis that were followed, and why each ended; `None` where it came to
    /// what was known.
    pub curves: Vec<Option<PathEnd>>,
    /// Points of all curves.
    pub steps: usize,
    /// The sum of the signs of the determinants at the equilibria found, where all are known. It is one for all
    /// equilibria of an arm whose sections have strains at every rotation of the base.
    pub sum_of_signs: Option<i64>,
    /// Whether the arm and what acts on it are alike on all sides of the axis of the base: then each shape that leaves
    /// the axis stands for the circle of those that are turned from it about the axis, and is marginal at best.
    pub circles: bool,
}

impl SpatialEquilibria {
    /// Whether it is known that equilibria are missing: the signs of the determinants do not sum to one, though no
    /// curve ended at a limit of a section.
    pub fn misses_some(&self) -> bool {
        tells_that_some_are_missing(&self.curves, self.sum_of_signs)
    }
}

/// Whether the signs of the determinants do not sum to one, though no curve ended at a limit of a section.
fn tells_that_some_are_missing(curves: &[Option<PathEnd>], sum_of_signs: Option<i64>) -> bool {
    let is_limited = curves.iter().any(|end| matches!(end, Some(PathEnd::Limit { .. })));
    !is_limited && sum_of_signs.is_some_and(|sum| sum != 1)
}

/// The equilibria of an arm in space that are found from `start` or, without one, from the path of the loads. `go_on`
/// is asked after every point of a curve, with how many there are.
pub(crate) fn equilibria(
    arm: &Arm,
    tol: f64,
    start: Option<&SpatialConfiguration>,
    go_on: &mut dyn FnMut(usize) -> bool,
) -> Result<SpatialEquilibria, PathError<SpatialError>> {
    if !(1e-12..=1e-3).contains(&tol) {
        return Err(PathError::Option { option: "tol", value: tol, expected: "in [1e-12, 1e-3]" });
    }
    has_a_path(arm)?;
    if let Some(cable) = arm.cables.iter().find(|c| c.stroke.is_some()) {
        return Err(PathError::Stroke { cable: cable.name.clone() });
    }
    let mut arm = arm.clone();
    arm.space.get_or_insert_default();
    let axes = first_axes(&arm);
    let mut search = Search { tol, found: Vec::new(), axes, known: Vec::new(), axis: 0, steps: 0, go_on };
    let mut curves = Vec::new();
    if let Some(start) = start {
        let mut engine = Engine::new(&arm);
        engine.take_shape_of(start);
        search.keep(&mut engine);
    }
    if search.found.is_empty() {
        search.start(&arm, &mut curves)?;
    }
    search.follow_all(&arm, &mut curves);
    search.deflate_all(&arm, &mut curves);
    let sum_of_signs = search.sum_of_signs();
    let circles = Engine::new(&arm).equations.axis_of_symmetry().is_some();
    let mut found: Vec<_> = search.found.into_iter().map(|found| found.shape).collect();
    let place = |one: &Equilibrium<SpatialConfiguration>| {
        let tip = one.configuration.tip();
        [tip.x, tip.y, tip.z].map(|v| (v / (1e-7 * arm.length)).round())
    };
    found.sort_by(|p, q| {
        let (p, q) = (place(p), place(q));
        p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])).then(p[2].total_cmp(&q[2]))
    });
    Ok(SpatialEquilibria { found, curves, steps: search.steps, sum_of_signs, circles })
}

/// Axes in space for the turns of the base: across its a and each load, then those of the first lot of angles.
fn first_axes(arm: &Arm) -> Vec<Vector<f64>> {
    let [a, _] = arm.base_directors();
    let space = arm.space.clone().unwrap_or_default();
    let force = [arm.tip.force[0], arm.tip.force[1], space.tip_force];
    let mut axes = Vec::new();
    for load in [arm.stream_in_space(), arm.gravity_in_space(), force] {
        add_axis(&mut axes, cross(&a, &load), dot(&load, &load).sqrt());
    }
    add_angles(&mut axes, arm, ANGLES[0]);
    axes
}

fn add_angles(axes: &mut Vec<Vector<f64>>, arm: &Arm, angles: &[f64]) {
    let [a, b] = arm.base_directors();
    let c = cross(&a, &b);
    for angle in angles {
        let (sin, cos) = (PI * angle).sin_cos();
        add_axis(axes, sum(&times(cos, &c), &times(sin, &b)), 1.0);
    }
}

/// Adds an axis, of any length against `unit`, that is none of those there.
fn add_axis(axes: &mut Vec<Vector<f64>>, axis: Vector<f64>, unit: f64) {
    let length = dot(&axis, &axis).sqrt();
    if length <= ALIKE * unit || !length.is_finite() {
        return;
    }
    let axis = times(1.0 / length, &axis);
    let is_alike = |other: &Vector<f64>| {
        let off = cross(other, &axis);
        dot(&off, &off).sqrt() < ALIKE
    };
    if !axes.iter().any(is_alike) {
        axes.push(axis);
    }
}

/// An equilibrium with its engine.
struct Candidate {
    engine: Engine,
    tip: SpatialTip,
    shape: Equilibrium<SpatialConfiguration>,
    sign: Option<i64>,
}

struct Search<'g> {
    tol: f64,
    found: Vec<Candidate>,
    /// Axes in space.
    axes: Vec<Vector<f64>>,
    /// Equilibria, axes and sides whose curve was followed.
    known: Vec<(usize, usize, bool)>,
    /// The axis of the present curve.
    axis: usize,
    steps: usize,
    go_on: &'g mut dyn FnMut(usize) -> bool,
}

impl Search<'_> {
    /// Finds the first equilibrium: by a solve at the base of the arm or, where there is none, at one that is turned
    /// from it, and by the curve from there.
    fn start(&mut self, arm: &Arm, curves: &mut Vec<Option<PathEnd>>) -> Result<(), PathError<SpatialError>> {
        let failed = |source| PathError::Start { parameter: Parameter::BaseAngle, value: arm.base.angle, source };
        let mut refused = None;
        for (turns, axis) in STARTS {
            let options = Options { snaps: SnapBounds::NONE, ..Options::default() };
            let mut solver = SpatialSolver::new(arm, options).map_err(failed)?;
            solver.engine.equations.stand_turned(self.axes[axis], turns);
            if let Err(error) = solver.solve() {
                if !matches!(error, SpatialError::NoEquilibrium(_)) {
                    return Err(failed(error));
                }
                refused.get_or_insert(error);
                continue;
            }
            let mut engine = solver.engine;
            engine.allowed = usize::MAX;
            if turns == 0.0 {
                self.keep(&mut engine);
            } else {
                self.axis = axis;
                engine.equations.turn_base(self.axes[axis]);
                engine.equations.set_range_fraction(turns);
                for side in [1.0, -1.0] {
                    curves.push(follow_turns(&mut engine.clone(), side, &mut |met| self.meet(met)));
                }
            }
            if !self.found.is_empty() {
                return Ok(());
            }
        }
        refused.map_or(Ok(()), |error| Err(failed(error)))
    }

    /// Follows the curves about all axes from everything that is found, until nothing is new, and about more axes while
    /// something is known to be missing.
    fn follow_all(&mut self, arm: &Arm, curves: &mut Vec<Option<PathEnd>>) {
        for more in [&[][..], ANGLES[1], ANGLES[2]] {
            if !more.is_empty() && !tells_that_some_are_missing(curves, self.sum_of_signs()) {
                return;
            }
            add_angles(&mut self.axes, arm, more);
            let mut next = 0;
            while next < self.found.len() {
                for axis in 0..self.axes.len() {
                    for forwards in [true, false] {
                        self.axis = axis;
                        if !self.mark(next, forwards) {
                            continue;
                        }
                        let mut engine = self.found[next].engine.clone();
                        engine.equations.turn_base(self.axes[axis]);
                        let side = if forwards { 1.0 } else { -1.0 };
                        let end = follow_turns(&mut engine, side, &mut |met| self.meet(met));
                        curves.push(end);
                        if end == Some(PathEnd::Stopped) {
                            return;
                        }
                    }
                }
                next += 1;
            }
        }
    }

    /// Searches by deflation for shapes that no curve led to, from the unloaded arm and from beside the shapes that are
    /// known, and follows the curves from what is new. Not where shapes are circles: keeping away from one shape of a
    /// circle leads to its next.
    fn deflate_all(&mut self, arm: &Arm, curves: &mut Vec<Option<PathEnd>>) {
        let Some(first) = self.found.first() else { return };
        if first.engine.equations.axis_of_symmetry().is_some() || curves.last() == Some(&Some(PathEnd::Stopped)) {
            return;
        }
        let mut starts = vec![(0, -1.0)];
        let mut known = 0;
        let mut next = 0;
        while next < starts.len().min(DEFLATIONS) && self.found.len() < MOST {
            starts.extend((known..self.found.len()).flat_map(|k| ASIDE.map(|aside| (k, aside))));
            known = self.found.len();
            let start = starts[next];
            next += 1;
            if self.another(start) {
                self.follow_all(arm, curves);
                if curves.last() == Some(&Some(PathEnd::Stopped)) {
                    return;
                }
            }
        }
    }

    /// Looks for a shape by deflation, from a known one that is moved by a part of its way from the unloaded arm (to
    /// the unloaded arm itself by -1); whether one was found that is new.
    fn another(&mut self, (index, aside): (usize, f64)) -> bool {
        let known = self.found.len();
        let mut engine = self.found[index].engine.clone();
        engine.allowed = engine.work() + DEFLATION_WORK;
        let mut start = engine.solution.clone();
        engine.start_unloaded_on(start.mesh.clone());
        if aside > -1.0 && start.extrapolate(&engine.solution, aside) {
            engine.solution = start;
        }
        let found: Vec<&Guess> = self.found.iter().map(|found| &found.engine.solution).collect();
        if engine.near_another(&found).is_err() {
            return false;
        }
        engine.allowed = usize::MAX;
        self.keep(&mut engine) == Some(known)
    }

    /// The sum of the signs of the determinants, where all are known.
    fn sum_of_signs(&self) -> Option<i64> {
        self.found.iter().map(|found| found.sign).sum()
    }

    /// Notes that the curve about the present axis is known from an equilibrium to one side; whether that is new.
    fn mark(&mut self, index: usize, forwards: bool) -> bool {
        let here = (index, self.axis, forwards);
        let new = !self.known.contains(&here);
        if new {
            self.known.push(here);
        }
        new
    }

    /// Keeps the equilibrium of an engine whose base is held, if it is new; which one it is.
    fn keep(&mut self, engine: &mut Engine) -> Option<usize> {
        let close = engine.iterate(1e-6, 14, None).is_ok();
        let estimate = if close { engine.settle(self.tol, First::Warm).ok() } else { None };
        let estimate = estimate?;
        engine.linearise().ok()?;
        let sign = engine.determinant().known_sign().map(|sign| if sign > 0.0 { 1 } else { -1 });
        let tip = engine.read_tip()?;
        let tip = engine.equations.axis_of_symmetry().map_or(tip, |axis| in_one_half_plane(&tip, &axis));
        if let Some(index) = self.found.iter().position(|found| is_same(&found.tip, &tip)) {
            return Some(index);
        }
        let statistics = engine.statistics(0);
        let error = estimate * engine.equations.units.length;
        let configuration = SpatialConfiguration::read(engine, error, statistics).ok()?;
        let stability: Option<Stability> = configuration.stability();
        let shape = Equilibrium { configuration, stability };
        self.found.push(Candidate { engine: engine.clone(), tip, shape, sign });
        Some(self.found.len() - 1)
    }

    /// Takes what the present curve has come to; whether it is followed further.
    fn meet(&mut self, met: Met<'_, Engine>) -> Further {
        let Met::WholeTurns { engine, rises } = met else {
            self.steps += 1;
            return if (self.go_on)(self.steps) { Further::Yes } else { Further::Stop };
        };
        let mut clamped = engine.clone();
        clamped.equations.hold();
        let Some(index) = self.keep(&mut clamped) else { return Further::Yes };
        if self.found.len() >= MOST {
            return Further::Stop;
        }
        // What comes is followed now; what was before is that of the other side.
        let new = self.mark(index, rises);
        self.mark(index, !rises);
        if new { Further::Yes } else { Further::No }
    }
}

/// The directors of a tip whose arm is turned about its axis, with the section about its own a, until what leaves the
/// axis does so to the same side: all shapes of a circle have the same.
fn in_one_half_plane(tip: &SpatialTip, axis: &Vector<f64>) -> SpatialTip {
    let across = |v: &Vector<f64>| sum(v, &times(-dot(v, axis), axis));
    let off = across(&tip.a);
    let size = dot(&off, &off).sqrt();
    // Where the tip is along the axis its sections are alike.
    if size < SAME {
        return *tip;
    }
    let side = across(&if axis[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] });
    let side = times(1.0 / dot(&side, &side).sqrt(), &side);
    let off = times(1.0 / size, &off);
    let (cos, sin) = (dot(&off, &side), dot(&cross(&off, &side), axis));
    let turned = |v: &Vector<f64>| {
        let along = times((1.0 - cos) * dot(v, axis), axis);
        sum(&sum(&times(cos, v), &times(sin, &cross(axis, v))), &along)
    };
    // Q b, where the section turns back about a by the same angle.
    let b = sum(&times(cos, &tip.b), &times(-sin, &tip.c));
    let c = sum(&times(sin, &tip.b), &times(cos, &tip.c));
    SpatialTip { a: turned(&tip.a), b: turned(&b), c: turned(&c), ..*tip }
}

/// Whether two tips have the same rotation.
fn is_same(p: &SpatialTip, q: &SpatialTip) -> bool {
    let off = cross(&p.a, &q.a);
    let along = dot(&p.a, &q.a) > 0.0 && dot(&p.b, &q.b) > 0.0;
    along && dot(&off, &off).sqrt() < SAME && {
        let other = cross(&p.b, &q.b);
        dot(&other, &other).sqrt() < SAME
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the shape that the unloaded arm comes to, without any curve, an arm against the stream is led to others of
    /// those that the plane is known to have.
    #[test]
    fn deflation_leads_to_shapes_that_no_path_was_followed_to() {
        let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
        arm.flow.speed = 0.2;
        arm.flow.direction = 175.0_f64.to_radians();
        let planar = arm.equilibria(1e-8).unwrap();
        assert!(planar.complete && planar.found.len() >= 3);
        arm.space.get_or_insert_default();
        let go_on = &mut |_: usize| true;
        let axes = first_axes(&arm);
        let mut search = Search { tol: 1e-8, found: Vec::new(), axes, known: Vec::new(), axis: 0, steps: 0, go_on };
        search.start(&arm, &mut Vec::new()).unwrap();
        assert_eq!((search.found.len(), search.steps), (1, 0));
        let mut tries = 0;
        for start in [(0, -1.0), (0, -0.5), (0, 0.5), (1, -0.5), (1, 0.5), (2, -0.5), (2, 0.5)] {
            if start.0 < search.found.len() {
                search.another(start);
                tries += 1;
            }
        }
        let of_plane = |found: &Candidate| {
            let tip = found.shape.configuration.tip();
            let apart = planar.found.iter().map(|one| {
                let own = one.configuration.tip();
                (own.x - tip.x).hypot(own.y - tip.y).hypot(tip.z)
            });
            apart.fold(f64::INFINITY, f64::min) < 1e-6 * arm.length
        };
        let met = search.found.iter().filter(|found| of_plane(found)).count();
        println!("{} found in {tries} tries, {met} of the plane's {}", search.found.len(), planar.found.len());
        assert!(search.found.len() >= 2 && met >= 2, "{} found, {met} of the plane's", search.found.len());
    }
}
