//! One step along a branch of equilibria: predict along the tangent, correct normal to it, refine, and
//! refuse what may be another branch or beyond a fold.

use hydrostat_bvp::Mesh;
use hydrostat_bvp::continuation::location::bordered;

use super::step_control::{BY_MESH, CORNER, DOUBTFUL, EVEN, FINEST, LOOSE, MANY, SYMMETRIC, StepControl};
use super::traced::{Along, Traced, Turn};
use crate::statics::border::NewtonStep;
use crate::statics::engine::{HOP, Trouble, roughly};

/// The largest correction (rad) of a prediction that leads to the same branch.
pub(super) const MOVED: f64 = 0.15;

/// The least turn of sections (rad) that counts as much as the whole load: arms that turn less are straight, as far as
/// anybody can see.
const FINE_SCALE: f64 = 0.01;

/// Corrections (rad) after which, but for second order, nothing is left to correct.
const CLOSE: f64 = 3e-5;

#[derive(Clone)]
pub(super) struct Point<E: Traced> {
    pub(super) state: E::State,
    pub(super) fraction: f64,
    /// Change a unit of load.
    pub(super) response: E::Change,
    /// The turns of the nodes by it.
    pub(super) turns: Vec<Turn>,
    /// That of the tensions that commanded strokes take.
    pub(super) tensions: Vec<f64>,
    /// How far each commanded cable is from what it cannot pass: the tension of a taut one, the slack of a slack one.
    pub(super) margins: Vec<f64>,
    /// The fraction's part of the unit tangent, positive where the load rises along the path:
    /// `dlambda_ds` times `response` is the rest.
    pub(super) dlambda_ds: f64,
    /// Whether the determinant says which way is on: not where rounding alone can turn its sign.
    pub(super) oriented: bool,
    /// Natural logarithm of the size of the determinant, and what it is the difference of.
    pub(super) size: f64,
    pub(super) clearance: f64,
    /// Estimated error of the tip over L.
    pub(super) error: f64,
}

impl<E: Traced> Point<E> {
    pub(super) fn mesh(&self) -> &Mesh {
        E::mesh_of(&self.state)
    }

    /// The turns of the tangent at the nodes of another mesh: linear interpolation is enough to orient.
    pub(super) fn tangent_on<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = Turn> + 'a {
        let (own, turns) = (self.mesh(), &self.turns);
        mesh.nodes().iter().map(move |s| {
            let e = own.element_of(*s);
            let x = (s - own.nodes()[e]) / own.step(e);
            each(|k| self.dlambda_ds * (turns[e][k] + x * (turns[e + 1][k] - turns[e][k])))
        })
    }

    /// The turn (rad, root mean square along the arm) by the whole load at the rate here, in a metric whose scale of
    /// turns is `scale`.
    fn turn_by_load(&self, scale: f64) -> f64 {
        scale * (self.dlambda_ds.powi(-2) - 1.0).max(0.0).sqrt()
    }

    pub(super) fn is_symmetric(&self) -> bool {
        let largest = self.turns.iter().fold(0.0, |m, turn| f64::max(m, size(turn)));
        self.dlambda_ds.abs() * largest < SYMMETRIC
    }
}

fn each(of: impl Fn(usize) -> f64) -> Turn {
    [of(0), of(1), of(2)]
}

fn dot(a: &Turn, b: &Turn) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The angle (rad) of a turn.
fn size(turn: &Turn) -> f64 {
    dot(turn, turn).sqrt()
}

/// `weight` times the product of two turns.
pub(super) fn weighed(weight: f64, a: &Turn, b: &Turn) -> f64 {
    dot(&a.map(|a| weight * a), b)
}

/// How far a branch has gone.
#[derive(Debug, Clone, Copy, Default)]
struct Progress {
    /// The sum of the turns of all steps, rad (root mean square along the arm).
    turn: f64,
    /// The sum of the changes of the fraction.
    d_lambda: f64,
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
    pub(super) fn value(self) -> f64 {
        match self {
            Self::Fixed(fraction) | Self::Free(fraction) | Self::AtTip(fraction) => fraction,
        }
    }
}

pub(super) struct Stepper<'e, E: Traced> {
    pub(super) engine: &'e mut E,
    along: Along,
    /// Fractions on which a step lands that would pass them.
    pub(super) bounds: [f64; 2],
    /// The last linearisation.
    pub(super) round: NewtonStep<E::Change>,
    pub(super) last_trouble: Option<Trouble>,
    /// Sign of dlambda/ds times that of the determinant.
    pub(super) orientation: f64,
    /// Fraction of the last solution that was refused as the next point because it is on a branch of
    /// the other orientation.
    pub(super) opposite: Option<f64>,
    /// Whether a tangent that points the other way is taken for another branch that crosses, however long the step.
    pub(super) bifurcations_welcome: bool,
    /// The last estimate of the tip's error over L.
    pub(super) error: f64,
    /// The turn (rad, root mean square along the arm) that counts as much as the whole of the load in the
    /// metric of the path.
    scale: f64,
    /// Where the branch began, and how far its shape has turned and its fraction has changed since.
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

impl<'e, E: Traced> Stepper<'e, E> {
    pub(super) fn new(engine: &'e mut E, along: Along, bounds: [f64; 2]) -> Self {
        Self {
            engine,
            along,
            bounds,
            round: NewtonStep::default(),
            last_trouble: None,
            orientation: 1.0,
            opposite: None,
            bifurcations_welcome: false,
            error: LOOSE,
            scale: 1.0,
            progress: Progress::default(),
            stretch: 0.0,
            current: false,
        }
    }

    /// The length of the next step over that of the last, done or refused.
    pub(super) fn pace_up(&self, done: bool) -> f64 {
        if !self.engine.is_in_a_hurry() {
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
        self.engine.set(self.along, fraction);
    }

    pub(super) fn linearise(&mut self) -> Result<(), Trouble> {
        self.current = false;
        self.engine.linearise_at_strokes(true, &mut self.round)
    }

    /// Weights of the squares of the nodes' turns in the metric of the path: its root mean square along the
    /// arm over [`Stepper::scale`].
    pub(super) fn weights(&self) -> Vec<f64> {
        let square = self.scale * self.scale;
        self.engine.mesh().node_weights().map(|weight| weight / square).collect()
    }

    /// Takes `start` for the start of a branch, and its response for the scale of turns.
    pub(super) fn begin(&mut self, start: &mut Point<E>) {
        self.progress = Progress::default();
        self.rescale(start, start.turn_by_load(self.scale));
    }

    /// Fits the scale of turns to the way from `here` to `next`, which becomes the next point to start from: the path
    /// must not be long in the load alone, or a shape that changes little, as that of an arm which hardly leans to
    /// either side, would turn back and forth within a step.
    pub(super) fn went(&mut self, here: &Point<E>, next: &mut Point<E>) {
        let way = self.distance(here, next);
        let d_lambda = next.fraction - here.fraction;
        self.progress.turn += self.scale * (way * way - d_lambda * d_lambda).max(0.0).sqrt();
        self.progress.d_lambda += d_lambda.abs();
        self.rescale(next, self.progress.turn / self.progress.d_lambda);
    }

    /// Widens the scale of turns to `wanted` (rad a whole load), and gives `point` the tangent of the metric that
    /// follows.
    fn rescale(&mut self, point: &mut Point<E>, wanted: f64) {
        let first = self.progress.turn == 0.0;
        let least = if first { FINE_SCALE } else { self.scale };
        let scale = if wanted.is_finite() { wanted.clamp(least, 1.0) } else { 1.0 };
        let turn = point.turn_by_load(self.scale) / scale;
        self.scale = scale;
        point.dlambda_ds = point.dlambda_ds.signum() / turn.hypot(1.0);
    }

    /// The point here. Its tangent is oriented by the determinant, whose sign times the sign of dlambda/ds is
    /// the same all along a branch, round folds and corners alike, until another branch crosses.
    pub(super) fn point(&mut self, fraction: f64) -> Result<Point<E>, Trouble> {
        self.linearise()?;
        self.point_of_round(fraction)
    }

    /// [`Stepper::point`] by the last linearisation.
    fn point_of_round(&mut self, fraction: f64) -> Result<Point<E>, Trouble> {
        self.engine.note_sides();
        let turns = self.engine.turns(&self.round.response);
        let square: f64 = self.weights().iter().zip(&turns).map(|(w, turn)| weighed(*w, turn, turn)).sum();
        let norm = (1.0 + square).sqrt();
        if !norm.is_finite() {
            return Err(Trouble::Singular);
        }
        let determinant = self.engine.determinant();
        let known = determinant.known_sign().filter(|_| determinant.clearance > BY_MESH);
        let dlambda_ds = self.orientation * known.unwrap_or(1.0) / norm;
        let (state, response) = (self.engine.state(), self.round.response.clone());
        let (tensions, margins) = (self.round.tension[1].clone(), self.margins());
        let (oriented, size, clearance) = (known.is_some(), determinant.log, determinant.clearance);
        let error = self.error;
        Ok(Point { state, fraction, response, turns, tensions, margins, dlambda_ds, oriented, size, clearance, error })
    }

    /// Moves the solution from `here` along its tangent.
    pub(super) fn predict(&mut self, here: &Point<E>, step: f64) -> f64 {
        self.current = false;
        self.stretch = 0.0;
        self.engine.restore(&here.state);
        let d_lambda = step * here.dlambda_ds;
        self.engine.move_along(&here.response, &here.tensions, d_lambda);
        here.fraction + d_lambda
    }

    pub(super) fn advance(
        &mut self,
        here: &Point<E>,
        step: f64,
        control: StepControl,
    ) -> Result<(Point<E>, StepOutcome), Trouble> {
        let mut fraction = self.predict(here, step);
        let [low, high] = self.bounds;
        if fraction >= high || fraction <= low {
            return self.land(here, if fraction >= high { high } else { low }, control);
        }
        let from = self.engine.nodes();
        self.correct(here, &mut fraction)?;
        self.arrive(here, &from, Fraction::Free(fraction), step, control)
    }

    /// A step that ends at a given fraction; near a fold that is refused, and steps shrink.
    pub(super) fn land(
        &mut self,
        here: &Point<E>,
        fraction: f64,
        control: StepControl,
    ) -> Result<(Point<E>, StepOutcome), Trouble> {
        let step = (fraction - here.fraction) / here.dlambda_ds;
        self.predict(here, step);
        self.set(fraction);
        let from = self.engine.nodes();
        roughly(self.engine.newton(1e-6 * self.scale, 9))?;
        let (end, turn) = self.arrive(here, &from, Fraction::Fixed(fraction), step, control)?;
        if turn == StepOutcome::Regular && end.dlambda_ds * here.dlambda_ds < 0.0 {
            return Err(Trouble::Stalled(step));
        }
        Ok((end, turn))
    }

    /// Newton on the plane through the present state that the tangent at `here` is normal to.
    pub(super) fn correct(&mut self, here: &Point<E>, fraction: &mut f64) -> Result<(), Trouble> {
        let normal: Vec<Turn> =
            here.tangent_on(self.engine.mesh()).zip(self.weights()).map(|(t, w)| t.map(|t| t * w)).collect();
        self.correct_on(&normal, here.dlambda_ds, fraction)
    }

    /// Newton with the angle of the tip about its c as it is.
    pub(super) fn correct_at_tip(&mut self, fraction: &mut f64) -> Result<(), Trouble> {
        let mut normal = vec![[0.0; 3]; self.engine.mesh().nodes().len()];
        if let Some(tip) = normal.last_mut() {
            tip[2] = 1.0;
        }
        self.correct_on(&normal, 0.0, fraction)
    }

    /// Newton on the plane through the present state with the normal (`normal`, `d_lambda`): its parts by the turns of
    /// the nodes and by the fraction.
    fn correct_on(&mut self, normal: &[Turn], d_lambda: f64, fraction: &mut f64) -> Result<(), Trouble> {
        // In a hurry, when the next one would be none.
        let close = self.scale * if self.engine.is_in_a_hurry() { CLOSE } else { 1e-6 };
        let mut before = f64::INFINITY;
        for round in 0..12 {
            self.set(*fraction);
            self.linearise()?;
            let [rest, response] = [&self.round.rest, &self.round.response].map(|change| self.engine.turns(change));
            let along = |turns: &[Turn]| -> f64 { normal.iter().zip(turns).map(|(n, turn)| dot(n, turn)).sum() };
            let slide = bordered(along(&rest), along(&response), d_lambda);
            self.engine.take_round(&self.round, slide);
            *fraction += slide;
            let turns = rest.iter().zip(&response).map(|(rest, by)| size(&each(|k| rest[k] + slide * by[k])));
            let largest = turns.fold(slide.abs(), f64::max);
            *self.engine.last_mut() = largest;
            if !largest.is_finite() || largest > 1.0 || (round > 3 && largest > 10.0 * before) {
                return Err(Trouble::Stalled(largest));
            }
            before = largest;
            if largest < close {
                break;
            }
        }
        self.current = self.engine.is_in_a_hurry() && before < self.scale * CLOSE;
        self.set(*fraction);
        // Across a kink corrections can hop between two points that are nearer than a path needs.
        if before > HOP { Err(Trouble::Stalled(before)) } else { Ok(()) }
    }

    /// The point that corrections have led to from the prediction `from`, if it may be trusted to be on
    /// the same branch and no fold was stepped over.
    fn arrive(
        &mut self,
        here: &Point<E>,
        from: &E::Nodes,
        mut fraction: Fraction,
        step: f64,
        control: StepControl,
    ) -> Result<(Point<E>, StepOutcome), Trouble> {
        let moved = self.engine.largest_turn_since(from);
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
        if cosine < 0.0 && next.oriented && next.clearance < DOUBTFUL {
            next.oriented = self.is_oriented_on_halves(&next)?;
        }
        if cosine < 0.0 && !(here.oriented && next.oriented) {
            // Rounding, or the mesh, may have turned the sign: the path goes straight on.
            (cosine, next.dlambda_ds) = (-cosine, -next.dlambda_ds);
            if next.oriented {
                self.orientation = -self.orientation;
            }
        }
        let bifurcation = cosine < 0.0 && -cosine >= control.straightness;
        // Nothing turns on a symmetric branch but the load: bifurcations are passed at once, because
        // near them rounding would lead off the branch.
        if bifurcation
            && (self.bifurcations_welcome || step.abs() < CORNER || (here.is_symmetric() && next.is_symmetric()))
        {
            return Ok((next, StepOutcome::Bifurcation));
        }
        // Where much of a slender arm in line with the stream changes sides within a step, it may do so in a snap.
        let strict = if self.engine.changed_sides(&here.state) > 0.05 { 0.1 } else { 1.0 };
        let bend = (1.0 - cosine) / (strict * (1.0 - control.straightness));
        let even = if self.engine.is_in_a_hurry() { strict.max(0.3) } else { strict };
        let unevenness = self.unevenness(here, &next, step) / (even * EVEN);
        self.stretch = self.stretch.max(bend).max(unevenness);
        if bifurcation {
            self.opposite = Some(next.fraction);
        }
        if step.abs() > CORNER && !(bend <= 1.0 && unevenness <= 1.0) {
            return Err(Trouble::Stalled(cosine - 2.0));
        }
        Ok((next, StepOutcome::Regular))
    }

    /// Whether the determinant's sign at a point, which the engine is at, is the same on halves of the elements.
    fn is_oriented_on_halves(&mut self, point: &Point<E>) -> Result<bool, Trouble> {
        let sign = self.orientation * point.dlambda_ds.signum();
        let round = &mut self.round;
        let there = self.engine.on_halves(1e-6 * self.scale, |halves| {
            halves.linearise_at_strokes(true, round)?;
            Ok(halves.determinant().known_sign())
        });
        self.linearise()?;
        Ok(there.is_ok_and(|there| there == Some(sign)))
    }

    /// How far the secant slope dlambda/ds from `a` to `b` is from the mean of the slopes at both, relative to the
    /// larger. Unlike an angle between tangents it sees a limit point that takes little load.
    fn unevenness(&self, a: &Point<E>, b: &Point<E>, step: f64) -> f64 {
        // A step that ended past a bound is landed backwards.
        let d_lambda = (b.fraction - a.fraction) * step.signum();
        let square = self.square_of_way(d_lambda, a, b);
        let mean = d_lambda / square.sqrt();
        (mean - 0.5 * (a.dlambda_ds + b.dlambda_ds)).abs() / a.dlambda_ds.abs().max(b.dlambda_ds.abs())
    }

    /// Refines when the mesh no longer carries `accuracy`, or, where that would take very many elements,
    /// what is `enough`.
    pub(super) fn keep_accuracy(
        &mut self,
        here: Option<&Point<E>>,
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
            let many = self.engine.mesh().elements() > MANY;
            if estimate <= accuracy || (many && estimate <= enough) {
                return Ok(());
            }
            let mesh = self.engine.refined(0.05 * accuracy, 2 * MANY);
            self.engine.remap_to(mesh);
            self.correct_again(here, fraction)?;
        }
        Ok(())
    }

    /// Corrections on another mesh: near a fold there may be no solution at the load that the last mesh
    /// had one at, so the load stays free unless the path ends there.
    fn correct_again(&mut self, here: Option<&Point<E>>, fraction: &mut Fraction) -> Result<(), Trouble> {
        self.current = false;
        match (fraction, here) {
            (Fraction::Free(fraction), Some(here)) => self.correct(here, fraction),
            (Fraction::AtTip(fraction), _) => self.correct_at_tip(fraction),
            _ => roughly(self.engine.newton(1e-6, 12)),
        }
    }

    /// The length of the step between two points in the metric of the path; the engine is left at the second.
    pub(super) fn distance(&mut self, a: &Point<E>, b: &Point<E>) -> f64 {
        self.engine.restore(&b.state);
        self.square_of_way(b.fraction - a.fraction, a, b).sqrt()
    }

    /// The square of the way between two points, the engine being at the second, in the metric of the path.
    fn square_of_way(&self, d_lambda: f64, a: &Point<E>, b: &Point<E>) -> f64 {
        let turns = self.engine.turns_between(&a.state, &b.state);
        turns.iter().zip(self.weights()).fold(d_lambda * d_lambda, |sum, (turn, w)| sum + w * dot(turn, turn))
    }

    fn cosine(&self, a: &Point<E>, b: &Point<E>) -> f64 {
        // Both on the mesh of `b`, lengths included: a coarse mesh measures them coarsely.
        let (mut both, mut first, mut second) =
            (a.dlambda_ds * b.dlambda_ds, a.dlambda_ds * a.dlambda_ds, b.dlambda_ds * b.dlambda_ds);
        for ((carried, own), w) in a.tangent_on(b.mesh()).zip(b.tangent_on(b.mesh())).zip(self.weights()) {
            both += weighed(w, &own, &carried);
            first += weighed(w, &carried, &carried);
            second += weighed(w, &own, &own);
        }
        both / (first * second).sqrt()
    }
}
