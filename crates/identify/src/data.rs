//! What was measured, and what is to be found from it.

use std::fmt;

use hydrostat::parameter::Unfit;
use hydrostat::{Arm, Parameter};

use crate::unknown::Unknown;

/// One number of an equilibrium that can be measured. Places are in metres along the arm before anything acts, in [0, L].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Quantity {
    /// x of the centreline at a place, m.
    X(f64),
    /// y of the centreline at a place, m.
    Y(f64),
    /// z of the centreline at a place, m, of an arm in space.
    Z(f64),
    /// x (0), y (1) or z (2) of a marker beside the centreline, m.
    Off(Marker, usize),
    /// Angle of the section at a place, rad: of its normal from e1.
    Angle(f64),
    /// Angle of the centreline's tangent at a place, rad from e1: what a picture shows. It differs from the section's by the shear.
    Tangent(f64),
    /// Stroke of a cable that is pulled with a given tension, m, positive when reeled in.
    Stroke(usize),
    /// Tension at the base of a cable whose stroke is commanded, N.
    Tension(usize),
    /// Force on the arm at its base along e1 (0) or e2 (1), of an arm in space e3 (2), N.
    BaseForce(usize),
    /// Moment on the arm at its base, of an arm in space that about e3, N m.
    BaseMoment,
    /// Moment on an arm in space at its base about e1 (0) or e2 (1), N m.
    BaseMomentAbout(usize),
}

/// A marker that is held beside the centreline: a rod that turns with the section and keeps its length, however the section swells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marker {
    /// Where its rod starts on the centreline, m.
    pub s: f64,
    /// From there along the section's directors a, b and c, m; in the plane along its normal and 90 degrees to the left of it.
    pub offset: [f64; 3],
}

impl Quantity {
    /// Coordinate `axis` (0 to 2) of a marker: of the centreline itself where it has no offset.
    pub fn of_marker(marker: Marker, axis: usize) -> Self {
        match (marker.offset == [0.0; 3], axis) {
            (false, _) => Self::Off(marker, axis.min(2)),
            (true, 0) => Self::X(marker.s),
            (true, 1) => Self::Y(marker.s),
            (true, _) => Self::Z(marker.s),
        }
    }

    /// The marker that it is a coordinate of, and which.
    pub fn marker(self) -> Option<(Marker, usize)> {
        let on = |s: f64| Marker { s, offset: [0.0; 3] };
        match self {
            Self::X(s) => Some((on(s), 0)),
            Self::Y(s) => Some((on(s), 1)),
            Self::Z(s) => Some((on(s), 2)),
            Self::Off(marker, axis) => Some((marker, axis.min(2))),
            _ => None,
        }
    }

    /// The unit of its values.
    pub fn unit(self) -> &'static str {
        match self {
            Self::X(_) | Self::Y(_) | Self::Z(_) | Self::Off(..) | Self::Stroke(_) => "m",
            Self::Angle(_) | Self::Tangent(_) => "rad",
            Self::Tension(_) | Self::BaseForce(_) => "N",
            Self::BaseMoment | Self::BaseMomentAbout(_) => "N m",
        }
    }

    /// Its name without its place.
    pub fn name(self) -> String {
        match self {
            Self::X(_) | Self::Off(_, 0) => "x".to_owned(),
            Self::Y(_) | Self::Off(_, 1) => "y".to_owned(),
            Self::Z(_) | Self::Off(..) => "z".to_owned(),
            Self::Angle(_) => "angle".to_owned(),
            Self::Tangent(_) => "tangent".to_owned(),
            Self::Stroke(c) => format!("stroke[{c}]"),
            Self::Tension(c) => format!("tension[{c}]"),
            Self::BaseForce(0) => "base force x".to_owned(),
            Self::BaseForce(1) => "base force y".to_owned(),
            Self::BaseForce(_) => "base force z".to_owned(),
            Self::BaseMoment => "base moment".to_owned(),
            Self::BaseMomentAbout(0) => "base moment x".to_owned(),
            Self::BaseMomentAbout(_) => "base moment y".to_owned(),
        }
    }

    /// Where along the arm, m, if it is at a place.
    pub fn place(self) -> Option<f64> {
        match self {
            Self::X(s) | Self::Y(s) | Self::Z(s) | Self::Angle(s) | Self::Tangent(s) => Some(s),
            Self::Off(marker, _) => Some(marker.s),
            _ => None,
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())?;
        let mm = |length: f64| (1e6 * length).round() / 1e3;
        if let Some(s) = self.place() {
            write!(f, " at s = {} mm", mm(s))?;
        }
        if let Self::Off(Marker { offset: [a, b, c], .. }, _) = self {
            write!(f, ", beside by ({}, {}, {}) mm", mm(*a), mm(*b), mm(*c))?;
        }
        Ok(())
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
