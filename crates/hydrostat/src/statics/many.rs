//! Many arms, each answered with a few numbers: tiles of rows, in parallel.
//!
//! A row starts from the one before where the two differ in tensions, stream, gravity or tip loads only, and solves by
//! itself wherever that could end on another branch than its own ramp (`docs/model.md`, section 7). A tile starts anew,
//! so that its rows do not depend on what else is solved, nor on how many threads do it.

use rayon::prelude::*;

use crate::rod::arm::{Arm, ArmError, Flow, Space};
use crate::rod::readings::Support;
use crate::statics::configuration::{Configuration, FoldMargin, Stations, Tip, Warning, Wrench};
use crate::statics::engine::{Engine, Guess};
use crate::statics::equations::StationData;
use crate::statics::path::PathSummary;
use crate::statics::prediction::Recent;
use crate::statics::refinement::{First, Refinable as _};
use crate::statics::snap::{Snap, SnapBounds};
use crate::statics::solve::{Options, Solver};
use crate::statics::stability::Stability;
use crate::statics::verdict::{Phase, SolveError, Verdict};

/// A tip that turns further (rad) from one row to the next has left what a small change does.
pub(crate) const FARTHEST: f64 = 0.5;

/// What is asked of every row beyond tip, base reaction and error estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[allow(clippy::struct_excessive_bools, reason = "each is asked for by itself")]
pub struct Wanted {
    /// How far each cable is reeled in.
    pub strokes: bool,
    /// How far the surface is from folding: reads the whole configuration.
    pub fold_margin: bool,
    /// Stability, two to three milliseconds.
    pub stability: bool,
    /// What should be known about the answer: reads the whole configuration.
    pub warnings: bool,
    /// So many equally spaced stations; none below two.
    pub stations: usize,
}

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

/// The answer of one row, in the plane or, as [`crate::SpatialRow`], in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Row<T = Tip, W = Wrench, S = Stations> {
    /// Where the tip is.
    pub tip: T,
    /// What support and cable anchors exert on the arm at the base.
    pub base_reaction: W,
    /// Estimated error of the tip position, m.
    pub error_estimate: f64,
    /// Tension of each cable at the base, N.
    pub tensions: Vec<f64>,
    /// How far each cable is reeled in, m; empty unless asked for.
    pub strokes: Vec<f64>,
    /// How far the surface is from folding, if asked for.
    pub fold_margin: Option<FoldMargin>,
    /// `None` where it was not asked for or is not established.
    pub stability: Option<Stability>,
    /// What should be known about the answer; empty unless asked for.
    pub warnings: Vec<Warning>,
    /// The snaps that the arm makes as its loads grow from nothing to these.
    pub snaps: Vec<Snap<T>>,
    /// How long each of them takes, s, where their motions were followed; else empty.
    pub snap_durations: Vec<f64>,
    /// Empty unless asked for.
    pub stations: S,
}

/// The row of what is wanted of a configuration, in the plane or in space.
macro_rules! row_of {
    ($configuration:expr, $wanted:expr) => {{
        let (configuration, wanted): (_, $crate::statics::many::Wanted) = ($configuration, $wanted);
        let cables = &configuration.cables;
        Self {
            tip: configuration.tip(),
            base_reaction: configuration.base_reaction,
            error_estimate: configuration.error_estimate,
            tensions: cables.iter().map(|cable| cable.tension).collect(),
            strokes: if wanted.strokes { cables.iter().map(|cable| cable.stroke).collect() } else { Vec::new() },
            fold_margin: wanted.fold_margin.then(|| configuration.fold_margin()),
            stability: if wanted.stability { configuration.stability() } else { None },
            warnings: if wanted.warnings { configuration.warnings() } else { Vec::new() },
            snaps: configuration.snaps.clone(),
            snap_durations: Vec::new(),
            stations: if wanted.stations < 2 { Default::default() } else { configuration.resampled(wanted.stations) },
        }
    }};
}
pub(crate) use row_of;

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

/// Rows that are solved one after the other.
///
/// ```
/// use hydrostat::{Arm, Cable, Options, Profile, Tile, Wanted};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// let mut tile = Tile::new(Options::with_tol(1e-6), Wanted { strokes: true, ..Wanted::default() })?;
/// let mut last = 0.0;
/// for step in 0..5 {
///     arm.cables[0].tension = 0.05 * f64::from(step); // N
///     let row = tile.solve(&arm).expect("so little does not fold the tip");
///     assert!(row.tip.theta >= last && row.error_estimate < 1e-6 * arm.length);
///     last = row.tip.theta;
/// }
/// # Ok::<(), hydrostat::SolveError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Tile {
    options: Options,
    wanted: Wanted,
    solver: Option<Solver>,
    /// The rows before the solver's, each of which the next one started from.
    before: Recent<Guess>,
}

impl Tile {
    /// No rows yet.
    ///
    /// # Errors
    /// [`SolveError::Option`] for a tolerance out of [1e-12, 1e-2] and bounds of snaps below 0.
    pub fn new(options: Options, wanted: Wanted) -> Result<Self, SolveError> {
        options.check()?;
        Ok(Self { options, wanted, solver: None, before: Recent::new() })
    }

    /// The next row.
    ///
    /// # Errors
    /// [`NoRow`].
    pub fn solve(&mut self, arm: &Arm) -> Result<Row, NoRow> {
        // What a row leaves behind is a start for the next one only if it was solved.
        if let Some(mut solver) = self.solver.take()
            && differ_in_loads(solver.engine.equations.arm(), arm)
        {
            arm.check_loads()?;
            if let Some(row) = self.warm(&mut solver, arm) {
                self.solver = Some(solver);
                return Ok(row);
            }
        }
        self.cold(arm)
    }

    fn cold(&mut self, arm: &Arm) -> Result<Row, NoRow> {
        self.before.clear();
        let mut solver = Solver::new(arm, self.options).map_err(no_row)?;
        let configuration = solver.solve().map_err(no_row)?;
        self.solver = may_be_followed(arm).then_some(solver);
        Ok(self.row(&configuration))
    }

    /// From the last row: `None` unless the answer is surely that of the row's own ramp.
    fn warm(&mut self, solver: &mut Solver, arm: &Arm) -> Option<Row> {
        let engine = &mut solver.engine;
        let (solution, here) = (engine.solution.clone(), loads(engine.equations.arm()));
        engine.lead_on(&self.before.steps(&here, &loads(arm)));
        self.before.push(here, solution);
        engine.take_loads(arm);
        engine.set_phase(Phase::Tension, 1.0);
        engine.reset_statistics();
        let before = engine.tip_angle();
        let estimate = engine.settle(self.options.tol, First::Warm).ok()?;
        // What a direct solve has to pass, too: one equilibrium, and that on the unloaded arm's branch.
        if engine.needs_continuation() || (engine.tip_angle() - before).abs() > FARTHEST {
            return None;
        }
        if self.wanted.fold_margin || self.wanted.stability || self.wanted.warnings || self.wanted.stations >= 2 {
            return Some(self.row(&solver.read(estimate, PathSummary::default()).ok()?));
        }
        self.read(engine, estimate)
    }

    /// A row from what the engine has at hand.
    fn read(&self, engine: &mut Engine, estimate: f64) -> Option<Row> {
        let mut strokes = Vec::new();
        if self.wanted.strokes {
            engine.system.take_stations(&engine.solution);
            let (equations, at) = (&engine.equations, StationData::of(&engine.system));
            let stroke = |cable| {
                let [now, unloaded] = equations.cable_lengths(cable, at);
                equations.units.length * (unloaded - now)
            };
            strokes = (0..equations.arm().cables.len()).map(stroke).collect();
        }
        let tip = engine.read_tip().ok()?;
        let (arm, units) = (engine.equations.arm(), engine.equations.units);
        Some(Row {
            tip,
            base_reaction: Wrench::of_base(engine.solution.nodes[0], &units),
            error_estimate: estimate * units.length,
            tensions: arm.cables.iter().map(|cable| cable.tension).collect(),
            strokes,
            fold_margin: None,
            stability: None,
            warnings: Vec::new(),
            snaps: Vec::new(),
            snap_durations: Vec::new(),
            stations: Stations::default(),
        })
    }

    /// A row from a whole configuration.
    fn row(&self, configuration: &Configuration) -> Row {
        Row::new(configuration, self.wanted)
    }
}

impl Row {
    /// What is wanted of a configuration.
    ///
    /// ```
    /// use hydrostat::{Arm, Row, Wanted};
    ///
    /// let shape = Arm::cone(0.2, 0.010, 0.002, 110e3, 0.5).solve()?;
    /// let row = Row::new(&shape, Wanted { fold_margin: true, ..Wanted::default() });
    /// assert_eq!((row.tip, row.fold_margin.is_some()), (shape.tip(), true));
    /// # Ok::<(), hydrostat::SolveError>(())
    /// ```
    pub fn new(configuration: &Configuration, wanted: Wanted) -> Self {
        row_of!(configuration, wanted)
    }
}

/// The numbers that [`differ_in_loads`] lets differ.
pub(crate) fn loads(arm: &Arm) -> Vec<f64> {
    let Flow { speed, direction, density, .. } = arm.flow;
    let gravity = arm.gravity.map_or([0.0; 2], |gravity| [gravity.acceleration, gravity.direction]);
    let [fx, fy] = arm.tip.force;
    let [fa, fb] = arm.tip.follower;
    let others = [speed, direction, density, gravity[0], gravity[1], fx, fy, fa, fb, arm.tip.moment];
    let in_space = arm.space.iter().flat_map(Space::loads);
    others.into_iter().chain(in_space).chain(arm.cables.iter().map(|cable| cable.tension)).collect()
}

/// Whether the next row may start from this arm's shape: no friction and no strokes, whose answers hang on the way to
/// them.
pub(crate) fn may_be_followed(arm: &Arm) -> bool {
    arm.readings.support == Support::Clamped && !arm.has_friction() && !arm.is_commanded()
}

/// Whether an arm differs from another in what a solver takes between two solves.
pub(crate) fn differ_in_loads(a: &Arm, b: &Arm) -> bool {
    a.has_geometry_of(b)
        && a.base == b.base
        && a.density == b.density
        && a.material == b.material
        && a.distributed == b.distributed
        && a.space.iter().zip(&b.space).all(|(a, b)| a.is_loaded_along_as(b))
        && a.cables.iter().chain(&b.cables).all(|cable| cable.friction == 0.0)
        && b.cables.iter().all(|cable| cable.stroke.is_none())
}

/// The rows of `arms`, `tile` of them at a time on the threads of rayon's current pool, each tile one after the other
/// by a copy of `start`.
pub(crate) fn in_tiles<S: Clone + Sync, R: Send>(
    arms: &[Arm],
    tile: usize,
    start: &S,
    solve: impl Fn(&mut S, &Arm) -> R + Sync,
) -> Result<Vec<R>, SolveError> {
    if tile == 0 {
        return Err(SolveError::Option { option: "tile", value: 0.0, expected: "at least 1" });
    }
    let tiles = arms.par_chunks(tile).map(|arms| -> Vec<R> {
        let mut solver = start.clone();
        arms.iter().map(|arm| solve(&mut solver, arm)).collect()
    });
    let tiles: Vec<Vec<R>> = tiles.collect();
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
    let start = Tile::new(Options { tol: options.tol, snaps: options.snaps }, options.wanted)?;
    in_tiles(arms, options.tile, &start, Tile::solve)
}
