//! Configurations and their stations.

use std::sync::atomic::{AtomicBool, Ordering};

use hydrostat::{AfterSnap, Configuration, Options, Snap, SnapBounds, SnapMotion, Stability, Statistics, Tip, Wrench};
use hydrostat_files::{Dimension, Note, stations_csv};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arm_class::Arm;
use crate::arrays::{field, given, shared};
use crate::figure::Figure;
use crate::interrupt::interruptible;
use crate::wrong::wrong;

/// From so many places on Ctrl-C is listened for.
const MANY: usize = 10_000;

/// A point, or NaN where there is none.
type Point = [f64; 2];

/// A configuration and the options that it was asked for with.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Solution {
    pub(crate) configuration: Configuration,
    options: Options,
    /// Those after its snaps, where they were followed.
    motions: Vec<SnapMotion>,
}

/// Stations along an arm.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Stations {
    stations: hydrostat::Stations,
}

#[pymethods]
impl Stations {
    /// One of the twelve fields, on the memory of this object.
    fn field<'py>(slf: Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let stations = &slf.get().stations;
        Ok(shared(slf.clone().into_any(), field(stations, name)?))
    }
}

/// The state and the count of unstable directions of a stability.
pub(crate) fn words(stability: Option<Stability>) -> (Option<&'static str>, Option<usize>) {
    (stability.map(Stability::name), stability.and_then(Stability::directions))
}

fn wrench(wrench: Wrench) -> (Point, f64) {
    (wrench.force, wrench.moment)
}

/// Name, tension, length, stroke, and where it was commanded that stroke, the length it leaves and whether the cable is slack.
pub(crate) type CableFields<'a> = (&'a str, f64, f64, f64, Option<(f64, f64, bool)>);

pub(crate) fn cable_fields(cables: &[hydrostat::CableState]) -> Vec<CableFields<'_>> {
    let command = |c: &hydrostat::CableState| c.command.map(|c| (c.stroke, c.length, c.slack));
    cables.iter().map(|c| (c.name.as_str(), c.tension, c.length, c.stroke, command(c))).collect()
}

/// What a solve took, by name.
pub(crate) fn statistics(s: &Statistics) -> [(&'static str, usize); 6] {
    [
        ("elements", s.elements),
        ("stages", s.stages),
        ("newton_rounds", s.newton_rounds),
        ("meshes", s.meshes),
        ("load_steps", s.load_steps),
        ("evaluations", s.evaluations),
    ]
}

/// Places (m) on an arm of this length.
pub(crate) fn places(length: f64, s: &PyReadonlyArray1<'_, f64>) -> PyResult<Vec<f64>> {
    let places: Vec<f64> = s.as_array().iter().copied().collect();
    match places.iter().find(|s| !(**s >= 0.0 && **s <= length)) {
        None => Ok(places),
        Some(outside) => Err(wrong(format!("s: expected places in [0, {length}] m, found {outside}"))),
    }
}

/// x, y, theta and alpha.
pub(crate) type TipFields = (f64, f64, f64, f64);

/// Phase, load fraction, the tip before and after, distance and angle; where its motion was followed, the duration, and,
/// where the curve leads on, whether the motion lands elsewhere.
pub(crate) type SnapFields = (&'static str, f64, TipFields, TipFields, f64, f64, Option<f64>, Option<bool>);

/// What Python's `Snap` is made of.
pub(crate) fn snaps(all: &[Snap]) -> Vec<SnapFields> {
    all.iter().map(|snap| snap_fields(snap, None, None)).collect()
}

fn snap_fields(s: &Snap, duration: Option<f64>, elsewhere: Option<bool>) -> SnapFields {
    let (before, after) = (tip(s.before), tip(s.after));
    (s.phase.name(), s.load_fraction, before, after, s.distance(), s.angle(), duration, elsewhere)
}

pub(crate) fn tip(Tip { x, y, theta, alpha }: Tip) -> TipFields {
    (x, y, theta, alpha)
}

/// Options of a solve: its tolerance, and how far the tip may jump (over the length) and turn (rad) at a snap.
pub(crate) fn options(tol: f64, (distance, angle): (f64, f64)) -> Options {
    Options { snaps: SnapBounds { distance, angle }, ..Options::with_tol(tol) }
}

/// An angle of a string, in rad; a bare number is in degrees.
#[pyfunction]
pub(crate) fn angle(text: &str) -> PyResult<f64> {
    Dimension::Angle.read(text).map(|(value, _)| value).map_err(wrong)
}

impl Solution {
    pub(crate) fn new(configuration: Configuration, options: Options) -> Self {
        Self { configuration, options, motions: Vec::new() }
    }

    /// A shape after snaps whose motions were followed.
    pub(crate) fn after_snap(found: AfterSnap, options: Options) -> Self {
        Self { configuration: found.configuration, options, motions: found.snaps }
    }
}

#[pymethods]
impl Solution {
    /// One of the twelve fields of the stations, on the memory of this object.
    fn field<'py>(slf: Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let stations = &slf.get().configuration.stations;
        Ok(shared(slf.clone().into_any(), field(stations, name)?))
    }

    /// The tolerance that was asked for.
    #[getter]
    fn tol(&self) -> f64 {
        self.options.tol
    }

    /// How far the tip was allowed to jump (over the length) and turn (rad) at a snap.
    #[getter]
    fn bounds(&self) -> (f64, f64) {
        (self.options.snaps.distance, self.options.snaps.angle)
    }

    #[getter]
    fn snaps(&self) -> Vec<SnapFields> {
        if self.motions.is_empty() {
            return snaps(&self.configuration.snaps);
        }
        let length = self.configuration.arm.length;
        let fields = |motion: &SnapMotion| {
            let elsewhere = motion.on_curve.map(|_| motion.lands_elsewhere(length));
            snap_fields(&motion.snap, Some(motion.duration), elsewhere)
        };
        self.motions.iter().map(fields).collect()
    }

    /// The arm with the loads that are balanced.
    #[getter]
    fn arm(&self, py: Python<'_>) -> PyResult<Arm> {
        Arm::of(py, &self.configuration.arm)
    }

    /// x, y, theta and alpha at the tip.
    #[getter]
    fn tip(&self) -> TipFields {
        tip(self.configuration.tip())
    }

    #[getter]
    fn cables(&self) -> Vec<CableFields<'_>> {
        cable_fields(&self.configuration.cables)
    }

    #[getter]
    fn base_reaction(&self) -> (Point, f64) {
        wrench(self.configuration.base_reaction)
    }

    #[getter]
    fn unmet(&self) -> Option<(Point, f64)> {
        self.configuration.unmet.map(wrench)
    }

    #[getter]
    fn error_estimate(&self) -> f64 {
        self.configuration.error_estimate
    }

    #[getter]
    fn strain_energy(&self) -> f64 {
        self.configuration.strain_energy()
    }

    /// The fold margin and where it is.
    #[getter]
    fn fold_margin(&self) -> (f64, f64) {
        let fold = self.configuration.fold_margin();
        (fold.value, fold.s)
    }

    /// Kind and message of each note on the answer.
    fn warnings(&self) -> Vec<(&'static str, String)> {
        Note::all(&self.configuration, self.options.tol).into_iter().map(|note| (note.kind, note.message)).collect()
    }

    /// State, count of unstable directions, and what the solve knows without looking further.
    fn stability(&self, py: Python<'_>) -> (Option<&'static str>, Option<usize>, Option<bool>) {
        let (state, directions) = words(py.detach(|| self.configuration.stability()));
        (state, directions, self.configuration.stable)
    }

    /// Real and imaginary parts of the rates.
    fn growth(&self, py: Python<'_>) -> Option<Vec<[f64; 2]>> {
        py.detach(|| self.configuration.growth()).map(|growth| growth.rates)
    }

    #[getter]
    fn statistics(&self) -> [(&'static str, usize); 6] {
        statistics(&self.configuration.statistics)
    }

    /// Stations at these places.
    fn at(&self, py: Python<'_>, s: PyReadonlyArray1<'_, f64>) -> PyResult<Stations> {
        self.stations(py, &self.places(&s)?)
    }

    /// So many equally spaced stations.
    fn resampled(&self, py: Python<'_>, count: usize) -> PyResult<Stations> {
        if count < 2 {
            return Err(wrong(format!("count: expected at least 2, found {count}")));
        }
        let length = self.configuration.arm.length;
        let places: Vec<f64> = (0..count).map(|k| length * k as f64 / (count - 1) as f64).collect();
        self.stations(py, &places)
    }

    /// The surface on the left and on the right: x and y of both, one after the other.
    fn surfaces<'py>(
        &self,
        py: Python<'py>,
        s: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 4]> {
        let places = self.places(&s)?;
        let points: Vec<[Point; 2]> = each(py, &places, |s| self.configuration.surfaces(s))?;
        let column = |side: usize, k: usize| given(py, points.iter().map(|p| p[side][k]).collect());
        Ok([column(0, 0), column(0, 1), column(1, 0), column(1, 1)])
    }

    /// The path of a cable, NaN past its anchor.
    fn cable_path<'py>(
        &self,
        py: Python<'py>,
        cable: usize,
        s: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 2]> {
        let cables = self.configuration.arm.cables.len();
        if cable >= cables {
            return Err(PyIndexError::new_err(format!("cable: the arm has {cables} cables, counted from 0")));
        }
        let point = |s: f64| self.configuration.cable_point(cable, s).unwrap_or([f64::NAN; 2]);
        let points: Vec<Point> = each(py, &self.places(&s)?, point)?;
        Ok([0, 1].map(|k| given(py, points.iter().map(|p| p[k]).collect())))
    }

    /// Speed of the water along the arm at a place and a distance from its windward surface, (7).
    fn layer_speed(&self, s: f64, y: f64) -> f64 {
        self.configuration.layer_speed(s, y)
    }

    /// The document of `hydrostat solve --format json`.
    fn to_json(&self) -> String {
        let notes = Note::all(&self.configuration, self.options.tol);
        let margin = self.configuration.fold_margin().value;
        let document = hydrostat_files::SolutionDocument::new(&self.configuration, margin, &notes);
        if self.motions.is_empty() {
            return document.to_json();
        }
        document.with_motions(&self.motions, self.configuration.arm.length).to_json()
    }

    /// The stations as CSV.
    fn to_csv(&self) -> String {
        stations_csv(&self.configuration.stations)
    }

    /// The arm to scale.
    fn figure(&self, note: Option<&str>) -> Figure {
        Figure::new(hydrostat_figures::arm_figure(&self.configuration, note, &hydrostat_figures::Page::default()))
    }
}

/// What is at each of many places, without the interpreter; Ctrl-C ends it.
pub(crate) fn each<T: Send>(py: Python<'_>, places: &[f64], of: impl Fn(f64) -> T + Sync + Send) -> PyResult<Vec<T>> {
    if places.len() < MANY {
        return Ok(py.detach(|| places.iter().map(|s| of(*s)).collect()));
    }
    let work =
        |stop: &AtomicBool| places.iter().take_while(|_| !stop.load(Ordering::Relaxed)).map(|s| of(*s)).collect();
    interruptible(py, |_| Ok(()), work)
}

impl Solution {
    fn stations(&self, py: Python<'_>, places: &[f64]) -> PyResult<Stations> {
        let mut out = hydrostat::Stations::default();
        for at in each(py, places, |s| self.configuration.at(s))? {
            let fields = [
                (&mut out.s, at.s),
                (&mut out.x, at.x),
                (&mut out.y, at.y),
                (&mut out.theta, at.theta),
                (&mut out.nu, at.nu),
                (&mut out.eta, at.eta),
                (&mut out.mu, at.mu),
                (&mut out.beta, at.beta),
                (&mut out.alpha, at.alpha),
                (&mut out.n_a, at.n_a),
                (&mut out.n_b, at.n_b),
                (&mut out.m, at.m),
            ];
            for (field, value) in fields {
                field.push(value);
            }
        }
        Ok(Stations { stations: out })
    }

    /// Places along the arm.
    fn places(&self, s: &PyReadonlyArray1<'_, f64>) -> PyResult<Vec<f64>> {
        places(self.configuration.arm.length, s)
    }
}
