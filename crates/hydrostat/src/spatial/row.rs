//! A few numbers about an equilibrium in space: the row of a table.

use super::configuration::{SpatialConfiguration, SpatialStations, SpatialWrench};
use super::tip::SpatialTip;
use crate::statics::row::{Row, Wanted, row_of};

/// The answer of one row in space.
pub type SpatialRow = Row<SpatialTip, SpatialWrench, SpatialStations>;

impl SpatialRow {
    /// What is wanted of a configuration.
    ///
    /// ```
    /// use hydrostat::{Arm, Options, SpatialRow, SpatialSolver, Wanted};
    ///
    /// let arm = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5);
    /// let shape = SpatialSolver::new(&arm, Options::default())?.solve()?;
    /// let row = SpatialRow::in_space(&shape, Wanted { fold_margin: true, ..Wanted::default() });
    /// assert_eq!((row.tip, row.fold_margin.is_some()), (shape.tip(), true));
    /// # Ok::<(), hydrostat::SpatialError>(())
    /// ```
    pub fn in_space(configuration: &SpatialConfiguration, wanted: Wanted) -> Self {
        row_of!(configuration, wanted)
    }
}
