//! The path that defines the answer: from the unloaded arm, loads first, then tensions (section 7 of
//! `docs/model.md`), followed by arclength so that no fold is stepped over unseen.

use hydrostat_bvp::{Correction, Mesh, Solution};

use crate::engine::{Engine, M, State, Trouble, solve};
use crate::equilibrium::{N, Q};
use crate::readings::Volume;
use crate::verdict::{Phase, Verdict, VerdictKind};

/// Fractions start here rather than at zero, where a tangent by the fraction is not defined. What an arm
/// in line with the stream does below is beyond the accuracy that its angles to the stream are known to.
const START: f64 = 1e-7;
/// Error of the tip over L that is kept along the path.
pub(crate) const LOOSE: f64 = 1e-4;

/// Largest turn a unit of load (rad) on a branch that nothing but the load moves along: rounding.
const SYMMETRIC: f64 = 1e-10;

/// The most accurate that a path gets however short its steps, tip error over L.
const FINEST: f64 = 1e-7;

/// More elements than this serve only to meet what a path must be accurate to.
const MANY: usize = 100;

/// Two branches that come as near as this fraction meet.
const MEET: f64 = 1e-3;

/// By how much of the steeper climb the mean climb of a step may differ from that of its two ends: two
/// folds within one step would make them differ by far more.
const EVEN: f64 = 0.15;

/// Steps shorter than this go round a corner of the path, which the load's kinks make where a whole part
/// of the arm meets them at once, and through bifurcations.
const CORNER: f64 = 1e-5;

/// Corrections (rad) that may go on hopping across a kink of the load.
const HOP: f64 = 1e-4;

/// Newton along the path, where hopping across a kink is good enough.
fn roughly(result: Result<(), Trouble>) -> Result<(), Trouble> {
    match result {
        Err(Trouble::Stalled(size)) if size <= HOP => Ok(()),
        other => other,
    }
}

/// How finely a path is followed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    /// Longest step of arclength (root mean square of the change of theta, with the fraction).
    pub(crate) longest: f64,
    /// Smallest cosine between the tangents at both ends of a step.
    pub(crate) straightness: f64,
    /// Most steps, refused ones included.
    pub(crate) most: usize,
    /// Error of the tip over L that is kept.
    pub(crate) accuracy: f64,
}

impl Pace {
    pub(crate) const BRISK: Self = Self { longest: 0.4, straightness: 0.94, most: 300, accuracy: LOOSE };
}

/// What a path met.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Travelled {
    pub(crate) steps: usize,
    /// Times the determinant changed sign while the load went on rising: bifurcations passed.
    pub(crate) crossings: usize,
    /// Whether it ended on a branch that nothing but the load moves along.
    pub(crate) symmetric: bool,
}

#[derive(Clone)]
struct Point {
    state: State,
    fraction: f64,
    /// Change a unit of load.
    response: Correction<N, M, Q>,
    /// The fraction's part of the unit tangent, positive where the load rises along the path: `rise`
    /// times `response` is the rest.
    rise: f64,
}

impl Point {
    fn mesh(&self) -> &Mesh {
        &self.state.solution.mesh
    }

    /// theta of the tangent at the nodes of another mesh: linear interpolation is enough to orient.
    fn tangent_on<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = f64> + 'a {
        let (own, response) = (self.mesh(), &self.response.nodes);
        mesh.nodes().iter().map(move |s| {
            let e = own.element_of(*s);
            let x = (s - own.nodes()[e]) / own.step(e);
            self.rise * (response[e][0] + x * (response[e + 1][0] - response[e][0]))
        })
    }

    fn is_symmetric(&self) -> bool {
        (self.rise * self.response.largest(0)).abs() < SYMMETRIC
    }
}

/// Whether corrections may change the load.
#[derive(Debug, Clone, Copy)]
enum Load {
    Fixed(f64),
    Free(f64),
}

impl Load {
    fn fraction(self) -> f64 {
        match self {
            Self::Fixed(fraction) | Self::Free(fraction) => fraction,
        }
    }
}

struct Stepper<'e> {
    engine: &'e mut Engine,
    phase: Phase,
    correction: Correction<N, M, Q>,
    response: Correction<N, M, Q>,
    last_trouble: Option<Trouble>,
    /// Sign of the climb times that of the determinant.
    orientation: f64,
    /// Fraction of the last solution that was refused as the next point because it is on a branch of
    /// the other orientation.
    opposite: Option<f64>,
}

/// Follows both phases to whole loads, or to a verdict, with the engine at the last good point.
pub(crate) fn follow(engine: &mut Engine, pace: Pace) -> Result<Travelled, Verdict> {
    let mut travelled = Travelled::default();
    engine.set_phase(Phase::Loads, START);
    engine.start_unloaded(10);
    for phase in [Phase::Loads, Phase::Tension] {
        let moves = match phase {
            Phase::Loads => engine.equations.has_loads(),
            Phase::Tension => engine.equations.has_tension(),
        };
        if moves {
            let mut stepper = Stepper {
                engine,
                phase,
                correction: Correction::default(),
                response: Correction::default(),
                last_trouble: None,
                orientation: 1.0,
                opposite: None,
            };
            stepper.follow(pace, &mut travelled)?;
        }
        engine.set_phase(phase, 1.0);
    }
    Ok(travelled)
}

/// How the path goes on at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Turn {
    /// Smoothly, or round a corner that a kink of the load makes.
    None,
    /// Smoothly, but the determinant's sign says backwards: another branch crosses.
    Crossing,
}

impl Stepper<'_> {
    fn follow(&mut self, pace: Pace, travelled: &mut Travelled) -> Result<(), Verdict> {
        let Ok(mut here) = self.start() else { return Err(self.never_started()) };
        // Which side of zero the determinant is on is a matter of the branch, which way is up is not.
        if here.rise < 0.0 {
            self.orientation = -self.orientation;
            here.rise = -here.rise;
        }
        let mut step = 0.1_f64.min(pace.longest);
        // A point before this one whose tangent climbed clearly more.
        let mut steeper = (here.fraction, here.rise);
        for attempt in 0.. {
            if attempt >= pace.most || step < 1e-8 {
                let residual = self.engine.last;
                self.engine.restore(&here.state);
                // Two branches of opposite orientation end where they meet: the path turns back in a corner
                // that the load's kinks make.
                if self.opposite.is_some_and(|f| (f - here.fraction).abs() < MEET) {
                    return Err(self.end(VerdictKind::LimitPoint, here.fraction, None));
                }
                let end = self.give_up(here.fraction, residual);
                // Towards a fold the square of the climb falls to zero linearly in the load.
                let fall = steeper.1.powi(2) - here.rise.powi(2);
                let ahead = (here.fraction - steeper.0) * here.rise.powi(2) / fall;
                if end.kind == VerdictKind::NotFound && here.rise < 0.1 && fall > 0.0 && ahead < 1e-3 {
                    return Err(self.end(VerdictKind::LimitPoint, here.fraction + ahead, None));
                }
                return Err(end);
            }
            match self.advance(&here, step, pace) {
                Ok((mut next, turn)) => {
                    if turn == Turn::Crossing {
                        // The branch goes straight on through a bifurcation.
                        self.orientation = -self.orientation;
                        next.rise = -next.rise;
                        travelled.crossings += 1;
                    }
                    if next.rise < 0.0 {
                        let limit = self.limit_point(&here, &next, step, pace);
                        return Err(self.end(VerdictKind::LimitPoint, limit, None));
                    }
                    travelled.steps += 1;
                    if next.fraction == 1.0 {
                        travelled.symmetric = next.is_symmetric();
                        return Ok(());
                    }
                    if here.rise > 1.3 * next.rise {
                        steeper = (here.fraction, here.rise);
                    } else if here.rise < next.rise {
                        steeper = (next.fraction, next.rise);
                    }
                    here = next;
                    step = (step * 1.6).min(pace.longest);
                }
                Err(trouble) => {
                    self.last_trouble = Some(trouble);
                    step *= 0.4;
                    self.engine.restore(&here.state);
                }
            }
        }
        unreachable!("the loop returns when its attempts are used up")
    }

    /// The point that a phase starts from. An arm that lies in the stream has tiny angles to it whose
    /// signs decide where it goes, so this point is made more accurate, as far as that can be had.
    fn start(&mut self) -> Result<Point, Trouble> {
        let whole = self.engine.solution.clone();
        let mut fraction = START;
        loop {
            self.set(fraction);
            match roughly(self.engine.newton(1e-6, 12)) {
                Ok(()) => break,
                // Straight in line with the stream an arm has a kink all along, and corrections hop.
                Err(_) if fraction > 1e-5 * START => {
                    fraction *= 0.1;
                    self.engine.solution.clone_from(&whole);
                }
                Err(trouble) => return Err(trouble),
            }
        }
        let refined = [1e-5, 1e-6, 1e-7].iter().all(|accuracy| {
            self.or_back(|this| this.keep_accuracy(None, &mut Load::Fixed(fraction), [*accuracy, LOOSE]))
        });
        if refined {
            self.or_back(|this| this.engine.settle(1e-8, true).map(|_| ()));
        }
        self.point(fraction)
    }

    /// Does `work`, or comes back to where it started from; whether it was done.
    fn or_back(&mut self, work: impl FnOnce(&mut Self) -> Result<(), Trouble>) -> bool {
        let before = self.engine.state();
        let done = work(self).is_ok();
        if !done {
            self.engine.restore(&before);
        }
        done
    }

    fn set(&mut self, fraction: f64) {
        self.engine.set_phase(self.phase, fraction);
    }

    fn linearise(&mut self) -> Result<(), Trouble> {
        let engine = &mut *self.engine;
        engine.linearise(true)?;
        solve(&engine.system, &engine.solution, 1, &mut self.response);
        Ok(())
    }

    /// Length of theta's change in the metric of the path: its root mean square along the arm.
    fn weights(&self) -> Vec<f64> {
        let mesh = &self.engine.solution.mesh;
        let n = mesh.elements();
        (0..=n)
            .map(|i| {
                let left = if i > 0 { mesh.step(i - 1) } else { 0.0 };
                let right = if i < n { mesh.step(i) } else { 0.0 };
                0.5 * (left + right)
            })
            .collect()
    }

    /// The point here. Its tangent is oriented by the determinant, whose sign times that of the climb is
    /// the same all along a branch, round folds and corners alike, until another branch crosses.
    fn point(&mut self, fraction: f64) -> Result<Point, Trouble> {
        self.linearise()?;
        let weights = self.weights();
        let square: f64 = weights.iter().zip(&self.response.nodes).map(|(w, z)| w * z[0] * z[0]).sum();
        let norm = (1.0 + square).sqrt();
        if !norm.is_finite() {
            return Err(Trouble::Singular);
        }
        let rise = self.orientation * self.engine.system.determinant().sign / norm;
        Ok(Point { state: self.engine.state(), fraction, response: self.response.clone(), rise })
    }

    /// Moves the solution from `here` along its tangent.
    fn predict(&mut self, here: &Point, step: f64) -> f64 {
        self.engine.restore(&here.state);
        let climb = step * here.rise;
        self.engine.solution.add(&here.response, climb);
        here.fraction + climb
    }

    fn advance(&mut self, here: &Point, step: f64, pace: Pace) -> Result<(Point, Turn), Trouble> {
        let mut fraction = self.predict(here, step);
        if fraction >= 1.0 {
            // Land on whole loads, at fixed load; near a fold that is refused and the step shrinks.
            let step = (1.0 - here.fraction) / here.rise;
            self.predict(here, step);
            self.set(1.0);
            let from = self.engine.solution.clone();
            roughly(self.engine.newton(1e-6, 9))?;
            let (end, turn) = self.arrive(here, &from, Load::Fixed(1.0), step, pace)?;
            if turn == Turn::None && end.rise < 0.0 {
                return Err(Trouble::Stalled(step));
            }
            return Ok((end, turn));
        }
        let from = self.engine.solution.clone();
        self.correct(here, &mut fraction)?;
        self.arrive(here, &from, Load::Free(fraction), step, pace)
    }

    /// Newton on the plane through the present state that the tangent at `here` is normal to.
    fn correct(&mut self, here: &Point, fraction: &mut f64) -> Result<(), Trouble> {
        let normal: Vec<f64> =
            here.tangent_on(&self.engine.solution.mesh).zip(self.weights()).map(|(t, w)| t * w).collect();
        let mut before = f64::INFINITY;
        for round in 0..12 {
            self.set(*fraction);
            self.linearise()?;
            solve(&self.engine.system, &self.engine.solution, 0, &mut self.correction);
            let dot = |c: &Correction<N, M, Q>| -> f64 { normal.iter().zip(&c.nodes).map(|(n, z)| n * z[0]).sum() };
            let slide = -dot(&self.correction) / (dot(&self.response) + here.rise);
            self.engine.system.quadratures(&mut self.engine.spans);
            self.engine.tip = [0.0; Q];
            for (i, span) in self.engine.spans.iter_mut().enumerate() {
                for q in 0..Q {
                    span[q] += self.correction.by_element[i][q] + slide * self.response.by_element[i][q];
                    self.engine.tip[q] += span[q];
                }
            }
            self.engine.solution.add(&self.correction, 1.0);
            self.engine.solution.add(&self.response, slide);
            *fraction += slide;
            let size = (0..self.correction.nodes.len())
                .map(|i| (self.correction.nodes[i][0] + slide * self.response.nodes[i][0]).abs())
                .fold(slide.abs(), f64::max);
            self.engine.last = size;
            if !size.is_finite() || size > 1.0 || (round > 3 && size > 10.0 * before) {
                return Err(Trouble::Stalled(size));
            }
            before = size;
            if size < 1e-6 {
                break;
            }
        }
        self.set(*fraction);
        // Across a kink corrections can hop between two points that are nearer than a path needs.
        if before > HOP { Err(Trouble::Stalled(before)) } else { Ok(()) }
    }

    /// The point that corrections have led to from the prediction `from`, if it may be trusted to be on
    /// the same branch and no fold was stepped over.
    fn arrive(
        &mut self,
        here: &Point,
        from: &Solution<N, M>,
        mut load: Load,
        step: f64,
        pace: Pace,
    ) -> Result<(Point, Turn), Trouble> {
        let moved = largest_turn(from, &self.engine.solution);
        if moved > 0.15 {
            return Err(Trouble::Stalled(moved));
        }
        // What the mesh is off by must not be mistaken for a turn of the path.
        let accuracy = (0.02 * step.abs()).clamp(FINEST, pace.accuracy);
        self.keep_accuracy(Some(here), &mut load, [accuracy, pace.accuracy])?;
        self.engine.ends_fine()?;
        let next = self.point(load.fraction())?;
        let cosine = self.cosine(here, &next);
        let crossing = cosine < 0.0 && -cosine >= pace.straightness;
        // Nothing turns on a symmetric branch but the load: bifurcations are passed at once, because
        // near them rounding would lead off the branch.
        if crossing && (step.abs() < CORNER || (here.is_symmetric() && next.is_symmetric())) {
            return Ok((next, Turn::Crossing));
        }
        let strict = if self.changed_sides(here) > 0.05 { 0.1 } else { 1.0 };
        let straight = 1.0 - cosine <= strict * (1.0 - pace.straightness);
        if crossing {
            self.opposite = Some(next.fraction);
        }
        if step.abs() > CORNER && !(straight && self.unevenness(here, &next) <= strict * EVEN) {
            return Err(Trouble::Stalled(cosine - 2.0));
        }
        Ok((next, Turn::None))
    }

    /// The share of the arm that the stream meets from the other side than at `here`. Where much of a
    /// slender arm in line with the stream changes sides within a step, it may do so in a snap.
    fn changed_sides(&self, here: &Point) -> f64 {
        let mesh = &self.engine.solution.mesh;
        let gauss = &self.engine.system.gauss;
        let (before, now) = (&here.state.equations, &self.engine.equations);
        let mut share = 0.0;
        for (k, s) in self.engine.equations.stations().iter().enumerate() {
            let e = here.mesh().element_of(*s);
            let w = gauss.cardinals((s - here.mesh().nodes()[e]) / here.mesh().step(e));
            let length = mesh.step(k / M) * gauss.b[k % M];
            for side in 0..2 {
                let then: f64 = (0..M).map(|j| w[j] * before.switch(e, j, side)).sum();
                if then * now.switch(k / M, k % M, side) < 0.0 {
                    share += length;
                }
            }
        }
        share
    }

    /// How far the climb from `a` to `b` over the way there is from the mean of the climbs at both,
    /// over the steeper. Unlike an angle it sees a fold that takes little load.
    fn unevenness(&self, a: &Point, b: &Point) -> f64 {
        let climb = b.fraction - a.fraction;
        // A step that ended past whole loads is landed backwards.
        let backwards = a.fraction > 1.0;
        let mut square = climb * climb;
        let gauss = &self.engine.system.gauss;
        for ((s, z), w) in b.mesh().nodes().iter().zip(&b.state.solution.nodes).zip(self.weights()) {
            let before = a.state.solution.state_in(gauss, a.mesh().element_of(*s), *s);
            square += w * (z[0] - before[0]).powi(2);
        }
        let mean = if backwards { -climb } else { climb } / square.sqrt();
        (mean - 0.5 * (a.rise + b.rise)).abs() / a.rise.abs().max(b.rise.abs())
    }

    /// Refines when the mesh no longer carries `accuracy`, or, where that would take very many elements,
    /// what is `enough`.
    fn keep_accuracy(
        &mut self,
        here: Option<&Point>,
        load: &mut Load,
        [accuracy, enough]: [f64; 2],
    ) -> Result<(), Trouble> {
        // Nodes follow the kinks, so that corrections do not hop across them, and as closely as this
        // accuracy needs, or it could not be had on any mesh.
        let resolution = 0.1 * accuracy.sqrt();
        for _ in 0..3 {
            let kinks = self.engine.kinks(resolution.max(10.0 * accuracy));
            if !self.engine.pin(&kinks, resolution) {
                break;
            }
            self.correct_again(here, load)?;
        }
        for _ in 0..4 {
            let estimate = self.engine.estimate(accuracy)?;
            let many = self.engine.solution.mesh.elements() > MANY;
            if estimate <= accuracy || (many && estimate <= enough) {
                return Ok(());
            }
            self.engine.refine(0.05 * accuracy, 2 * MANY);
            self.correct_again(here, load)?;
        }
        Ok(())
    }

    /// Corrections on another mesh: near a fold there may be no solution at the load that the last mesh
    /// had one at, so the load stays free unless the path ends there.
    fn correct_again(&mut self, here: Option<&Point>, load: &mut Load) -> Result<(), Trouble> {
        match (load, here) {
            (Load::Free(fraction), Some(here)) => self.correct(here, fraction),
            _ => roughly(self.engine.newton(1e-6, 12)),
        }
    }

    fn cosine(&self, a: &Point, b: &Point) -> f64 {
        // Both on the mesh of `b`, lengths included: a coarse mesh measures them coarsely.
        let (mut both, mut first, mut second) = (a.rise * b.rise, a.rise * a.rise, b.rise * b.rise);
        for ((carried, own), w) in a.tangent_on(b.mesh()).zip(b.tangent_on(b.mesh())).zip(self.weights()) {
            both += w * own * carried;
            first += w * carried * carried;
            second += w * own * own;
        }
        both / (first * second).sqrt()
    }

    /// The point with the largest fraction between two whose tangents rise and fall. The engine is left at it.
    fn limit_point(&mut self, here: &Point, next: &Point, step: f64, pace: Pace) -> f64 {
        let pace = Pace { straightness: -1.0, accuracy: 1e-6_f64.min(pace.accuracy), ..pace };
        let (mut low, mut low_rise) = (0.0, here.rise);
        let (mut high, mut high_rise) = (step, next.rise);
        let mut best: Option<Point> = None;
        for _ in 0..25 {
            let share = (low_rise / (low_rise - high_rise)).clamp(0.1, 0.9);
            let middle = low + share * (high - low);
            match self.advance(here, middle, pace) {
                Ok((point, Turn::None)) => {
                    let rise = point.rise;
                    if rise < 0.0 {
                        (high, high_rise) = (middle, rise);
                    } else {
                        (low, low_rise) = (middle, rise);
                    }
                    if best.as_ref().is_none_or(|b| point.fraction > b.fraction) {
                        best = Some(point);
                    }
                    if rise.abs() < 1e-6 {
                        break;
                    }
                }
                _ => high = middle,
            }
            if high - low < 1e-7 {
                break;
            }
        }
        let best = best.filter(|b| b.fraction > here.fraction);
        let limit = best.as_ref().unwrap_or(here);
        self.engine.restore(&limit.state);
        self.set(limit.fraction.min(1.0));
        limit.fraction.max(next.fraction).clamp(0.0, 1.0)
    }

    fn end(&self, kind: VerdictKind, load_fraction: f64, s: Option<f64>) -> Verdict {
        let load_fraction = if load_fraction <= START { 0.0 } else { load_fraction.min(1.0) };
        let s = s.map(|s| s * self.engine.equations.units.length);
        Verdict { kind, phase: self.phase, load_fraction, s, residual: self.engine.last }
    }

    fn never_started(&mut self) -> Verdict {
        self.engine.last = 0.0;
        if self.engine.equations.arm().readings.load_can_jump() {
            self.end(VerdictKind::LoadJump, 0.0, self.engine.nearest_switch())
        } else {
            self.end(VerdictKind::NotFound, 0.0, None)
        }
    }

    /// Names the limit that the last good point is at.
    fn give_up(&mut self, fraction: f64, residual: f64) -> Verdict {
        self.engine.last = residual;
        self.set(fraction);
        let near = self.engine.nearest_limits();
        let failed = match &self.last_trouble {
            Some(Trouble::Section(failure)) => Some(*failure),
            _ => None,
        };
        let volume = self.engine.equations.volume();
        let readings = self.engine.equations.arm().readings;
        let mut openness = near.openness;
        let mut nu = near.nu;
        let mut regularity = near.regularity;
        if let Some(f) = failed {
            // The failure may be at an end, which is no station, or just past the limit.
            for (least, value) in [(&mut openness, f.openness), (&mut nu, f.nu), (&mut regularity, f.regularity)] {
                if value.abs() < least.0 {
                    *least = (value.abs(), f.s);
                }
            }
        }
        if openness.0 < 0.1 {
            self.end(VerdictKind::CableFold, fraction, Some(openness.1))
        } else if volume == Volume::None && nu.0 < 0.1 {
            self.end(VerdictKind::SectionCrushed, fraction, Some(nu.1))
        } else if regularity.0 < 0.15 {
            self.end(VerdictKind::NoSectionSolution, fraction, Some(regularity.1))
        } else if readings.load_can_jump() && failed.is_none() {
            self.end(VerdictKind::LoadJump, fraction, self.engine.nearest_switch())
        } else {
            self.end(VerdictKind::NotFound, fraction, failed.map(|f| f.s))
        }
    }
}

fn largest_turn(a: &Solution<N, M>, b: &Solution<N, M>) -> f64 {
    if a.nodes.len() != b.nodes.len() {
        return 0.0;
    }
    a.nodes.iter().zip(&b.nodes).fold(0.0, |m, (a, b)| f64::max(m, (a[0] - b[0]).abs()))
}

#[cfg(test)]
mod small_steps;
