//! Parameters from measured shapes.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::Ordering;

use hydrostat::Options;
use hydrostat_figures::{Page, fit_figure};
use hydrostat_files::{
    Deviations, FitKey, FitKeyError, IdentificationDocument, PriorKey, arm_to_toml, fitted, parse_measurements,
    read_measurements, residuals_csv,
};
use hydrostat_identify::{Case, FitOptions, Fitted, Loss, Progress, Shape};
use pyo3::prelude::*;

use crate::arm::Arm;
use crate::errors::{identify_error, measurements_error, wrong};
use crate::figure::Figure;
use crate::interrupt::interruptible;
use crate::solution::Solution;
use crate::spatial_solution::SpatialSolution;

/// A fit with what it was made to.
#[pyclass(frozen, module = "hydrostat._native")]
pub(crate) struct Fit {
    found: hydrostat_identify::Fit,
    cases: Vec<Case>,
    /// The fitted arm, with the loads of its file.
    best: hydrostat::Arm,
    options: FitOptions,
}

/// A table to fill in.
#[pyfunction]
pub(crate) fn measurements_template(arm: &Arm) -> String {
    hydrostat_files::measurements_template(&arm.given)
}

/// Fits parameters of `arm` to a table, given as a file's `path` or as its `text`; `say` is handed how far the work is, in words.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "one call of a private function")]
pub(crate) fn identify(
    py: Python<'_>,
    arm: &Arm,
    path: Option<&str>,
    text: &str,
    fit: Vec<String>,
    priors: Vec<String>,
    deviations: Vec<String>,
    loss: &str,
    rescale: bool,
    cross_validate: bool,
    tol: f64,
    say: Option<Py<PyAny>>,
) -> PyResult<Fit> {
    let mut sd = Deviations::default();
    for text in &deviations {
        sd.add(text).map_err(|error| wrong(format!("sd: {error}")))?;
    }
    let wanted = wanted(arm, &fit, &priors)?;
    let parameters: Vec<_> = wanted.iter().map(|one| one.parameter).collect();
    let cases = match path {
        Some(path) => read_measurements(Path::new(path), &arm.file, &sd, &parameters),
        None => parse_measurements(text, "data", &arm.file, &sd, &parameters),
    };
    let cases = cases.map_err(|error| measurements_error(py, error))?;
    let options = FitOptions { loss: loss_of(loss)?, rescale, cross_validate, tol, ..FitOptions::default() };
    let step: Mutex<Option<Progress>> = Mutex::new(None);
    let taken = || step.lock().ok().and_then(|mut step| step.take());
    let found = interruptible(
        py,
        |py| match (&say, taken()) {
            (Some(say), Some(step)) => say.call1(py, (step.to_string(),)).map(drop),
            _ => Ok(()),
        },
        |stop| {
            hydrostat_identify::fit(&cases, &wanted, &options, |now| {
                if let Ok(mut step) = step.lock() {
                    *step = Some(now);
                }
                !stop.load(Ordering::Relaxed)
            })
        },
    )?;
    let found = found.map_err(|error| identify_error(py, error, Options::with_tol(tol)))?;
    let best = found.applied_to(&arm.given);
    Ok(Fit { found, cases, best, options })
}

fn wanted(arm: &Arm, fit: &[String], priors: &[String]) -> PyResult<Vec<Fitted>> {
    let of_fit = |error: FitKeyError| wrong(format!("fit: {error}"));
    let keys: Vec<FitKey> = fit.iter().map(|text| text.parse().map_err(of_fit)).collect::<PyResult<_>>()?;
    let of_prior = |error: FitKeyError| wrong(format!("prior: {error}"));
    let priors: Vec<PriorKey> = priors.iter().map(|text| text.parse().map_err(of_prior)).collect::<PyResult<_>>()?;
    fitted(&arm.given, &keys, &priors).map_err(of_fit)
}

fn loss_of(name: &str) -> PyResult<Loss> {
    let found = Loss::ALL.into_iter().find(|loss| loss.name() == name);
    found.ok_or_else(|| wrong(format!("loss: expected none, huber or cauchy, found {name:?}")))
}

#[pymethods]
impl Fit {
    /// The document of `hydrostat identify --json`.
    fn to_json(&self) -> String {
        IdentificationDocument::new(&self.best, &self.cases, &self.found, self.options.loss).to_json()
    }

    fn to_csv(&self) -> String {
        residuals_csv(&self.cases, &self.found)
    }

    /// The fitted arm as TOML.
    fn to_toml(&self) -> String {
        arm_to_toml(&self.best)
    }

    /// Names of the load cases with measured numbers, and the fitted arm in them.
    fn shapes(&self, py: Python<'_>) -> PyResult<Vec<(String, Py<PyAny>)>> {
        let name = |case: usize| self.cases.get(case).map(|case| case.name.clone()).unwrap_or_default();
        let options = Options::with_tol(self.options.tol);
        let one = |(case, shape): &(usize, Shape)| {
            let shape = match shape {
                Shape::Plane(shape) => Py::new(py, Solution::new((**shape).clone(), options))?.into_any(),
                Shape::Space(shape) => Py::new(py, SpatialSolution::new((**shape).clone(), options))?.into_any(),
            };
            Ok((name(*case), shape))
        };
        self.found.shapes.iter().map(one).collect()
    }

    /// Shapes with markers, residuals and correlations.
    fn figure(&self) -> Figure {
        Figure::new(fit_figure(&self.best.name, &self.cases, &self.found, &Page::default()))
    }
}
