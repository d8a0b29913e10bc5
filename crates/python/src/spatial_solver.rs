//! One arm in space, again and again as its loads change.

use hydrostat::{Arm as Given, ArmError, Options, SpatialConfiguration, SpatialError};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::finite;
use crate::errors::{spatial_error, wrong};
use crate::solution::options;
use crate::spatial_solution::{SpatialSolution, TipFields, tip};

/// A solver that keeps its last configuration to start from.
#[pyclass(module = "hydrostat._native")]
pub(crate) struct SpatialSolver {
    solver: hydrostat::SpatialSolver,
    options: Options,
}

#[pymethods]
impl SpatialSolver {
    #[new]
    fn new(py: Python<'_>, arm: &Arm, tol: f64, snaps: (f64, f64)) -> PyResult<Self> {
        Self::of(py, &arm.given, options(tol, snaps))
    }

    /// A solver of its own that goes on from the same shape.
    fn copy(&self) -> Self {
        Self { solver: self.solver.clone(), options: self.options }
    }

    /// Tensions that were set last, N.
    #[getter]
    fn tensions(&self) -> Vec<f64> {
        self.solver.arm().cables.iter().map(|cable| cable.tension).collect()
    }

    fn set_tensions(&mut self, tensions: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let tensions = finite("tensions", &tensions, false)?;
        self.solver.set_tensions(&tensions).map_err(|error| wrong(format!("tensions: {error}")))
    }

    #[expect(clippy::unused_self, reason = "a method of both solvers")]
    fn set_stroke(&mut self, cable: usize, stroke: f64) -> PyResult<()> {
        let _ = stroke;
        let why = "is not solved yet (give the tension)";
        Err(wrong(ArmError::NotInSpace { key: format!("cable[{cable}].stroke"), why }))
    }

    /// The next solve begins with the unloaded arm.
    fn set_flow_speed(&mut self, py: Python<'_>, speed: f64) -> PyResult<()> {
        let mut arm = self.solver.arm().clone();
        arm.flow.speed = speed;
        *self = Self::of(py, &arm, self.options)?;
        Ok(())
    }

    fn solve(&mut self, py: Python<'_>) -> PyResult<SpatialSolution> {
        self.whole(py, hydrostat::SpatialSolver::solve)
    }

    fn resolve(&mut self, py: Python<'_>) -> PyResult<SpatialSolution> {
        self.whole(py, hydrostat::SpatialSolver::resolve)
    }

    /// The shape at the present loads.
    fn configuration(&mut self, py: Python<'_>) -> PyResult<SpatialSolution> {
        self.whole(py, hydrostat::SpatialSolver::resolve)
    }

    /// The tip, and the estimated error.
    fn update(&mut self, py: Python<'_>) -> PyResult<(TipFields, f64)> {
        let (solver, options) = (&mut self.solver, self.options);
        let found = py.detach(|| solver.resolve()).map_err(|error| spatial_error(py, error, options))?;
        Ok((tip(found.tip()), found.error_estimate))
    }
}

impl SpatialSolver {
    fn of(py: Python<'_>, arm: &Given, options: Options) -> PyResult<Self> {
        let solver = hydrostat::SpatialSolver::new(arm, options);
        Ok(Self { solver: solver.map_err(|error| spatial_error(py, error, options))?, options })
    }

    fn whole(
        &mut self,
        py: Python<'_>,
        solve: impl FnOnce(&mut hydrostat::SpatialSolver) -> Result<SpatialConfiguration, SpatialError> + Send,
    ) -> PyResult<SpatialSolution> {
        let (solver, options) = (&mut self.solver, self.options);
        let solved = py.detach(|| solve(solver));
        solved.map(|found| SpatialSolution::new(found, options)).map_err(|error| spatial_error(py, error, options))
    }
}
