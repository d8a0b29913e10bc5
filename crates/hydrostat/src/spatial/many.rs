//! Many arms in space, each answered with a few numbers: tiles of rows as in the plane (`statics/many`).

use super::row::SpatialRow;
use super::solve::SpatialSolver;
use crate::rod::arm::Arm;
use crate::statics::many::{ManyOptions, NoRow, asked, in_tiles, no_row};
use crate::statics::row::Wanted;
use crate::statics::solve::Options;
use crate::statics::verdict::SolveError;

impl asked::Answers for SpatialSolver {
    type Row = SpatialRow;

    fn for_arm(arm: &Arm, options: Options) -> Result<Self, NoRow> {
        Self::new(arm, options).map_err(no_row)
    }

    fn take_arm(&mut self, arm: &Arm) -> Result<(), NoRow> {
        self.set_arm(arm).map_err(no_row)
    }

    fn next_row(&mut self, wanted: Wanted) -> Result<SpatialRow, NoRow> {
        self.row(wanted).map_err(no_row)
    }
}

/// Solves all `arms` in space, on the threads of rayon's current pool. The rows are the same to the last bit whatever
/// their number.
///
/// ```
/// use hydrostat::{Arm, Cable, ManyOptions, Profile, solve_many_in_space};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// let offset = Profile::linear(0.005, 0.001);
/// arm.cables.push(Cable { angle: 1.0.into(), ..Cable::new("left", offset) }); // rad
/// let arms: Vec<Arm> = [0.1, 0.2, 1.9] // N
///     .map(|tension| {
///         let mut arm = arm.clone();
///         arm.cables[0].tension = tension;
///         arm
///     })
///     .into();
/// let rows = solve_many_in_space(&arms, &ManyOptions::default())?;
/// assert!(rows[1].is_ok() && rows[2].is_err(), "1.9 N fold the tip");
/// # Ok::<(), hydrostat::SolveError>(())
/// ```
///
/// # Errors
/// [`SolveError::Option`]: a tolerance out of range, tiles without rows. What is wrong with a row is in its place.
pub fn solve_many_in_space(arms: &[Arm], options: &ManyOptions) -> Result<Vec<Result<SpatialRow, NoRow>>, SolveError> {
    in_tiles::<SpatialSolver>(arms, options)
}
