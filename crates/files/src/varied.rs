//! What is to vary, and over which range: `KEY=FROM:TO`.

use std::str::FromStr;

use hydrostat::Parameter;
use hydrostat::parameter::{UnknownParameter, names};
use serde::Serialize;

use crate::digits::number;
use crate::error::shortened;
use crate::format::{bracketed, dimension_at, home_of, nearest, synonym};
use crate::heads::head_of;
use crate::quantity::{Dimension, WrongValue, parted};
use crate::shared_unit::{PartialUnit, bare, shared_unit};

/// One quantity of an arm and the range over which it is to vary.
///
/// ```
/// use hydrostat_files::Varied;
///
/// let varied: Varied = "cable[0].tension=0:500 mN".parse().unwrap();
/// assert_eq!(varied.range, [0.0, 0.5]);
/// assert_eq!(varied.with_unit(0.25), "250 mN");
/// let varied: Varied = "arm.base.angle=0:180".parse().unwrap();
/// assert_eq!((varied.range[1], varied.unit), (std::f64::consts::PI, "deg"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Varied {
    /// Which.
    pub parameter: Parameter,
    /// From and to, in SI units (rad for angles).
    pub range: [f64; 2],
    /// The unit in which it is shown: the first that the range is written with, else that of bare numbers; empty for a
    /// plain number.
    pub unit: &'static str,
    /// How many of that unit an SI unit is.
    pub per_si: f64,
}

/// What varied and over which range, as documents have it.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct RangeOut {
    parameter: String,
    unit: &'static str,
    range: [f64; 2],
}

impl RangeOut {
    pub(crate) fn new(parameter: Parameter, range: [f64; 2]) -> Self {
        Self { parameter: parameter.to_string(), unit: parameter.unit(), range }
    }
}

/// Why a text does not say what is to vary.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum VariedError {
    /// Not of the form `KEY=FROM:TO`.
    #[error("{}: expected KEY=FROM:TO, such as cable[0].tension=\"0 N:0.5 N\" or flow.speed=0:0.5", shortened(.text))]
    Form {
        /// What was given.
        text: String,
    },
    /// Nothing that can vary.
    #[error("{}", unknown(source, .suggestion.as_ref()))]
    Unknown {
        /// What was given, and what can vary.
        source: UnknownParameter,
        /// The key that may have been meant.
        suggestion: Option<String>,
    },
    /// An end of the range that is no value of this quantity.
    #[error(transparent)]
    Value(#[from] WrongValue),
    /// A unit behind one end.
    #[error(transparent)]
    Unit(#[from] PartialUnit),
    /// A number of values, where there are as many as it takes.
    #[error(
        "{}: expected {}=FROM:TO, found a COUNT after the range: a path chooses its own points; for equally spaced values see \
         `hydrostat sweep --vary` and `hydrostat equilibria --over`",
        shortened(.text),
        shortened(.key)
    )]
    Count {
        /// The quantity.
        key: String,
        /// What was given.
        text: String,
    },
    /// A range without length.
    #[error("{}: expected a range with two different ends, found \"{}\" twice", shortened(.key), shortened(.text))]
    Empty {
        /// The quantity.
        key: String,
        /// Either end.
        text: String,
    },
}

pub(crate) fn hint(suggestion: Option<&String>) -> String {
    suggestion.map_or_else(String::new, |key| format!("; did you mean `{key}`?"))
}

/// With a suggestion the list of all keys is left out: it is long.
fn unknown(source: &UnknownParameter, suggestion: Option<&String>) -> String {
    match suggestion {
        Some(key) => format!("`{}` cannot vary along a path; did you mean `{key}`?", shortened(&source.name)),
        None => source.to_string(),
    }
}

impl FromStr for Varied {
    type Err = VariedError;

    fn from_str(text: &str) -> Result<Self, VariedError> {
        let form = || VariedError::Form { text: text.to_owned() };
        let (key, range) = text.split_once('=').ok_or_else(form)?;
        let parameter = parameter(key.trim())?;
        let (from, to) = range.split_once(':').ok_or_else(form)?;
        let key = parameter.to_string();
        let parts = to.split(':').map(|part| part.trim().trim_matches('"'));
        if to.contains(':') && parts.clone().all(|part| parted(part).is_some()) {
            return Err(VariedError::Count { key, text: text.to_owned() });
        }
        let dimension = dimension_at(&key).unwrap_or(Dimension::Number);
        let texts = shared_unit(dimension, &key, &[from, to], ":")?;
        let ends = [dimension.value_of(&key, &texts[0])?, dimension.value_of(&key, &texts[1])?];
        let range = ends.map(|(value, _)| value);
        if range[0] == range[1] {
            return Err(VariedError::Empty { key, text: to.trim().to_owned() });
        }
        let unit = ends.iter().find_map(|(_, unit)| *unit).unwrap_or(bare(dimension));
        Ok(Self { parameter, range, unit, per_si: dimension.per_si(unit).unwrap_or(1.0) })
    }
}

fn parameter(key: &str) -> Result<Parameter, VariedError> {
    bracketed(key).parse().map_err(|source| {
        let known = names();
        let last = key.rsplit('.').next().unwrap_or(key);
        let meant = synonym(last).map(str::to_owned).filter(|meant| known.contains(meant));
        let slip = || nearest(key, known.iter().map(String::as_str)).map(str::to_owned);
        let home = || home_of(last).filter(|home| known.contains(home));
        VariedError::Unknown { suggestion: meant.or_else(slip).or_else(home), source }
    })
}

/// Without the last digits, which rounding has left of what was meant: 90.00000000000001 is 90.
pub(crate) fn rounded(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

impl Varied {
    /// A value (SI) as a number of the unit shown.
    pub fn shown(&self, value: f64) -> f64 {
        rounded(value * self.per_si)
    }

    /// A value (SI) with the unit shown, to five digits.
    ///
    /// ```
    /// let varied: hydrostat_files::Varied = "flow.direction=0:1 rad".parse().unwrap();
    /// assert_eq!(varied.with_unit(0.5), "0.5 rad");
    /// ```
    pub fn with_unit(&self, value: f64) -> String {
        let text = format!("{} {}", number(self.shown(value)), self.unit);
        text.trim_end().to_owned()
    }

    /// `count` values from one end of the range to the other, equally spaced.
    pub fn values(&self, count: usize) -> Vec<f64> {
        let [from, to] = self.range;
        let last = count.saturating_sub(1).max(1);
        let fraction = |k: usize| k as f64 / last as f64;
        (0..count).map(|k| if k == last { to } else { rounded(from + fraction(k) * (to - from)) }).collect()
    }

    /// The quantity with its SI unit, as the head of a column: `flow_speed_m_s`.
    pub fn column(&self) -> String {
        head_of(&self.parameter.to_string(), self.parameter.unit())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        text.parse::<Varied>().unwrap_err().to_string()
    }

    #[test]
    fn ranges_take_units() {
        let read = |text: &str| text.parse::<Varied>().unwrap();
        let half = std::f64::consts::FRAC_PI_2;
        for (text, range, unit) in [
            ("cable[0].tension=0:100", [0.0, 100.0], "N"),
            ("cable.0.tension=0:100", [0.0, 100.0], "N"),
            ("cable[1].tension = 0 N : 1 kN", [0.0, 1000.0], "N"),
            ("cable[0].tension=\"0:200 mN\"", [0.0, 0.2], "mN"),
            ("flow.speed=0:36 km/h", [0.0, 10.0], "km/h"),
            ("flow.speed=5:20 cm/s", [0.05, 0.2], "cm/s"),
            ("flow.speed=50 mm/s:20 cm/s", [0.05, 0.2], "mm/s"),
            ("flow.direction=-90:90 deg", [-half, half], "deg"),
            ("arm.base.angle=1.5 rad:0", [1.5, 0.0], "rad"),
            ("tip.force[1]=0:-3", [0.0, -3.0], "N"),
            ("tip.moment=0:2 N mm", [0.0, 0.002], "N mm"),
            ("gravity.acceleration=0:1 g", [0.0, 9.80665], "g"),
            ("material.young=100 kPa:200 kPa", [1e5, 2e5], "kPa"),
            ("material.poisson=0.3:0.5", [0.3, 0.5], ""),
        ] {
            let varied = read(text);
            assert!(
                varied.range.iter().zip(range).all(|(a, b)| (a - b).abs() <= 1e-14 * b.abs()),
                "{text}: {varied:?}"
            );
            assert_eq!(varied.unit, unit, "{text}");
        }
        assert_eq!(read("flow.direction=0:90").with_unit(half), "90 deg");
        assert_eq!(read("flow.direction=0:90").shown(half), 90.0);
        assert_eq!(read("material.poisson=0.3:0.5").with_unit(0.25), "0.25");
    }

    #[test]
    fn every_parameter_has_a_dimension_and_it_is_its_unit() {
        for name in names() {
            let varied: Varied = format!("{name}=1:2").parse().unwrap();
            let unit = varied.parameter.unit();
            assert_eq!(dimension_at(&name).unwrap().per_si(unit).unwrap_or(1.0), 1.0, "{name}");
            assert_eq!(dimension_at(&name) == Some(Dimension::Number), unit.is_empty(), "{name}");
        }
        assert_eq!(dimension_at("arm.length.x"), None);
        assert_eq!(dimension_at("flow"), None);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for text in ["", "flow.speed", "flow.speed=1", "flow.speed=1;2"] {
            assert!(error(text).contains("expected KEY=FROM:TO"), "{text}");
        }
        assert!(error("flow.sped=0:1").ends_with("did you mean `flow.speed`?"));
        assert!(error("E=0:1").ends_with("did you mean `material.young`?"));
        assert!(error("flow.speed=0:1:20").contains("found a COUNT after the range"));
        assert!(error("tension=0:1").ends_with("did you mean `cable[0].tension`?"));
        assert!(error("arm.inner_radius=0:1").contains("keys that can: cable[0].tension, cable[0].stroke, flow.speed"));
        assert!(error("flow.speed=0:1 N").contains("expected a speed"));
        assert!(error("flow.speed=0:1 N").contains("`N` is the unit of a force"));
        assert!(error("flow.speed=0:").contains("does not start with a number"));
        assert!(error("flow.speed=nan:1").contains("does not start with a number"));
        assert!(error("flow.speed=0:1e999").contains("too large"));
        assert!(error("material.poisson=0:0.5 m").contains("a number without unit"));
        assert!(error("flow.speed=1 m/s:100 cm/s").contains("two different ends"));
        let said = error("flow.speed=5 cm/s:20");
        assert!(said.contains("\"5:20 cm/s\"") && said.contains("\"5 cm/s:20 m/s\""), "{said}");
    }

    #[test]
    fn values_are_equally_spaced_and_columns_named() {
        let varied: Varied = "flow.speed=0:10 cm/s".parse().unwrap();
        assert_eq!(varied.values(3), [0.0, 0.05, 0.1]);
        assert_eq!(varied.values(1), [0.0]);
        assert_eq!(varied.column(), "flow_speed_m_s");
        assert_eq!("tip.moment=0:1".parse::<Varied>().unwrap().column(), "tip_moment_Nm");
        assert_eq!("material.poisson=0:0.1".parse::<Varied>().unwrap().column(), "material_poisson");
    }
}
