//! Paths over a parameter, and all equilibria under the same loads.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use hydrostat::{Configuration, Options, PathOptions, SpatialConfiguration, Stability};
use hydrostat_figures::Page;
use hydrostat_files::{
    EquilibriaDocument, PathDocument, Search, Varied, end_message, equilibria_csv, path_csv, spatial_path_csv,
};
use numpy::PyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::{path_error, spatial_path_error, wrong};
use crate::figure::{Axis, Figure, abscissa, quantity};
use crate::interrupt::interruptible;
use crate::solution::{Solution, words};
use crate::spatial_solution::SpatialSolution;

/// A path and what it varies, in the unit that was asked for.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Path {
    found: AnyPath,
    varied: Varied,
    tol: f64,
}

/// In the plane or in space.
enum AnyPath {
    Plane(hydrostat::Path),
    Space(hydrostat::Path<SpatialConfiguration>),
}

/// All equilibria of an arm.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Equilibria {
    all: Searched,
    arm: hydrostat::Arm,
    tol: f64,
}

/// What a search found in the plane or in space.
enum Searched {
    Plane(hydrostat::Equilibria),
    Space(hydrostat::SpatialEquilibria),
}

impl Searched {
    fn search(&self) -> Search<'_> {
        match self {
            Self::Plane(all) => all.into(),
            Self::Space(all) => all.into(),
        }
    }
}

/// A column of numbers.
type Numbers<'py> = Bound<'py, PyArray1<f64>>;

/// The name of an event, and its cable.
type Named = (&'static str, Option<usize>);

/// x, y, theta (in space z) and alpha of the tip, state and count of unstable directions, a value each.
type States<'py> = ([Numbers<'py>; 4], Vec<Option<&'static str>>, Vec<Option<usize>>);

fn states<'py>(py: Python<'py>, all: &[(&Configuration, Option<Stability>)]) -> States<'py> {
    let tips: Vec<hydrostat::Tip> = all.iter().map(|(configuration, _)| configuration.tip()).collect();
    let column = |of: fn(&hydrostat::Tip) -> f64| given(py, tips.iter().map(of).collect());
    let tip = [column(|t| t.x), column(|t| t.y), column(|t| t.theta), column(|t| t.alpha)];
    let (state, directions) = all.iter().map(|(_, stability)| words(*stability)).unzip();
    (tip, state, directions)
}

fn states_in_space<'py>(py: Python<'py>, all: &[(&SpatialConfiguration, Option<Stability>)]) -> States<'py> {
    let tips: Vec<hydrostat::SpatialTip> = all.iter().map(|(configuration, _)| configuration.tip()).collect();
    let column = |of: fn(&hydrostat::SpatialTip) -> f64| given(py, tips.iter().map(of).collect());
    let tip = [column(|t| t.x), column(|t| t.y), column(|t| t.z), column(|t| t.alpha)];
    let (state, directions) = all.iter().map(|(_, stability)| words(*stability)).unzip();
    (tip, state, directions)
}

/// Follows the equilibria of `arm` over `KEY=FROM:TO`.
#[pyfunction]
#[pyo3(signature = (arm, vary, tol, longest, most, branches))]
pub(crate) fn path(
    py: Python<'_>,
    arm: &Arm,
    vary: &str,
    tol: f64,
    longest: f64,
    most: usize,
    branches: bool,
) -> PyResult<Path> {
    let varied: Varied = vary.parse().map_err(wrong)?;
    varied.parameter.of(&arm.given).map_err(wrong)?;
    let options = PathOptions { tol, longest, most, branches };
    if arm.given.space.is_some() {
        let follow = |stop: &AtomicBool| {
            let go_on = |_: &_| !stop.load(Ordering::Relaxed);
            arm.given.path_in_space_with(varied.parameter, varied.range, &options, go_on)
        };
        let found = interruptible(py, |_| Ok(()), follow)?
            .map_err(|error| spatial_path_error(py, error, Options::with_tol(tol)))?;
        return Ok(Path { found: AnyPath::Space(found), varied, tol });
    }
    let follow = |stop: &AtomicBool| {
        arm.given.path_with(varied.parameter, varied.range, &options, |_| !stop.load(Ordering::Relaxed))
    };
    let found =
        interruptible(py, |_| Ok(()), follow)?.map_err(|error| path_error(py, error, Options::with_tol(tol)))?;
    Ok(Path { found: AnyPath::Plane(found), varied, tol })
}

#[pymethods]
impl Path {
    /// Name, unit and how many of that unit an SI unit is.
    #[getter]
    fn axis(&self) -> Axis {
        (self.varied.parameter.to_string(), self.varied.unit.to_owned(), self.varied.per_si)
    }

    /// The ends of the range in the unit shown.
    #[getter]
    fn range(&self) -> [f64; 2] {
        self.varied.range.map(|value| self.varied.shown(value))
    }

    #[getter]
    fn in_space(&self) -> bool {
        matches!(self.found, AnyPath::Space(_))
    }

    /// For each branch: how many points, the name and the words of its end, the value at which it was switched to.
    #[getter]
    fn branches(&self) -> Vec<(usize, &'static str, String, Option<f64>)> {
        match &self.found {
            AnyPath::Plane(path) => path.branches.iter().map(|branch| ends(branch, &self.varied)).collect(),
            AnyPath::Space(path) => path.branches.iter().map(|branch| ends(branch, &self.varied)).collect(),
        }
    }

    /// Values of the parameter on a branch, in the unit shown.
    fn values<'py>(&self, py: Python<'py>, branch: usize) -> PyResult<Numbers<'py>> {
        let values = match &self.found {
            AnyPath::Plane(path) => self.values_of(one(path, branch)?),
            AnyPath::Space(path) => self.values_of(one(path, branch)?),
        };
        Ok(given(py, values))
    }

    fn states<'py>(&self, py: Python<'py>, branch: usize) -> PyResult<States<'py>> {
        Ok(match &self.found {
            AnyPath::Plane(path) => states(py, &with_stability(one(path, branch)?)),
            AnyPath::Space(path) => states_in_space(py, &with_stability(one(path, branch)?)),
        })
    }

    /// The name of each point's event, and its cable.
    fn events(&self, branch: usize) -> PyResult<Vec<Option<Named>>> {
        match &self.found {
            AnyPath::Plane(path) => Ok(events(one(path, branch)?)),
            AnyPath::Space(path) => Ok(events(one(path, branch)?)),
        }
    }

    /// The shape at a point.
    fn solution(&self, py: Python<'_>, branch: usize, point: usize) -> PyResult<Py<PyAny>> {
        let none = || PyIndexError::new_err("point: the branch has no such point");
        let options = Options::with_tol(self.tol);
        match &self.found {
            AnyPath::Plane(path) => {
                let point = one(path, branch)?.points.get(point).ok_or_else(none)?;
                Ok(Py::new(py, Solution::new(point.configuration.clone(), options))?.into_any())
            }
            AnyPath::Space(path) => {
                let point = one(path, branch)?.points.get(point).ok_or_else(none)?;
                Ok(Py::new(py, SpatialSolution::new(point.configuration.clone(), options))?.into_any())
            }
        }
    }

    fn figure(&self, asked: &str, title: &str) -> PyResult<Figure> {
        let (asked, over, page) = (quantity(asked)?, abscissa(self.axis()), Page::default());
        if !asked.is_of(self.in_space()) {
            let where_ = if self.in_space() { "in space" } else { "in the plane" };
            return Err(wrong(format!("quantity: an arm {where_} has no {asked}")));
        }
        Ok(Figure::new(match &self.found {
            AnyPath::Plane(path) => hydrostat_figures::path_figure(path, &over, asked, title, &page),
            AnyPath::Space(path) => hydrostat_figures::spatial_path_figure(path, &over, asked, title, &page),
        }))
    }

    fn shapes_figure(&self, title: &str) -> PyResult<Figure> {
        let AnyPath::Plane(path) = &self.found else {
            return Err(wrong(
                "shapes along a path are drawn of arms in the plane, and this arm has `space = \"spatial\"`",
            ));
        };
        let page = Page::default();
        Ok(Figure::new(hydrostat_figures::path_shapes_figure(path, &abscissa(self.axis()), title, &page)))
    }

    fn to_json(&self) -> Option<String> {
        let document = match &self.found {
            AnyPath::Plane(path) => PathDocument::new(path, &self.varied),
            AnyPath::Space(path) => PathDocument::in_space(path, &self.varied),
        };
        document.map(|document| document.to_json())
    }

    fn to_csv(&self) -> String {
        match &self.found {
            AnyPath::Plane(path) => path_csv(path, &self.varied),
            AnyPath::Space(path) => spatial_path_csv(path, &self.varied),
        }
    }
}

impl Path {
    fn values_of<C>(&self, branch: &hydrostat::Branch<C>) -> Vec<f64> {
        branch.points.iter().map(|point| self.varied.shown(point.value)).collect()
    }
}

fn one<C>(path: &hydrostat::Path<C>, index: usize) -> PyResult<&hydrostat::Branch<C>> {
    path.branches.get(index).ok_or_else(|| PyIndexError::new_err("branch: the path has no such branch"))
}

fn with_stability<C>(branch: &hydrostat::Branch<C>) -> Vec<(&C, Option<Stability>)> {
    branch.points.iter().map(|point| (&point.configuration, point.stability)).collect()
}

fn ends<C>(branch: &hydrostat::Branch<C>, varied: &Varied) -> (usize, &'static str, String, Option<f64>) {
    let last = branch.points.last().map_or(f64::NAN, |point| point.value);
    let end = end_message(branch.end, varied, last);
    let switched_at = branch.switched_at.map(|value| varied.shown(value));
    (branch.points.len(), branch.end.name(), end, switched_at)
}

fn events<C>(branch: &hydrostat::Branch<C>) -> Vec<Option<Named>> {
    branch.points.iter().map(|point| point.event.map(|event| (event.name(), event.cable()))).collect()
}

/// All equilibria of `arm`, or those found within so many seconds.
#[pyfunction]
pub(crate) fn equilibria(py: Python<'_>, arm: &Arm, tol: f64, time_limit: Option<f64>) -> PyResult<Equilibria> {
    let limit = time_limit.map(Duration::try_from_secs_f64).transpose();
    let limit = limit.map_err(|_| wrong("time_limit: expected seconds that are not negative"))?;
    let start = Instant::now();
    let in_time = || limit.is_none_or(|limit| start.elapsed() < limit);
    let options = Options::with_tol(tol);
    let all = if arm.given.space.is_some() {
        let search = |stop: &AtomicBool| {
            arm.given.equilibria_in_space_while(tol, |_| in_time() && !stop.load(Ordering::Relaxed))
        };
        let all = interruptible(py, |_| Ok(()), search)?;
        Searched::Space(all.map_err(|error| spatial_path_error(py, error, options))?)
    } else {
        let search =
            |stop: &AtomicBool| arm.given.equilibria_while(tol, |_| in_time() && !stop.load(Ordering::Relaxed));
        let all = interruptible(py, |_| Ok(()), search)?;
        Searched::Plane(all.map_err(|error| path_error(py, error, options))?)
    };
    Ok(Equilibria { all, arm: arm.given.clone(), tol })
}

#[pymethods]
impl Equilibria {
    fn __len__(&self) -> usize {
        match &self.all {
            Searched::Plane(all) => all.found.len(),
            Searched::Space(all) => all.found.len(),
        }
    }

    #[getter]
    fn in_space(&self) -> bool {
        matches!(self.all, Searched::Space(_))
    }

    #[getter]
    fn complete(&self) -> bool {
        self.all.search().is_complete()
    }

    /// Whether it is known that some are missing, in space.
    #[getter]
    fn misses_some(&self) -> bool {
        matches!(&self.all, Searched::Space(all) if all.misses_some())
    }

    /// In the plane: angles of the tip over which the curve was followed, and of the base that they belong to, rad.
    #[getter]
    fn angles(&self) -> Option<[[f64; 2]; 2]> {
        match &self.all {
            Searched::Plane(all) => Some([all.tip_angles, all.base_angles]),
            Searched::Space(_) => None,
        }
    }

    #[getter]
    fn steps(&self) -> usize {
        match &self.all {
            Searched::Plane(all) => all.steps,
            Searched::Space(all) => all.steps,
        }
    }

    fn states<'py>(&self, py: Python<'py>) -> States<'py> {
        match &self.all {
            Searched::Plane(all) => {
                states(py, &all.found.iter().map(|one| (&one.configuration, one.stability)).collect::<Vec<_>>())
            }
            Searched::Space(all) => states_in_space(
                py,
                &all.found.iter().map(|one| (&one.configuration, one.stability)).collect::<Vec<_>>(),
            ),
        }
    }

    fn solution(&self, py: Python<'_>, index: usize) -> PyResult<Py<PyAny>> {
        let none = || PyIndexError::new_err("there is no such equilibrium");
        let options = Options::with_tol(self.tol);
        match &self.all {
            Searched::Plane(all) => {
                let one = all.found.get(index).ok_or_else(none)?;
                Ok(Py::new(py, Solution::new(one.configuration.clone(), options))?.into_any())
            }
            Searched::Space(all) => {
                let one = all.found.get(index).ok_or_else(none)?;
                Ok(Py::new(py, SpatialSolution::new(one.configuration.clone(), options))?.into_any())
            }
        }
    }

    fn figure(&self, title: &str) -> Figure {
        let page = Page::default();
        Figure::new(match &self.all {
            Searched::Plane(all) => hydrostat_figures::equilibria_figure(all, title, &page),
            Searched::Space(all) => hydrostat_figures::spatial_equilibria_figure(all, title, &page),
        })
    }

    fn to_json(&self) -> String {
        EquilibriaDocument::new(&self.arm, self.all.search()).to_json()
    }

    fn to_csv(&self) -> String {
        equilibria_csv(self.arm.cables.len(), self.all.search())
    }
}

/// All equilibria at each of several values (SI).
#[pyfunction]
pub(crate) fn over_figure(
    searches: Vec<(f64, Py<Equilibria>)>,
    axis: Axis,
    asked: &str,
    title: &str,
) -> PyResult<Figure> {
    let (asked, over, page) = (quantity(asked)?, abscissa(axis), Page::default());
    let (mut plane, mut space) = (Vec::new(), Vec::new());
    for (value, all) in &searches {
        match &all.get().all {
            Searched::Plane(all) => plane.push((*value, all)),
            Searched::Space(all) => space.push((*value, all)),
        }
    }
    if !(plane.is_empty() || space.is_empty()) {
        return Err(wrong("searches: of arms in the plane, or of arms in space, not of both"));
    }
    Ok(Figure::new(if space.is_empty() {
        hydrostat_figures::over_figure(&plane, &over, asked, title, &page)
    } else {
        hydrostat_figures::spatial_over_figure(&space, &over, asked, title, &page)
    }))
}
