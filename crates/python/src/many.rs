//! Many arms that differ in a few numbers, each answered with a few numbers.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use hydrostat::parameter::names;
use hydrostat::{
    NoRow, Options, Parameter, Pose as _, PoseChange, Row, RowSolver, Rows, SensitivityOptions, SolveError, Solver,
    SpatialPoseChange, SpatialRow, SpatialSolver, SpatialStations, SpatialTip, SpatialWrench, Stations, Wanted, Wrench,
};
use hydrostat_files::Dimension;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::wrong;
use crate::interrupt::interruptible;
use crate::order::order;
use crate::solution::{options, words};
use crate::sweep::say;

/// Rows that are ordered at a time: some tens of milliseconds, in which Ctrl-C is not heard.
const BLOCK: usize = 1 << 17;
/// The word for a row whose numbers are none.
const NOT_A_NUMBER: &str = "not_a_number";

/// The derivatives of a row: of what [`Columns::DERIVATIVES`] names, then of each cable's stroke, by the parameters asked for.
type Gradients = Vec<Vec<f64>>;

/// What a row is answered with.
enum Answer<R> {
    /// With the kinds of its warnings.
    Row(Box<R>, Option<Gradients>, String),
    No(NoRow),
}

/// The rows of what solves them.
type RowOf<S> = Row<<S as Columns>::Tip, <S as Columns>::Wrench, <S as Columns>::Stations>;

/// The columns of rows, of a solver in the plane or in space.
trait Columns: RowSolver<Row = RowOf<Self>> {
    type Tip: Send + Sync;
    type Wrench: Send + Sync;
    type Stations: Send + Sync;
    /// The columns that every row has, a number each.
    const FIELDS: &'static [&'static str];
    /// The columns of stations, where they are asked for, a number a station each.
    const STATIONS: &'static [&'static str];
    /// The columns of derivatives of the tip.
    const DERIVATIVES: &'static [&'static str];

    /// The number of a row in the column [`Columns::FIELDS`]`[column]`.
    fn field(row: &RowOf<Self>, column: usize) -> f64;
    /// The numbers of a row in the column [`Columns::STATIONS`]`[column]`.
    fn stations(row: &RowOf<Self>, column: usize) -> Vec<f64>;
    /// Derivatives about the shape of a row, by a solver that may have those about another row before.
    fn gradients(
        request: &Request<'_>,
        kept: &mut Option<Self>,
        arm: &hydrostat::Arm,
        found: &RowOf<Self>,
    ) -> Option<Gradients>;
}

/// What is varied, and what is asked.
struct Request<'a> {
    base: &'a hydrostat::Arm,
    varied: Vec<(Parameter, Vec<f64>)>,
    options: Options,
    tile: usize,
    wanted: Wanted,
    gradients: Vec<Parameter>,
}

/// The names of what can vary, those of cables with the index 0.
#[pyfunction]
pub(crate) fn parameter_names() -> Vec<String> {
    names()
}

/// Solves `arm` with the values of `keys`, a column each (angles in degrees), row by row; rows with NaN are none. So many `threads`, 0 for
/// as many as the machine has; `progress` hears rows that are done.
#[pyfunction]
#[pyo3(signature = (arm, keys, columns, rows, tol, snaps, tile, strokes, fold_margin, stability, warnings, stations, gradients, threads, progress))]
#[expect(clippy::too_many_arguments, clippy::fn_params_excessive_bools, reason = "one call of a private function")]
pub(crate) fn solve_many<'py>(
    py: Python<'py>,
    arm: &Arm,
    keys: Vec<String>,
    columns: Vec<PyReadonlyArray1<'py, f64>>,
    rows: usize,
    tol: f64,
    snaps: (f64, f64),
    tile: usize,
    strokes: bool,
    fold_margin: bool,
    stability: bool,
    warnings: bool,
    stations: usize,
    gradients: Vec<String>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut varied: Vec<(Parameter, Vec<f64>)> = Vec::new();
    for (key, column) in keys.iter().zip(&columns) {
        let parameter: Parameter = key.parse().map_err(wrong)?;
        parameter.of(&arm.given).map_err(wrong)?;
        let si = |value: &f64| if parameter.unit() == "rad" { Dimension::Angle.bare(*value) } else { *value };
        varied.push((parameter, column.as_array().iter().map(si).collect()));
    }
    let by = |key: &String| -> PyResult<Parameter> {
        let of_gradients = |error: &dyn std::fmt::Display| wrong(format!("gradients: {error}"));
        let parameter: Parameter = key.parse().map_err(|error| of_gradients(&error))?;
        parameter.of(&arm.given).map_err(|error| of_gradients(&error))?;
        Ok(parameter)
    };
    let wanted = Wanted { strokes, fold_margin, stability, warnings, stations };
    let gradients = gradients.iter().map(by).collect::<PyResult<_>>()?;
    let options = options(tol, snaps);
    let request = Request { base: &arm.given, varied, options, tile, wanted, gradients };
    // Options are looked at whatever the rows.
    if tile == 0 {
        let none: SolveError = SolveError::Option { option: "tile", value: 0.0, expected: "at least 1" };
        return Err(wrong(none));
    }
    if arm.given.space.is_some() {
        return request.solve::<SpatialSolver>(py, rows, threads, progress.as_ref());
    }
    request.solve::<Solver>(py, rows, threads, progress.as_ref())
}

impl Request<'_> {
    fn solve<'py, S: Columns>(
        &self,
        py: Python<'py>,
        rows: usize,
        threads: usize,
        progress: Option<&Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let start = Rows::<S>::new(self.options, self.wanted).map_err(wrong)?;
        let done = AtomicU64::new(0);
        let answers = interruptible(
            py,
            |py| say(py, progress, done.load(Ordering::Relaxed)),
            |stop| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
                Ok(pool.install(|| self.answers(&start, rows, &done, stop)))
            },
        )?;
        let answers =
            answers.map_err(|error: rayon::ThreadPoolBuildError| PyRuntimeError::new_err(error.to_string()))?;
        say(py, progress, rows as u64)?;
        self.columns_of::<S>(py, &answers)
    }

    /// The answers of all rows; `None` of those with NaN.
    fn answers<S: Columns>(
        &self,
        start: &Rows<S>,
        rows: usize,
        done: &AtomicU64,
        stop: &AtomicBool,
    ) -> Answers<RowOf<S>> {
        let mut out = Answers { solved: Vec::new(), places: Vec::with_capacity(rows) };
        let tile = |rows: &[usize]| -> Vec<Answer<RowOf<S>>> {
            let mut tile = start.clone();
            let mut differentiated = None;
            let mut arm = self.base.clone();
            let mut out = Vec::with_capacity(rows.len());
            for row in rows {
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                for (parameter, values) in &self.varied {
                    // The arm was seen to have it.
                    let _ = parameter.set(&mut arm, values[*row]);
                }
                out.push(match tile.next(&arm) {
                    Ok(found) => {
                        let asked = !self.gradients.is_empty();
                        let gradients =
                            if asked { S::gradients(self, &mut differentiated, &arm, &found) } else { None };
                        let kinds = if self.wanted.warnings {
                            let asked = self.options.tol * arm.length;
                            hydrostat_sweep::warning_kinds(&found.warnings, found.error_estimate, asked)
                        } else {
                            String::new()
                        };
                        Answer::Row(Box::new(found), gradients, kinds)
                    }
                    Err(no) => Answer::No(no),
                });
                done.fetch_add(1, Ordering::Relaxed);
            }
            out
        };
        let mut from = 0;
        while from < rows && !stop.load(Ordering::Relaxed) {
            let block = from..rows.min(from + BLOCK);
            from = block.end;
            let order = order(&self.varied, block.clone());
            done.fetch_add((block.len() - order.solved.len()) as u64, Ordering::Relaxed);
            let solved: Vec<Vec<Answer<RowOf<S>>>> = order.solved.par_chunks(self.tile).map(tile).collect();
            let before = out.solved.len();
            out.solved.extend(solved.into_iter().flatten());
            out.places.extend(order.places.into_iter().map(|place| place.map(|place| before + place)));
        }
        out
    }

    /// How far from a row's tip (m) that of a solver may be for its derivatives to be the row's.
    fn near(&self, arm: &hydrostat::Arm) -> f64 {
        (1e-6 + 10.0 * self.options.tol) * arm.length
    }

    fn columns_of<'py, S: Columns>(
        &self,
        py: Python<'py>,
        answers: &Answers<RowOf<S>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let out = PyDict::new(py);
        let cables = self.base.cables.len();
        let wanted = self.wanted;
        let put = |name: &str, values: Vec<f64>| out.set_item(name, given(py, values));
        for (column, name) in S::FIELDS.iter().enumerate() {
            put(name, answers.cells(1, |row, cells| cells.push(S::field(row, column))))?;
        }
        put("error_estimate", answers.cells(1, |row, cells| cells.push(row.error_estimate)))?;
        put("tension", answers.cells(cables, |row, cells| cells.extend_from_slice(&row.tensions)))?;
        if wanted.strokes {
            put("stroke", answers.cells(cables, |row, cells| cells.extend_from_slice(&row.strokes)))?;
        }
        if wanted.fold_margin {
            put("fold_margin", answers.cells(1, |row, cells| cells.extend(row.fold_margin.map(|fold| fold.value))))?;
        }
        if wanted.stations >= 2 {
            for (column, name) in S::STATIONS.iter().enumerate() {
                put(name, answers.cells(wanted.stations, |row, cells| cells.extend(S::stations(row, column))))?;
            }
        }
        if !self.gradients.is_empty() {
            for (k, name) in S::DERIVATIVES.iter().enumerate() {
                put(name, answers.derivatives(k, 1, self.gradients.len()))?;
            }
            put("d_stroke", answers.derivatives(S::DERIVATIVES.len(), cables, self.gradients.len()))?;
        }
        if wanted.stability {
            let state = |row: Option<&RowOf<S>>| row.and_then(|row| words(row.stability).0).unwrap_or_default();
            out.set_item("stability", answers.rows().map(state).collect::<Vec<_>>())?;
        }
        if wanted.warnings {
            let words = |answer: Option<&'_ Answer<RowOf<S>>>| match answer {
                Some(Answer::Row(_, _, kinds)) => kinds.clone(),
                _ => String::new(),
            };
            out.set_item("warnings", answers.all().map(words).collect::<Vec<_>>())?;
        }
        let verdict = |answer: Option<&Answer<RowOf<S>>>| match answer {
            None => NOT_A_NUMBER,
            Some(Answer::Row(..)) => "",
            Some(Answer::No(NoRow::Verdict(verdict))) => verdict.kind.name(),
            Some(Answer::No(NoRow::Arm(_))) => hydrostat_sweep::NO_ARM,
        };
        out.set_item("verdict", answers.all().map(verdict).collect::<Vec<_>>())?;
        let reason = |answer: (usize, Option<&Answer<RowOf<S>>>)| match answer {
            (row, None) => self.not_a_number(row),
            (_, Some(Answer::Row(..))) => String::new(),
            (_, Some(Answer::No(no))) => no.to_string(),
        };
        out.set_item("reason", answers.all().enumerate().map(reason).collect::<Vec<_>>())?;
        let fraction = |answer: Option<&Answer<RowOf<S>>>| match answer {
            Some(Answer::No(NoRow::Verdict(verdict))) => verdict.load_fraction,
            _ => f64::NAN,
        };
        put("load_fraction", answers.all().map(fraction).collect())?;
        Ok(out)
    }

    fn not_a_number(&self, row: usize) -> String {
        let own = self.varied.iter().find(|(_, values)| values[row].is_nan());
        own.map_or_else(String::new, |(parameter, _)| format!("`{parameter}` is not a number"))
    }
}

impl Columns for Solver {
    type Tip = hydrostat::Tip;
    type Wrench = Wrench;
    type Stations = Stations;
    const FIELDS: &'static [&'static str] =
        &["tip_x", "tip_y", "tip_theta", "tip_alpha", "base_force_x", "base_force_y", "base_moment"];
    const STATIONS: &'static [&'static str] = &["x", "y", "theta"];
    const DERIVATIVES: &'static [&'static str] = &["d_tip_x", "d_tip_y", "d_tip_theta", "d_tip_alpha"];

    fn field(row: &Row, column: usize) -> f64 {
        let (tip, base) = (row.tip, row.base_reaction);
        [tip.x, tip.y, tip.theta, tip.alpha, base.force[0], base.force[1], base.moment][column]
    }

    fn stations(row: &Row, column: usize) -> Vec<f64> {
        [&row.stations.x, &row.stations.y, &row.stations.theta][column].clone()
    }

    fn gradients(
        request: &Request<'_>,
        kept: &mut Option<Solver>,
        arm: &hydrostat::Arm,
        found: &Row,
    ) -> Option<Gradients> {
        let near = |tip: hydrostat::Tip| (tip.x - found.tip.x).hypot(tip.y - found.tip.y) <= request.near(arm);
        // From the row before where that leads to the shape that the row has.
        let warm = kept
            .as_mut()
            .is_some_and(|solver| solver.set_arm(arm).is_ok() && solver.update().is_ok_and(|answer| near(answer.tip)));
        if !warm {
            let mut solver = Solver::new(arm, request.options).ok()?;
            solver.solve().ok()?;
            *kept = Some(solver);
        }
        let found = kept.as_mut()?.sensitivities_with(&request.gradients, &SensitivityOptions::default()).ok()?;
        let of = |part: fn(&PoseChange) -> f64| -> Vec<f64> { found.tip.iter().map(part).collect() };
        let mut out = vec![of(|tip| tip.x), of(|tip| tip.y), of(|tip| tip.theta), of(|tip| tip.alpha)];
        out.extend(found.strokes);
        Some(out)
    }
}

impl Columns for SpatialSolver {
    type Tip = SpatialTip;
    type Wrench = SpatialWrench;
    type Stations = SpatialStations;
    #[rustfmt::skip]
    const FIELDS: &'static [&'static str] = &[
        "tip_x", "tip_y", "tip_z",
        "tip_a_x", "tip_a_y", "tip_a_z", "tip_b_x", "tip_b_y", "tip_b_z", "tip_c_x", "tip_c_y", "tip_c_z",
        "tip_alpha",
        "base_force_x", "base_force_y", "base_force_z", "base_moment_x", "base_moment_y", "base_moment_z",
    ];
    const STATIONS: &'static [&'static str] = &["x", "y", "z", "a_x", "a_y", "a_z", "b_x", "b_y", "b_z"];
    const DERIVATIVES: &'static [&'static str] =
        &["d_tip_x", "d_tip_y", "d_tip_z", "d_tip_turn_x", "d_tip_turn_y", "d_tip_turn_z"];

    fn field(row: &SpatialRow, column: usize) -> f64 {
        let SpatialTip { x, y, z, a, b, c, alpha } = row.tip;
        match column {
            0..12 => [[x, y, z], a, b, c][column / 3][column % 3],
            12 => alpha,
            13..16 => row.base_reaction.force[column - 13],
            _ => row.base_reaction.moment[column - 16],
        }
    }

    fn stations(row: &SpatialRow, column: usize) -> Vec<f64> {
        let at = &row.stations;
        match column {
            0..3 => [&at.x, &at.y, &at.z][column].clone(),
            _ => [&at.a, &at.b][column / 3 - 1].iter().map(|director| director[column % 3]).collect(),
        }
    }

    fn gradients(
        request: &Request<'_>,
        kept: &mut Option<SpatialSolver>,
        arm: &hydrostat::Arm,
        found: &SpatialRow,
    ) -> Option<Gradients> {
        let near = |tip: SpatialTip| tip.distance_to(&found.tip) <= request.near(arm);
        // From the row before where that leads to the shape that the row has.
        let warm = kept
            .as_mut()
            .is_some_and(|solver| solver.set_arm(arm).is_ok() && solver.update().is_ok_and(|answer| near(answer.tip)));
        if !warm {
            let mut solver = SpatialSolver::new(arm, request.options).ok()?;
            solver.solve().ok()?;
            *kept = Some(solver);
        }
        let found = kept.as_mut()?.sensitivities_with(&request.gradients, &SensitivityOptions::default()).ok()?;
        let part = |k: usize| move |c: &SpatialPoseChange| if k < 3 { c.place[k] } else { c.turn[k - 3] };
        let mut out: Gradients = (0..6).map(|k| found.tip.iter().map(part(k)).collect()).collect();
        out.extend(found.strokes);
        Some(out)
    }
}

/// Answers of the rows that were solved, and the place of each row's among them.
struct Answers<R> {
    solved: Vec<Answer<R>>,
    places: Vec<Option<usize>>,
}

impl<R> Answers<R> {
    fn all(&self) -> impl Iterator<Item = Option<&Answer<R>>> {
        self.places.iter().map(|place| place.and_then(|place| self.solved.get(place)))
    }

    /// `count` numbers of every row; NaN where it has none.
    fn cells(&self, count: usize, add: impl Fn(&R, &mut Vec<f64>)) -> Vec<f64> {
        let mut cells = Vec::with_capacity(count * self.places.len());
        for (k, row) in self.rows().enumerate() {
            if let Some(row) = row {
                add(row, &mut cells);
            }
            cells.resize((k + 1) * count, f64::NAN);
        }
        cells
    }

    fn rows(&self) -> impl Iterator<Item = Option<&R>> {
        self.all().map(|answer| match answer {
            Some(Answer::Row(row, ..)) => Some(row.as_ref()),
            _ => None,
        })
    }

    /// Derivatives of `count` quantities from the one at `first` on by so many parameters, row by row.
    fn derivatives(&self, first: usize, count: usize, parameters: usize) -> Vec<f64> {
        let mut out = Vec::with_capacity(self.places.len() * count * parameters);
        for answer in self.all() {
            match answer {
                Some(Answer::Row(_, Some(gradients), _)) => {
                    out.extend(gradients[first..first + count].iter().flatten());
                }
                _ => out.resize(out.len() + count * parameters, f64::NAN),
            }
        }
        out
    }
}
