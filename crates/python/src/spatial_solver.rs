//! One arm in space, again and again as its loads change.

use hydrostat::{
    Arm as Given, Options, SensitivityError, SensitivityOptions, SpatialConfiguration, SpatialError, SpatialPoseChange,
};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::arrays::{finite, given};
use crate::errors::{spatial_error, spatial_sensitivity_error, wrong};
use crate::sensitivity::{SpatialSensitivities, method, parameters};
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

    /// Strokes are then no longer commanded.
    fn set_tensions(&mut self, tensions: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let tensions = finite("tensions", &tensions, false)?;
        self.solver.set_tensions(&tensions).map_err(|error| wrong(format!("tensions: {error}")))
    }

    fn set_stroke(&mut self, py: Python<'_>, cable: usize, stroke: f64) -> PyResult<()> {
        let mut arm = self.solver.arm().clone();
        let Some(own) = arm.cables.get_mut(cable) else {
            let expected = "the index of one of the arm's cables";
            return Err(wrong(SpatialError::Option { option: "cable", value: cable as f64, expected }));
        };
        own.stroke = Some(stroke);
        self.set_arm(py, &arm)
    }

    fn set_flow_speed(&mut self, py: Python<'_>, speed: f64) -> PyResult<()> {
        let mut arm = self.solver.arm().clone();
        arm.flow.speed = speed;
        self.set_arm(py, &arm)
    }

    fn solve(&mut self, py: Python<'_>) -> PyResult<SpatialSolution> {
        self.whole(py, hydrostat::SpatialSolver::solve)
    }

    /// The shape at the present loads.
    fn configuration(&mut self, py: Python<'_>) -> PyResult<SpatialSolution> {
        self.whole(py, hydrostat::SpatialSolver::configuration)
    }

    /// Derivatives, and the solution that they are about.
    fn sensitivities(
        &mut self,
        py: Python<'_>,
        names: Option<Vec<String>>,
        stations: PyReadonlyArray1<'_, f64>,
        by: &str,
    ) -> PyResult<(SpatialSensitivities, SpatialSolution)> {
        let parameters = parameters(names, self.solver.arm())?;
        let asked = SensitivityOptions { stations: finite("stations", &stations, true)?, method: method(by)? };
        let (solver, options) = (&mut self.solver, self.options);
        let found = py.detach(|| {
            let found = solver.sensitivities_with(&parameters, &asked)?;
            let solution = solver.configuration().map_err(SensitivityError::Solve)?;
            Ok((found, solution))
        });
        let (found, solution) = found.map_err(|error| spatial_sensitivity_error(py, error, options))?;
        Ok((SpatialSensitivities::new(found), SpatialSolution::new(solution, options)))
    }

    /// The gradient of a number by parameters, given its derivatives by x, y, z and the turns about e1, e2, e3 at
    /// places.
    fn gradient<'py>(
        &mut self,
        py: Python<'py>,
        names: Vec<String>,
        stations: PyReadonlyArray1<'py, f64>,
        weights: [PyReadonlyArray1<'py, f64>; 6],
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let parameters = parameters(Some(names), self.solver.arm())?;
        let stations = finite("stations", &stations, true)?;
        let columns = weights.iter().map(|array| finite("weights", array, true)).collect::<PyResult<Vec<_>>>()?;
        let part = |k: usize, row: usize| columns[k].get(row).copied().unwrap_or(0.0);
        let weights: Vec<(f64, SpatialPoseChange)> = stations
            .iter()
            .enumerate()
            .map(|(row, s)| {
                let three = |first: usize| [0, 1, 2].map(|axis| part(first + axis, row));
                (*s, SpatialPoseChange { place: three(0), turn: three(3) })
            })
            .collect();
        let (solver, options) = (&mut self.solver, self.options);
        let found = py.detach(|| solver.gradient(&parameters, &weights));
        Ok(given(py, found.map_err(|error| spatial_sensitivity_error(py, error, options))?))
    }

    /// The tip, and the estimated error.
    fn update(&mut self, py: Python<'_>) -> PyResult<(TipFields, f64)> {
        let (solver, options) = (&mut self.solver, self.options);
        let answer = py.detach(|| solver.update()).map_err(|error| spatial_error(py, error, options))?;
        Ok((tip(answer.tip), answer.error_estimate))
    }
}

impl SpatialSolver {
    fn of(py: Python<'_>, arm: &Given, options: Options) -> PyResult<Self> {
        let solver = hydrostat::SpatialSolver::new(arm, options);
        Ok(Self { solver: solver.map_err(|error| spatial_error(py, error, options))?, options })
    }

    fn set_arm(&mut self, py: Python<'_>, arm: &Given) -> PyResult<()> {
        self.solver.set_arm(arm).map_err(|error| spatial_error(py, error, self.options))
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
