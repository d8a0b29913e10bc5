//! What became of a row, in the plane or in space.

use hydrostat::{
    AfterSnapError, Arm, FoldMargin, MotionError, NoRow, Options, Row, Rows, Snap, SolveError, SpatialError,
    SpatialRow, SpatialSnap, SpatialSolver, SpatialTip, Stability, Verdict, Wanted, Warning,
};

/// Why a row has no answer.
#[derive(Debug, Clone)]
pub(crate) enum NoAnswer {
    /// There is no such equilibrium, or none was found.
    Verdict(Verdict),
    /// Its values make no arm; in words.
    Arm(String),
}

impl From<NoRow> for NoAnswer {
    fn from(no: NoRow) -> Self {
        match no {
            NoRow::Verdict(verdict) => Self::Verdict(verdict),
            NoRow::Arm(error) => Self::Arm(error.to_string()),
        }
    }
}

/// The answer of a row.
#[derive(Debug, Clone)]
pub(crate) enum AnyRow {
    /// Of an arm in the plane.
    Plane(Box<Row>),
    /// Of an arm in space.
    Space(Box<SpatialRow>),
}

impl From<Row> for AnyRow {
    fn from(row: Row) -> Self {
        Self::Plane(Box::new(row))
    }
}

impl From<SpatialRow> for AnyRow {
    fn from(row: SpatialRow) -> Self {
        Self::Space(Box::new(row))
    }
}

/// The rows of a tile, of arms in the plane and in space.
#[derive(Debug, Clone)]
pub(crate) struct Tile {
    pub(crate) plane: Rows,
    pub(crate) space: Rows<SpatialSolver>,
}

impl Tile {
    pub(crate) fn new(options: Options, wanted: Wanted) -> Result<Self, SolveError> {
        Ok(Self { plane: Rows::new(options, wanted)?, space: Rows::new(options, wanted)? })
    }
}

/// Solves a row whose `verdict` is a snap, with the motion after it.
pub(crate) fn solve_after_snap(arm: &Arm, tol: f64, wanted: Wanted, verdict: Verdict) -> Result<AnyRow, NoAnswer> {
    match arm.solve_after_snap(tol) {
        Ok(found) => {
            let snap_durations = found.snaps.iter().map(|motion| motion.duration).collect();
            Ok(Row { snap_durations, ..Row::new(&found.configuration, wanted) }.into())
        }
        Err(AfterSnapError::Solve(SolveError::NoEquilibrium(no))) => Err(NoAnswer::Verdict(no.verdict)),
        Err(error) => Err(no_rest(&error, verdict)),
    }
}

/// [`solve_after_snap`] of an arm in space.
pub(crate) fn solve_after_snap_in_space(
    arm: &Arm,
    tol: f64,
    wanted: Wanted,
    verdict: Verdict,
) -> Result<AnyRow, NoAnswer> {
    match arm.solve_after_snap_in_space(tol) {
        Ok(found) => {
            let snap_durations = found.snaps.iter().map(|motion| motion.duration).collect();
            Ok(SpatialRow { snap_durations, ..SpatialRow::in_space(&found.configuration, wanted) }.into())
        }
        Err(AfterSnapError::Solve(SpatialError::NoEquilibrium(no))) => Err(NoAnswer::Verdict(no.verdict)),
        Err(error) => Err(no_rest(&error, verdict)),
    }
}

/// Why a row that snaps has no shape after it.
fn no_rest<E>(error: &AfterSnapError<E>, verdict: Verdict) -> NoAnswer
where
    AfterSnapError<E>: std::fmt::Display,
{
    match error {
        AfterSnapError::Solve(_) | AfterSnapError::Motion { motion: MotionError::Unsupported { .. }, .. } => {
            NoAnswer::Arm(error.to_string())
        }
        // It snaps, and where to is not known.
        AfterSnapError::Motion { .. } | AfterSnapError::NoRest { .. } => NoAnswer::Verdict(verdict),
    }
}

impl AnyRow {
    /// How many snaps the arm makes on its way to the loads; of the one that goes furthest load fraction, distance (m),
    /// angle (rad) and, where its motion was followed, duration (s).
    pub(crate) fn snaps(&self) -> (usize, [Option<f64>; 4]) {
        match self {
            Self::Plane(row) => {
                let of = |s: &Snap| [s.load_fraction, s.distance(), s.angle()];
                furthest(row.snaps.iter().map(of), &row.snap_durations)
            }
            Self::Space(row) => {
                let of = |s: &SpatialSnap| [s.load_fraction, s.distance(), s.angle()];
                furthest(row.snaps.iter().map(of), &row.snap_durations)
            }
        }
    }

    pub(crate) fn error_estimate(&self) -> f64 {
        match self {
            Self::Plane(row) => row.error_estimate,
            Self::Space(row) => row.error_estimate,
        }
    }

    pub(crate) fn tensions(&self) -> &[f64] {
        match self {
            Self::Plane(row) => &row.tensions,
            Self::Space(row) => &row.tensions,
        }
    }

    pub(crate) fn strokes(&self) -> &[f64] {
        match self {
            Self::Plane(row) => &row.strokes,
            Self::Space(row) => &row.strokes,
        }
    }

    pub(crate) fn fold_margin(&self) -> Option<FoldMargin> {
        match self {
            Self::Plane(row) => row.fold_margin,
            Self::Space(row) => row.fold_margin,
        }
    }

    pub(crate) fn stability(&self) -> Option<Stability> {
        match self {
            Self::Plane(row) => row.stability,
            Self::Space(row) => row.stability,
        }
    }

    pub(crate) fn warnings(&self) -> &[Warning] {
        match self {
            Self::Plane(row) => &row.warnings,
            Self::Space(row) => &row.warnings,
        }
    }

    /// Place of the tip and its angle, or in space its directors, in the order of their columns.
    pub(crate) fn tip(&self) -> Vec<f64> {
        match self {
            Self::Plane(row) => vec![row.tip.x, row.tip.y, row.tip.theta],
            Self::Space(row) => {
                let SpatialTip { x, y, z, a, b, c, .. } = row.tip;
                [[x, y, z], a, b, c].concat()
            }
        }
    }

    pub(crate) fn alpha(&self) -> f64 {
        match self {
            Self::Plane(row) => row.tip.alpha,
            Self::Space(row) => row.tip.alpha,
        }
    }

    /// Force and moment at the base.
    pub(crate) fn base(&self) -> Vec<f64> {
        match self {
            Self::Plane(row) => {
                let base = row.base_reaction;
                vec![base.force[0], base.force[1], base.moment]
            }
            Self::Space(row) => [row.base_reaction.force, row.base_reaction.moment].concat(),
        }
    }

    /// A field of the stations, by its place among the columns of a shape.
    pub(crate) fn shape(&self, field: usize, station: usize) -> Option<f64> {
        match self {
            Self::Plane(row) => {
                let s = &row.stations;
                [&s.x, &s.y, &s.theta].get(field)?.get(station).copied()
            }
            Self::Space(row) => {
                let s = &row.stations;
                if let Some(places) = [&s.x, &s.y, &s.z].get(field) {
                    return places.get(station).copied();
                }
                let director = [&s.a, &s.b].get(field / 3 - 1)?.get(station)?;
                Some(director[field % 3])
            }
        }
    }
}

/// How many snaps there are, given load fraction, distance and angle of each, and the duration of some; the same of the one
/// that goes furthest.
fn furthest(snaps: impl Iterator<Item = [f64; 3]>, durations: &[f64]) -> (usize, [Option<f64>; 4]) {
    let snaps: Vec<[f64; 3]> = snaps.collect();
    let furthest = (0..snaps.len()).max_by(|a, b| snaps[*a][1].total_cmp(&snaps[*b][1]));
    let of = furthest.map_or([None; 4], |k| {
        let [load_fraction, distance, angle] = snaps[k].map(Some);
        [load_fraction, distance, angle, durations.get(k).copied()]
    });
    (snaps.len(), of)
}
