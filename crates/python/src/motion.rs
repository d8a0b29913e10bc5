//! Arms in motion, and along loads that rise and fall.

use std::sync::atomic::Ordering;

use hydrostat::{
    AfterSnapError, Course, Inputs, Loading, LoadingError, LoadingStep, MotionError, MotionOptions, Options,
};
use hydrostat_figures::{LoadingPoint, MotionFrame, Page};
use hydrostat_files::{LoadRows, LoadingDocument, LoadingRow, loading_csv, motion_columns, motion_numbers};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::arm_class::Arm;
use crate::arrays::{finite, given};
use crate::errors::{motion_error, solve_error, wrong};
use crate::figure::{Axis, Figure, abscissa, quantity};
use crate::interrupt::interruptible;
use crate::solution::{Solution, TipFields, tip};

/// A key with its times and values, and whether a smooth line joins them.
type Given<'py> = (String, PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>, bool);

/// An arm in motion.
#[pyclass(module = "hydrostat._native")]
pub(crate) struct Simulation {
    simulation: hydrostat::Simulation,
    arm: hydrostat::Arm,
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (arm, inputs, tol, start, elements))]
    fn new(
        py: Python<'_>,
        arm: &Arm,
        inputs: Vec<Given<'_>>,
        tol: f64,
        start: f64,
        elements: Option<usize>,
    ) -> PyResult<Self> {
        let inputs = courses(&inputs)?;
        let options = MotionOptions { tol, start, elements, ..MotionOptions::default() };
        let made = py.detach(|| hydrostat::Simulation::new(&arm.given, inputs, options));
        let simulation = made.map_err(|error| motion_error(py, error))?;
        Ok(Self { simulation, arm: arm.given.clone() })
    }

    /// A motion of its own that goes on from here.
    fn copy(&self) -> Self {
        Self { simulation: self.simulation.clone(), arm: self.arm.clone() }
    }

    /// The names of the numbers of a row.
    #[getter]
    fn columns(&self) -> Vec<String> {
        motion_columns(self.arm.cables.len())
    }

    #[getter]
    fn time(&self) -> f64 {
        self.simulation.time()
    }

    /// The row of the present time.
    fn now(&mut self) -> Vec<f64> {
        motion_numbers(&self.simulation.now())
    }

    /// Moves on by so many seconds, while loads change to these values.
    fn step(&mut self, py: Python<'_>, dt: f64, loads: Vec<(String, f64)>) -> PyResult<Vec<f64>> {
        let simulation = &mut self.simulation;
        let loads: Vec<(&str, f64)> = loads.iter().map(|(key, value)| (key.as_str(), *value)).collect();
        let at = py.detach(|| simulation.step_to(dt, &loads)).map_err(|error| motion_error(py, error))?;
        py.check_signals()?;
        Ok(motion_numbers(&at))
    }

    /// All rows up to a time, one after the other, the shapes at them (x, y and theta at the nodes), and why it ended
    /// early: kind, time, place, and message.
    #[allow(clippy::type_complexity, reason = "a row of plain values")]
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        until: f64,
        every: f64,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Option<Verdict>)> {
        let simulation = &mut self.simulation;
        let (mut rows, mut shapes) = (Vec::new(), Vec::new());
        let outcome = interruptible(
            py,
            |_| Ok(()),
            |stop| {
                simulation.run(until, every, |at, simulation| {
                    rows.extend(motion_numbers(at));
                    shapes.extend(simulation.shape().iter().flat_map(|[_, x, y, theta]| [*x, *y, *theta]));
                    !stop.load(Ordering::Relaxed)
                })
            },
        )?;
        let verdict = match outcome {
            Ok(()) => None,
            Err(MotionError::Ended(verdict)) => Some((verdict.kind.name(), verdict.time, verdict.s, verdict.message())),
            Err(error) => return Err(motion_error(py, error)),
        };
        Ok((given(py, rows), given(py, shapes), verdict))
    }

    /// Places of the nodes along the arm, m, and half the width of the arm without loads there.
    fn nodes<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 2] {
        let places: Vec<f64> = self.simulation.shape().iter().map(|at| at[0]).collect();
        let widths = places.iter().map(|s| self.arm.radius.at(*s, self.arm.length).value).collect();
        [given(py, places), given(py, widths)]
    }

    /// x, y and theta at the nodes at the present time.
    fn shape<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 3] {
        let shape = self.simulation.shape();
        [1, 2, 3].map(|k| given(py, shape.iter().map(|at| at[k]).collect()))
    }

    #[getter]
    fn error_estimate(&self) -> f64 {
        self.simulation.error_estimate()
    }

    #[getter]
    fn statistics(&self) -> [(&'static str, usize); 5] {
        let s = self.simulation.statistics();
        [
            ("steps", s.steps),
            ("rejected", s.rejected),
            ("solves", s.solves),
            ("rounds", s.rounds),
            ("elements", s.elements),
        ]
    }
}

/// Kind, time, place and message of what ended a motion.
type Verdict = (&'static str, f64, Option<f64>, String);

fn courses(all: &[Given<'_>]) -> PyResult<Inputs> {
    let mut inputs = Inputs::default();
    for (key, times, values, smooth) in all {
        let times = finite(key, times, true)?;
        let values = finite(key, values, true)?;
        let points = times.iter().copied().zip(values);
        let course = if *smooth {
            let points: Vec<[f64; 2]> = points.map(|(t, v)| [t, v]).collect();
            Course::Smooth(hydrostat::profile::Table::new(&points).map_err(|error| wrong(format!("{key}: {error}")))?)
        } else {
            Course::Table(points.collect())
        };
        inputs.set(key, course).map_err(|error| wrong(format!("inputs: {error}")))?;
    }
    Ok(inputs)
}

/// The figures of a motion: shapes at equal times, and what changes over time.
#[pyfunction]
pub(crate) fn motion_figures(
    times: PyReadonlyArray1<'_, f64>,
    shapes: PyReadonlyArray1<'_, f64>,
    energies: (PyReadonlyArray1<'_, f64>, PyReadonlyArray1<'_, f64>),
    count: usize,
    title: &str,
) -> PyResult<(Figure, Figure)> {
    let (times, shapes) = (times.as_array(), shapes.as_array().to_vec());
    let nodes = shapes.len() / (2 * times.len().max(1));
    if nodes == 0 || shapes.len() != 2 * nodes * times.len() {
        return Err(wrong("motion: expected x and y of the same nodes at each time"));
    }
    let frames: Vec<MotionFrame> = shapes
        .chunks(2 * nodes)
        .enumerate()
        .map(|(k, shape)| MotionFrame {
            time: times[k],
            centreline: shape.chunks(2).map(|p| [p[0], p[1]]).collect(),
            kinetic_energy: energies.0.as_array()[k],
            strain_energy: energies.1.as_array()[k],
        })
        .collect();
    let page = Page::default();
    let strobe = hydrostat_figures::strobe_figure(&frames, count, title, &page);
    Ok((Figure::new(strobe), Figure::new(hydrostat_figures::motion_figure(&frames, title, &page))))
}

/// What a solve after snaps ends with.
pub(crate) fn after_snap_error(py: Python<'_>, error: AfterSnapError, options: Options) -> PyErr {
    match error {
        AfterSnapError::Solve(error) => solve_error(py, error, options),
        AfterSnapError::Motion { motion: MotionError::Unsupported { .. }, .. } => wrong(error),
        error => not_at_rest(py, &error.to_string()),
    }
}

/// `hydrostat.MotionError` of a motion after a snap.
fn not_at_rest(py: Python<'_>, words: &str) -> PyErr {
    static ENDED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    crate::wrong::made(py, &ENDED, "MotionError", (words, "no_rest", f64::NAN, None::<f64>))
}

/// Equilibria along a sequence of loads.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct History {
    arm: hydrostat::Arm,
    loads: LoadRows,
    rows: Vec<LoadingRow>,
    tol: f64,
}

/// Index of its row, the loads, share, tips before and after, distance, angle, duration, and, where the curve leads on,
/// whether the motion lands elsewhere.
type RowSnapFields = (usize, Vec<f64>, f64, TipFields, TipFields, f64, f64, f64, Option<bool>);

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
    let (found, failure) = interruptible(
        py,
        |_| Ok(()),
        |stop| {
            let mut rows: Vec<LoadingRow> = Vec::new();
            let values = |k: usize| loads.rows[k].1.clone();
            let (mut loading, first) = match Loading::start(&arms[0], tol) {
                Ok(started) => started,
                Err(error) => return (rows, Some((0, error))),
            };
            let step = LoadingStep { configuration: first.configuration, snaps: Vec::new() };
            rows.push(LoadingRow::new(None, values(0), step));
            for (k, arm) in arms.iter().enumerate().skip(1) {
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                match loading.go_to(arm) {
                    Ok(step) => rows.push(LoadingRow::new(Some(&values(k - 1)), values(k), step)),
                    Err(error) => return (rows, Some((k, error))),
                }
            }
            (rows, None)
        },
    )?;
    let error = failure.map(|(row, error)| loading_error(py, row, error, tol));
    Ok((History { arm: arm.given.clone(), loads, rows: found, tol }, error))
}

fn loading_error(py: Python<'_>, row: usize, error: LoadingError, tol: f64) -> PyErr {
    match error {
        LoadingError::Start(error) => after_snap_error(py, error, Options::with_tol(tol)),
        error @ (LoadingError::Arm(_)
        | LoadingError::Unsupported { .. }
        | LoadingError::Motion { motion: MotionError::Unsupported { .. }, .. }) => wrong(format!("row {row}: {error}")),
        error => not_at_rest(py, &format!("row {row}: {error}")),
    }
}

#[pymethods]
impl History {
    fn __len__(&self) -> usize {
        self.rows.len()
    }

    #[getter]
    fn keys(&self) -> Vec<String> {
        self.loads.keys.clone()
    }

    /// The loads of all rows at a key.
    fn loads<'py>(&self, py: Python<'py>, column: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if column >= self.loads.keys.len() {
            return Err(PyIndexError::new_err("column: the history has no such column"));
        }
        Ok(given(py, self.rows.iter().map(|row| row.loads[column]).collect()))
    }

    fn solution(&self, row: usize) -> PyResult<Solution> {
        let row = self.rows.get(row).ok_or_else(|| PyIndexError::new_err("row: the history has no such row"))?;
        Ok(Solution::new(row.step.configuration.clone(), Options::with_tol(self.tol)))
    }

    #[getter]
    fn snaps(&self) -> Vec<RowSnapFields> {
        let one = |(k, row): (usize, &LoadingRow)| -> Vec<RowSnapFields> {
            let fields = |snap: &hydrostat_files::RowSnap| {
                let own = snap.snap;
                let elsewhere = own.on_curve.map(|_| own.lands_elsewhere(self.arm.length));
                let (before, after) = (tip(own.before), tip(own.after));
                let sizes = (own.distance(), own.angle());
                (k, snap.loads.clone(), own.share, before, after, sizes.0, sizes.1, own.duration, elsewhere)
            };
            row.snaps.iter().map(fields).collect()
        };
        self.rows.iter().enumerate().flat_map(one).collect()
    }

    fn figure(&self, column: usize, asked: &str, title: &str) -> PyResult<Figure> {
        let Some(key) = self.loads.keys.get(column) else {
            return Err(PyIndexError::new_err("column: the history has no such column"));
        };
        let points: Vec<LoadingPoint<'_>> = self
            .rows
            .iter()
            .map(|row| LoadingPoint {
                value: row.loads[column],
                configuration: &row.step.configuration,
                snaps: row.snaps.iter().map(|snap| (snap.loads[column], snap.snap)).collect(),
            })
            .collect();
        let axis: Axis = (key.clone(), self.loads.unit(column).to_owned(), 1.0);
        let page = Page::default();
        let scene = hydrostat_figures::loading_figure(&points, &abscissa(axis), quantity(asked)?, title, &page);
        Ok(Figure::new(scene))
    }

    fn to_json(&self) -> String {
        LoadingDocument::new(&self.arm, &self.loads, &self.rows, None).to_json()
    }

    fn to_csv(&self) -> String {
        loading_csv(&self.loads, &self.rows)
    }
}
