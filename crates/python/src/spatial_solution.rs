//! Configurations of arms in space and their stations.

use hydrostat::{
    AfterSnap, Options, SpatialConfiguration, SpatialSnap, SpatialSnapMotion, SpatialStations, SpatialTip,
    SpatialWrench,
};
use hydrostat_files::{Note, SpatialSolutionDocument, spatial_stations_csv};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::exceptions::{PyIndexError, PyKeyError};
use pyo3::prelude::*;

use crate::arm_class::Arm;
use crate::arrays::{given, given_points, shared, shared_points};
use crate::figure::Figure;
use crate::solution::{CableFields, cable_fields, each, places, statistics, words};
use crate::wrong::wrong;

/// A point, or a direction.
type Point = [f64; 3];

/// x, y, z, the directors a, b, c, and alpha.
pub(crate) type TipFields = (f64, f64, f64, Point, Point, Point, f64);

/// Phase, load fraction, the tip before and after, distance and angle; where its motion was followed, the duration, and
/// whether the motion lands elsewhere than the curve leads on to.
pub(crate) type SnapFields = (&'static str, f64, TipFields, TipFields, f64, f64, Option<f64>, Option<bool>);

/// A configuration in space and the options that it was asked for with.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct SpatialSolution {
    configuration: SpatialConfiguration,
    options: Options,
    /// Those of the snaps that were followed.
    motions: Vec<SpatialSnapMotion>,
}

/// Stations along an arm in space.
#[pyclass(frozen, module = "hydrostat._native", name = "SpatialStations")]
pub(crate) struct Stations {
    stations: SpatialStations,
}

#[pymethods]
impl Stations {
    /// A field of numbers, on the memory of this object.
    fn field<'py>(slf: Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let stations = &slf.get().stations;
        Ok(shared(slf.clone().into_any(), numbers(stations, name)?))
    }

    /// A field of directors, on the memory of this object.
    fn directors<'py>(slf: Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let stations = &slf.get().stations;
        Ok(shared_points(slf.clone().into_any(), directors(stations, name)?))
    }
}

pub(crate) fn tip(tip: SpatialTip) -> TipFields {
    let SpatialTip { x, y, z, a, b, c, alpha } = tip;
    (x, y, z, a, b, c, alpha)
}

/// What Python's `Snap` is made of.
pub(crate) fn snaps(all: &[SpatialSnap]) -> Vec<SnapFields> {
    all.iter().map(|snap| snap_fields(snap, None, None)).collect()
}

fn snap_fields(s: &SpatialSnap, duration: Option<f64>, elsewhere: Option<bool>) -> SnapFields {
    let (before, after) = (tip(s.before), tip(s.after));
    (s.phase.name(), s.load_fraction, before, after, s.distance(), s.angle(), duration, elsewhere)
}

fn wrench(wrench: SpatialWrench) -> (Point, Point) {
    (wrench.force, wrench.moment)
}

impl SpatialSolution {
    pub(crate) fn new(configuration: SpatialConfiguration, options: Options) -> Self {
        Self { configuration, options, motions: Vec::new() }
    }

    /// A shape after snaps whose motions were followed.
    pub(crate) fn after_snap(found: AfterSnap<SpatialConfiguration, SpatialTip>, options: Options) -> Self {
        Self { configuration: found.configuration, options, motions: found.snaps }
    }
}

#[pymethods]
impl SpatialSolution {
    /// A field of numbers of the stations, on the memory of this object.
    fn field<'py>(slf: Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let stations = &slf.get().configuration.stations;
        Ok(shared(slf.clone().into_any(), numbers(stations, name)?))
    }

    /// A field of directors of the stations, on the memory of this object.
    fn directors<'py>(slf: Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let stations = &slf.get().configuration.stations;
        Ok(shared_points(slf.clone().into_any(), directors(stations, name)?))
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
        let fields = |motion: &SpatialSnapMotion| {
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

    #[getter]
    fn tip(&self) -> TipFields {
        tip(self.configuration.tip())
    }

    #[getter]
    fn cables(&self) -> Vec<CableFields<'_>> {
        cable_fields(&self.configuration.cables)
    }

    #[getter]
    fn base_reaction(&self) -> (Point, Point) {
        wrench(self.configuration.base_reaction)
    }

    #[getter]
    fn unmet(&self) -> Option<(Point, Point)> {
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
        let notes = Note::all_in_space(&self.configuration, self.options.tol);
        notes.into_iter().map(|note| (note.kind, note.message)).collect()
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
        let places = places(self.configuration.arm.length, &s)?;
        let mut stations = SpatialStations::default();
        for station in each(py, &places, |s| self.configuration.at(s))? {
            stations.push(&station);
        }
        Ok(Stations { stations })
    }

    /// So many equally spaced stations.
    fn resampled(&self, py: Python<'_>, count: usize) -> PyResult<Stations> {
        if count < 2 {
            return Err(wrong(format!("count: expected at least 2, found {count}")));
        }
        Ok(Stations { stations: py.detach(|| self.configuration.resampled(count)) })
    }

    /// Places on the surface: `sides` of them round each section, section by section.
    fn surface<'py>(
        &self,
        py: Python<'py>,
        s: PyReadonlyArray1<'py, f64>,
        sides: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let arm = &self.configuration.arm;
        let ring = |s: f64| -> Vec<Point> {
            let st = self.configuration.at(s);
            let radius = st.beta * arm.radius.at(st.s, arm.length).value;
            let corner = |k: usize| {
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
                [0, 1, 2].map(|i| [st.x, st.y, st.z][i] + radius * (cos * st.b[i] + sin * st.c[i]))
            };
            (0..sides).map(corner).collect()
        };
        let rings = each(py, &places(arm.length, &s)?, ring)?;
        Ok(given_points(py, &rings.concat()))
    }

    /// The path of a cable, NaN past its anchor.
    fn cable_path<'py>(
        &self,
        py: Python<'py>,
        cable: usize,
        s: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 3]> {
        let cables = self.configuration.arm.cables.len();
        if cable >= cables {
            return Err(PyIndexError::new_err(format!("cable: the arm has {cables} cables, counted from 0")));
        }
        let point = |s: f64| self.configuration.cable_point(cable, s).unwrap_or([f64::NAN; 3]);
        let points: Vec<Point> = each(py, &places(self.configuration.arm.length, &s)?, point)?;
        Ok([0, 1, 2].map(|k| given(py, points.iter().map(|p| p[k]).collect())))
    }

    /// The document of `hydrostat solve --format json`.
    fn to_json(&self) -> String {
        let notes = Note::all_in_space(&self.configuration, self.options.tol);
        let document = SpatialSolutionDocument::new(&self.configuration, &notes);
        if self.motions.is_empty() {
            return document.to_json();
        }
        document.with_motions(&self.motions, self.configuration.arm.length).to_json()
    }

    /// The stations as CSV.
    fn to_csv(&self) -> String {
        spatial_stations_csv(&self.configuration.stations)
    }

    /// Three views of the arm, and a perspective.
    fn figure(&self, note: Option<&str>) -> Figure {
        let page = hydrostat_figures::Page::default();
        Figure::new(hydrostat_figures::spatial_arm_figure(&self.configuration, note, &page))
    }
}

fn numbers<'a>(stations: &'a SpatialStations, name: &str) -> PyResult<&'a [f64]> {
    Ok(match name {
        "s" => &stations.s,
        "x" => &stations.x,
        "y" => &stations.y,
        "z" => &stations.z,
        "nu" => &stations.nu,
        "eta" => &stations.eta,
        "zeta" => &stations.zeta,
        "tau" => &stations.tau,
        "kappa" => &stations.kappa,
        "mu" => &stations.mu,
        "beta" => &stations.beta,
        "alpha" => &stations.alpha,
        "n_a" => &stations.n_a,
        "n_b" => &stations.n_b,
        "n_c" => &stations.n_c,
        "m_a" => &stations.m_a,
        "m_b" => &stations.m_b,
        "m_c" => &stations.m_c,
        _ => return Err(PyKeyError::new_err(name.to_owned())),
    })
}

fn directors<'a>(stations: &'a SpatialStations, name: &str) -> PyResult<&'a [Point]> {
    Ok(match name {
        "a" => &stations.a,
        "b" => &stations.b,
        "c" => &stations.c,
        _ => return Err(PyKeyError::new_err(name.to_owned())),
    })
}
