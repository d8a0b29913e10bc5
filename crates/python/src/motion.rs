//! Arms in motion.

use std::sync::atomic::{AtomicBool, Ordering};

use hydrostat::{
    AfterSnapError, Course, Inputs, Instant, MotionError, MotionOptions, Options, SpatialInstant, SpatialSimulation,
};
use hydrostat_figures::{MotionFrame, Page, motion_figure, spatial_strobe_figure, strobe_figure};
use hydrostat_files::{motion_columns, motion_numbers, spatial_motion_heads, spatial_motion_numbers};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;

use crate::arm_class::Arm;
use crate::arrays::{finite, given};
use crate::errors::{motion_error, wrong};
use crate::figure::Figure;
use crate::interrupt::interruptible;

/// A key with its times and values, and whether a smooth line joins them.
type Given<'py> = (String, PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>, bool);

/// A motion of one kind, as Python has it.
trait Rowed {
    type At;

    /// Numbers at a node in [`Simulation::fields`].
    const WIDTH: usize;

    fn columns(cables: usize) -> Vec<String>;
    fn numbers(at: &Self::At) -> Vec<f64>;
    /// The numbers of all nodes, node by node, and the places of these, m.
    fn at_nodes(&self) -> Vec<(f64, Vec<f64>)>;
}

impl Rowed for hydrostat::Simulation {
    type At = Instant;

    const WIDTH: usize = 3;

    fn columns(cables: usize) -> Vec<String> {
        motion_columns(cables)
    }

    fn numbers(at: &Instant) -> Vec<f64> {
        motion_numbers(at)
    }

    fn at_nodes(&self) -> Vec<(f64, Vec<f64>)> {
        self.shape().iter().map(|[s, own @ ..]| (*s, own.to_vec())).collect()
    }
}

impl Rowed for SpatialSimulation {
    type At = SpatialInstant;

    const WIDTH: usize = 12;

    fn columns(cables: usize) -> Vec<String> {
        spatial_motion_heads(cables, 0, false)
    }

    fn numbers(at: &SpatialInstant) -> Vec<f64> {
        spatial_motion_numbers(at)
    }

    fn at_nodes(&self) -> Vec<(f64, Vec<f64>)> {
        let of = |[s, ..]: &[f64; 4]| {
            let at = self.station(*s);
            (*s, [at.place, at.a, at.b, at.c].concat())
        };
        self.shape().iter().map(of).collect()
    }
}

#[derive(Clone)]
enum Motion {
    Plane(Box<hydrostat::Simulation>),
    Space(Box<SpatialSimulation>),
}

/// The same of either kind of motion.
macro_rules! of {
    ($motion:expr, $own:ident => $what:expr) => {
        match $motion {
            Motion::Plane($own) => $what,
            Motion::Space($own) => $what,
        }
    };
}

fn numbers_of<M: Rowed>(_: &M, at: &M::At) -> Vec<f64> {
    M::numbers(at)
}

fn columns_of<M: Rowed>(_: &M, cables: usize) -> Vec<String> {
    M::columns(cables)
}

fn width_of<M: Rowed>(_: &M) -> usize {
    M::WIDTH
}

/// Takes rows, and the numbers at the nodes, for as long as nobody wants it to stop.
fn taken<'a, M: Rowed>(
    rows: &'a mut Vec<f64>,
    shapes: &'a mut Vec<f64>,
    stop: &'a AtomicBool,
) -> impl FnMut(&M::At, &M) -> bool + 'a {
    |at, simulation| {
        rows.extend(M::numbers(at));
        shapes.extend(simulation.at_nodes().into_iter().flat_map(|(_, own)| own));
        !stop.load(Ordering::Relaxed)
    }
}

/// An arm in motion, in the plane or in space.
#[pyclass(module = "hydrostat._native")]
pub(crate) struct Simulation {
    motion: Motion,
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
        let made = py.detach(|| {
            if arm.given.space.is_some() {
                SpatialSimulation::new(&arm.given, inputs, options).map(|own| Motion::Space(Box::new(own)))
            } else {
                hydrostat::Simulation::new(&arm.given, inputs, options).map(|own| Motion::Plane(Box::new(own)))
            }
        });
        let motion = made.map_err(|error| motion_error(py, error))?;
        Ok(Self { motion, arm: arm.given.clone() })
    }

    /// A motion of its own that goes on from here.
    fn copy(&self) -> Self {
        Self { motion: self.motion.clone(), arm: self.arm.clone() }
    }

    /// The names of the numbers of a row.
    #[getter]
    fn columns(&self) -> Vec<String> {
        of!(&self.motion, own => columns_of(&**own, self.arm.cables.len()))
    }

    #[getter]
    fn time(&self) -> f64 {
        of!(&self.motion, own => own.time())
    }

    /// The row of the present time.
    fn now(&mut self) -> Vec<f64> {
        of!(&mut self.motion, own => {
            let at = own.now();
            numbers_of(&**own, &at)
        })
    }

    /// Moves on by so many seconds, while loads change to these values.
    fn step(&mut self, py: Python<'_>, dt: f64, loads: Vec<(String, f64)>) -> PyResult<Vec<f64>> {
        let motion = &mut self.motion;
        let loads: Vec<(&str, f64)> = loads.iter().map(|(key, value)| (key.as_str(), *value)).collect();
        let row = py.detach(|| of!(motion, own => own.step_to(dt, &loads).map(|at| numbers_of(&**own, &at))));
        let row = row.map_err(|error| motion_error(py, error))?;
        py.check_signals()?;
        Ok(row)
    }

    /// All rows up to a time, one after the other, what `shape` has at them, and why it ended early: kind, time, place,
    /// and message.
    #[allow(clippy::type_complexity, reason = "a row of plain values")]
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        until: f64,
        every: f64,
    ) -> PyResult<(Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Option<Verdict>)> {
        let motion = &mut self.motion;
        let (mut rows, mut shapes) = (Vec::new(), Vec::new());
        let outcome = interruptible(
            py,
            |_| Ok(()),
            |stop| of!(motion, own => own.run(until, every, taken(&mut rows, &mut shapes, stop))),
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
        let places: Vec<f64> = of!(&self.motion, own => own.at_nodes()).into_iter().map(|(s, _)| s).collect();
        let widths = places.iter().map(|s| self.arm.radius.at(*s, self.arm.length).value).collect();
        [given(py, places), given(py, widths)]
    }

    /// How many numbers there are at a node: x, y and theta in the plane; x, y, z, a, b and c in space.
    #[getter]
    fn width(&self) -> usize {
        of!(&self.motion, own => width_of(&**own))
    }

    /// The numbers at the nodes at the present time, node by node.
    fn shape<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let nodes = of!(&self.motion, own => own.at_nodes());
        given(py, nodes.into_iter().flat_map(|(_, own)| own).collect())
    }

    #[getter]
    fn error_estimate(&self) -> f64 {
        of!(&self.motion, own => own.error_estimate())
    }

    #[getter]
    fn statistics(&self) -> [(&'static str, usize); 5] {
        let s = of!(&self.motion, own => own.statistics());
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

/// The figures of a motion: shapes at equal times, and what changes over time; `dimensions` are those of a place.
#[pyfunction]
pub(crate) fn motion_figures(
    times: PyReadonlyArray1<'_, f64>,
    shapes: PyReadonlyArray1<'_, f64>,
    energies: (PyReadonlyArray1<'_, f64>, PyReadonlyArray1<'_, f64>),
    dimensions: usize,
    count: usize,
    title: &str,
) -> PyResult<(Figure, Figure)> {
    let given = Frames { times: &times, shapes: &shapes, energies: &energies };
    let page = Page::default();
    let (strobe, over_time) = if dimensions == 3 {
        let frames = given.read::<3>()?;
        (spatial_strobe_figure(&frames, count, title, &page), motion_figure(&frames, title, &page))
    } else {
        let frames = given.read::<2>()?;
        (strobe_figure(&frames, count, title, &page), motion_figure(&frames, title, &page))
    };
    Ok((Figure::new(strobe), Figure::new(over_time)))
}

/// Arrays of a motion.
struct Frames<'a, 'py> {
    times: &'a PyReadonlyArray1<'py, f64>,
    shapes: &'a PyReadonlyArray1<'py, f64>,
    energies: &'a (PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>),
}

impl Frames<'_, '_> {
    fn read<const D: usize>(&self) -> PyResult<Vec<MotionFrame<D>>> {
        let (times, shapes) = (self.times.as_array(), self.shapes.as_array().to_vec());
        let nodes = shapes.len() / (D * times.len().max(1));
        if nodes == 0 || shapes.len() != D * nodes * times.len() {
            return Err(wrong("motion: expected places of the same nodes at each time"));
        }
        let frame = |(k, shape): (usize, &[f64])| MotionFrame {
            time: times[k],
            centreline: shape.chunks(D).map(|p| std::array::from_fn(|axis| p[axis])).collect(),
            kinetic_energy: self.energies.0.as_array()[k],
            strain_energy: self.energies.1.as_array()[k],
        };
        Ok(shapes.chunks(D * nodes).enumerate().map(frame).collect())
    }
}

/// What a solve after snaps ends with; `solve_error` makes an exception of what the statics say.
pub(crate) fn after_snap_error<E>(
    py: Python<'_>,
    error: AfterSnapError<E>,
    options: Options,
    solve_error: impl FnOnce(Python<'_>, E, Options) -> PyErr,
) -> PyErr
where
    AfterSnapError<E>: std::fmt::Display,
{
    match error {
        AfterSnapError::Solve(error) => solve_error(py, error, options),
        AfterSnapError::Motion { motion: MotionError::Unsupported { .. }, .. } => wrong(error),
        error => not_at_rest(py, &error.to_string()),
    }
}

/// `hydrostat.MotionError` of a motion after a snap.
pub(crate) fn not_at_rest(py: Python<'_>, words: &str) -> PyErr {
    static ENDED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    crate::wrong::made(py, &ENDED, "MotionError", (words, "no_rest", f64::NAN, None::<f64>))
}
