//! What became of a row, in the plane or in space.

use hydrostat::{
    AfterSnapError, Arm, FoldMargin, MotionError, Options, Row, Snap, SolveError, SpatialConfiguration, SpatialError,
    SpatialSnap, SpatialSolver, SpatialTip, SpatialWrench, Stability, Verdict, Wanted, Warning,
};

/// Why a row has no answer.
#[derive(Debug, Clone)]
pub(crate) enum NoAnswer {
    /// There is no such equilibrium, or none was found.
    Verdict(Verdict),
    /// Its values make no arm; in words.
    Arm(String),
}

/// The answer of a row.
#[derive(Debug, Clone)]
pub(crate) enum AnyRow {
    /// Of an arm in the plane.
    Plane(Row),
    /// Of an arm in space.
    Space(SpatialRow),
}

/// What is kept of an arm in space.
#[derive(Debug, Clone)]
pub(crate) struct SpatialRow {
    tip: SpatialTip,
    base_reaction: SpatialWrench,
    error_estimate: f64,
    tensions: Vec<f64>,
    strokes: Vec<f64>,
    fold_margin: FoldMargin,
    stability: Option<Stability>,
    warnings: Vec<Warning>,
    snaps: Vec<SpatialSnap>,
    /// How long they take, s, where their motion was followed.
    snap_durations: Vec<f64>,
    /// Place and directors a and b at each station; empty unless asked for.
    shape: Vec<[f64; 9]>,
}

impl SpatialRow {
    fn of(configuration: &SpatialConfiguration, wanted: Wanted) -> Self {
        let cables = &configuration.cables;
        Self {
            tip: configuration.tip(),
            base_reaction: configuration.base_reaction,
            error_estimate: configuration.error_estimate,
            tensions: cables.iter().map(|cable| cable.tension).collect(),
            strokes: cables.iter().map(|cable| cable.stroke).collect(),
            fold_margin: configuration.fold_margin(),
            stability: if wanted.stability { configuration.stability() } else { None },
            warnings: if wanted.warnings { configuration.warnings() } else { Vec::new() },
            snaps: configuration.snaps.clone(),
            snap_durations: Vec::new(),
            shape: if wanted.stations < 2 { Vec::new() } else { shape(configuration, wanted.stations) },
        }
    }
}

fn shape(configuration: &SpatialConfiguration, count: usize) -> Vec<[f64; 9]> {
    let stations = configuration.resampled(count);
    let at = |k: usize| {
        let (a, b) = (stations.a[k], stations.b[k]);
        [stations.x[k], stations.y[k], stations.z[k], a[0], a[1], a[2], b[0], b[1], b[2]]
    };
    (0..stations.len()).map(at).collect()
}

/// Solves a row in space by itself: it does not depend on the rows before.
pub(crate) fn solve_in_space(arm: &Arm, options: Options, wanted: Wanted) -> Result<AnyRow, NoAnswer> {
    match SpatialSolver::new(arm, options).and_then(|mut solver| solver.solve()) {
        Ok(configuration) => Ok(AnyRow::Space(SpatialRow::of(&configuration, wanted))),
        Err(SpatialError::NoEquilibrium(no)) => Err(NoAnswer::Verdict(no.verdict)),
        Err(error) => Err(NoAnswer::Arm(error.to_string())),
    }
}

/// Solves a row whose `verdict` is a snap, with the motion after it.
pub(crate) fn solve_after_snap(arm: &Arm, tol: f64, wanted: Wanted, verdict: Verdict) -> Result<AnyRow, NoAnswer> {
    match arm.solve_after_snap(tol) {
        Ok(found) => {
            let snap_durations = found.snaps.iter().map(|motion| motion.duration).collect();
            Ok(AnyRow::Plane(Row { snap_durations, ..Row::new(&found.configuration, wanted) }))
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
            Ok(AnyRow::Space(SpatialRow { snap_durations, ..SpatialRow::of(&found.configuration, wanted) }))
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
            Self::Space(row) => Some(row.fold_margin),
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
            Self::Plane(Row { tip, .. }) => vec![tip.x, tip.y, tip.theta],
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
            Self::Plane(Row { base_reaction: base, .. }) => vec![base.force[0], base.force[1], base.moment],
            Self::Space(row) => [row.base_reaction.force, row.base_reaction.moment].concat(),
        }
    }

    /// A field of the stations, by its place among the columns of a shape.
    pub(crate) fn shape(&self, field: usize, station: usize) -> Option<f64> {
        match self {
            Self::Plane(Row { stations: s, .. }) => [&s.x, &s.y, &s.theta].get(field)?.get(station).copied(),
            Self::Space(row) => row.shape.get(station)?.get(field).copied(),
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
