//! What can be measured of an equilibrium.

use std::fmt;

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
