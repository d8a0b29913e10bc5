//! The path of `docs/model.md`, section 7, in space: loads first, then tensions, by arclength continuation.
//!
//! A step predicts along the tangent, corrects normal to it, and is refused where the tangent turns too much. The
//! metric is the turn of the sections (root mean square along the arm, over a scale) with the fraction of the phase's
//! loads.

use hydrostat_bvp::{Correction, Mesh};

use super::engine::{Engine, State, turn_of};
use super::equations::{Guess, L, M, N, Q};
use super::rotation::{Vector, dot};
use super::tip::SpatialTip;
use crate::numerics::rounds::{correct, linearise};
use crate::statics::engine::{Trouble, roughly};
use crate::statics::limit::limit_at;
use crate::statics::path::follow_tensions;
use crate::statics::shape::Pose as _;
use crate::statics::snap::{self, SnapBounds};
use crate::statics::verdict::{Phase, Verdict, VerdictKind};

/// Fractions start here, where the tangent by the fraction is defined.
const START: f64 = 1e-7;
/// Longest step of arclength, smallest cosine between the tangents at both ends of a step, most steps of a phase,
/// refused ones included.
const LONGEST: f64 = 0.4;
const STRAIGHT: f64 = 0.94;
const MOST: usize = 400;
/// The steps that a path has left once it turned back.
const BEYOND: usize = 200;
/// Steps shorter than this go round a corner of the path, which the load's kinks make.
const CORNER: f64 = 1e-5;
/// The first step of arclength, and the most of them, from an equilibrium near a limit point to that.
const NEARBY: f64 = 1e-3;
const MOST_NEARBY: usize = 40;
/// Largest correction (rad) of a prediction that leads to the same branch.
const MOVED: f64 = 0.15;
/// The least change of rotation (rad) that counts as much as the whole load.
const FINE_SCALE: f64 = 0.01;

/// A jump of an arm in space from a limit point to the next part of the same curve at the same loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialSnap {
    /// In which phase of loading.
    pub phase: Phase,
    /// The fraction of the phase's loads at the limit point.
    pub load_fraction: f64,
    /// The tip at the limit point.
    pub before: SpatialTip,
    /// The tip where the arm lands.
    pub after: SpatialTip,
}

impl SpatialSnap {
    /// How far the tip jumps, m.
    pub fn distance(&self) -> f64 {
        self.before.distance_to(&self.after)
    }

    /// The angle of the rotation between both tip sections, rad.
    pub fn angle(&self) -> f64 {
        self.before.turn_to(&self.after)
    }

    /// What happens, in a phrase with its numbers.
    pub fn message(&self) -> String {
        snap::message(self.phase, self.load_fraction, self.distance(), self.angle())
    }
}

/// What a path met.
#[derive(Debug, Clone, Default)]
pub(super) struct Travelled {
    pub(super) steps: usize,
    /// Times the determinant changed sign while the load went on rising.
    pub(super) crossings: usize,
    pub(super) snaps: Vec<SpatialSnap>,
}

/// Why a path ended, and what it met.
#[derive(Debug)]
pub(super) struct Stopped {
    pub(super) verdict: Verdict,
    pub(super) snaps: Vec<SpatialSnap>,
}

/// A point of the path with its tangent.
struct Point {
    state: State,
    fraction: f64,
    /// Forcing a unit of the fraction.
    response: Correction<N, M, Q, L>,
    /// The turns (about the directors) of the nodes a unit of the fraction.
    turns: Vec<Vector<f64>>,
    /// The fraction's part of the unit tangent: `dlambda_ds` times `response` is the rest.
    dlambda_ds: f64,
    /// The sign of the determinant, where it is known.
    sign: Option<f64>,
}

/// Follows both phases; the engine is at the whole loads then.
pub(super) fn follow(engine: &mut Engine, bounds: SnapBounds) -> Result<Travelled, Stopped> {
    let mut travelled = Travelled::default();
    engine.equations.set_phase(Phase::Loads, 0.0);
    engine.start_unloaded(8);
    follow_phases(engine, &[Phase::Loads, Phase::Tension], START, bounds, &mut travelled)
        .map_err(|verdict| Stopped { verdict, snaps: travelled.snaps.clone() })?;
    if !(engine.equations.has_loads() || engine.equations.has_tension()) {
        // Nothing acts: the unloaded arm.
        let settled = engine.iterate(1e-10, 14, None);
        if settled.is_err() {
            let verdict = verdict(engine, VerdictKind::NotFound, Phase::Loads, 0.0, None);
            return Err(Stopped { verdict, snaps: Vec::new() });
        }
    }
    Ok(travelled)
}

/// Follows the path on from the engine's equilibrium at a fraction of a phase.
pub(super) fn follow_on(
    engine: &mut Engine,
    (phase, fraction): (Phase, f64),
    bounds: SnapBounds,
) -> Result<Travelled, Stopped> {
    let mut travelled = Travelled::default();
    let phases: &[Phase] = if phase == Phase::Loads { &[Phase::Loads, Phase::Tension] } else { &[Phase::Tension] };
    follow_phases(engine, phases, fraction, bounds, &mut travelled)
        .map_err(|verdict| Stopped { verdict, snaps: travelled.snaps.clone() })?;
    Ok(travelled)
}

/// Leads the engine, whose equilibrium is near a limit point of a phase, to that point; the fraction of the loads
/// there.
pub(crate) fn slide_to_limit(engine: &mut Engine, phase: Phase) -> Option<f64> {
    let [loads, tension] = engine.equations.fraction;
    let from = if phase == Phase::Loads { loads } else { tension };
    let mut travelled = Travelled::default();
    let bounds = SnapBounds::NONE;
    Ramp { engine, phase, scale: 1.0, trouble: None, travelled: &mut travelled, bounds }.limit(from)
}

/// Follows phases, the first one from a fraction of its loads.
fn follow_phases(
    engine: &mut Engine,
    phases: &[Phase],
    mut from: f64,
    bounds: SnapBounds,
    travelled: &mut Travelled,
) -> Result<(), Verdict> {
    for &phase in phases {
        let acts = match phase {
            Phase::Loads => engine.equations.has_loads(),
            _ => engine.equations.has_tension(),
        };
        let start = std::mem::replace(&mut from, START);
        if !acts || start >= 1.0 {
            engine.equations.set_phase(phase, 1.0);
            continue;
        }
        let mut ramp = |engine: &mut Engine, from: Option<f64>| {
            let mut ramp = Ramp { engine, phase, scale: 1.0, trouble: None, travelled: &mut *travelled, bounds };
            ramp.follow(from.unwrap_or(start))
        };
        if phase == Phase::Tension { follow_tensions(engine, ramp) } else { ramp(engine, None) }?;
    }
    Ok(())
}

/// A verdict at `s`, m.
pub(super) fn verdict(engine: &Engine, kind: VerdictKind, phase: Phase, fraction: f64, s: Option<f64>) -> Verdict {
    let load_fraction = if fraction <= START { 0.0 } else { fraction.min(1.0) };
    let spent = (engine.work() >= engine.allowed).then(|| engine.work()).filter(|_| kind == VerdictKind::NotFound);
    Verdict { kind, phase, load_fraction, s, residual: engine.last, spent }
}

/// One phase of the path.
struct Ramp<'e, 't> {
    engine: &'e mut Engine,
    phase: Phase,
    /// The turn (rad) that counts as much as the whole load.
    scale: f64,
    trouble: Option<Trouble>,
    travelled: &'t mut Travelled,
    bounds: SnapBounds,
}

impl Ramp<'_, '_> {
    fn follow(&mut self, from: f64) -> Result<(), Verdict> {
        let mut here = match self.start(from) {
            Ok(point) => point,
            Err(trouble) => {
                self.trouble = Some(trouble);
                return Err(self.stuck(from));
            }
        };
        self.begin(&mut here);
        let mut step = 0.1;
        let mut most = MOST;
        let mut attempt = 0;
        // The limit point that the path turned back at and has not come past yet.
        let mut limit: Option<(f64, State, Option<SpatialTip>)> = None;
        loop {
            let out_of_work = self.engine.may_go_on().is_err();
            if attempt >= most || step < 1e-7 || out_of_work {
                if let Some((fraction, state, _)) = limit {
                    self.engine.restore(&state);
                    return Err(self.end(VerdictKind::LimitPoint, fraction));
                }
                self.engine.restore(&here.state);
                if out_of_work {
                    return Err(self.end(VerdictKind::NotFound, here.fraction));
                }
                return Err(self.stuck(here.fraction));
            }
            attempt += 1;
            match self.advance(&here, step) {
                Ok(next) => {
                    self.travelled.steps += 1;
                    let crossed = matches!((here.sign, next.sign), (Some(a), Some(b)) if a != b);
                    if crossed && here.dlambda_ds * next.dlambda_ds > 0.0 {
                        self.travelled.crossings += 1;
                    }
                    if limit.is_none() && next.dlambda_ds < 0.0 {
                        // The path turns back between both points: steps are halved until its place is known.
                        if step > 1e-3 && (next.fraction - here.fraction).abs() > 1e-4 {
                            step *= 0.4;
                            self.engine.restore(&here.state);
                            continue;
                        }
                        let fraction = here.fraction.max(next.fraction);
                        let tip = self.engine.read_tip();
                        limit = Some((fraction, self.engine.state(), tip));
                        most = most.max(attempt + BEYOND);
                    }
                    if let Some((fraction, state, _)) = &limit
                        && next.fraction <= 0.0
                    {
                        let (fraction, state) = (*fraction, state.clone());
                        self.engine.restore(&state);
                        return Err(self.end(VerdictKind::LimitPoint, fraction));
                    }
                    if let Some((fraction, state, tip)) = &limit
                        && next.dlambda_ds > 0.0
                        && next.fraction >= *fraction
                    {
                        let after = self.engine.read_tip();
                        let stays = next.sign != Some(-1.0);
                        if let (Some(before), Some(after), true) = (*tip, after, stays) {
                            let snap = SpatialSnap { phase: self.phase, load_fraction: *fraction, before, after };
                            self.travelled.snaps.push(snap);
                            if !self.bounds.hold(snap.distance(), snap.angle(), self.engine.equations.units.length) {
                                let (fraction, state) = (*fraction, state.clone());
                                self.engine.restore(&state);
                                return Err(self.end(VerdictKind::LimitPoint, fraction));
                            }
                            self.travelled.crossings = 0;
                            limit = None;
                        }
                    }
                    if next.fraction == 1.0 && limit.is_none() {
                        return Ok(());
                    }
                    here = next;
                    step = (step * 1.6).min(LONGEST);
                }
                Err(trouble) => {
                    self.trouble = Some(trouble);
                    step *= 0.4;
                    self.engine.restore(&here.state);
                }
            }
        }
    }

    /// From the engine's equilibrium at a fraction to the limit point near it, which is on the way of rising loads on
    /// either side of it; the fraction there.
    fn limit(&mut self, from: f64) -> Option<f64> {
        let mut here = self.start(from).ok()?;
        self.begin(&mut here);
        let mut step = NEARBY;
        for _ in 0..MOST_NEARBY {
            match self.advance(&here, step) {
                Ok(next) if next.dlambda_ds < 0.0 => {
                    let fraction = here.dlambda_ds / (here.dlambda_ds - next.dlambda_ds);
                    return self.advance(&here, fraction * step).ok().map(|limit| limit.fraction);
                }
                Ok(next) => {
                    here = next;
                    step *= 1.5;
                }
                Err(_) => step *= 0.4,
            }
        }
        None
    }

    /// The point that the phase starts from.
    fn start(&mut self, from: f64) -> Result<Point, Trouble> {
        self.engine.equations.set_phase(self.phase, from);
        roughly(self.engine.iterate(1e-6, 14, None))?;
        self.engine.keep_accuracy()?;
        self.point(from, None)
    }

    /// Takes the scale of the metric from the first point.
    fn begin(&mut self, start: &mut Point) {
        let turn = turn_by_load(start);
        self.scale = if turn.is_finite() { turn.clamp(FINE_SCALE, 1.0) } else { 1.0 };
        start.dlambda_ds = 1.0 / (turn / self.scale).hypot(1.0);
    }

    /// One step from `here`.
    fn advance(&mut self, here: &Point, step: f64) -> Result<Point, Trouble> {
        let engine = &mut *self.engine;
        engine.restore(&here.state);
        let mut d_lambda = step * here.dlambda_ds;
        let lands = here.fraction + d_lambda >= 1.0;
        if lands {
            d_lambda = 1.0 - here.fraction;
        }
        engine.solution.add(&here.response, d_lambda);
        let mut fraction = here.fraction + d_lambda;
        let predicted = engine.solution.nodes.clone();
        if lands {
            fraction = 1.0;
            engine.equations.set_phase(self.phase, 1.0);
            roughly(engine.iterate(1e-6 * self.scale, 9, None))?;
        } else {
            self.correct(here, &mut fraction)?;
        }
        let engine = &mut *self.engine;
        let moved = largest_way(&predicted, &engine.solution);
        if moved > MOVED.max(0.5 * step) {
            return Err(Trouble::Stalled(moved));
        }
        if engine.correction.largest_inner().is_nan() {
            return Err(Trouble::Singular);
        }
        self.engine.keep_accuracy()?;
        self.engine.ends_fine()?;
        let mut next = self.point(fraction, Some(here))?;
        // How straight the way was.
        let cosine = self.cosine(here, &next);
        if cosine < STRAIGHT {
            // Round a corner, which kinks of the load make, the determinant says which way is on.
            let (Some(before), Some(after)) = (here.sign, next.sign) else { return Err(Trouble::Stalled(cosine)) };
            if step > CORNER {
                return Err(Trouble::Stalled(cosine));
            }
            next.dlambda_ds = next.dlambda_ds.abs() * here.dlambda_ds.signum() * before * after;
        }
        if lands && next.dlambda_ds * here.dlambda_ds < 0.0 {
            return Err(Trouble::Stalled(step));
        }
        Ok(next)
    }

    /// Newton on the plane through the present state that the tangent at `here` is normal to.
    fn correct(&mut self, here: &Point, fraction: &mut f64) -> Result<(), Trouble> {
        let engine = &mut *self.engine;
        let square = self.scale * self.scale;
        let normal: Vec<Vector<f64>> = weights(&engine.solution.mesh)
            .zip(&here.turns)
            .map(|(w, t)| t.map(|t| w * t * here.dlambda_ds / square))
            .collect();
        let mut response = Correction::default();
        engine.match_closure();
        for round in 0..9 {
            engine.may_go_on()?;
            engine.equations.set_phase(self.phase, *fraction);
            linearise(&mut engine.system, &engine.equations, &engine.solution)?;
            engine.rounds += 1;
            correct(&mut engine.system, &engine.solution, &mut engine.correction);
            engine.response(&mut response)?;
            let along = |c: &Correction<N, M, Q, L>, solution: &Guess| -> f64 {
                let nodes = normal.iter().zip(&solution.nodes).zip(&c.nodes);
                nodes.map(|((n, z), dz)| dot(n, &turn_of(z, dz))).sum()
            };
            let by_response = along(&response, &engine.solution) + here.dlambda_ds;
            let slide = -along(&engine.correction, &engine.solution) / by_response;
            if !slide.is_finite() {
                return Err(Trouble::Singular);
            }
            engine.correction.add(&response, slide);
            let size = super::engine::largest_turn(&engine.solution, &engine.correction);
            engine.last = size;
            if !size.is_finite() || size > 1.0 {
                return Err(Trouble::Stalled(size));
            }
            engine.take_correction(1.0);
            *fraction += slide;
            if size < 1e-6 * self.scale {
                engine.equations.set_phase(self.phase, *fraction);
                return Ok(());
            }
            if round == 8 && size > 1e-4 {
                return Err(Trouble::Stalled(size));
            }
        }
        engine.equations.set_phase(self.phase, *fraction);
        Ok(())
    }

    /// The point here, its tangent on from that of the point before.
    fn point(&mut self, fraction: f64, before: Option<&Point>) -> Result<Point, Trouble> {
        let engine = &mut *self.engine;
        engine.linearise()?;
        let mut response = Correction::default();
        engine.response(&mut response)?;
        let nodes = engine.solution.nodes.iter().zip(&response.nodes);
        let turns: Vec<Vector<f64>> = nodes.map(|(z, dz)| turn_of(z, dz)).collect();
        let sign = engine.system.determinant().known_sign();
        let mut out = Point { state: engine.state(), fraction, response, turns, dlambda_ds: 1.0, sign };
        let norm = (turn_by_load(&out) / self.scale).hypot(1.0);
        if !norm.is_finite() {
            return Err(Trouble::Singular);
        }
        out.dlambda_ds = 1.0 / norm;
        if let Some(before) = before
            && self.cosine(before, &out) < 0.0
        {
            out.dlambda_ds = -out.dlambda_ds;
        }
        Ok(out)
    }

    /// The cosine between two tangents.
    fn cosine(&self, a: &Point, b: &Point) -> f64 {
        let (from, mesh) = (&a.state.solution.mesh, &b.state.solution.mesh);
        let square = self.scale * self.scale;
        let turned: f64 = weights(mesh)
            .zip(mesh.nodes())
            .zip(&b.turns)
            .map(|((w, s), t)| {
                let e = from.element_of(*s);
                let x = (s - from.nodes()[e]) / from.step(e);
                let own: Vector<f64> = [0, 1, 2].map(|k| a.turns[e][k] + x * (a.turns[e + 1][k] - a.turns[e][k]));
                w * dot(&own, t)
            })
            .sum();
        a.dlambda_ds * b.dlambda_ds * (1.0 + turned / square)
    }

    /// Why no step leads on from the engine's shape.
    fn stuck(&mut self, fraction: f64) -> Verdict {
        let (kind, s) = name_limit(self.engine, self.trouble.as_ref());
        verdict(self.engine, kind, self.phase, fraction, s)
    }

    fn end(&self, kind: VerdictKind, fraction: f64) -> Verdict {
        verdict(self.engine, kind, self.phase, fraction, None)
    }
}

/// The turn (rad, root mean square along the arm) a unit of the fraction.
fn turn_by_load(point: &Point) -> f64 {
    let squares = weights(&point.state.solution.mesh).zip(&point.turns).map(|(w, t)| w * dot(t, t));
    squares.sum::<f64>().sqrt()
}

/// The root of the sum of squares with these weights is the root mean square along the arm.
fn weights(mesh: &Mesh) -> impl Iterator<Item = f64> + '_ {
    let n = mesh.elements();
    (0..=n).map(move |i| {
        let left = if i > 0 { mesh.step(i - 1) } else { 0.0 };
        let right = if i < n { mesh.step(i) } else { 0.0 };
        0.5 * (left + right)
    })
}

/// The largest turn (rad) of a node from where it was.
pub(super) fn largest_way(before: &[[f64; N]], solution: &Guess) -> f64 {
    if before.len() != solution.nodes.len() {
        return 0.0;
    }
    let way = before.iter().zip(&solution.nodes).map(|(old, new)| {
        let d: [f64; N] = std::array::from_fn(|k| new[k] - old[k]);
        let phi = turn_of(old, &d);
        dot(&phi, &phi).sqrt()
    });
    way.fold(0.0, f64::max)
}

/// Names the limit that the engine's shape is at, with its place, m; `trouble` is what kept it from going on.
pub(super) fn name_limit(engine: &Engine, trouble: Option<&Trouble>) -> (VerdictKind, Option<f64>) {
    let mut near = engine.nearest_limits();
    let failed = trouble.and_then(Trouble::failed_section);
    if let Some(failure) = &failed {
        near.note_failure(failure);
    }
    let (kind, s) = match limit_at(near, engine.equations.volume) {
        Some((kind, s)) => (kind, Some(s)),
        None => (VerdictKind::NotFound, failed.map(|f| f.s)),
    };
    (kind, s.map(|s| s * engine.equations.units.length))
}
