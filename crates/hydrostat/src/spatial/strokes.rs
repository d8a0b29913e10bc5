//! Arms in space with commanded strokes: tension and slack of such a cable are not negative, and one of them is zero.
//!
//! The shape meant is the end of the path of `docs/model.md`, section 7: loads and given tensions first, the
//! commanded cables slack, then all commanded strokes in proportion, from those that the slack cables have there to
//! those asked for. It is followed by arclength as in the plane, unless Newton's method gets there at once with whole
//! corrections and no load pushes hard against the arm: then that shape stands.

use super::configuration::SpatialConfiguration;
use super::engine::Engine;
use super::solve::{SpatialError, SpatialSolver};
use super::traced::largest_turn_between;
use crate::statics::engine::Trouble;
use crate::statics::path::{PathSummary, StepControl, Stopped, follow_strokes};
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::verdict::Phase;

/// Turn (rad) of a node that Newton's method may lead to at once.
const LONGEST: f64 = 1.0;

impl SpatialSolver {
    /// From the shape with the commanded cables slack, which the engine holds.
    pub(super) fn solve_strokes(&mut self, slack: SpatialConfiguration) -> Result<SpatialConfiguration, SpatialError> {
        let engine = &mut self.engine;
        engine.hold_strokes();
        engine.equations.set_phase(Phase::Tension, 1.0);
        let from = engine.strokes();
        if let Some(stroke_control) = &mut engine.stroke_control {
            stroke_control.from = from;
            stroke_control.fraction = 0.0;
        }
        let mut snaps = slack.snaps;
        let start = engine.state();
        let mut steps = slack.statistics.load_steps;
        let settled = if let Ok(estimate) = engine.reel_at_once(self.options.tol) {
            Ok(estimate)
        } else {
            engine.restore(&start);
            match follow_strokes(engine, StepControl::BRISK, self.options.snaps) {
                Ok(mut travelled) => {
                    steps += travelled.steps;
                    snaps.append(&mut travelled.snaps);
                }
                Err(mut stopped) => {
                    snaps.append(&mut stopped.snaps);
                    return Err(self.no_equilibrium(Stopped { snaps, ..stopped }));
                }
            }
            self.engine.settle(self.options.tol, First::Rough)
        };
        let travelled = PathSummary { steps, snaps: snaps.clone(), ..PathSummary::default() };
        let Ok(mut configuration) = settled.and_then(|estimate| self.read(estimate, travelled)) else {
            return Err(self.last_verdict(Phase::Stroke, snaps));
        };
        if self.engine.determinant().known_sign() == Some(-1.0) {
            configuration.stable = Some(false);
        }
        Ok(configuration)
    }
}

impl Engine {
    /// Reels in all strokes in one step, where that leads to a shape that no load pushes hard against: the estimated
    /// error of the tip over L.
    fn reel_at_once(&mut self, tol: f64) -> Result<f64, Trouble> {
        let before = self.solution.nodes.clone();
        if let Some(stroke_control) = &mut self.stroke_control {
            stroke_control.fraction = 1.0;
        }
        self.damped = false;
        self.iterate(1e-6, 9, None)?;
        let turned = largest_turn_between(&before, &self.solution);
        if self.damped || turned > LONGEST {
            return Err(Trouble::Stalled(turned));
        }
        let estimate = self.settle(tol, First::Rough)?;
        self.ends_fine()?;
        if self.needs_continuation() || self.determinant().known_sign() != Some(1.0) {
            return Err(Trouble::Singular);
        }
        Ok(estimate)
    }
}
