//! What was measured, and what is to be found from it.

use std::fmt;

use hydrostat::parameter::Unfit;
use hydrostat::{Arm, Parameter};

/// One number of an equilibrium that can be measured. Places are in metres along the arm before anything acts, in [0, L].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Quantity {
    /// x of the centreline at a place, m.
    X(f64),
    /// y of the centreline at a place, m.
    Y(f64),
    /// Angle of the section at a place, rad: of its normal from e1.
    Angle(f64),
    /// Angle of the centreline's tangent at a place, rad from e1: what a picture shows. It differs from the section's by the shear.
    Tangent(f64),
    /// Stroke of a cable that is pulled with a given tension, m, positive when reeled in.
    Stroke(usize),
    /// Tension at the base of a cable whose stroke is commanded, N.
    Tension(usize),
    /// Force on the arm at its base along e1 (0) or e2 (1), N.
    BaseForce(usize),
    /// Moment on the arm at its base, N m.
    BaseMoment,
}

impl Quantity {
    /// The unit of its values.
    pub fn unit(self) -> &'static str {
        match self {
            Self::X(_) | Self::Y(_) | Self::Stroke(_) => "m",
            Self::Angle(_) | Self::Tangent(_) => "rad",
            Self::Tension(_) | Self::BaseForce(_) => "N",
            Self::BaseMoment => "N m",
        }
    }

    /// Its name without its place.
    pub fn name(self) -> String {
        match self {
            Self::X(_) => "x".to_owned(),
            Self::Y(_) => "y".to_owned(),
            Self::Angle(_) => "angle".to_owned(),
            Self::Tangent(_) => "tangent".to_owned(),
            Self::Stroke(c) => format!("stroke[{c}]"),
            Self::Tension(c) => format!("tension[{c}]"),
            Self::BaseForce(0) => "base force x".to_owned(),
            Self::BaseForce(_) => "base force y".to_owned(),
            Self::BaseMoment => "base moment".to_owned(),
        }
    }

    /// Where along the arm, m, if it is at a place.
    pub fn place(self) -> Option<f64> {
        match self {
            Self::X(s) | Self::Y(s) | Self::Angle(s) | Self::Tangent(s) => Some(s),
            _ => None,
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())?;
        match self.place() {
            Some(s) => write!(f, " at s = {} mm", (1e6 * s).round() / 1e3),
            None => Ok(()),
        }
    }
}

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
    /// In [`Parameter::unit`].
    pub mean: f64,
    /// Standard deviation, above zero.
    pub sd: f64,
}

/// A parameter that is to be found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// Which.
    pub parameter: Parameter,
    /// Where the search starts, in [`Parameter::unit`] as all values here.
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
    pub fn new(parameter: Parameter, arm: &Arm) -> Result<Self, Unfit> {
        Ok(Self { parameter, start: parameter.of(arm)?, bounds: natural_bounds(parameter), prior: None })
    }
}

/// Between which values a parameter makes an arm; the ends themselves may make none.
pub fn natural_bounds(parameter: Parameter) -> [f64; 2] {
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
        | Parameter::DragTangential => [0.0, f64::INFINITY],
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
