//! The solver of the plane, as tensions are looked for with it.

use super::effort::dot;
use super::problem::Target;
use super::reaching::Reaching;
use crate::rod::arm::{Arm, ArmError};
use crate::rod::parameter::Parameter;
use crate::statics::configuration::{CableState, Configuration, Station};
use crate::statics::engine::Engine;
use crate::statics::sensitivity::{Quantity, SensitivityMethod};
use crate::statics::solve::{Options, Solver};
use crate::statics::stability::Stability;
use crate::statics::verdict::SolveError;

/// Tips (over L) that are this near are at the same place.
pub(super) const SAME: f64 = 1e-6;

/// What is to be reached.
#[derive(Debug, Clone)]
pub(super) enum Goal {
    /// Places of the arm.
    Places(Vec<Target>),
    /// The angle alpha of the tip section, rad.
    TipAngle(f64),
}

impl Goal {
    fn targets(&self) -> &[Target] {
        match self {
            Self::Places(targets) => targets,
            Self::TipAngle(_) => &[],
        }
    }
}

impl Reaching for Solver {
    type Goal = Goal;
    type Shape = Configuration;
    type Place = Station;
    type Error = SolveError;

    fn fits(goal: &Goal, arm: &Arm) -> bool {
        match goal {
            Goal::Places(targets) => !targets.is_empty() && targets.iter().all(|target| target.is_for(arm)),
            Goal::TipAngle(angle) => angle.is_finite(),
        }
    }

    fn stations(goal: &Goal) -> Vec<f64> {
        goal.targets().iter().filter_map(|target| target.s).collect()
    }

    fn wrong(error: ArmError) -> SolveError {
        error.into()
    }

    fn begin(arm: &Arm, tolerance: f64) -> Result<Self, SolveError> {
        let mut solver = Self::new(arm, Options::with_tol(tolerance))?;
        solver.update()?;
        Ok(solver)
    }

    fn watch(&mut self, places: &[f64]) -> bool {
        self.engine.watch(places, self.options.tol).is_ok()
    }

    fn pull(&mut self, tensions: &[f64]) -> Option<()> {
        self.set_tensions(tensions).ok()
    }

    fn settle(&mut self) -> Option<()> {
        self.update().ok().map(drop)
    }

    fn settle_warm(&mut self) -> Option<()> {
        Self::settle_warm(self).map(drop)
    }

    fn tensions(&self) -> Vec<f64> {
        self.arm().cables.iter().map(|cable| cable.tension).collect()
    }

    fn strokes(&self, count: usize) -> Vec<f64> {
        self.engine.strokes(0..count)
    }

    fn rest(&self, goal: &Goal, arm: &Arm) -> Vec<f64> {
        let engine = &self.engine;
        let (base, length) = (arm.base, arm.length);
        let targets = match goal {
            Goal::Places(targets) => targets,
            // Where the end has no strains it is as far off as can be.
            Goal::TipAngle(angle) => return vec![engine.read_tip().map_or(f64::INFINITY, |tip| tip.alpha - angle)],
        };
        let mut out = Vec::with_capacity(3 * targets.len());
        for target in targets {
            let [x, y, theta] = engine.pose_of(target.s.map_or(1.0, |s| s / length));
            out.push(target.weight * (x - (target.x - base.x) / length));
            out.push(target.weight * (y - (target.y - base.y) / length));
            if let Some(angle) = target.angle {
                let turns = std::f64::consts::TAU;
                let off = (theta - angle).rem_euclid(turns);
                out.push(target.weight * if off > 0.5 * turns { off - turns } else { off });
            }
        }
        out
    }

    fn derivatives(&self, goal: &Goal, arm: &Arm, of_strokes: bool) -> Option<Vec<Vec<f64>>> {
        let cables: Vec<Parameter> = (0..arm.cables.len()).map(Parameter::Tension).collect();
        let mut quantities = Vec::new();
        let mut weights = Vec::new();
        if let Goal::TipAngle(_) = goal {
            quantities.push(self.engine.pose_at(1.0)[3]);
            weights.push(1.0);
        }
        for target in goal.targets() {
            let [x, y, theta, _] = self.engine.pose_at(target.s.map_or(1.0, |s| s / arm.length));
            quantities.extend([x, y]);
            weights.extend([target.weight / arm.length; 2]);
            if target.angle.is_some() {
                quantities.push(theta);
                weights.push(target.weight);
            }
        }
        if of_strokes {
            quantities.extend((0..cables.len()).map(Quantity::Command));
            weights.resize(quantities.len(), 1.0 / arm.length);
        }
        let mut rows = self.engine.derivatives(&quantities, &cables, SensitivityMethod::Best)?.rows;
        for (row, weight) in rows.iter_mut().zip(&weights) {
            for v in row {
                *v *= weight;
            }
        }
        Some(rows)
    }

    fn tip_pose(&self) -> Vec<f64> {
        self.engine.pose_of(1.0).to_vec()
    }

    fn turned(&self, from: &Self) -> f64 {
        (self.engine.tip_angle() - from.engine.tip_angle()).abs()
    }

    fn shape(&mut self) -> Result<Configuration, SolveError> {
        self.configuration()
    }

    fn on_the_path(arm: &Arm) -> Option<Configuration> {
        arm.solve().ok()
    }

    fn is_near(a: &Configuration, b: &Configuration) -> bool {
        let apart = [a.tip().x - b.tip().x, a.tip().y - b.tip().y];
        dot(&apart, &apart).sqrt() < SAME * a.arm.length
    }

    fn arm(shape: &Configuration) -> &Arm {
        &shape.arm
    }

    fn cables(shape: &Configuration) -> &[CableState] {
        &shape.cables
    }

    fn stability(shape: &Configuration) -> Option<Stability> {
        shape.stability()
    }

    fn place(shape: &Configuration, s: f64) -> Station {
        shape.at(s)
    }

    fn unit_force(arm: &Arm) -> f64 {
        Engine::new(arm).equations.units.force
    }
}
