//! Tensions that bring an arm to targets.

use std::sync::atomic::{AtomicBool, Ordering};

use hydrostat::{
    Bound as TensionBound, BoundaryOptions, Configuration, Followed, Options, ReachError, ReachOptions, Reached,
    Solver, SpatialConfiguration, SpatialStation, SpatialTarget, Target,
};
use hydrostat_figures::{Page, boundary_figure, reach_figure, spatial_arm_figure};
use hydrostat_files::{BoundaryDocument, ReachDocument, boundary_csv, reach_csv, spatial_reach_csv};
use numpy::PyArray1;
use pyo3::exceptions::{PyIndexError, PyRuntimeError};
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::given;
use crate::errors::{reach_error, solve_error, spatial_reach_error, wrong};
use crate::figure::Figure;
use crate::interrupt::interruptible;
use crate::solution::{Solution, words};
use crate::spatial_solution::SpatialSolution;

/// x, y, s, angle and weight of a target.
type Goal = (f64, f64, Option<f64>, Option<f64>, f64);

/// Place, s, direction and weight of a target in space.
type GoalInSpace = ([f64; 3], Option<f64>, Option<[f64; 3]>, f64);

/// Targets in the plane or in space.
#[derive(FromPyObject)]
pub(crate) enum Goals {
    Plane(Vec<Goal>),
    Space(Vec<GoalInSpace>),
}

/// In the plane or in space.
enum AnyReach {
    Plane(Box<hydrostat::Reach>),
    Space(Box<hydrostat::Reach<SpatialConfiguration, SpatialStation>>),
}

/// Tensions, effort, distance, kind and cable of each bound, whether a solve leads there, state and count of unstable directions.
type ReachedFields<'py> =
    (Bound<'py, PyArray1<f64>>, f64, f64, Vec<(&'static str, usize)>, bool, (Option<&'static str>, Option<usize>));

/// Tensions, tip, distance, whether that is reached, whether the arm jumped, and solves.
type FollowedFields<'py> = (Bound<'py, PyArray1<f64>>, (f64, f64, f64, f64), f64, bool, bool, usize);

/// What was found for targets.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Reach {
    found: AnyReach,
    arm: hydrostat::Arm,
    targets: Vec<Target>,
    tol: f64,
}

/// What follows a path of targets.
#[derive(Clone)]
#[pyclass(module = "hydrostat._native")]
pub(crate) struct Follower {
    inner: hydrostat::Follower,
    arm: hydrostat::Arm,
    options: ReachOptions,
    /// Those of the last call.
    targets: Vec<Target>,
    /// Where it is, once that was asked.
    last: Option<Followed>,
    /// What reads whole shapes out.
    solver: Option<Solver>,
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
    targets: Goals,
    most: Most,
    tol: f64,
    all: bool,
    by_strokes: bool,
) -> PyResult<Reach> {
    let (max_tension, max_stroke) = most;
    let options = ReachOptions { max_tension, max_stroke, tol, all };
    let targets = match targets {
        Goals::Plane(goals) => targets_of(goals),
        Goals::Space(goals) => {
            let target = |(place, s, direction, weight): GoalInSpace| SpatialTarget { s, place, direction, weight };
            let targets: Vec<SpatialTarget> = goals.into_iter().map(target).collect();
            let search = |stop: &AtomicBool| {
                let go_on = || !stop.load(Ordering::Relaxed);
                if by_strokes {
                    arm.given.reach_in_space_by_strokes_while(&targets, &options, go_on)
                } else {
                    arm.given.reach_in_space_while(&targets, &options, go_on)
                }
            };
            let found = interruptible(py, |_| Ok(()), search)?
                .map_err(|error| spatial_reach_error(py, error, Options::with_tol(tol)))?;
            return Ok(Reach {
                found: AnyReach::Space(found.into()),
                arm: arm.given.clone(),
                targets: Vec::new(),
                tol,
            });
        }
    };
    let search = |stop: &AtomicBool| {
        let go_on = || !stop.load(Ordering::Relaxed);
        if by_strokes {
            arm.given.reach_by_strokes_while(&targets, &options, go_on)
        } else {
            arm.given.reach_while(&targets, &options, go_on)
        }
    };
    let found =
        interruptible(py, |_| Ok(()), search)?.map_err(|error| reach_error(py, error, Options::with_tol(tol)))?;
    Ok(Reach { found: AnyReach::Plane(found.into()), arm: arm.given.clone(), targets, tol })
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
    let (found, slack) = found.map_err(|error| reach_error(py, error, Options::with_tol(tol)))?;
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
        Figure::new(boundary_figure(&self.found, &self.slack, &Page::default()))
    }
}

/// One of the solutions, or the closest, which comes after them.
fn one<C, P>(found: &hydrostat::Reach<C, P>, index: usize) -> PyResult<&Reached<C, P>> {
    let mut all = found.solutions.iter().chain(&found.closest);
    all.nth(index).ok_or_else(|| PyIndexError::new_err("there is no such solution"))
}

fn counts<C, P>(found: &hydrostat::Reach<C, P>) -> (usize, bool) {
    (found.solutions.len(), found.closest.is_some())
}

fn fields<'py, C, P>(py: Python<'py>, one: &Reached<C, P>) -> ReachedFields<'py> {
    let bound = |bound: &TensionBound| match *bound {
        TensionBound::Slack(cable) => ("slack", cable),
        TensionBound::Most(cable) => ("most", cable),
        TensionBound::Stroke(cable) => ("stroke", cable),
    };
    let bounds = one.bounds.iter().map(bound).collect();
    let tensions = given(py, one.tensions.clone());
    (tensions, one.effort, one.distance, bounds, one.on_the_path, words(one.stability))
}

#[pymethods]
impl Reach {
    /// How many solutions there are, and whether there is a closest.
    #[getter]
    fn counts(&self) -> (usize, bool) {
        match &self.found {
            AnyReach::Plane(found) => counts(found),
            AnyReach::Space(found) => counts(found),
        }
    }

    fn fields<'py>(&self, py: Python<'py>, index: usize) -> PyResult<ReachedFields<'py>> {
        match &self.found {
            AnyReach::Plane(found) => Ok(fields(py, one(found, index)?)),
            AnyReach::Space(found) => Ok(fields(py, one(found, index)?)),
        }
    }

    fn solution(&self, py: Python<'_>, index: usize) -> PyResult<Py<PyAny>> {
        let options = Options::with_tol(self.tol);
        match &self.found {
            AnyReach::Plane(found) => {
                Ok(Py::new(py, Solution::new(one(found, index)?.configuration.clone(), options))?.into_any())
            }
            AnyReach::Space(found) => {
                Ok(Py::new(py, SpatialSolution::new(one(found, index)?.configuration.clone(), options))?.into_any())
            }
        }
    }

    /// The shape with the targets.
    fn figure(&self, index: usize, note: Option<&str>) -> PyResult<Figure> {
        let page = Page::default();
        Ok(Figure::new(match &self.found {
            AnyReach::Plane(found) => {
                let targets: Vec<[f64; 2]> = self.targets.iter().map(|target| [target.x, target.y]).collect();
                reach_figure(&one(found, index)?.configuration, &targets, note, &page)
            }
            AnyReach::Space(found) => spatial_arm_figure(&one(found, index)?.configuration, note, &page),
        }))
    }

    fn to_json(&self) -> String {
        match &self.found {
            AnyReach::Plane(found) => ReachDocument::new(&self.arm, found).to_json(),
            AnyReach::Space(found) => ReachDocument::in_space(&self.arm, found).to_json(),
        }
    }

    fn to_csv(&self) -> String {
        match &self.found {
            AnyReach::Plane(found) => reach_csv(self.arm.cables.len(), found),
            AnyReach::Space(found) => spatial_reach_csv(self.arm.cables.len(), found),
        }
    }
}

#[pymethods]
impl Follower {
    #[new]
    fn new(py: Python<'_>, arm: &Arm, targets: Vec<Goal>, most: Most, tol: f64, all: bool) -> PyResult<Self> {
        let targets = targets_of(targets);
        let (max_tension, max_stroke) = most;
        Self::start(py, arm.given.clone(), targets, ReachOptions { max_tension, max_stroke, tol, all })
    }

    /// A follower of its own that goes on from the same shape.
    fn copy(&self) -> Self {
        self.clone()
    }

    fn follow<'py>(&mut self, py: Python<'py>, targets: Vec<Goal>) -> PyResult<FollowedFields<'py>> {
        let found = self.go(py, targets_of(targets))?;
        let tip = found.tip;
        let tip = (tip.x, tip.y, tip.theta, tip.alpha);
        Ok((given(py, found.tensions), tip, found.distance, found.reached, found.jumped, found.solves))
    }

    /// The tensions that it is at, N.
    #[getter]
    fn tensions<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(given(py, self.now(py)?.tensions))
    }

    /// The whole shape.
    fn solution(&mut self, py: Python<'_>) -> PyResult<Solution> {
        self.shape(py).map(|found| Solution::new(found, Options::with_tol(SHAPE)))
    }

    /// Another speed of the stream (m/s): the tensions stay, and the arm gives way.
    fn set_flow_speed(&mut self, py: Python<'_>, speed: f64) -> PyResult<()> {
        self.shape(py)?;
        let mut arm = self.arm.clone();
        arm.flow.speed = speed;
        arm.check().map_err(|error| wrong(format!("flow_speed: {error}")))?;
        let options = self.options.clone();
        self.begin_again(py, arm, options)
    }

    /// Other bounds of all tensions and strokes.
    fn set_bounds(&mut self, py: Python<'_>, most: Most) -> PyResult<()> {
        self.shape(py)?;
        let (max_tension, max_stroke) = most;
        let options = ReachOptions { max_tension, max_stroke, ..self.options.clone() };
        self.begin_again(py, self.arm.clone(), options)
    }
}

/// The tolerance of shapes that are read out, over the length.
const SHAPE: f64 = 1e-8;

impl Follower {
    fn start(py: Python<'_>, arm: hydrostat::Arm, targets: Vec<Target>, options: ReachOptions) -> PyResult<Self> {
        let inner = py.detach(|| hydrostat::Follower::new(&arm, &targets, &options));
        let inner = inner.map_err(|error| reach_error(py, error, Options::with_tol(options.tol)))?;
        Ok(Self { inner, arm, options, targets, last: None, solver: None })
    }

    fn go(&mut self, py: Python<'_>, targets: Vec<Target>) -> PyResult<Followed> {
        let (inner, tol) = (&mut self.inner, self.options.tol);
        let found =
            py.detach(|| inner.follow(&targets)).map_err(|error| reach_error(py, error, Options::with_tol(tol)))?;
        self.targets = targets;
        self.last = Some(found.clone());
        Ok(found)
    }

    fn now(&mut self, py: Python<'_>) -> PyResult<Followed> {
        match &self.last {
            Some(last) => Ok(last.clone()),
            None => self.go(py, self.targets.clone()),
        }
    }

    /// The shape that it is at: from the one read out last, or by a solve.
    fn shape(&mut self, py: Python<'_>) -> PyResult<Configuration> {
        let now = self.now(py)?;
        self.arm.set_tensions(&now.tensions).map_err(wrong)?;
        let (arm, kept) = (&self.arm, &mut self.solver);
        let within = (1e-6 + 10.0 * self.options.tol) * arm.length;
        let is_it = |found: &Configuration| {
            let tip = found.tip();
            (tip.x - now.tip.x).hypot(tip.y - now.tip.y) <= within
        };
        let solved = py.detach(|| {
            let warm = kept.as_mut().and_then(|solver| {
                solver.set_arm(arm).ok()?;
                solver.configuration().ok().filter(is_it)
            });
            if let Some(found) = warm {
                return Ok(Some(found));
            }
            let mut solver = Solver::new(arm, Options::with_tol(SHAPE))?;
            let found = solver.solve()?;
            *kept = Some(solver);
            Ok(is_it(&found).then_some(found))
        });
        let found = solved.map_err(|error| solve_error(py, error, Options::with_tol(SHAPE)))?;
        found.ok_or_else(|| {
            PyRuntimeError::new_err("the follower is at a shape that no solve from the unloaded arm gives")
        })
    }

    /// From the shape that the present tensions lead to with another arm or other bounds, the targets being where its places are.
    fn begin_again(&mut self, py: Python<'_>, arm: hydrostat::Arm, options: ReachOptions) -> PyResult<()> {
        let Some(solver) = &mut self.solver else { return Ok(()) };
        let mut moved = solver.clone();
        let found = py.detach(|| {
            moved.set_arm(&arm)?;
            moved.configuration()
        });
        let found = found.map_err(|error| solve_error(py, error, Options::with_tol(SHAPE)))?;
        let length = arm.length;
        let target = |old: &Target| {
            let at = found.at(old.s.unwrap_or(length));
            Target { x: at.x, y: at.y, angle: old.angle.map(|_| at.theta), ..*old }
        };
        let targets = self.targets.iter().map(target).collect();
        *self = Self { solver: Some(moved), ..Self::start(py, arm, targets, options)? };
        Ok(())
    }
}
