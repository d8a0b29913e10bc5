//! Numbers as NumPy arrays, and back.

use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::wrong::wrong;

/// A read-only array on memory that belongs to `owner`, without a copy.
///
/// The caller hands in numbers that `owner`, a frozen class, holds in a vector that nothing changes.
pub(crate) fn shared<'py>(owner: Bound<'py, PyAny>, numbers: &[f64]) -> Bound<'py, PyArray1<f64>> {
    // SAFETY: the array keeps `owner` alive, which keeps the vector; frozen, it never gives out a way to change or move it.
    #[expect(unsafe_code, reason = "NumPy cannot know how long the memory lives: see above")]
    let array = unsafe { PyArray1::borrow_from_array(&ArrayView1::from(numbers), owner) };
    array.readwrite().make_nonwriteable();
    array
}

/// The same of points, as an array of three columns.
pub(crate) fn shared_points<'py>(owner: Bound<'py, PyAny>, points: &[[f64; 3]]) -> Bound<'py, PyArray2<f64>> {
    // SAFETY: as in `shared`.
    #[expect(unsafe_code, reason = "NumPy cannot know how long the memory lives: see `shared`")]
    let array = unsafe { PyArray2::borrow_from_array(&ArrayView2::from(points), owner) };
    array.readwrite().make_nonwriteable();
    array
}

/// A read-only array of three columns with its own memory.
pub(crate) fn given_points<'py>(py: Python<'py>, points: &[[f64; 3]]) -> Bound<'py, PyArray2<f64>> {
    let array = PyArray2::from_array(py, &ArrayView2::from(points));
    array.readwrite().make_nonwriteable();
    array
}

/// A vector's own memory as a read-only array.
pub(crate) fn given(py: Python<'_>, numbers: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    let array = PyArray1::from_vec(py, numbers);
    array.readwrite().make_nonwriteable();
    array
}

/// The field of `stations` that has this name.
pub(crate) fn field<'a>(stations: &'a hydrostat::Stations, name: &str) -> PyResult<&'a [f64]> {
    Ok(match name {
        "s" => &stations.s,
        "x" => &stations.x,
        "y" => &stations.y,
        "theta" => &stations.theta,
        "nu" => &stations.nu,
        "eta" => &stations.eta,
        "mu" => &stations.mu,
        "beta" => &stations.beta,
        "alpha" => &stations.alpha,
        "n_a" => &stations.n_a,
        "n_b" => &stations.n_b,
        "m" => &stations.m,
        _ => return Err(PyKeyError::new_err(name.to_owned())),
    })
}

/// The numbers of an array that are all finite, and not below zero where `least` says so. `name` is the argument's.
pub(crate) fn finite(name: &str, array: &PyReadonlyArray1<'_, f64>, negative: bool) -> PyResult<Vec<f64>> {
    let numbers: Vec<f64> = array.as_array().iter().copied().collect();
    for (index, number) in numbers.iter().enumerate() {
        if !number.is_finite() {
            return Err(wrong(format!("{name}[{index}]: expected a finite number, found {number}")));
        }
        if !negative && *number < 0.0 {
            return Err(wrong(format!("{name}[{index}]: expected a number that is not negative, found {number}")));
        }
    }
    Ok(numbers)
}
