//! Arms along loads that rise and fall.

use std::sync::atomic::{AtomicBool, Ordering};

use hydrostat::{
    AfterSnapError, Configuration, Loading, LoadingError, LoadingSnap, LoadingStep, MotionError, Options,
    SpatialConfiguration, SpatialError, SpatialSolver, SpatialTip, Tip,
};
use hydrostat_figures::{LoadingPoint, Page};
use hydrostat_files::{LoadRows, LoadingDocument, LoadingRow, RowSnap, loading_csv, spatial_loading_csv};
use numpy::PyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arm_class::Arm;
use crate::arrays::given;
use crate::errors::{solve_error, spatial_error, wrong};
use crate::figure::{Axis, Figure, abscissa, quantity};
use crate::interrupt::interruptible;
use crate::motion::{after_snap_error, not_at_rest};
use crate::solution::{Solution, tip};
use crate::spatial_solution::{SpatialSolution, tip as spatial_tip};

/// Rows that were reached.
enum Rows {
    Plane(Vec<LoadingRow>),
    Space(Vec<LoadingRow<SpatialConfiguration, SpatialTip>>),
}

/// The same of rows in the plane and in space.
macro_rules! of {
    ($rows:expr, $own:ident => $what:expr) => {
        match $rows {
            Rows::Plane($own) => $what,
            Rows::Space($own) => $what,
        }
    };
}

/// Equilibria along a sequence of loads.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct History {
    arm: hydrostat::Arm,
    loads: LoadRows,
    rows: Rows,
    tol: f64,
}

/// Index of its row, the loads, fraction, tips before and after, distance, angle, duration, and, where the curve leads on,
/// whether the motion lands elsewhere.
type RowSnapFields = (usize, Vec<f64>, f64, Py<PyAny>, Py<PyAny>, f64, f64, f64, Option<bool>);

/// A way along rows of loads: the rows that were reached, and what ended it.
type Way<C, T, E> = (Vec<LoadingRow<C, T>>, Option<(usize, LoadingError<E>)>);

/// Goes from row to row.
fn along<C, T: hydrostat::Pose, E, L>(
    arms: &[hydrostat::Arm],
    loads: &LoadRows,
    stop: &AtomicBool,
    start: impl FnOnce(&hydrostat::Arm) -> Result<(L, C), LoadingError<E>>,
    go_to: impl Fn(&mut L, &hydrostat::Arm) -> Result<LoadingStep<C, T>, LoadingError<E>>,
) -> Way<C, T, E> {
    let mut rows: Vec<LoadingRow<C, T>> = Vec::new();
    let values = |k: usize| loads.rows[k].1.clone();
    let (mut loading, configuration) = match start(&arms[0]) {
        Ok(started) => started,
        Err(error) => return (rows, Some((0, error))),
    };
    rows.push(LoadingRow::new(None, values(0), LoadingStep { configuration, snaps: Vec::new() }));
    for (k, arm) in arms.iter().enumerate().skip(1) {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        match go_to(&mut loading, arm) {
            Ok(step) => rows.push(LoadingRow::new(Some(&values(k - 1)), values(k), step)),
            Err(error) => return (rows, Some((k, error))),
        }
    }
    (rows, None)
}

/// Follows `arm` along rows of loads: the rows that were reached, and what ended the way to the next one.
#[pyfunction]
pub(crate) fn history(
    py: Python<'_>,
    arm: &Arm,
    keys: Vec<String>,
    rows: Vec<Vec<f64>>,
    tol: f64,
) -> PyResult<(History, Option<PyErr>)> {
    let loads = LoadRows::new(&keys, rows);
    let arms = loads.arms(&arm.given).map_err(wrong)?;
    let (rows, error) = if arm.given.space.is_some() {
        let go = |stop: &AtomicBool| -> Way<SpatialConfiguration, SpatialTip, SpatialError> {
            let start = |arm: &hydrostat::Arm| {
                Loading::<SpatialSolver>::start_in_space(arm, tol)
                    .map(|(loading, first)| (loading, first.configuration))
            };
            along(&arms, &loads, stop, start, Loading::<SpatialSolver>::go_to)
        };
        let (rows, failure) = interruptible(py, |_| Ok(()), go)?;
        (Rows::Space(rows), failure.map(|(row, error)| loading_error(py, row, error, tol, spatial_error)))
    } else {
        let go = |stop: &AtomicBool| -> Way<Configuration, Tip, hydrostat::SolveError> {
            let start =
                |arm: &hydrostat::Arm| Loading::start(arm, tol).map(|(loading, first)| (loading, first.configuration));
            along(&arms, &loads, stop, start, |loading: &mut Loading, arm| loading.go_to(arm))
        };
        let (rows, failure) = interruptible(py, |_| Ok(()), go)?;
        (Rows::Plane(rows), failure.map(|(row, error)| loading_error(py, row, error, tol, solve_error)))
    };
    Ok((History { arm: arm.given.clone(), loads, rows, tol }, error))
}

fn loading_error<E>(
    py: Python<'_>,
    row: usize,
    error: LoadingError<E>,
    tol: f64,
    solve_error: impl FnOnce(Python<'_>, E, Options) -> PyErr,
) -> PyErr
where
    LoadingError<E>: std::fmt::Display,
    AfterSnapError<E>: std::fmt::Display,
{
    match error {
        LoadingError::Start(error) => after_snap_error(py, error, Options::with_tol(tol), solve_error),
        error @ (LoadingError::Arm(_)
        | LoadingError::Unsupported { .. }
        | LoadingError::Motion { motion: MotionError::Unsupported { .. }, .. }) => wrong(format!("row {row}: {error}")),
        error => not_at_rest(py, &format!("row {row}: {error}")),
    }
}

/// The snaps on the way to all rows.
fn snaps<C, T: hydrostat::Pose>(
    rows: &[LoadingRow<C, T>],
    length: f64,
    tip: impl Fn(T) -> PyResult<Py<PyAny>>,
) -> PyResult<Vec<RowSnapFields>> {
    let mut out = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        for RowSnap { loads, snap } in &row.snaps {
            let LoadingSnap { fraction, before, after, duration, on_curve } = *snap;
            let elsewhere = on_curve.map(|_| snap.lands_elsewhere(length));
            let sizes = (snap.distance(), snap.angle());
            out.push((k, loads.clone(), fraction, tip(before)?, tip(after)?, sizes.0, sizes.1, duration, elsewhere));
        }
    }
    Ok(out)
}

/// The points of the loading diagram.
fn points<C: hydrostat_figures::Posed>(rows: &[LoadingRow<C, C::Tip>], column: usize) -> Vec<LoadingPoint<'_, C>> {
    rows.iter()
        .map(|row| LoadingPoint {
            value: row.loads[column],
            configuration: &row.step.configuration,
            snaps: row.snaps.iter().map(|snap| (snap.loads[column], snap.snap)).collect(),
        })
        .collect()
}

#[pymethods]
impl History {
    fn __len__(&self) -> usize {
        of!(&self.rows, rows => rows.len())
    }

    #[getter]
    fn keys(&self) -> Vec<String> {
        self.loads.keys.clone()
    }

    /// Whether the arm is in space.
    #[getter]
    fn is_spatial(&self) -> bool {
        matches!(self.rows, Rows::Space(_))
    }

    /// The loads of all rows at a key.
    fn loads<'py>(&self, py: Python<'py>, column: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if column >= self.loads.keys.len() {
            return Err(PyIndexError::new_err("column: the history has no such column"));
        }
        Ok(given(py, of!(&self.rows, rows => rows.iter().map(|row| row.loads[column]).collect())))
    }

    /// A `Solution`, or a `SpatialSolution` of an arm in space.
    fn solution(&self, py: Python<'_>, row: usize) -> PyResult<Py<PyAny>> {
        let none = || PyIndexError::new_err("row: the history has no such row");
        let options = Options::with_tol(self.tol);
        match &self.rows {
            Rows::Plane(rows) => {
                let row = rows.get(row).ok_or_else(none)?;
                Ok(Py::new(py, Solution::new(row.step.configuration.clone(), options))?.into_any())
            }
            Rows::Space(rows) => {
                let row = rows.get(row).ok_or_else(none)?;
                Ok(Py::new(py, SpatialSolution::new(row.step.configuration.clone(), options))?.into_any())
            }
        }
    }

    #[getter]
    fn snaps(&self, py: Python<'_>) -> PyResult<Vec<RowSnapFields>> {
        let length = self.arm.length;
        match &self.rows {
            Rows::Plane(rows) => snaps(rows, length, |at| Ok(tip(at).into_pyobject(py)?.into_any().unbind())),
            Rows::Space(rows) => snaps(rows, length, |at| Ok(spatial_tip(at).into_pyobject(py)?.into_any().unbind())),
        }
    }

    fn figure(&self, column: usize, asked: &str, title: &str) -> PyResult<Figure> {
        let Some(key) = self.loads.keys.get(column) else {
            return Err(PyIndexError::new_err("column: the history has no such column"));
        };
        let axis: Axis = (key.clone(), self.loads.unit(column).to_owned(), 1.0);
        let (axis, asked, page) = (abscissa(axis), quantity(asked)?, Page::default());
        let scene = of!(&self.rows, rows => hydrostat_figures::loading_figure(&points(rows, column), &axis, asked, title, &page));
        Ok(Figure::new(scene))
    }

    fn to_json(&self) -> String {
        match &self.rows {
            Rows::Plane(rows) => LoadingDocument::new(&self.arm, &self.loads, rows, None).to_json(),
            Rows::Space(rows) => LoadingDocument::in_space(&self.arm, &self.loads, rows, None).to_json(),
        }
    }

    fn to_csv(&self) -> String {
        match &self.rows {
            Rows::Plane(rows) => loading_csv(&self.loads, rows),
            Rows::Space(rows) => spatial_loading_csv(&self.loads, rows),
        }
    }
}
