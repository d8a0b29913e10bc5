//! The columns of measured shapes: what their heads say.

use hydrostat_identify::Quantity;

use crate::error::shortened;
use crate::format::{dimension_at, is_key, nearest};
use crate::quantity::Dimension;

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
    pub(crate) fn named(name: &str) -> Option<Self> {
        let index = |stem: &str| name.strip_prefix(stem)?.strip_prefix('[')?.strip_suffix(']')?.parse().ok();
        Some(match name {
            "x" => Self::X,
            "y" => Self::Y,
            "angle" => Self::Angle,
            "tangent" => Self::Tangent,
            "base force x" => Self::BaseForce(0),
            "base force y" => Self::BaseForce(1),
            "base moment" => Self::BaseMoment,
            _ => match (index("stroke"), index("tension")) {
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
}

/// A column with how it is headed.
#[derive(Debug, Clone)]
pub(crate) struct Head {
    pub(crate) column: Column,
    pub(crate) text: String,
    pub(crate) unit: String,
}

/// What a column head means.
pub(crate) fn head(text: &str) -> Result<Head, String> {
    let (name, unit) = match text.strip_suffix(']').and_then(|rest| rest.rsplit_once(" [")) {
        Some((name, unit)) => (name.trim(), unit.trim()),
        None => (text, ""),
    };
    let lower = name.to_lowercase();
    let (column, dimension) = if lower == "case" {
        (Column::Case, None)
    } else if lower == "s" {
        (Column::Place, Some(Dimension::Length))
    } else if lower == "sd position" {
        (Column::Deviation(None), Some(Dimension::Length))
    } else if let Some(measured) = Measured::named(&lower) {
        (Column::Value(measured), Some(measured.dimension()))
    } else if let Some(measured) = lower.strip_prefix("sd ").and_then(|name| Measured::named(name.trim())) {
        (Column::Deviation(Some(measured)), Some(measured.dimension()))
    } else if is_key(name) && name.contains('.') {
        let dimension = dimension_at(name);
        (Column::Setting(name.to_owned(), dimension), dimension)
    } else {
        return Err(unknown(&lower));
    };
    match dimension {
        None | Some(Dimension::Number) if !unit.is_empty() => {
            Err(format!("expected no unit, found [{}]", shortened(unit)))
        }
        None | Some(Dimension::Number) => Ok(()),
        Some(dimension) => check_unit(name, unit, dimension),
    }?;
    Ok(Head { column, text: text.to_owned(), unit: unit.to_owned() })
}

fn unknown(name: &str) -> String {
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
    let candidates = KNOWN.into_iter().chain(keys.iter().map(String::as_str));
    let hint = nearest(name, candidates).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
    format!(
        "is no column of measurements: expected {}, `sd` with one of the measured names, or a key of the arm file such as flow.speed{hint}",
        KNOWN.join(", ")
    )
}

fn check_unit(name: &str, unit: &str, dimension: Dimension) -> Result<(), String> {
    let units: Vec<&str> = dimension.units_shown();
    let expected = format!("expected {dimension} in {}", units.join(", "));
    if unit.is_empty() {
        return Err(format!(
            "{expected}; write the unit behind the name, as in \"{name} [{}]\"",
            units.first().unwrap_or(&"")
        ));
    }
    if dimension.spellings().any(|known| known == unit) {
        return Ok(());
    }
    let other = Dimension::ALL.into_iter().find(|other| other.spellings().any(|known| known == unit));
    Err(match other {
        Some(other) => format!("{expected}; `{unit}` is the unit of {other}"),
        None => format!("{expected}; `{}` is no unit known here", shortened(unit)),
    })
}
