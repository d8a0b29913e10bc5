//! One arm, again and again as its loads change.

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::finite;
use crate::errors::{solve_error, wrong};
use crate::solution::Solution;

/// A solver that keeps its last configuration to start from.
#[pyclass(module = "hydrostat._native")]
pub(crate) struct Solver {
    solver: hydrostat::Solver,
    tol: f64,
}

#[pymethods]
impl Solver {
    #[new]
    fn new(py: Python<'_>, arm: &Arm, tol: f64) -> PyResult<Self> {
        let solver = hydrostat::Solver::new(&arm.given, hydrostat::Options { tol });
        Ok(Self { solver: solver.map_err(|error| solve_error(py, error, tol))?, tol })
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

    fn resolve(&mut self, py: Python<'_>) -> PyResult<Solution> {
        self.whole(py, hydrostat::Solver::resolve)
    }

    fn configuration(&mut self, py: Python<'_>) -> PyResult<Solution> {
        self.whole(py, hydrostat::Solver::configuration)
    }

    /// x, y, theta and alpha at the tip, and the estimated error.
    fn update(&mut self, py: Python<'_>) -> PyResult<(f64, f64, f64, f64, f64)> {
        let (solver, tol) = (&mut self.solver, self.tol);
        let answer = py.detach(|| solver.update()).map_err(|error| solve_error(py, error, tol))?;
        let tip = answer.tip;
        Ok((tip.x, tip.y, tip.theta, tip.alpha, answer.error_estimate))
    }
}

impl Solver {
    fn whole(
        &mut self,
        py: Python<'_>,
        solve: impl FnOnce(&mut hydrostat::Solver) -> Result<hydrostat::Configuration, hydrostat::SolveError> + Send,
    ) -> PyResult<Solution> {
        let (solver, tol) = (&mut self.solver, self.tol);
        let solved = py.detach(|| solve(solver));
        solved.map(|found| Solution::new(found, tol)).map_err(|error| solve_error(py, error, tol))
    }
}
