//! One step along a branch of equilibria: predict along the tangent, correct normal to it, refine, and
//! refuse what may be another branch or beyond a fold.

use hydrostat_bvp::continuation::location::bordered;
use hydrostat_bvp::{Correction, Mesh, Solution};

use super::step_control::{CORNER, EVEN, FINEST, LOOSE, MANY, SYMMETRIC, StepControl};
use crate::statics::engine::{Engine, HOP, M, NewtonStep, State, Trouble, roughly};
use crate::statics::equations::{L, N, Q};
use crate::statics::refinement::Refinable as _;
use crate::statics::verdict::Phase;

/// The largest correction (rad) of a prediction that leads to the same branch.
const MOVED: f64 = 0.15;

/// The least change of theta (rad) that counts as much as the whole load: arms that turn less are straight, as far as
/// anybody can see.
const FINE_SCALE: f64 = 0.01;

/// Corrections (rad) after which, but for second order, nothing is left to correct.
const CLOSE: f64 = 3e-5;

#[derive(Clone)]
pub(super) struct Point {
    pub(super) state: State,
    pub(super) fraction: f64,
    /// Change a unit of load.
    pub(super) response: Correction<N, M, Q, L>,
    /// That of the tensions that commanded strokes take.
    pub(super) tensions: Vec<f64>,
    /// How far each commanded cable is from what it cannot pass: the tension of a taut one, the slack of a slack one.
    pub(super) margins: Vec<f64>,
    /// The fraction's part of the unit tangent, positive where the load rises along the path: `rise`
    /// times `response` is the rest.
    pub(super) dlambda_ds: f64,
    /// Whether the determinant says which way is on: not where rounding alone can turn its sign.
    pub(super) oriented: bool,
    /// Natural logarithm of the size of the determinant.
    pub(super) size: f64,
    /// Estimated error of the tip over L.
    pub(super) error: f64,
}

impl Point {
    pub(super) fn mesh(&self) -> &Mesh {
        &self.state.solution.mesh
    }

    /// theta of the tangent at the nodes of another mesh: linear interpolation is enough to orient.
    pub(super) fn tangent_on<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = f64> + 'a {
        let (own, response) = (self.mesh(), &self.response.nodes);
        mesh.nodes().iter().map(move |s| {
            let e = own.element_of(*s);
            let x = (s - own.nodes()[e]) / own.step(e);
            self.dlambda_ds * (response[e][0] + x * (response[e + 1][0] - response[e][0]))
        })
    }

    /// theta at the tip, rad.
    pub(super) fn tip_angle(&self) -> f64 {
        self.state.solution.nodes.last().map_or(0.0, |z| z[0])
    }

    /// The change of the fraction by that of the angle of the tip (rad) along the branch.
    pub(super) fn slope(&self) -> f64 {
        self.response.nodes.last().map_or(f64::INFINITY, |z| 1.0 / z[0])
    }

    /// The turn (rad, root mean square along the arm) by the whole load at the rate here, in a metric whose scale of
    /// theta is `scale`.
    fn turn_by_load(&self, scale: f64) -> f64 {
        scale * (self.dlambda_ds.powi(-2) - 1.0).max(0.0).sqrt()
    }

    pub(super) fn is_symmetric(&self) -> bool {
        (self.dlambda_ds * self.response.largest(0)).abs() < SYMMETRIC
    }
}

/// How far a branch has gone.
#[derive(Debug, Clone, Copy, Default)]
struct Progress {
    /// The sum of the turns of all steps, rad (root mean square along the arm).
    turn: f64,
    /// The sum of the changes of the fraction.
    climb: f64,
}

/// The fraction of a path, and whether corrections may change it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Fraction {
    Fixed(f64),
    Free(f64),
    /// Free, while the angle of the tip stays.
    AtTip(f64),
}

impl Fraction {
    fn value(self) -> f64 {
        match self {
            Self::Fixed(fraction) | Self::Free(fraction) | Self::AtTip(fraction) => fraction,
        }
    }
}

/// What the fraction of a path is a fraction of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Along {
    /// The loads of a phase.
    Phase(Phase),
    /// The range of a parameter, see [`crate::statics::equations::Equations::vary`].
    Range,
}

pub(super) struct Stepper<'e> {
    pub(super) engine: &'e mut Engine,
    along: Along,
    /// Fractions on which a step lands that would pass them.
    pub(super) bounds: [f64; 2],
    /// The last linearisation.
    pub(super) round: NewtonStep,
    pub(super) last_trouble: Option<Trouble>,
    /// Sign of the climb times that of the determinant.
    pub(super) orientation: f64,
    /// Fraction of the last solution that was refused as the next point because it is on a branch of
    /// the other orientation.
    pub(super) opposite: Option<f64>,
    /// Whether a tangent that points the other way is taken for another branch that crosses, however long the step.
    pub(super) crossings_welcome: bool,
    /// The last estimate of the tip's error over L.
    pub(super) error: f64,
    /// The change of theta (rad, root mean square along the arm) that counts as much as the whole of the load in the
    /// metric of the path.
    scale: f64,
    /// Where the branch began, and how far its shape has turned and its fraction has climbed since.
    progress: Progress,
    /// How much of what a step may bend the path the last one did, over all of it: of the second order in the step.
    stretch: f64,
    /// Whether the last linearisation is that of the solution, but for a correction that is as good as none.
    current: bool,
}

/// How the path goes on at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StepOutcome {
    /// Smoothly, or round a corner that a kink of the load makes.
    Regular,
    /// Smoothly, but the determinant's sign says backwards: another branch crosses.
    Bifurcation,
}

impl<'e> Stepper<'e> {
    pub(super) fn new(engine: &'e mut Engine, along: Along, bounds: [f64; 2]) -> Self {
        Self {
            engine,
            along,
            bounds,
            round: NewtonStep::default(),
            last_trouble: None,
            orientation: 1.0,
            opposite: None,
            crossings_welcome: false,
            error: LOOSE,
            scale: 1.0,
            progress: Progress::default(),
            stretch: 0.0,
            current: false,
        }
    }

    /// The length of the next step over that of the last, done or refused.
    pub(super) fn pace_up(&self, done: bool) -> f64 {
        if !self.engine.in_a_hurry {
            return if done { 1.6 } else { 0.4 };
        }
        let fit = 0.8 / self.stretch.max(1e-3).sqrt();
        match (done, self.stretch > 1.0) {
            (true, _) => fit.clamp(0.5, 2.5),
            (false, true) => fit.clamp(0.2, 0.7),
            (false, false) => 0.4,
        }
    }

    /// Does `work`, or comes back to where it started from; whether it was done.
    pub(super) fn or_back(&mut self, work: impl FnOnce(&mut Self) -> Result<(), Trouble>) -> bool {
        let before = self.engine.state();
        let done = work(self).is_ok();
        if !done {
            self.engine.restore(&before);
        }
        done
    }

    pub(super) fn set(&mut self, fraction: f64) {
        match self.along {
            Along::Phase(phase) => self.engine.set_phase(phase, fraction),
            Along::Range => self.engine.equations.set_share(fraction),
        }
    }

    pub(super) fn linearise(&mut self) -> Result<(), Trouble> {
        self.current = false;
        self.engine.linearise_held(true, &mut self.round)
    }

    /// Weights of the squares of theta's change at the nodes in the metric of the path: its root mean square along the
    /// arm over [`Stepper::scale`].
    pub(super) fn weights(&self) -> Vec<f64> {
        let square = self.scale * self.scale;
        self.engine.solution.mesh.node_weights().map(|weight| weight / square).collect()
    }

    /// Takes `start` for the start of a branch, and its response for the scale of theta.
    pub(super) fn begin(&mut self, start: &mut Point) {
        self.progress = Progress::default();
        self.rescale(start, start.turn_by_load(self.scale));
    }

    /// Fits the scale of theta to the way from `here` to `next`, which becomes the next point to start from: the path
    /// must not be long in the load alone, or a shape that changes little, as that of an arm which hardly leans to
    /// either side, would turn back and forth within a step.
    pub(super) fn went(&mut self, here: &Point, next: &mut Point) {
        let way = self.distance(here, next);
        let climb = next.fraction - here.fraction;
        self.progress.turn += self.scale * (way * way - climb * climb).max(0.0).sqrt();
        self.progress.climb += climb.abs();
        self.rescale(next, self.progress.turn / self.progress.climb);
    }

    /// Widens the scale of theta to `wanted` (rad a whole load), and gives `point` the tangent of the metric that
    /// follows.
    fn rescale(&mut self, point: &mut Point, wanted: f64) {
        let first = self.progress.turn == 0.0;
        let least = if first { FINE_SCALE } else { self.scale };
        let scale = if wanted.is_finite() { wanted.clamp(least, 1.0) } else { 1.0 };
        let turn = point.turn_by_load(self.scale) / scale;
        self.scale = scale;
        point.dlambda_ds = point.dlambda_ds.signum() / turn.hypot(1.0);
    }

    /// The point here. Its tangent is oriented by the determinant, whose sign times that of the climb is
    /// the same all along a branch, round folds and corners alike, until another branch crosses.
    pub(super) fn point(&mut self, fraction: f64) -> Result<Point, Trouble> {
        self.linearise()?;
        self.point_of_round(fraction)
    }

    /// [`Stepper::point`] by the last linearisation.
    fn point_of_round(&mut self, fraction: f64) -> Result<Point, Trouble> {
        self.engine.take_switches();
        let weights = self.weights();
        let square: f64 = weights.iter().zip(&self.round.response.nodes).map(|(w, z)| w * z[0] * z[0]).sum();
        let norm = (1.0 + square).sqrt();
        if !norm.is_finite() {
            return Err(Trouble::Singular);
        }
        let determinant = self.engine.determinant();
        let known = determinant.known_sign();
        let dlambda_ds = self.orientation * known.unwrap_or(1.0) / norm;
        let (state, response) = (self.engine.state(), self.round.response.clone());
        let (tensions, margins) = (self.round.tension[1].clone(), self.margins());
        let (oriented, size) = (known.is_some(), determinant.log);
        Ok(Point { state, fraction, response, tensions, margins, dlambda_ds, oriented, size, error: self.error })
    }

    /// Moves the solution from `here` along its tangent.
    pub(super) fn predict(&mut self, here: &Point, step: f64) -> f64 {
        self.current = false;
        self.stretch = 0.0;
        self.engine.restore(&here.state);
        let climb = step * here.dlambda_ds;
        self.engine.solution.add(&here.response, climb);
        self.engine.add_tensions(&here.tensions, climb);
        here.fraction + climb
    }

    pub(super) fn advance(
        &mut self,
        here: &Point,
        step: f64,
        control: StepControl,
    ) -> Result<(Point, StepOutcome), Trouble> {
        let mut fraction = self.predict(here, step);
        let [low, high] = self.bounds;
        if fraction >= high || fraction <= low {
            return self.land(here, if fraction >= high { high } else { low }, control);
        }
        let from = self.engine.solution.clone();
        self.correct(here, &mut fraction)?;
        self.arrive(here, &from, Fraction::Free(fraction), step, control)
    }

    /// A step that ends at a given fraction; near a fold that is refused, and steps shrink.
    pub(super) fn land(
        &mut self,
        here: &Point,
        fraction: f64,
        control: StepControl,
    ) -> Result<(Point, StepOutcome), Trouble> {
        let step = (fraction - here.fraction) / here.dlambda_ds;
        self.predict(here, step);
        self.set(fraction);
        let from = self.engine.solution.clone();
        roughly(self.engine.newton(1e-6 * self.scale, 9))?;
        let (end, turn) = self.arrive(here, &from, Fraction::Fixed(fraction), step, control)?;
        if turn == StepOutcome::Regular && end.dlambda_ds * here.dlambda_ds < 0.0 {
            return Err(Trouble::Stalled(step));
        }
        Ok((end, turn))
    }

    /// The point of the branch at which the tip has a given angle, from one nearby. There is one wherever that angle
    /// alone decides the shape, round sharp folds, too, of which no tangent at a distance knows.
    pub(super) fn at_tip_angle(&mut self, here: &Point, angle: f64, control: StepControl) -> Result<Point, Trouble> {
        let climb = (angle - here.tip_angle()) * here.slope();
        let mut fraction = self.predict(here, climb / here.dlambda_ds);
        let from = self.engine.solution.clone();
        self.correct_at_tip(&mut fraction)?;
        let moved = largest_turn(&from, &self.engine.solution);
        if moved > MOVED {
            return Err(Trouble::Stalled(moved));
        }
        let mut fraction = Fraction::AtTip(fraction);
        self.keep_accuracy(None, &mut fraction, [control.accuracy; 2])?;
        self.engine.check_ends()?;
        self.point(fraction.value())
    }

    /// Newton on the plane through the present state that the tangent at `here` is normal to.
    pub(super) fn correct(&mut self, here: &Point, fraction: &mut f64) -> Result<(), Trouble> {
        let normal: Vec<f64> =
            here.tangent_on(&self.engine.solution.mesh).zip(self.weights()).map(|(t, w)| t * w).collect();
        self.correct_on(&normal, here.dlambda_ds, fraction)
    }

    /// Newton with the angle of the tip as it is.
    fn correct_at_tip(&mut self, fraction: &mut f64) -> Result<(), Trouble> {
        let mut normal = vec![0.0; self.engine.solution.nodes.len()];
        if let Some(tip) = normal.last_mut() {
            *tip = 1.0;
        }
        self.correct_on(&normal, 0.0, fraction)
    }

    /// Newton on the plane through the present state with the normal `normal`, over theta at the nodes, and `climb`,
    /// over the fraction.
    fn correct_on(&mut self, normal: &[f64], climb: f64, fraction: &mut f64) -> Result<(), Trouble> {
        // In a hurry, when the next one would be none.
        let close = self.scale * if self.engine.in_a_hurry { CLOSE } else { 1e-6 };
        let mut before = f64::INFINITY;
        for round in 0..12 {
            self.set(*fraction);
            self.linearise()?;
            let dot = |c: &Correction<N, M, Q, L>| -> f64 { normal.iter().zip(&c.nodes).map(|(n, z)| n * z[0]).sum() };
            let slide = bordered(dot(&self.round.rest), dot(&self.round.response), climb);
            self.engine.system.quadratures(&mut self.engine.spans);
            self.engine.tip = [0.0; Q];
            for (i, span) in self.engine.spans.iter_mut().enumerate() {
                for q in 0..Q {
                    span[q] += self.round.rest.by_element[i][q] + slide * self.round.response.by_element[i][q];
                    self.engine.tip[q] += span[q];
                }
            }
            self.engine.add_round(&self.round, 0, 1.0);
            self.engine.add_round(&self.round, 1, slide);
            *fraction += slide;
            let turns = self.round.rest.nodes.iter().zip(&self.round.response.nodes);
            let size = turns.map(|(rest, response)| (rest[0] + slide * response[0]).abs()).fold(slide.abs(), f64::max);
            self.engine.last = size;
            if !size.is_finite() || size > 1.0 || (round > 3 && size > 10.0 * before) {
                return Err(Trouble::Stalled(size));
            }
            before = size;
            if size < close {
                break;
            }
        }
        self.current = self.engine.in_a_hurry && before < self.scale * CLOSE;
        self.set(*fraction);
        // Across a kink corrections can hop between two points that are nearer than a path needs.
        if before > HOP { Err(Trouble::Stalled(before)) } else { Ok(()) }
    }

    /// The point that corrections have led to from the prediction `from`, if it may be trusted to be on
    /// the same branch and no fold was stepped over.
    fn arrive(
        &mut self,
        here: &Point,
        from: &Solution<N, M, L>,
        mut fraction: Fraction,
        step: f64,
        control: StepControl,
    ) -> Result<(Point, StepOutcome), Trouble> {
        let moved = largest_turn(from, &self.engine.solution);
        self.stretch = moved / MOVED;
        if moved > MOVED {
            return Err(Trouble::Stalled(moved));
        }
        // What the mesh is off by must not be mistaken for a turn of the path.
        let accuracy = (0.02 * step.abs() * self.scale).max(FINEST).min(control.accuracy);
        self.keep_accuracy(Some(here), &mut fraction, [accuracy, control.accuracy])?;
        self.engine.check_ends()?;
        let fraction = fraction.value();
        let mut next = if self.current { self.point_of_round(fraction)? } else { self.point(fraction)? };
        let mut cosine = self.cosine(here, &next);
        if cosine < 0.0 && !(here.oriented && next.oriented) {
            // Rounding may have turned the sign: the path goes straight on.
            (cosine, next.dlambda_ds) = (-cosine, -next.dlambda_ds);
            if next.oriented {
                self.orientation = -self.orientation;
            }
        }
        let crossing = cosine < 0.0 && -cosine >= control.straightness;
        // Nothing turns on a symmetric branch but the load: bifurcations are passed at once, because
        // near them rounding would lead off the branch.
        if crossing && (self.crossings_welcome || step.abs() < CORNER || (here.is_symmetric() && next.is_symmetric())) {
            return Ok((next, StepOutcome::Bifurcation));
        }
        let strict = if self.changed_sides(here) > 0.05 { 0.1 } else { 1.0 };
        let bend = (1.0 - cosine) / (strict * (1.0 - control.straightness));
        let even = if self.engine.in_a_hurry { strict.max(0.3) } else { strict };
        let unevenness = self.unevenness(here, &next, step) / (even * EVEN);
        self.stretch = self.stretch.max(bend).max(unevenness);
        if crossing {
            self.opposite = Some(next.fraction);
        }
        if step.abs() > CORNER && !(bend <= 1.0 && unevenness <= 1.0) {
            return Err(Trouble::Stalled(cosine - 2.0));
        }
        Ok((next, StepOutcome::Regular))
    }

    /// The share of the arm that the stream meets from the other side than at `here`. Where much of a
    /// slender arm in line with the stream changes sides within a step, it may do so in a snap.
    fn changed_sides(&self, here: &Point) -> f64 {
        let mesh = &self.engine.solution.mesh;
        let gauss = &self.engine.system.gauss;
        let mut share = 0.0;
        for (k, s) in self.engine.equations.stations().iter().enumerate() {
            let e = here.mesh().element_of(*s);
            let w = gauss.cardinals((s - here.mesh().nodes()[e]) / here.mesh().step(e));
            let length = mesh.step(k / M) * gauss.b[k % M];
            for side in 0..2 {
                let then: f64 = (0..M).map(|j| w[j] * here.state.switch(e, j, side)).sum();
                if then * self.engine.switch(k / M, k % M, side) < 0.0 {
                    share += length;
                }
            }
        }
        share
    }

    /// How far the climb from `a` to `b` over the way there is from the mean of the climbs at both,
    /// over the steeper. Unlike an angle it sees a fold that takes little load.
    fn unevenness(&self, a: &Point, b: &Point, step: f64) -> f64 {
        // A step that ended past a bound is landed backwards.
        let climb = (b.fraction - a.fraction) * step.signum();
        let mut square = climb * climb;
        let gauss = &self.engine.system.gauss;
        for ((s, z), w) in b.mesh().nodes().iter().zip(&b.state.solution.nodes).zip(self.weights()) {
            let before = a.state.solution.state_in(gauss, a.mesh().element_of(*s), *s);
            square += w * (z[0] - before[0]).powi(2);
        }
        let mean = climb / square.sqrt();
        (mean - 0.5 * (a.dlambda_ds + b.dlambda_ds)).abs() / a.dlambda_ds.abs().max(b.dlambda_ds.abs())
    }

    /// Refines when the mesh no longer carries `accuracy`, or, where that would take very many elements,
    /// what is `enough`.
    pub(super) fn keep_accuracy(
        &mut self,
        here: Option<&Point>,
        fraction: &mut Fraction,
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
            self.correct_again(here, fraction)?;
        }
        for _ in 0..4 {
            let estimate = self.engine.estimate(accuracy, Some(accuracy))?;
            self.error = estimate;
            let many = self.engine.solution.mesh.elements() > MANY;
            if estimate <= accuracy || (many && estimate <= enough) {
                return Ok(());
            }
            let mesh = self.engine.refined(0.05 * accuracy, 2 * MANY);
            self.engine.move_to(mesh);
            self.correct_again(here, fraction)?;
        }
        Ok(())
    }

    /// Corrections on another mesh: near a fold there may be no solution at the load that the last mesh
    /// had one at, so the load stays free unless the path ends there.
    fn correct_again(&mut self, here: Option<&Point>, fraction: &mut Fraction) -> Result<(), Trouble> {
        self.current = false;
        match (fraction, here) {
            (Fraction::Free(fraction), Some(here)) => self.correct(here, fraction),
            (Fraction::AtTip(fraction), _) => self.correct_at_tip(fraction),
            _ => roughly(self.engine.newton(1e-6, 12)),
        }
    }

    /// The length of the step between two points in the metric of the path; the engine is left at the second.
    pub(super) fn distance(&mut self, a: &Point, b: &Point) -> f64 {
        self.engine.restore(&b.state);
        let mut square = (b.fraction - a.fraction).powi(2);
        for ((s, z), w) in b.mesh().nodes().iter().zip(&b.state.solution.nodes).zip(self.weights()) {
            let before = a.state.solution.state_in(&self.engine.system.gauss, a.mesh().element_of(*s), *s);
            square += w * (z[0] - before[0]).powi(2);
        }
        square.sqrt()
    }

    fn cosine(&self, a: &Point, b: &Point) -> f64 {
        // Both on the mesh of `b`, lengths included: a coarse mesh measures them coarsely.
        let (mut both, mut first, mut second) =
            (a.dlambda_ds * b.dlambda_ds, a.dlambda_ds * a.dlambda_ds, b.dlambda_ds * b.dlambda_ds);
        for ((carried, own), w) in a.tangent_on(b.mesh()).zip(b.tangent_on(b.mesh())).zip(self.weights()) {
            both += w * own * carried;
            first += w * carried * carried;
            second += w * own * own;
        }
        both / (first * second).sqrt()
    }
}

fn largest_turn(a: &Solution<N, M, L>, b: &Solution<N, M, L>) -> f64 {
    if a.nodes.len() != b.nodes.len() {
        return 0.0;
    }
    a.nodes.iter().zip(&b.nodes).fold(0.0, |m, (a, b)| f64::max(m, (a[0] - b[0]).abs()))
}
