//! Several equilibria of an arm in space, the first of them after a snap where the path of the loads leads to none.

use crate::rod::arm::Arm;
use crate::spatial::{SpatialEquilibria, SpatialError, equilibria};
use crate::statics::path::PathError;
use crate::statics::verdict::{SolveError, VerdictKind};

/// Error of the tip over L of the shape after a snap, from which the search starts.
const ROUGH: f64 = 1e-6;

impl Arm {
    /// Equilibria of an arm in space under its loads, whether the path from the unloaded arm leads to them or not, each
    /// with its stability. The tip position is good to `tol` L.
    ///
    /// From each equilibrium the base is turned about axes across it, those across a load among them; wherever it comes
    /// to whole turns, the arm has an equilibrium. An equilibrium need not be on such a curve, so that the list may not
    /// be complete: see [`SpatialEquilibria::misses_some`].
    ///
    /// ```
    /// use hydrostat::{Arm, Space};
    ///
    /// // A soft arm that the stream meets from the tip, and a little from above.
    /// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    /// arm.flow.speed = 0.2;
    /// arm.space = Some(Space { stream: Some([-1.0, 0.01, 0.02]), ..Space::default() });
    /// let all = arm.equilibria_in_space(1e-8).unwrap();
    /// assert!(all.found.len() >= 3 && !all.misses_some());
    /// ```
    ///
    /// # Errors
    /// [`PathError::Start`] when no equilibrium was found at any rotation of the base, [`PathError::Support`],
    /// [`PathError::Friction`], [`PathError::Option`], [`PathError::Stroke`].
    pub fn equilibria_in_space(&self, tol: f64) -> Result<SpatialEquilibria, PathError<SpatialError>> {
        self.equilibria_in_space_while(tol, |_| true)
    }

    /// [`Arm::equilibria_in_space`] that asks `go_on` after every point of a curve, with how many there are, and ends
    /// the search where that is false.
    ///
    /// # Errors
    /// Those of [`Arm::equilibria_in_space`].
    pub fn equilibria_in_space_while(
        &self,
        tol: f64,
        mut go_on: impl FnMut(usize) -> bool,
    ) -> Result<SpatialEquilibria, PathError<SpatialError>> {
        let found = equilibria(self, tol, None, &mut go_on);
        let Err(PathError::Start { source: SolveError::NoEquilibrium(no), .. }) = &found else { return found };
        if no.verdict.kind != VerdictKind::LimitPoint || !go_on(0) {
            return found;
        }
        match self.solve_after_snap_in_space(ROUGH) {
            Ok(after) => equilibria(self, tol, Some(&after.configuration), &mut go_on),
            Err(_) => found,
        }
    }
}
