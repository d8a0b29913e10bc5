//! Load cases that were not fitted, as a fit predicts them.

use rayon::prelude::*;

use crate::data::{Case, Fitted};
use crate::error::{IdentifyError, Trial};
use crate::fit::{Fit, FitOptions, Residual, residuals_of};
use crate::model::{Answer, Observed};
use crate::shape::Shape;
use crate::unknown::Unknown;

/// A load case that was not fitted.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// Index of the load case.
    pub case: usize,
    /// What the fitted arm has of each measured number, and its shape; or why it has none.
    pub found: Result<(Vec<Residual>, Shape), Trial>,
}

/// What the fitted arm has in load cases that it was not fitted to; those without measured numbers are left out.
///
/// ```
/// use hydrostat::{Arm, Cable, Parameter, Profile};
/// use hydrostat_identify::{Case, FitOptions, Fitted, Measurement, Quantity, fit, predict};
///
/// let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
/// arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
/// let case = |tension: f64| {
///     let mut arm = arm.clone();
///     arm.cables[0].tension = tension;
///     let y = arm.solve().expect("small tensions").tip().y;
///     Case { name: tension.to_string(), arm, measurements: vec![Measurement::new(Quantity::Y(0.245), y, 1e-3)] }
/// };
/// let options = FitOptions::default();
/// let young = Fitted { start: 90e3, ..Fitted::new(Parameter::Young, &arm).expect("a cone is homogeneous") };
/// let found = fit(&[case(0.1)], &[young], &options, |_| true)?;
/// let others = predict(&found, &[case(0.2)], &options)?;
/// let (residuals, _) = others[0].found.as_ref().expect("there is such a shape");
/// assert!(residuals[0].standardised.abs() < 1e-3);
/// # Ok::<(), hydrostat_identify::IdentifyError>(())
/// ```
///
/// # Errors
/// [`IdentifyError`] for measurements or parameters that a case does not have.
pub fn predict(fit: &Fit, cases: &[Case], options: &FitOptions) -> Result<Vec<Prediction>, IdentifyError> {
    let fitted: Vec<Fitted> = fit.estimates.iter().map(|one| Fitted { start: one.value, ..one.fitted }).collect();
    let unknowns: Vec<Unknown> = fitted.iter().map(|one| one.parameter).collect();
    let values: Vec<f64> = fitted.iter().map(|one| one.start).collect();
    let measured = (0..cases.len()).filter(|i| !cases[*i].measurements.is_empty());
    let observed = measured.map(|i| Ok((i, Observed::new(&cases[i], true, &fitted, options.tol)?)));
    let observed: Vec<(usize, Observed)> = observed.collect::<Result<_, IdentifyError>>()?;
    let one = |(case, mut own): (usize, Observed)| {
        let found = own.answer(&unknowns, &values);
        let found =
            found.map(|Answer { values, shape, .. }| (residuals_of(&own.case, case, &values, options.loss), shape));
        let found = found.map(|(residuals, shape)| shape.map(|shape| (residuals, shape)));
        Some(Prediction { case, found: found.transpose()? })
    };
    Ok(observed.into_par_iter().filter_map(one).collect())
}
