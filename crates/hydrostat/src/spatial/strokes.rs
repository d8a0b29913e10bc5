//! Arms in space with commanded strokes: tension and slack of such a cable are not negative, and one of them is zero.
//!
//! The shape meant is the end of the path of `docs/model.md`, section 7: loads and given tensions first, the
//! commanded cables slack, then all commanded strokes in proportion, from those that the slack cables have there to
//! those asked for. The strokes are raised in steps that Newton's method takes with whole corrections, which keeps it
//! on the branch; where no step is small enough, a limit point is told by the determinant, whose square falls
//! linearly to zero there.

use super::configuration::SpatialConfiguration;
use super::engine::Engine;
use super::path::{Travelled, name_limit, verdict};
use super::solve::{SpatialError, SpatialSolver};
use crate::statics::engine::Trouble;
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::verdict::{Phase, Verdict, VerdictKind};

/// The least step, over the way of all strokes.
const SHORTEST: f64 = 1e-6;
/// Most steps, refused ones included.
const MOST: usize = 400;
/// Turn (rad) of a node in one step that Newton's method may lead to.
const LONGEST: f64 = 1.0;
/// How near to the last point (in the fraction of the way) the determinant's zero has to be to name a limit point.
const NEAR: f64 = 1e-3;

/// What was met on the way.
#[derive(Debug, Default)]
struct Way {
    steps: usize,
    crossings: usize,
    /// Share of the way and logarithm of the determinant at the points since the set of taut cables changed last.
    points: Vec<(f64, f64)>,
    taut: Vec<bool>,
}

impl SpatialSolver {
    /// From the shape with the commanded cables slack, which the engine holds.
    pub(super) fn solve_strokes(&mut self, slack: SpatialConfiguration) -> Result<SpatialConfiguration, SpatialError> {
        let engine = &mut self.engine;
        engine.hold_strokes();
        engine.equations.set_phase(Phase::Tension, 1.0);
        let from = engine.strokes();
        if let Some(held) = &mut engine.held {
            held.from = from;
            held.fraction = 0.0;
        }
        let mut way = Way::default();
        if let Err(verdict) = raise(engine, &mut way) {
            return Err(self.no_equilibrium(verdict, slack.snaps));
        }
        let travelled = Travelled {
            steps: slack.statistics.load_steps + way.steps,
            crossings: way.crossings,
            snaps: slack.snaps.clone(),
        };
        let settled = self.engine.settle(self.options.tol, First::Rough);
        let read = settled.and_then(|estimate| self.read(estimate, travelled));
        let Ok(mut configuration) = read else {
            let verdict = verdict(&self.engine, VerdictKind::NotFound, Phase::Stroke, 1.0, None);
            return Err(self.no_equilibrium(verdict, slack.snaps));
        };
        if self.engine.determinant().known_sign() == Some(-1.0) {
            configuration.stable = Some(false);
        }
        Ok(configuration)
    }
}

/// Raises the strokes to those asked for.
fn raise(engine: &mut Engine, way: &mut Way) -> Result<(), Verdict> {
    let mut here = 0.0;
    let mut step = 1.0_f64;
    let mut state = engine.state();
    let mut sign = 1.0;
    let mut trouble = None;
    for _ in 0..MOST {
        let there = (here + step).min(1.0);
        match advance(engine, there) {
            Ok(()) => {
                way.steps += 1;
                let determinant = engine.determinant();
                if let Some(now) = determinant.known_sign() {
                    way.crossings += usize::from(now != sign);
                    sign = now;
                }
                let taut = engine.held.as_ref().map(|held| held.taut.clone()).unwrap_or_default();
                if taut != way.taut {
                    way.points.clear();
                    way.taut = taut;
                }
                way.points.push((there, determinant.log));
                if there == 1.0 {
                    return Ok(());
                }
                here = there;
                step *= 2.0;
                state = engine.state();
            }
            Err(Trouble::Spent) => {
                trouble = Some(Trouble::Spent);
                break;
            }
            Err(other) => {
                trouble = Some(other);
                engine.restore(&state);
                step = 0.4 * (there - here);
                if step < SHORTEST {
                    break;
                }
            }
        }
    }
    engine.restore(&state);
    if let Some(at) = limit_point(&way.points) {
        return Err(verdict(engine, VerdictKind::LimitPoint, Phase::Stroke, at, None));
    }
    let (kind, s) = name_limit(engine, trouble.as_ref());
    Err(verdict(engine, kind, Phase::Stroke, here, s))
}

/// One step to a fraction of the way.
fn advance(engine: &mut Engine, fraction: f64) -> Result<(), Trouble> {
    let before = engine.solution.clone();
    if let Some(held) = &mut engine.held {
        held.fraction = fraction;
    }
    engine.damped = false;
    engine.iterate(1e-6, 9, None)?;
    if engine.damped {
        return Err(Trouble::Stalled(1.0));
    }
    let turned = super::path::largest_way(&before.nodes, &engine.solution);
    if turned > LONGEST {
        return Err(Trouble::Stalled(turned));
    }
    engine.keep_accuracy()?;
    engine.ends_fine()?;
    engine.linearise()?;
    engine.find_border()
}

/// Where the square of the determinant, which is linear in the fraction of the way before a limit point, comes to zero.
fn limit_point(points: &[(f64, f64)]) -> Option<f64> {
    let [.., (a, log_a), (b, log_b)] = points else { return None };
    // (D_b / D_a)^2.
    let ratio = (2.0 * (log_b - log_a)).exp();
    let ahead = (b - a) * ratio / (1.0 - ratio);
    (ratio < 1.0 && ahead < NEAR).then_some(b + ahead)
}
