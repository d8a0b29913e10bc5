//! The columns of measured shapes: what their heads say.

use hydrostat_identify::Quantity;

use crate::error::shortened;
use crate::format::{dimension_at, nearest};
use crate::heads::{identifier, key_named, readings, unit_of};
use crate::quantity::Dimension;
use crate::results::{INNER, THETA};

/// What a measured column is of; places are in another column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Measured {
    X,
    Y,
    Angle,
    Tangent,
    Stroke(usize),
    Tension(usize),
    BaseForce(usize),
    BaseMoment,
}

impl Measured {
    /// By its name as an identifier: `base_force_x`, `stroke_0`.
    fn named(name: &str) -> Option<Self> {
        let index = |stem: &str| name.strip_prefix(stem)?.parse().ok();
        Some(match name {
            "x" => Self::X,
            "y" => Self::Y,
            "angle" => Self::Angle,
            "tangent" => Self::Tangent,
            "base_force_x" => Self::BaseForce(0),
            "base_force_y" => Self::BaseForce(1),
            "base_moment" => Self::BaseMoment,
            _ => match (index("stroke_"), index("tension_")) {
                (Some(c), _) => Self::Stroke(c),
                (_, Some(c)) => Self::Tension(c),
                _ => return None,
            },
        })
    }

    pub(crate) fn dimension(self) -> Dimension {
        match self {
            Self::X | Self::Y | Self::Stroke(_) => Dimension::Length,
            Self::Angle | Self::Tangent => Dimension::Angle,
            Self::Tension(_) | Self::BaseForce(_) => Dimension::Force,
            Self::BaseMoment => Dimension::Moment,
        }
    }

    pub(crate) fn at(self, s: f64) -> Quantity {
        match self {
            Self::X => Quantity::X(s),
            Self::Y => Quantity::Y(s),
            Self::Angle => Quantity::Angle(s),
            Self::Tangent => Quantity::Tangent(s),
            Self::Stroke(c) => Quantity::Stroke(c),
            Self::Tension(c) => Quantity::Tension(c),
            Self::BaseForce(k) => Quantity::BaseForce(k),
            Self::BaseMoment => Quantity::BaseMoment,
        }
    }
}

/// What a column has.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Column {
    Case,
    Place,
    Value(Measured),
    /// Of one quantity, or of x and y.
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
    let inner = if text == THETA { Some(Column::Theta) } else { INNER.contains(&text).then_some(Column::Inner) };
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

/// The column of a name, with what it measures.
fn named(name: &str) -> Option<(Column, Option<Dimension>)> {
    let plain = identifier(&name.to_lowercase());
    Some(match plain.as_str() {
        "case" => (Column::Case, None),
        "s" => (Column::Place, Some(Dimension::Length)),
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
    const KNOWN: [&str; 12] = [
        "case",
        "s",
        "x",
        "y",
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
