//! Errors of what was given, which need no solution.

use hydrostat_files::FileError;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyAny;

/// A request that cannot be meant, in words.
pub(crate) fn wrong(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An arm file that is none; a `ValueError` that knows its key, or an `OSError`.
pub(crate) fn file_error(py: Python<'_>, error: FileError) -> PyErr {
    static ARM_ERROR: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    if let FileError::Read { source, .. } = &error {
        let text = error.to_string();
        return match source.kind() {
            std::io::ErrorKind::NotFound => PyFileNotFoundError::new_err(text),
            _ => PyOSError::new_err(text),
        };
    }
    made(py, &ARM_ERROR, "ArmError", (error.to_string(), error.key()))
}

/// The exception that a function or class of `hydrostat._errors` makes of these fields.
pub(crate) fn made<'py, A>(py: Python<'py>, kept: &PyOnceLock<Py<PyAny>>, name: &str, fields: A) -> PyErr
where
    A: pyo3::call::PyCallArgs<'py>,
{
    let make = kept.get_or_try_init(py, || Ok(py.import("hydrostat._errors")?.getattr(name)?.unbind()));
    match make.and_then(|make: &Py<PyAny>| make.bind(py).call1(fields)) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}
