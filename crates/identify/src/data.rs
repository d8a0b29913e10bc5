//! What was measured, and what is to be found from it.

use hydrostat::parameter::Unfit;
use hydrostat::{Arm, Parameter};

use crate::quantity::Quantity;
use crate::unknown::Unknown;

/// A measured number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Of what.
    pub quantity: Quantity,
    /// In its unit.
    pub value: f64,
    /// Standard deviation of its error, above zero.
    pub sd: f64,
    /// The row of the file that it came from, from 1; 0 for none.
    pub row: usize,
}

impl Measurement {
    /// A number that came from no file.
    pub fn new(quantity: Quantity, value: f64, sd: f64) -> Self {
        Self { quantity, value, sd, row: 0 }
    }
}

/// One load case: an arm under known loads, and what was measured of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// For people.
    pub name: String,
    /// The arm under the loads of this case. What is fitted is set in it, whatever it has there.
    pub arm: Arm,
    /// What was measured.
    pub measurements: Vec<Measurement>,
}

/// What was known of a parameter before: a normal distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// In [`Unknown::unit`].
    pub mean: f64,
    /// Standard deviation, above zero.
    pub sd: f64,
}

/// A number that is to be found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// Which.
    pub parameter: Unknown,
    /// Where the search starts, in [`Unknown::unit`] as all values here.
    pub start: f64,
    /// From and to, which may be infinite.
    pub bounds: [f64; 2],
    /// What was known of it.
    pub prior: Option<Prior>,
}

impl Fitted {
    /// `parameter`, from its value in `arm`, within what makes an arm.
    ///
    /// # Errors
    /// [`Unfit`] when the arm has no such quantity.
    pub fn new(parameter: impl Into<Unknown>, arm: &Arm) -> Result<Self, Unfit> {
        let parameter = parameter.into();
        Ok(Self { parameter, start: parameter.of(arm)?, bounds: natural_bounds(parameter), prior: None })
    }
}

/// Between which values a parameter makes an arm; the ends themselves may make none.
pub fn natural_bounds(parameter: impl Into<Unknown>) -> [f64; 2] {
    const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];
    let parameter = match parameter.into() {
        Unknown::Of(parameter) => parameter,
        Unknown::TensionFactor | Unknown::CableFactor(_) => return POSITIVE,
        Unknown::Base(_) => return [f64::NEG_INFINITY, f64::INFINITY],
    };
    match parameter {
        Parameter::Young
        | Parameter::ShearFactor
        | Parameter::Coefficient(_)
        | Parameter::Tension(_)
        | Parameter::FlowSpeed
        | Parameter::FlowDensity
        | Parameter::GravityAcceleration
        | Parameter::Density
        | Parameter::Radius(_)
        | Parameter::Length
        | Parameter::DragNormal
        | Parameter::DragTangential => POSITIVE,
        Parameter::Poisson => [-1.0, 0.5],
        _ => [f64::NEG_INFINITY, f64::INFINITY],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_could_be_searched_for_below_zero() {
        assert_eq!(natural_bounds(Parameter::Radius(hydrostat::Point::Knot(0))), [0.0, f64::INFINITY]);
    }
}
