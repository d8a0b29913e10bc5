//! Many arms, each answered with a few numbers: tiles of rows, in parallel.
//!
//! A row starts from the one before where the two differ in tensions, stream, gravity or tip loads only, and solves by
//! itself wherever that could end on another branch than its own ramp ([`WarmStart::Ramp`]; `docs/model.md`, section
//! 7). A tile starts anew, so that its rows do not depend on what else is solved, nor on how many threads do it.

use rayon::prelude::*;

use crate::rod::arm::{Arm, ArmError};
use crate::statics::row::{Row, Wanted};
use crate::statics::snap::SnapBounds;
use crate::statics::solve::{Options, Solver};
use crate::statics::verdict::{SolveError, Verdict};
use crate::statics::warm_start::WarmStart;

/// How many arms are solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManyOptions {
    /// Error of the tip position over L that is asked for, in [1e-12, 1e-2].
    pub tol: f64,
    /// Rows a tile, at least one: the first is solved from nothing, each other one from the row before where that is
    /// safe.
    pub tile: usize,
    /// How far an arm may snap on its way to its loads.
    pub snaps: SnapBounds,
    /// What is asked of every row.
    pub wanted: Wanted,
}

impl Default for ManyOptions {
    fn default() -> Self {
        Self { tol: 1e-6, tile: 256, snaps: SnapBounds::default(), wanted: Wanted::default() }
    }
}

/// Why a row has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoRow {
    /// Its numbers make no arm.
    #[error(transparent)]
    Arm(#[from] ArmError),
    /// There is no such equilibrium, or none was found.
    #[error("{}", .0.message())]
    Verdict(Verdict),
}

/// Why a row has no answer whose options were checked.
pub(crate) fn no_row<C, T>(error: SolveError<C, T>) -> NoRow {
    match error {
        SolveError::Arm(error) => NoRow::Arm(error),
        SolveError::NoEquilibrium(no) => NoRow::Verdict(no.verdict),
        SolveError::Option { .. } => unreachable!("the tolerance was checked"),
    }
}

/// A solver that [`Rows`] asks: [`Solver`] or [`crate::SpatialSolver`].
pub trait RowSolver: asked::Answers {}

impl<S: asked::Answers> RowSolver for S {}

/// What [`Rows`] asks of a solver, with options that it has checked: for itself alone.
pub(crate) mod asked {
    use super::{Arm, NoRow, Options, Wanted};

    /// The rows of a solver.
    pub trait Answers: Clone + Send + Sync {
        /// The answer of one row.
        type Row: Send;

        /// A solver for `arm`.
        ///
        /// # Errors
        /// [`NoRow::Arm`] for one that is none.
        fn for_arm(arm: &Arm, options: Options) -> Result<Self, NoRow>;

        /// Takes the arm of the next row.
        ///
        /// # Errors
        /// [`NoRow::Arm`] for one that is none.
        fn take_arm(&mut self, arm: &Arm) -> Result<(), NoRow>;

        /// What is wanted of its equilibrium.
        ///
        /// # Errors
        /// [`NoRow::Verdict`] where there is none.
        fn next_row(&mut self, wanted: Wanted) -> Result<Self::Row, NoRow>;
    }
}

impl asked::Answers for Solver {
    type Row = Row;

    fn for_arm(arm: &Arm, options: Options) -> Result<Self, NoRow> {
        Self::new(arm, options).map_err(no_row)
    }

    fn take_arm(&mut self, arm: &Arm) -> Result<(), NoRow> {
        self.set_arm(arm).map_err(no_row)
    }

    fn next_row(&mut self, wanted: Wanted) -> Result<Row, NoRow> {
        self.row(wanted).map_err(no_row)
    }
}

/// Rows that are answered one after the other, each as if it was the only one: by a solver with [`WarmStart::Ramp`],
/// which an arm without answer takes away.
///
/// ```
/// use hydrostat::{Arm, Cable, Options, Profile, Rows, Solver, Wanted};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// let wanted = Wanted { strokes: true, ..Wanted::default() };
/// let mut rows = Rows::<Solver>::new(Options::with_tol(1e-6), wanted)?;
/// let mut last = 0.0;
/// for step in 0..5 {
///     arm.cables[0].tension = 0.05 * f64::from(step); // N
///     let row = rows.next(&arm).expect("so little does not fold the tip");
///     assert!(row.tip.theta >= last && row.error_estimate < 1e-6 * arm.length);
///     last = row.tip.theta;
/// }
/// # Ok::<(), hydrostat::SolveError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Rows<S = Solver> {
    options: Options,
    wanted: Wanted,
    solver: Option<S>,
}

impl<S: RowSolver> Rows<S> {
    /// No rows yet.
    ///
    /// # Errors
    /// [`SolveError::Option`] for a tolerance out of [1e-12, 1e-2] and bounds of snaps below 0.
    pub fn new(options: Options, wanted: Wanted) -> Result<Self, SolveError> {
        options.check()?;
        Ok(Self { options: Options { warm_start: WarmStart::Ramp, ..options }, wanted, solver: None })
    }

    /// The row of `arm`.
    ///
    /// # Errors
    /// [`NoRow`].
    pub fn next(&mut self, arm: &Arm) -> Result<S::Row, NoRow> {
        let mut solver = match self.solver.take() {
            Some(mut solver) => {
                solver.take_arm(arm)?;
                solver
            }
            None => S::for_arm(arm, self.options)?,
        };
        let row = solver.next_row(self.wanted)?;
        self.solver = Some(solver);
        Ok(row)
    }
}

/// Solves all `arms` as [`Rows`] does, `options.tile` of them at a time on the threads of rayon's current pool.
pub(crate) fn in_tiles<S: RowSolver>(
    arms: &[Arm],
    options: &ManyOptions,
) -> Result<Vec<Result<S::Row, NoRow>>, SolveError> {
    let each = Options { snaps: options.snaps, ..Options::with_tol(options.tol) };
    let start = Rows::<S>::new(each, options.wanted)?;
    if options.tile == 0 {
        return Err(SolveError::Option { option: "tile", value: 0.0, expected: "at least 1" });
    }
    let tiles = arms.par_chunks(options.tile).map(|arms| -> Vec<_> {
        let mut rows = start.clone();
        arms.iter().map(|arm| rows.next(arm)).collect()
    });
    let tiles: Vec<Vec<_>> = tiles.collect();
    Ok(tiles.into_iter().flatten().collect())
}

/// Solves all `arms`, on the threads of rayon's current pool. The rows are the same to the last bit whatever their
/// number.
///
/// ```
/// use hydrostat::{Arm, Cable, ManyOptions, Profile, solve_many};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// let arms: Vec<Arm> = (0..20)
///     .map(|step| {
///         let mut arm = arm.clone();
///         arm.cables[0].tension = 0.1 * f64::from(step); // N
///         arm
///     })
///     .collect();
/// let rows = solve_many(&arms, &ManyOptions::default())?;
/// assert!(rows[9].is_ok() && rows[19].is_err(), "1.9 N fold the tip");
/// # Ok::<(), hydrostat::SolveError>(())
/// ```
///
/// # Errors
/// [`SolveError::Option`]: a tolerance out of range, tiles without rows. What is wrong with a row is in its place.
pub fn solve_many(arms: &[Arm], options: &ManyOptions) -> Result<Vec<Result<Row, NoRow>>, SolveError> {
    in_tiles::<Solver>(arms, options)
}
