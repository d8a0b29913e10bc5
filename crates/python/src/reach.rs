//! Tensions that bring an arm to targets.

use std::sync::atomic::{AtomicBool, Ordering};

use hydrostat::{Bound as TensionBound, BoundaryOptions, Configuration, ReachError, ReachOptions, Reached, Target};
use hydrostat_figures::{boundary_figure, reach_figure};
use hydrostat_files::{BoundaryDocument, ReachDocument, boundary_csv, reach_csv};
use numpy::PyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::reach_error;
use crate::figure::Figure;
use crate::interrupt::interruptible;
use crate::solution::{Solution, words};

/// x, y, s, angle and weight of a target.
type Goal = (f64, f64, Option<f64>, Option<f64>, f64);

/// Tensions, effort, distance, kind and cable of each bound, whether a solve leads there, state and count of unstable directions.
type ReachedFields<'py> =
    (Bound<'py, PyArray1<f64>>, f64, f64, Vec<(&'static str, usize)>, bool, (Option<&'static str>, Option<usize>));

/// Tensions, tip, distance, whether that is reached, whether the arm jumped, and solves.
type FollowedFields<'py> = (Bound<'py, PyArray1<f64>>, (f64, f64, f64, f64), f64, bool, bool, usize);

/// What was found for targets.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Reach {
    found: hydrostat::Reach,
    arm: hydrostat::Arm,
    targets: Vec<Target>,
    tol: f64,
}

/// What follows a path of targets.
#[pyclass(module = "hydrostat._native")]
pub(crate) struct Follower {
    follower: hydrostat::Follower,
    tol: f64,
}

fn targets_of(goals: Vec<Goal>) -> Vec<Target> {
    goals.into_iter().map(|(x, y, s, angle, weight)| Target { s, x, y, angle, weight }).collect()
}

/// The largest tension (N) and stroke (m) of every cable.
type Most = (Option<f64>, Option<f64>);

/// Looks for tensions of `arm` that meet the targets.
#[pyfunction]
pub(crate) fn reach(
    py: Python<'_>,
    arm: &Arm,
    targets: Vec<Goal>,
    most: Most,
    tol: f64,
    all: bool,
    by_strokes: bool,
) -> PyResult<Reach> {
    let targets = targets_of(targets);
    let (max_tension, max_stroke) = most;
    let options = ReachOptions { max_tension, max_stroke, tol, all };
    let search = |stop: &AtomicBool| {
        let go_on = || !stop.load(Ordering::Relaxed);
        if by_strokes {
            arm.given.reach_by_strokes_while(&targets, &options, go_on)
        } else {
            arm.given.reach_while(&targets, &options, go_on)
        }
    };
    let found = interruptible(py, |_| Ok(()), search)?.map_err(|error| reach_error(py, error, tol))?;
    Ok(Reach { found, arm: arm.given.clone(), targets, tol })
}

/// What bounds the places that the tip reaches.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Boundary {
    found: hydrostat::Boundary,
    arm: hydrostat::Arm,
    /// The shape with slack cables.
    slack: Configuration,
}

/// Traces the boundary.
#[pyfunction]
pub(crate) fn reachable(
    py: Python<'_>,
    arm: &Arm,
    max_tension: Option<f64>,
    spacing: f64,
    tol: f64,
) -> PyResult<Boundary> {
    let options = BoundaryOptions { max_tension, spacing, tol };
    let trace = |stop: &AtomicBool| -> Result<_, ReachError> {
        let go_on = |_| !stop.load(Ordering::Relaxed);
        Ok((arm.given.reachable_while(&options, go_on)?, arm.given.slackened().solve()?))
    };
    let found = interruptible(py, |_| Ok(()), trace)?;
    let (found, slack) = found.map_err(|error| reach_error(py, error, tol))?;
    Ok(Boundary { found, arm: arm.given.clone(), slack })
}

#[pymethods]
impl Boundary {
    fn to_json(&self) -> String {
        BoundaryDocument::new(&self.arm, &self.found).to_json()
    }

    fn to_csv(&self) -> String {
        boundary_csv(self.arm.cables.len(), &self.found)
    }

    fn figure(&self) -> Figure {
        Figure::new(boundary_figure(&self.found, &self.slack))
    }
}

impl Reach {
    /// One of the solutions, or the closest, which comes after them.
    fn one(&self, index: usize) -> PyResult<&Reached> {
        let mut all = self.found.solutions.iter().chain(&self.found.closest);
        all.nth(index).ok_or_else(|| PyIndexError::new_err("there is no such solution"))
    }
}

#[pymethods]
impl Reach {
    /// How many solutions there are, and whether there is a closest.
    #[getter]
    fn counts(&self) -> (usize, bool) {
        (self.found.solutions.len(), self.found.closest.is_some())
    }

    fn fields<'py>(&self, py: Python<'py>, index: usize) -> PyResult<ReachedFields<'py>> {
        let one = self.one(index)?;
        let bound = |bound: &TensionBound| match *bound {
            TensionBound::Slack(cable) => ("slack", cable),
            TensionBound::Most(cable) => ("most", cable),
            TensionBound::Stroke(cable) => ("stroke", cable),
        };
        let bounds = one.bounds.iter().map(bound).collect();
        let tensions = given(py, one.tensions.clone());
        Ok((tensions, one.effort, one.distance, bounds, one.on_the_path, words(one.stability)))
    }

    fn solution(&self, index: usize) -> PyResult<Solution> {
        Ok(Solution::new(self.one(index)?.configuration.clone(), self.tol))
    }

    /// The shape with the targets.
    fn figure(&self, index: usize, note: Option<&str>) -> PyResult<Figure> {
        let targets: Vec<[f64; 2]> = self.targets.iter().map(|target| [target.x, target.y]).collect();
        Ok(Figure::new(reach_figure(&self.one(index)?.configuration, &targets, note)))
    }

    fn to_json(&self) -> String {
        ReachDocument::new(&self.arm, &self.found).to_json()
    }

    fn to_csv(&self) -> String {
        reach_csv(self.arm.cables.len(), &self.found)
    }
}

#[pymethods]
impl Follower {
    #[new]
    fn new(py: Python<'_>, arm: &Arm, targets: Vec<Goal>, most: Most, tol: f64, all: bool) -> PyResult<Self> {
        let targets = targets_of(targets);
        let (max_tension, max_stroke) = most;
        let options = ReachOptions { max_tension, max_stroke, tol, all };
        let follower = py.detach(|| hydrostat::Follower::new(&arm.given, &targets, &options));
        Ok(Self { follower: follower.map_err(|error| reach_error(py, error, tol))?, tol })
    }

    /// A follower of its own that goes on from the same shape.
    fn copy(&self) -> Self {
        Self { follower: self.follower.clone(), tol: self.tol }
    }

    fn follow<'py>(&mut self, py: Python<'py>, targets: Vec<Goal>) -> PyResult<FollowedFields<'py>> {
        let targets = targets_of(targets);
        let (follower, tol) = (&mut self.follower, self.tol);
        let found = py.detach(|| follower.follow(&targets)).map_err(|error| reach_error(py, error, tol))?;
        let tip = found.tip;
        let tip = (tip.x, tip.y, tip.theta, tip.alpha);
        Ok((given(py, found.tensions), tip, found.distance, found.reached, found.jumped, found.solves))
    }
}
