//! One arm, again and again as its loads change.

use hydrostat::{Options, PoseChange, SensitivityOptions};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::{finite, given};
use crate::errors::{sensitivity_error, solve_error, wrong};
use crate::sensitivity::{Sensitivities, method, parameters};
use crate::solution::{Solution, options};

/// A solver that keeps its last configuration to start from.
#[pyclass(module = "hydrostat._native")]
pub(crate) struct Solver {
    solver: hydrostat::Solver,
    options: Options,
}

#[pymethods]
impl Solver {
    #[new]
    fn new(py: Python<'_>, arm: &Arm, tol: f64, snaps: (f64, f64)) -> PyResult<Self> {
        let options = options(tol, snaps);
        let solver = hydrostat::Solver::new(&arm.given, options);
        Ok(Self { solver: solver.map_err(|error| solve_error(py, error, options))?, options })
    }

    /// A solver of its own that goes on from the same shape.
    fn copy(&self) -> Self {
        Self { solver: self.solver.clone(), options: self.options }
    }

    /// Tensions that were set last, N; those of commanded cables are what the last solve began with.
    #[getter]
    fn tensions(&self) -> Vec<f64> {
        self.solver.arm().cables.iter().map(|cable| cable.tension).collect()
    }

    fn set_tensions(&mut self, tensions: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let tensions = finite("tensions", &tensions, false)?;
        self.solver.set_tensions(&tensions).map_err(|error| wrong(format!("tensions: {error}")))
    }

    fn set_stroke(&mut self, cable: usize, stroke: f64) -> PyResult<()> {
        self.solver.set_stroke(cable, stroke).map_err(wrong)
    }

    fn set_flow_speed(&mut self, speed: f64) -> PyResult<()> {
        self.solver.set_flow_speed(speed).map_err(wrong)
    }

    fn solve(&mut self, py: Python<'_>) -> PyResult<Solution> {
        self.whole(py, hydrostat::Solver::solve)
    }

    fn configuration(&mut self, py: Python<'_>) -> PyResult<Solution> {
        self.whole(py, hydrostat::Solver::configuration)
    }

    /// x, y, theta and alpha at the tip, and the estimated error.
    fn update(&mut self, py: Python<'_>) -> PyResult<(f64, f64, f64, f64, f64)> {
        let (solver, options) = (&mut self.solver, self.options);
        let answer = py.detach(|| solver.update()).map_err(|error| solve_error(py, error, options))?;
        let tip = answer.tip;
        Ok((tip.x, tip.y, tip.theta, tip.alpha, answer.error_estimate))
    }

    /// Derivatives by these parameters, or by all, and the shape that they are about.
    fn sensitivities(
        &mut self,
        py: Python<'_>,
        names: Option<Vec<String>>,
        stations: PyReadonlyArray1<'_, f64>,
        way: &str,
    ) -> PyResult<(Sensitivities, Solution)> {
        let wanted = SensitivityOptions { stations: finite("stations", &stations, true)?, method: method(way)? };
        let parameters = parameters(names, self.solver.arm())?;
        let (solver, options) = (&mut self.solver, self.options);
        let found = py.detach(|| solver.sensitivities_with(&parameters, &wanted));
        let found = found.map_err(|error| sensitivity_error(py, error, options))?;
        Ok((Sensitivities::new(found), self.configuration(py)?))
    }

    /// Derivatives of a number by these parameters, given its own by x, y, theta and alpha at places.
    fn gradient<'py>(
        &mut self,
        py: Python<'py>,
        names: Vec<String>,
        stations: PyReadonlyArray1<'py, f64>,
        weights: [PyReadonlyArray1<'py, f64>; 4],
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let stations = finite("stations", &stations, true)?;
        let [x, y, theta, alpha] = &weights.each_ref().map(PyReadonlyArray1::as_array);
        let by = |k: usize| PoseChange { x: x[k], y: y[k], theta: theta[k], alpha: alpha[k] };
        let weights: Vec<(f64, PoseChange)> = stations.iter().enumerate().map(|(k, s)| (*s, by(k))).collect();
        let parameters = parameters(Some(names), self.solver.arm())?;
        let (solver, options) = (&mut self.solver, self.options);
        let found = py.detach(|| solver.gradient(&parameters, &weights));
        Ok(given(py, found.map_err(|error| sensitivity_error(py, error, options))?))
    }
}

impl Solver {
    fn whole(
        &mut self,
        py: Python<'_>,
        solve: impl FnOnce(&mut hydrostat::Solver) -> Result<hydrostat::Configuration, hydrostat::SolveError> + Send,
    ) -> PyResult<Solution> {
        let (solver, options) = (&mut self.solver, self.options);
        let solved = py.detach(|| solve(solver));
        solved.map(|found| Solution::new(found, options)).map_err(|error| solve_error(py, error, options))
    }
}
