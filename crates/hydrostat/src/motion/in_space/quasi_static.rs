//! The equilibria of the loads of each moment, beside a motion in space.

use crate::motion::error::MotionError;
use crate::motion::inputs::Inputs;
use crate::rod::arm::Arm;
use crate::spatial::{SpatialError, SpatialSolver, SpatialTip};
use crate::statics::solve::Options;

/// The equilibrium of an arm in space under loads that change in time, followed from time to time.
#[derive(Debug)]
pub struct SpatialQuasiStatic {
    solver: SpatialSolver,
    arm: Arm,
    inputs: Inputs,
}

impl SpatialQuasiStatic {
    pub(super) fn new(arm: &Arm, inputs: Inputs) -> Result<Self, MotionError> {
        let refused = |error: SpatialError| MotionError::SpatialStart(Box::new(error));
        let solver = SpatialSolver::new(arm, Options::default()).map_err(refused)?;
        Ok(Self { solver, arm: arm.clone(), inputs })
    }

    /// The tip of the equilibrium under the loads just before `time` (s), from the equilibrium that was asked for
    /// before.
    ///
    /// # Errors
    /// [`SpatialError::NoEquilibrium`] where there is none, or none was found.
    pub fn tip(&mut self, time: f64) -> Result<SpatialTip, SpatialError> {
        self.inputs.apply(&mut self.arm, time);
        self.solver.set_arm(&self.arm)?;
        Ok(self.solver.update()?.tip)
    }
}
