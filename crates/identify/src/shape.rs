//! The equilibrium of a load case, in the plane or in space, and what it has of a measured quantity.

use hydrostat::{Arm, Configuration, SpatialConfiguration, SpatialStation, Station};

use crate::quantity::{Marker, Quantity};

/// An equilibrium.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Of an arm in the plane.
    Plane(Box<Configuration>),
    /// Of an arm in space.
    Space(Box<SpatialConfiguration>),
}

impl Shape {
    /// The arm with the loads that it balances.
    pub fn arm(&self) -> &Arm {
        match self {
            Self::Plane(shape) => &shape.arm,
            Self::Space(shape) => &shape.arm,
        }
    }

    /// What it has of a quantity; NaN where it has no such one.
    pub fn value(&self, quantity: Quantity) -> f64 {
        match self {
            Self::Plane(shape) => value_of(shape, quantity),
            Self::Space(shape) => value_in_space(shape, quantity),
        }
    }

    /// Where a marker is, m.
    pub fn place(&self, marker: Marker) -> [f64; 3] {
        match self {
            Self::Plane(shape) => {
                let at = shape.at(marker.s);
                let [x, y] = off_in_plane(&at, marker.offset);
                [at.x + x, at.y + y, 0.0]
            }
            Self::Space(shape) => {
                let at = shape.at(marker.s);
                let off = off_in_space(&at, marker.offset);
                [at.x + off[0], at.y + off[1], at.z + off[2]]
            }
        }
    }
}

/// From the centreline to a marker, m.
pub(crate) fn off_in_plane(at: &Station, [a, b, _]: [f64; 3]) -> [f64; 2] {
    let (sin, cos) = at.theta.sin_cos();
    [a * cos - b * sin, a * sin + b * cos]
}

/// From the centreline to a marker, m.
pub(crate) fn off_in_space(at: &SpatialStation, [a, b, c]: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a * at.a[k] + b * at.b[k] + c * at.c[k])
}

/// What a configuration has of a quantity; NaN where it has no such one.
pub fn value_of(shape: &Configuration, quantity: Quantity) -> f64 {
    if let Quantity::Off(marker, axis @ 0..2) = quantity {
        let at = shape.at(marker.s);
        return [at.x, at.y][axis] + off_in_plane(&at, marker.offset)[axis];
    }
    match quantity {
        Quantity::X(s) => shape.at(s).x,
        Quantity::Y(s) => shape.at(s).y,
        Quantity::Angle(s) => shape.at(s).theta,
        Quantity::Tangent(s) => {
            let place = shape.at(s);
            place.theta + place.alpha
        }
        Quantity::Stroke(c) => shape.cables.get(c).map_or(f64::NAN, |cable| cable.stroke),
        Quantity::Tension(c) => shape.cables.get(c).map_or(f64::NAN, |cable| cable.tension),
        Quantity::BaseForce(axis @ 0..2) => shape.base_reaction.force[axis],
        Quantity::BaseMoment => shape.base_reaction.moment,
        Quantity::Z(_) | Quantity::Off(..) | Quantity::BaseForce(_) | Quantity::BaseMomentAbout(_) => f64::NAN,
    }
}

/// [`value_of`] in space.
pub fn value_in_space(shape: &SpatialConfiguration, quantity: Quantity) -> f64 {
    if let Some((marker, axis)) = quantity.marker() {
        let at = shape.at(marker.s);
        return [at.x, at.y, at.z][axis] + off_in_space(&at, marker.offset)[axis];
    }
    match quantity {
        Quantity::Stroke(c) => shape.cables.get(c).map_or(f64::NAN, |cable| cable.stroke),
        Quantity::Tension(c) => shape.cables.get(c).map_or(f64::NAN, |cable| cable.tension),
        Quantity::BaseForce(axis) => shape.base_reaction.force[axis.min(2)],
        Quantity::BaseMoment => shape.base_reaction.moment[2],
        Quantity::BaseMomentAbout(axis) => shape.base_reaction.moment[axis.min(1)],
        _ => f64::NAN,
    }
}
