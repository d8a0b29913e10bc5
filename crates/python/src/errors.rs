//! Errors of the library as Python's exceptions: a wrong request is a `ValueError`, no equilibrium is `hydrostat.NoEquilibrium` with
//! the verdict's fields.

use hydrostat::{
    MotionError, NoEquilibrium, Options, PathError, ReachError, SensitivityError, Snap, SnapBounds, SolveError,
    SpatialError,
};
use hydrostat_files::MeasurementsError;
use hydrostat_identify::{IdentifyError, Trial};
use hydrostat_sweep::SweepError;
use pyo3::exceptions::{PyFileExistsError, PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyAny;

use crate::solution::{Solution, snaps};
use crate::spatial_solution::{self, SpatialSolution};
use crate::wrong::made;
pub(crate) use crate::wrong::{file_error, wrong};

/// What a solve ends with.
pub(crate) fn solve_error(py: Python<'_>, error: SolveError, options: Options) -> PyErr {
    let SolveError::NoEquilibrium(no) = error else { return wrong(error) };
    let shape = |found, options| Ok(Py::new(py, Solution::new(found, options))?.into_any());
    no_equilibrium(py, *no, options, shape, snaps)
}

/// What a path or a search for equilibria ends with.
pub(crate) fn path_error(py: Python<'_>, error: PathError, options: Options) -> PyErr {
    match error {
        PathError::Start { source: source @ SolveError::NoEquilibrium(_), .. } => solve_error(py, source, options),
        other => wrong(other),
    }
}

/// What a path in space ends with.
pub(crate) fn spatial_path_error(py: Python<'_>, error: PathError<SpatialError>, options: Options) -> PyErr {
    match error {
        PathError::Start { source: source @ SpatialError::NoEquilibrium(_), .. } => spatial_error(py, source, options),
        other => wrong(other),
    }
}

/// What derivatives in space end with.
pub(crate) fn spatial_sensitivity_error(
    py: Python<'_>,
    error: SensitivityError<SpatialError>,
    options: Options,
) -> PyErr {
    match error {
        SensitivityError::Solve(error) => spatial_error(py, error, options),
        other => no_derivative(py, &other),
    }
}

/// What derivatives end with.
pub(crate) fn sensitivity_error(py: Python<'_>, error: SensitivityError, options: Options) -> PyErr {
    match error {
        SensitivityError::Solve(error) => solve_error(py, error, options),
        other => no_derivative(py, &other),
    }
}

fn no_derivative<E: std::fmt::Display + std::error::Error + 'static>(
    py: Python<'_>,
    error: &SensitivityError<E>,
) -> PyErr {
    static NO_DERIVATIVE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    match error {
        SensitivityError::Solve(error) => wrong(error),
        SensitivityError::Station { .. } => wrong(format!("stations: {error}")),
        SensitivityError::Unfit(_) | SensitivityError::Commanded(_) | SensitivityError::NotCommanded(_) => {
            wrong(format!("parameters: {error}"))
        }
        SensitivityError::Friction(_) | SensitivityError::Support => wrong(format!("arm: {error}")),
        SensitivityError::Singular | SensitivityError::Unsettled(_) => {
            made(py, &NO_DERIVATIVE, "NoDerivative", (error.to_string(),))
        }
    }
}

/// What a search for tensions in space ends with.
pub(crate) fn spatial_reach_error(py: Python<'_>, error: ReachError<SpatialError>, options: Options) -> PyErr {
    match error {
        ReachError::Solve(error) => spatial_error(py, error, options),
        ReachError::Sensitivity(error @ SensitivityError::Station { .. }) => wrong(format!("targets: {error}")),
        ReachError::Sensitivity(error) => spatial_sensitivity_error(py, error, options),
        ReachError::NoCables => wrong(format!("arm: {error}")),
        ReachError::Target => wrong(format!("targets: {error}")),
        ReachError::Option { .. } => wrong(error),
    }
}

/// What a search for tensions ends with.
pub(crate) fn reach_error(py: Python<'_>, error: ReachError, options: Options) -> PyErr {
    match error {
        ReachError::Solve(error) => solve_error(py, error, options),
        ReachError::Sensitivity(error @ SensitivityError::Station { .. }) => wrong(format!("targets: {error}")),
        ReachError::Sensitivity(error) => sensitivity_error(py, error, options),
        ReachError::NoCables => wrong(format!("arm: {error}")),
        ReachError::Target => wrong(format!("targets: {error}")),
        // Its words begin with the argument.
        ReachError::Option { .. } => wrong(error),
    }
}

/// A table of measured numbers that is none; a `ValueError` that knows its row and column.
pub(crate) fn measurements_error(py: Python<'_>, error: MeasurementsError) -> PyErr {
    static MEASUREMENTS_ERROR: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let row = (error.row > 0).then_some(error.row);
    made(py, &MEASUREMENTS_ERROR, "MeasurementsError", (error.to_string(), row, error.column))
}

/// What a motion ends with.
pub(crate) fn motion_error(py: Python<'_>, error: MotionError) -> PyErr {
    static ENDED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    match error {
        MotionError::Start(source) => solve_error(py, *source, Options::default()),
        MotionError::SpatialStart(source) => spatial_error(py, *source, Options::default()),
        MotionError::Ended(verdict) => {
            let fields = (verdict.message(), verdict.kind.name(), verdict.time, verdict.s);
            made(py, &ENDED, "MotionError", fields)
        }
        // An option's name is that of the argument.
        other => wrong(other),
    }
}

/// What a fit ends with.
pub(crate) fn identify_error(py: Python<'_>, error: IdentifyError, options: Options) -> PyErr {
    let words = error.to_string();
    let IdentifyError::Start { case, source } = error else { return wrong(words) };
    let found = match *source {
        Trial::Sensitivity(source) => sensitivity_error(py, source, options),
        Trial::InSpace(source) => spatial_sensitivity_error(py, source, options),
        Trial::Arm(_) => return wrong(words),
    };
    let note = format!("load case {case} has no answer where the search starts");
    match found.value(py).call_method1("add_note", (note,)) {
        Ok(_) => found,
        Err(error) => error,
    }
}

/// What a sweep ends with.
pub(crate) fn sweep_error(error: SweepError) -> PyErr {
    match error {
        SweepError::Exists { .. } | SweepError::Begun { .. } => PyFileExistsError::new_err(error.to_string()),
        SweepError::Locked { .. } | SweepError::Write(_) | SweepError::Read { .. } | SweepError::Damaged { .. } => {
            PyOSError::new_err(error.to_string())
        }
        SweepError::Threads(_) => PyRuntimeError::new_err(error.to_string()),
        // The option's name is that of the argument.
        other => wrong(other.to_string().trim_start_matches("--")),
    }
}

/// What a solve in space ends with.
pub(crate) fn spatial_error(py: Python<'_>, error: SpatialError, options: Options) -> PyErr {
    let SpatialError::NoEquilibrium(no) = error else { return wrong(error) };
    let shape = |found, options| Ok(Py::new(py, SpatialSolution::new(found, options))?.into_any());
    no_equilibrium(py, *no, options, shape, spatial_solution::snaps)
}

/// `hydrostat.NoEquilibriumError` with the shapes that are known.
fn no_equilibrium<'py, C, T, S: IntoPyObject<'py>>(
    py: Python<'py>,
    no: NoEquilibrium<C, T>,
    options: Options,
    solution: impl Fn(C, Options) -> PyResult<Py<PyAny>>,
    snaps: impl Fn(&[Snap<T>]) -> S,
) -> PyErr {
    static NO_EQUILIBRIUM: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let NoEquilibrium { verdict, last_good, snaps: all, after_snap, at_full_loads } = no;
    let shape = |found: Option<C>, options| found.map(|configuration| solution(configuration, options)).transpose();
    // Beyond the snap are shapes that a solve has which follows every one.
    let followed = Options { snaps: SnapBounds::NONE, ..options };
    let shapes =
        || Ok::<_, PyErr>((shape(last_good, options)?, shape(after_snap, followed)?, shape(at_full_loads, followed)?));
    let (last_good, after_snap, at_full_loads) = match shapes() {
        Ok(shapes) => shapes,
        Err(error) => return error,
    };
    let fields = (
        verdict.kind.name(),
        verdict.phase.name(),
        verdict.load_fraction,
        verdict.s,
        verdict.residual,
        verdict.message(),
        verdict.advice(),
        last_good,
        snaps(&all),
        after_snap,
        at_full_loads,
    );
    made(py, &NO_EQUILIBRIUM, "no_equilibrium", fields)
}
