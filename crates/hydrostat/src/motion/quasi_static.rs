//! The equilibria of the loads of each moment, beside a motion.

use super::error::MotionError;
use super::inputs::Inputs;
use crate::rod::arm::Arm;
use crate::statics::shape::Tip;
use crate::statics::solve::{Options, Solver};
use crate::statics::verdict::SolveError;

/// The equilibrium of an arm under loads that change in time, followed from time to time.
#[derive(Debug)]
pub struct QuasiStatic {
    solver: Solver,
    arm: Arm,
    inputs: Inputs,
}

impl QuasiStatic {
    pub(super) fn new(arm: &Arm, inputs: Inputs) -> Result<Self, MotionError> {
        let refused = |error: SolveError| MotionError::Start(Box::new(error));
        let solver = Solver::new(arm, Options::default()).map_err(refused)?;
        Ok(Self { solver, arm: arm.clone(), inputs })
    }

    /// The tip of the equilibrium under the loads just before `time` (s), from the equilibrium that was asked for
    /// before.
    ///
    /// # Errors
    /// [`SolveError::NoEquilibrium`] where there is none, or none was found.
    pub fn tip(&mut self, time: f64) -> Result<Tip, SolveError> {
        self.inputs.apply(&mut self.arm, time);
        self.solver.set_arm(&self.arm)?;
        Ok(self.solver.update()?.tip)
    }
}
