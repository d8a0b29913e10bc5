//! Paths over a parameter, and all equilibria under the same loads.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use hydrostat::{Configuration, Event, Options, PathOptions, Stability};
use hydrostat_figures::Page;
use hydrostat_files::{EquilibriaDocument, PathDocument, Varied, end_message, equilibria_csv, path_csv};
use numpy::PyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::{path_error, wrong};
use crate::figure::{Axis, Figure, abscissa, quantity};
use crate::interrupt::interruptible;
use crate::solution::{Solution, words};

/// A path and what it varies, in the unit that was asked for.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Path {
    found: hydrostat::Path,
    varied: Varied,
    tol: f64,
}

/// All equilibria of an arm.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Equilibria {
    pub(crate) all: hydrostat::Equilibria,
    arm: hydrostat::Arm,
    tol: f64,
}

/// A column of numbers.
type Numbers<'py> = Bound<'py, PyArray1<f64>>;

/// The name of an event, and its cable.
type Named = (&'static str, Option<usize>);

/// x, y, theta and alpha of the tip, state and count of unstable directions, a value each.
type States<'py> = ([Numbers<'py>; 4], Vec<Option<&'static str>>, Vec<Option<usize>>);

fn states<'py>(py: Python<'py>, all: &[(&Configuration, Option<Stability>)]) -> States<'py> {
    let tips: Vec<hydrostat::Tip> = all.iter().map(|(configuration, _)| configuration.tip()).collect();
    let column = |of: fn(&hydrostat::Tip) -> f64| given(py, tips.iter().map(of).collect());
    let tip = [column(|t| t.x), column(|t| t.y), column(|t| t.theta), column(|t| t.alpha)];
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
    let follow = |stop: &std::sync::atomic::AtomicBool| {
        arm.given.path_with(varied.parameter, varied.range, &options, |_| !stop.load(Ordering::Relaxed))
    };
    let found =
        interruptible(py, |_| Ok(()), follow)?.map_err(|error| path_error(py, error, Options::with_tol(tol)))?;
    Ok(Path { found, varied, tol })
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
        self.found.range.map(|value| self.varied.shown(value))
    }

    /// For each branch: how many points, the name and the words of its end, the value at which it was switched to.
    #[getter]
    fn branches(&self) -> Vec<(usize, &'static str, String, Option<f64>)> {
        let branch = |branch: &hydrostat::Branch| {
            let last = branch.points.last().map_or(f64::NAN, |point| point.value);
            let end = end_message(branch.end, &self.varied, last);
            let switched_at = branch.switched_at.map(|value| self.varied.shown(value));
            (branch.points.len(), branch.end.name(), end, switched_at)
        };
        self.found.branches.iter().map(branch).collect()
    }

    /// Values of the parameter on a branch, in the unit shown.
    fn values<'py>(&self, py: Python<'py>, branch: usize) -> PyResult<Numbers<'py>> {
        let points = &self.branch(branch)?.points;
        Ok(given(py, points.iter().map(|point| self.varied.shown(point.value)).collect()))
    }

    fn states<'py>(&self, py: Python<'py>, branch: usize) -> PyResult<States<'py>> {
        let points = &self.branch(branch)?.points;
        let all: Vec<_> = points.iter().map(|point| (&point.configuration, point.stability)).collect();
        Ok(states(py, &all))
    }

    /// The name of each point's event, and its cable.
    fn events(&self, branch: usize) -> PyResult<Vec<Option<Named>>> {
        let event = |event: Event| (event.name(), event.cable());
        Ok(self.branch(branch)?.points.iter().map(|point| point.event.map(event)).collect())
    }

    /// The shape at a point.
    fn solution(&self, branch: usize, point: usize) -> PyResult<Solution> {
        let points = &self.branch(branch)?.points;
        let point = points.get(point).ok_or_else(|| PyIndexError::new_err("point: the branch has no such point"))?;
        Ok(Solution::new(point.configuration.clone(), Options::with_tol(self.tol)))
    }

    fn figure(&self, asked: &str, title: &str) -> PyResult<Figure> {
        let scene = hydrostat_figures::path_figure(
            &self.found,
            &abscissa(self.axis()),
            quantity(asked)?,
            title,
            &Page::default(),
        );
        Ok(Figure::new(scene))
    }

    fn shapes_figure(&self, title: &str) -> Figure {
        let page = Page::default();
        Figure::new(hydrostat_figures::path_shapes_figure(&self.found, &abscissa(self.axis()), title, &page))
    }

    fn to_json(&self) -> Option<String> {
        PathDocument::new(&self.found, &self.varied).map(|document| document.to_json())
    }

    fn to_csv(&self) -> String {
        path_csv(&self.found, &self.varied)
    }
}

impl Path {
    fn branch(&self, index: usize) -> PyResult<&hydrostat::Branch> {
        self.found.branches.get(index).ok_or_else(|| PyIndexError::new_err("branch: the path has no such branch"))
    }
}

/// All equilibria of `arm`, or those found within so many seconds.
#[pyfunction]
pub(crate) fn equilibria(py: Python<'_>, arm: &Arm, tol: f64, time_limit: Option<f64>) -> PyResult<Equilibria> {
    let limit = time_limit.map(Duration::try_from_secs_f64).transpose();
    let limit = limit.map_err(|_| wrong("time_limit: expected seconds that are not negative"))?;
    let start = Instant::now();
    let all = interruptible(
        py,
        |_| Ok(()),
        |stop| {
            let in_time = || limit.is_none_or(|limit| start.elapsed() < limit);
            arm.given.equilibria_while(tol, |_| in_time() && !stop.load(Ordering::Relaxed))
        },
    )?;
    let all = all.map_err(|error| path_error(py, error, Options::with_tol(tol)))?;
    Ok(Equilibria { all, arm: arm.given.clone(), tol })
}

#[pymethods]
impl Equilibria {
    fn __len__(&self) -> usize {
        self.all.found.len()
    }

    #[getter]
    fn complete(&self) -> bool {
        self.all.complete
    }

    /// Angles of the tip over which the curve was followed, and of the base that they belong to, rad.
    #[getter]
    fn angles(&self) -> [[f64; 2]; 2] {
        [self.all.tip_angles, self.all.base_angles]
    }

    #[getter]
    fn steps(&self) -> usize {
        self.all.steps
    }

    fn states<'py>(&self, py: Python<'py>) -> States<'py> {
        let all: Vec<_> = self.all.found.iter().map(|one| (&one.configuration, one.stability)).collect();
        states(py, &all)
    }

    fn solution(&self, index: usize) -> PyResult<Solution> {
        let one = self.all.found.get(index).ok_or_else(|| PyIndexError::new_err("there is no such equilibrium"))?;
        Ok(Solution::new(one.configuration.clone(), Options::with_tol(self.tol)))
    }

    fn figure(&self, title: &str) -> Figure {
        Figure::new(hydrostat_figures::equilibria_figure(&self.all, title, &Page::default()))
    }

    fn to_json(&self) -> String {
        EquilibriaDocument::new(&self.arm, &self.all).to_json()
    }

    fn to_csv(&self) -> String {
        equilibria_csv(self.arm.cables.len(), &self.all)
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
    let searches: Vec<(f64, &hydrostat::Equilibria)> =
        searches.iter().map(|(value, all)| (*value, &all.get().all)).collect();
    let page = Page::default();
    Ok(Figure::new(hydrostat_figures::over_figure(&searches, &abscissa(axis), quantity(asked)?, title, &page)))
}
