//! The columns of measured shapes: what their heads say.

use hydrostat_identify::{Marker, Quantity};

use crate::error::shortened;
use crate::format::{dimension_at, nearest};
use crate::heads::{identifier, key_named, readings, unit_of};
use crate::quantity::Dimension;
use crate::results::{INNER, THETA};
use crate::spatial_results::INNER_IN_SPACE;

/// What a measured column is of; places are in another column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Measured {
    X,
    Y,
    Z,
    Angle,
    Tangent,
    Stroke(usize),
    Tension(usize),
    BaseForce(usize),
    BaseMoment,
    BaseMomentAbout(usize),
}

impl Measured {
    /// By its name as an identifier: `base_force_x`, `stroke_0`.
    fn named(name: &str) -> Option<Self> {
        let index = |stem: &str| name.strip_prefix(stem)?.parse().ok();
        Some(match name {
            "x" => Self::X,
            "y" => Self::Y,
            "z" => Self::Z,
            "angle" => Self::Angle,
            "tangent" => Self::Tangent,
            "base_force_x" => Self::BaseForce(0),
            "base_force_y" => Self::BaseForce(1),
            "base_force_z" => Self::BaseForce(2),
            "base_moment" | "base_moment_z" => Self::BaseMoment,
            "base_moment_x" => Self::BaseMomentAbout(0),
            "base_moment_y" => Self::BaseMomentAbout(1),
            _ => match (index("stroke_"), index("tension_")) {
                (Some(c), _) => Self::Stroke(c),
                (_, Some(c)) => Self::Tension(c),
                _ => return None,
            },
        })
    }

    pub(crate) fn dimension(self) -> Dimension {
        match self {
            Self::X | Self::Y | Self::Z | Self::Stroke(_) => Dimension::Length,
            Self::Angle | Self::Tangent => Dimension::Angle,
            Self::Tension(_) | Self::BaseForce(_) => Dimension::Force,
            Self::BaseMoment | Self::BaseMomentAbout(_) => Dimension::Moment,
        }
    }

    /// Whether it is a coordinate of a marker.
    pub(crate) fn is_position(self) -> bool {
        matches!(self, Self::X | Self::Y | Self::Z)
    }

    pub(crate) fn at(self, Marker { s, offset }: Marker) -> Quantity {
        let coordinate = |axis| Quantity::of_marker(Marker { s, offset }, axis);
        match self {
            Self::X => coordinate(0),
            Self::Y => coordinate(1),
            Self::Z => coordinate(2),
            Self::Angle => Quantity::Angle(s),
            Self::Tangent => Quantity::Tangent(s),
            Self::Stroke(c) => Quantity::Stroke(c),
            Self::Tension(c) => Quantity::Tension(c),
            Self::BaseForce(k) => Quantity::BaseForce(k),
            Self::BaseMoment => Quantity::BaseMoment,
            Self::BaseMomentAbout(k) => Quantity::BaseMomentAbout(k),
        }
    }
}

/// What a column has.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Column {
    Case,
    Place,
    /// Of a marker from the centreline along a (0), b (1) or c (2).
    Offset(usize),
    Value(Measured),
    /// Of one quantity, or of x, y and z.
    Deviation(Option<Measured>),
    /// A key of the arm file, with what it measures; `None` for words.
    Setting(String, Option<Dimension>),
    /// The section's angle in a table of stations, which is measured where such tables are not computed.
    Theta,
    /// What tables of stations have and nobody measures.
    Inner,
}

/// A column with how it is headed.
#[derive(Debug, Clone)]
pub(crate) struct Head {
    pub(crate) column: Column,
    pub(crate) text: String,
    pub(crate) unit: String,
}

/// What a column head means: a name with its unit, as `x [mm]` or as `x_mm`.
pub(crate) fn head(text: &str) -> Result<Head, String> {
    let inner = if text == THETA { Some(Column::Theta) } else { is_inner(text).then_some(Column::Inner) };
    if let Some(column) = inner {
        return Ok(Head { column, text: text.to_owned(), unit: "rad".to_owned() });
    }
    let readings = readings(text);
    let mut refused = None;
    for (name, unit) in &readings {
        let Some((column, dimension)) = named(name) else { continue };
        match unit_in_head(name, unit, dimension) {
            Ok(unit) => return Ok(Head { column, text: text.to_owned(), unit: unit.to_owned() }),
            // The longest name is the one that was meant.
            Err(why) => refused = refused.or(Some(why)),
        }
    }
    Err(refused.unwrap_or_else(|| unknown(&readings)))
}

/// Whether a table of stations has this head and nobody measures it.
fn is_inner(text: &str) -> bool {
    INNER.contains(&text) || INNER_IN_SPACE.contains(&text)
}

/// The column of a name, with what it measures.
fn named(name: &str) -> Option<(Column, Option<Dimension>)> {
    let plain = identifier(&name.to_lowercase());
    Some(match plain.as_str() {
        "case" => (Column::Case, None),
        "s" => (Column::Place, Some(Dimension::Length)),
        "offset_a" => (Column::Offset(0), Some(Dimension::Length)),
        "offset_b" => (Column::Offset(1), Some(Dimension::Length)),
        "offset_c" => (Column::Offset(2), Some(Dimension::Length)),
        "sd_position" => (Column::Deviation(None), Some(Dimension::Length)),
        _ => {
            if let Some(measured) = Measured::named(&plain) {
                (Column::Value(measured), Some(measured.dimension()))
            } else if let Some(measured) = plain.strip_prefix("sd_").and_then(Measured::named) {
                (Column::Deviation(Some(measured)), Some(measured.dimension()))
            } else {
                let key = key_named(name).filter(|key| key.contains('.'))?;
                let dimension = dimension_at(&key);
                (Column::Setting(key, dimension), dimension)
            }
        }
    })
}

/// The unit of a column as it is spelled in arm files; none of words and plain numbers.
fn unit_in_head(name: &str, unit: &str, dimension: Option<Dimension>) -> Result<&'static str, String> {
    match dimension {
        None | Some(Dimension::Number) if !unit.is_empty() => {
            Err(format!("expected no unit, found [{}]", shortened(unit)))
        }
        None | Some(Dimension::Number) => Ok(""),
        Some(dimension) => match unit_of(dimension, unit) {
            Some(known) => Ok(known),
            None => Err(wrong_unit(name, unit, dimension)),
        },
    }
}

fn unknown(readings: &[(&str, &str)]) -> String {
    const KNOWN: [&str; 14] = [
        "case",
        "s",
        "offset_b",
        "x",
        "y",
        "z",
        "angle",
        "tangent",
        "stroke[0]",
        "tension[0]",
        "base force x",
        "base force y",
        "base moment",
        "sd position",
    ];
    let keys = hydrostat::parameter::names();
    let near = readings.iter().find_map(|(name, _)| {
        let candidates = KNOWN.into_iter().chain(keys.iter().map(String::as_str));
        nearest(&name.to_lowercase(), candidates).map(str::to_owned)
    });
    let hint = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    format!(
        "is not a column of measurements: expected {}, `sd` with one of the measured names, or a key of the arm file such as flow.speed{hint}",
        KNOWN.join(", ")
    )
}

fn wrong_unit(name: &str, unit: &str, dimension: Dimension) -> String {
    let units: Vec<&str> = dimension.units_shown();
    let expected = format!("expected {dimension} in {}", units.join(", "));
    if unit.is_empty() {
        return format!(
            "{expected}; write the unit behind the name, as in \"{name} [{}]\"",
            units.first().unwrap_or(&"")
        );
    }
    match Dimension::ALL.into_iter().find(|other| unit_of(*other, unit).is_some()) {
        Some(other) => format!("{expected}; `{unit}` is the unit of {other}"),
        None => format!("{expected}; `{}` is not a known unit here", shortened(unit)),
    }
}
