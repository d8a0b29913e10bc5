//! Many arms in space, each answered with a few numbers: tiles of rows as in the plane (`statics/many`).

use super::configuration::{SpatialConfiguration, SpatialStations, SpatialWrench};
use super::equations::Guess;
use super::solve::SpatialSolver;
use super::tip::SpatialTip;
use crate::rod::arm::Arm;
use crate::statics::many::{
    FARTHEST, ManyOptions, NoRow, Row, Wanted, differ_in_loads, in_tiles, loads, may_be_followed, no_row, row_of,
};
use crate::statics::path::PathSummary;
use crate::statics::prediction::Recent;
use crate::statics::shape::Pose as _;
use crate::statics::solve::Options;
use crate::statics::verdict::SolveError;

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

/// Rows of arms in space that are solved one after the other; [`crate::Tile`] has those in the plane.
///
/// ```
/// use hydrostat::{Arm, Cable, Options, Profile, SpatialTile, Wanted};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// let offset = Profile::linear(0.005, 0.001);
/// arm.cables.push(Cable { angle: 2.0.into(), ..Cable::new("left", offset) }); // rad
/// let mut tile = SpatialTile::new(Options::with_tol(1e-6), Wanted::default())?;
/// let mut last = 0.0;
/// for step in 1..5 {
///     arm.cables[0].tension = 0.05 * f64::from(step); // N
///     let row = tile.solve(&arm).expect("so little does not fold the tip");
///     assert!(row.tip.z > last && row.error_estimate < 1e-6 * arm.length);
///     last = row.tip.z;
/// }
/// # Ok::<(), hydrostat::SolveError>(())
/// ```
#[derive(Debug, Clone)]
pub struct SpatialTile {
    options: Options,
    wanted: Wanted,
    solver: Option<SpatialSolver>,
    /// The rows before the solver's, each of which the next one started from.
    before: Recent<Guess>,
}

impl SpatialTile {
    /// No rows yet.
    ///
    /// # Errors
    /// [`SolveError::Option`] for a tolerance out of [1e-12, 1e-2] and bounds of snaps below 0.
    pub fn new(options: Options, wanted: Wanted) -> Result<Self, SolveError> {
        options.check()?;
        Ok(Self { options, wanted, solver: None, before: Recent::new() })
    }

    /// The next row. An arm without [`Arm::space`] may leave its plane.
    ///
    /// # Errors
    /// [`NoRow`].
    pub fn solve(&mut self, arm: &Arm) -> Result<SpatialRow, NoRow> {
        let mut arm = arm.clone();
        arm.space.get_or_insert_default();
        // What a row leaves behind is a start for the next one only if it was solved.
        if let Some(mut solver) = self.solver.take()
            && differ_in_loads(solver.arm(), &arm)
        {
            arm.check()?;
            if let Some(row) = self.warm(&mut solver, &arm) {
                self.solver = Some(solver);
                return Ok(row);
            }
        }
        self.cold(&arm)
    }

    fn cold(&mut self, arm: &Arm) -> Result<SpatialRow, NoRow> {
        self.before.clear();
        let mut solver = SpatialSolver::new(arm, self.options).map_err(no_row)?;
        let configuration = solver.solve().map_err(no_row)?;
        self.solver = may_be_followed(arm).then_some(solver);
        Ok(SpatialRow::in_space(&configuration, self.wanted))
    }

    /// From the last row: `None` unless the answer is surely that of the row's own ramp.
    fn warm(&mut self, solver: &mut SpatialSolver, arm: &Arm) -> Option<SpatialRow> {
        let here = loads(solver.arm());
        let before = solver.engine.read_tip()?;
        let solution = solver.engine.solution.clone();
        solver.engine.lead_on(&self.before.steps(&here, &loads(arm)));
        self.before.push(here, solution);
        solver.take_loads(arm);
        let estimate = solver.settle_warm()?;
        let tip = solver.engine.read_tip()?;
        // What a direct solve has to pass, too: one equilibrium, and that on the unloaded arm's branch.
        if solver.engine.needs_continuation() || before.turn_to(&tip) > FARTHEST {
            return None;
        }
        Some(SpatialRow::in_space(&solver.read(estimate, PathSummary::default()).ok()?, self.wanted))
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
    let start = SpatialTile::new(Options { tol: options.tol, snaps: options.snaps }, options.wanted)?;
    in_tiles(arms, options.tile, &start, SpatialTile::solve)
}
