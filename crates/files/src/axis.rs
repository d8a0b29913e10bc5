//! What a sweep varies: a key of the arm file with a grid, a list, or a range to draw from.

use std::str::FromStr;

use hydrostat::parameter::names;

use crate::error::shortened;
use crate::format::{bracketed, dimension_at, home_of, is_key, nearest, synonym};
use crate::heads::head_of;
use crate::quantity::{Dimension, WrongValue};
use crate::shared_unit::{PartialUnit, bare, shared_unit};
use crate::varied::{hint, rounded};

/// The most values of one key.
const MOST: u64 = 1_000_000_000;

/// One key and its values: `KEY=FROM:TO:COUNT`, `KEY=V1,V2,...` or, to draw from, `KEY=FROM:TO`.
///
/// ```
/// use hydrostat_files::{Axis, AxisValue, AxisValues};
///
/// let axis: Axis = "cable[0].tension=0:500 mN:3".parse().unwrap();
/// assert_eq!(axis.value(1), Some(AxisValue::Number(0.25)));
/// assert_eq!((axis.values.count(), axis.column().as_str()), (Some(3), "cable_0_tension_N"));
/// let axis: Axis = "model.volume=planar,none".parse().unwrap();
/// assert_eq!(axis.value(1), Some(AxisValue::Word("none")));
/// let axis: Axis = "arm.radius.tip=1 mm:2 mm".parse().unwrap();
/// assert_eq!(axis.values, AxisValues::Span { from: 0.001, to: 0.002 });
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The dotted key.
    pub key: String,
    /// What it measures; `None` where it is text or is not a key of the arm file.
    pub dimension: Option<Dimension>,
    /// The unit in which it is shown; empty for a plain number and for text.
    pub unit: &'static str,
    /// Its values.
    pub values: AxisValues,
}

/// The values of a key, numbers in SI units (rad for angles).
#[derive(Debug, Clone, PartialEq)]
pub enum AxisValues {
    /// Equally spaced, both ends included.
    Even {
        /// The first.
        from: f64,
        /// The last.
        to: f64,
        /// How many, at least one.
        count: u64,
    },
    /// Any number between two.
    Span {
        /// One end.
        from: f64,
        /// The other end.
        to: f64,
    },
    /// These numbers.
    List(Vec<f64>),
    /// These words.
    Words(Vec<String>),
}

/// One value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AxisValue<'a> {
    /// In SI units.
    Number(f64),
    /// As it stands in the arm file.
    Word(&'a str),
}

/// The key that may have been meant, or where the keys are listed.
fn suggested(suggestion: Option<&String>) -> String {
    match suggestion {
        None => "; `hydrostat check ARM` lists the keys, such as cable[0].tension".to_owned(),
        some => hint(some),
    }
}

/// Why a text is not a key with its values.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AxisError {
    /// Not of the form `KEY=VALUES`.
    #[error("{}: expected KEY=FROM:TO:COUNT, KEY=V1,V2,... or, for a sample, KEY=FROM:TO, such as flow.speed=0:0.5:26", shortened(.text))]
    Form {
        /// What was given.
        text: String,
    },
    /// No key of the arm file.
    #[error("{}: unknown key of the arm file{}", shortened(.key), suggested(.suggestion.as_ref()))]
    Unknown {
        /// What was given.
        key: String,
        /// The key that may have been meant.
        suggestion: Option<String>,
    },
    /// No values.
    #[error("{}: expected at least one value, found none", shortened(.key))]
    Empty {
        /// The key.
        key: String,
    },
    /// A count that is none.
    #[error("{}: expected a whole number from 1 to {MOST} as COUNT, found \"{}\"", shortened(.key), shortened(.text))]
    Count {
        /// The key.
        key: String,
        /// What was given.
        text: String,
    },
    /// Two ends with one value, or one end with many.
    #[error(
        "{}: expected {}, found {count} values from {} to {}",
        shortened(.key),
        if *.count == 1 { "two ends that are the same with one value" } else { "two different ends" },
        shortened(.from),
        shortened(.to)
    )]
    Ends {
        /// The key.
        key: String,
        /// The ends as given.
        from: String,
        /// The ends as given.
        to: String,
        /// How many values.
        count: u64,
    },
    /// A range of words.
    #[error("{}: expected words separated by commas, because the values of this key are not numbers, found \"{}\"", shortened(.key), shortened(.text))]
    Range {
        /// The key.
        key: String,
        /// What was given.
        text: String,
    },
    /// A value of another kind.
    #[error(transparent)]
    Value(#[from] WrongValue),
    /// A unit behind some of the numbers.
    #[error(transparent)]
    Unit(#[from] PartialUnit),
}

/// Numbers of one dimension, and the first unit that they were written with.
fn numbers(
    dimension: Dimension,
    key: &str,
    parts: &[&str],
    join: &str,
) -> Result<(Vec<f64>, Option<&'static str>), AxisError> {
    let (mut values, mut shown) = (Vec::with_capacity(parts.len()), None);
    for text in shared_unit(dimension, key, parts, join)? {
        let (value, unit) = dimension.value_of(key, &text)?;
        values.push(value);
        shown = shown.or(unit);
    }
    Ok((values, shown))
}

impl FromStr for Axis {
    type Err = AxisError;

    fn from_str(text: &str) -> Result<Self, AxisError> {
        let (key, given) = text.split_once('=').ok_or_else(|| AxisError::Form { text: text.to_owned() })?;
        let (key, given) = (bracketed(key.trim()), given.trim().trim_matches('"'));
        if key.is_empty() {
            return Err(AxisError::Form { text: text.to_owned() });
        }
        let parts = || given.split(',').map(|part| part.trim().trim_matches('"').trim());
        if parts().any(str::is_empty) {
            return Err(AxisError::Empty { key });
        }
        let Some(dimension) = dimension_at(&key) else {
            if !is_key(&key) {
                let last = key.rsplit('.').next().unwrap_or(&key);
                let near = || nearest(&key, names().iter().map(String::as_str)).map(str::to_owned);
                let slip = synonym(last).map(str::to_owned).or_else(near);
                return Err(AxisError::Unknown { suggestion: slip.or_else(|| home_of(last)), key });
            }
            if given.contains(':') {
                return Err(AxisError::Range { key, text: given.to_owned() });
            }
            let values = AxisValues::Words(parts().map(str::to_owned).collect());
            return Ok(Self { key, dimension: None, unit: "", values });
        };
        let (values, unit) = if given.contains(':') {
            let pieces: Vec<&str> = given.split(':').collect();
            match pieces[..] {
                [from, to] => {
                    let (ends, unit) = numbers(dimension, &key, &[from, to], ":")?;
                    (AxisValues::Span { from: ends[0], to: ends[1] }, unit)
                }
                [from, to, count] => {
                    let (ends, unit) = numbers(dimension, &key, &[from, to], ":")?;
                    (even(&key, &ends, [from, to], count)?, unit)
                }
                _ => return Err(AxisError::Form { text: text.to_owned() }),
            }
        } else {
            let (values, unit) = numbers(dimension, &key, &parts().collect::<Vec<_>>(), ",")?;
            (AxisValues::List(values), unit)
        };
        Ok(Self { key, dimension: Some(dimension), unit: unit.unwrap_or(bare(dimension)), values })
    }
}

fn even(key: &str, ends: &[f64], texts: [&str; 2], count: &str) -> Result<AxisValues, AxisError> {
    let key = key.to_owned();
    let Some(count) = count.trim().parse().ok().filter(|count| (1..=MOST).contains(count)) else {
        return Err(AxisError::Count { key, text: count.trim().to_owned() });
    };
    if (ends[0] == ends[1]) != (count == 1) {
        let [from, to] = texts.map(|end| end.trim().to_owned());
        return Err(AxisError::Ends { key, from, to, count });
    }
    Ok(AxisValues::Even { from: ends[0], to: ends[1], count })
}

impl AxisValues {
    /// How many there are; `None` of a range to draw from.
    pub fn count(&self) -> Option<u64> {
        match self {
            Self::Even { count, .. } => Some(*count),
            Self::Span { .. } => None,
            Self::List(values) => Some(values.len() as u64),
            Self::Words(words) => Some(words.len() as u64),
        }
    }
}

impl Axis {
    /// Value `index`; `None` past the last one, and of a range to draw from.
    pub fn value(&self, index: u64) -> Option<AxisValue<'_>> {
        let at = usize::try_from(index).ok()?;
        match &self.values {
            AxisValues::Even { from, to, count } if index < *count => Some(AxisValue::Number(match index {
                0 => *from,
                last if last == count - 1 => *to,
                k => rounded(from + k as f64 / (count - 1) as f64 * (to - from)),
            })),
            AxisValues::List(values) => values.get(at).copied().map(AxisValue::Number),
            AxisValues::Words(words) => words.get(at).map(|word| AxisValue::Word(word)),
            AxisValues::Even { .. } | AxisValues::Span { .. } => None,
        }
    }

    /// The value at `fraction` in [0, 1) of the range, or of the list.
    pub fn drawn(&self, fraction: f64) -> Option<AxisValue<'_>> {
        match &self.values {
            AxisValues::Span { from, to } => Some(AxisValue::Number(from + fraction * (to - from))),
            values => {
                let count = values.count()?;
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a fraction of a count")]
                let index = (fraction * count as f64) as u64;
                self.value(index.min(count - 1))
            }
        }
    }

    /// A value as the arm file's text has it.
    pub fn text(&self, value: AxisValue<'_>) -> String {
        match value {
            AxisValue::Word(word) => word.to_owned(),
            AxisValue::Number(number) if self.dimension == Some(Dimension::Angle) => format!("{number:?} rad"),
            AxisValue::Number(number) => format!("{number:?}"),
        }
    }

    /// The key with its SI unit, as the head of a column: `flow_speed_m_s`.
    pub fn column(&self) -> String {
        let unit = match self.dimension {
            None => "",
            Some(Dimension::Angle) => "rad",
            Some(dimension) => dimension.bare_unit(),
        };
        head_of(&self.key, unit)
    }

    /// How many of the unit shown an SI unit is.
    pub fn per_si(&self) -> f64 {
        self.dimension.and_then(|dimension| dimension.per_si(self.unit)).unwrap_or(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        text.parse::<Axis>().unwrap_err().to_string()
    }

    fn values(text: &str) -> AxisValues {
        text.parse::<Axis>().unwrap_or_else(|e| panic!("{text}: {e}")).values
    }

    #[test]
    fn grids_lists_and_ranges_take_units() {
        assert_eq!(values("flow.speed=0:1:11"), AxisValues::Even { from: 0.0, to: 1.0, count: 11 });
        assert_eq!(values("flow.speed = \"0:36 km/h:3\""), AxisValues::Even { from: 0.0, to: 10.0, count: 3 });
        assert_eq!(values("flow.speed=0.5:0.5:1"), AxisValues::Even { from: 0.5, to: 0.5, count: 1 });
        assert_eq!(values("arm.length=\"20 cm\",0.3 m"), AxisValues::List(vec![0.2, 0.3]));
        assert_eq!(values("material.poisson=0.3:0.5"), AxisValues::Span { from: 0.3, to: 0.5 });
        assert_eq!(values("flow.law=momentum"), AxisValues::Words(vec!["momentum".to_owned()]));
        let AxisValues::List(angles) = values("flow.direction=90 deg, 1 rad") else { panic!() };
        assert_eq!(angles, [std::f64::consts::FRAC_PI_2, 1.0]);
    }

    /// From 5 m/s to 20 cm/s it went, in silence.
    #[test]
    fn a_unit_behind_a_range_was_that_of_its_end_alone() {
        assert_eq!(values("flow.speed=5:20 cm/s:4"), AxisValues::Even { from: 0.05, to: 0.2, count: 4 });
        assert_eq!(values("material.young=50:100 kPa:3"), AxisValues::Even { from: 50e3, to: 100e3, count: 3 });
        assert_eq!(values("material.young=50:100 kPa"), AxisValues::Span { from: 50e3, to: 100e3 });
        assert_eq!(values("arm.length=20,\"30 cm\""), AxisValues::List(vec![0.2, 0.3]));
        assert_eq!(values("flow.speed=5 mm/s:20 cm/s:4"), AxisValues::Even { from: 0.005, to: 0.2, count: 4 });
        for (text, spelled) in [
            ("flow.speed=5 cm/s:20:4", ["5:20 cm/s", "5 cm/s:20 m/s"]),
            ("flow.speed=5 cm/s:20", ["5:20 cm/s", "5 cm/s:20 m/s"]),
            ("flow.speed=5 cm/s,20", ["5,20 cm/s", "5 cm/s,20 m/s"]),
        ] {
            let said = error(text);
            assert!(spelled.iter().all(|words| said.contains(&format!("\"{words}\""))), "{said}");
        }
    }

    #[test]
    fn grids_reach_their_ends_and_lists_are_drawn_evenly() {
        let axis: Axis = "flow.speed=0.1:0.7:7".parse().unwrap();
        let all: Vec<_> = (0..8).map(|k| axis.value(k)).collect();
        let want = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7].map(|v| Some(AxisValue::Number(v)));
        assert_eq!((&all[..7], all[7]), (&want[..], None));
        let axis: Axis = "model.volume=planar,none".parse().unwrap();
        assert_eq!(
            [0.0, 0.49, 0.5, 0.999].map(|u| axis.drawn(u).unwrap() == AxisValue::Word("none")),
            [false, false, true, true]
        );
        let axis: Axis = "flow.speed=1:3".parse().unwrap();
        assert_eq!((axis.drawn(0.25), axis.value(0)), (Some(AxisValue::Number(1.5)), None));
    }

    #[test]
    fn columns_have_the_si_unit() {
        for (text, column, unit) in [
            ("flow.direction=0:10 mrad:2", "flow_direction_rad", "mrad"),
            ("material.young=1 kPa", "material_young_Pa", "kPa"),
            ("reference.mu=1", "reference_mu_per_m", "1/m"),
            ("tip.moment=1", "tip_moment_Nm", "N m"),
            ("arm.density=1", "arm_density_kg_m3", "kg/m3"),
            ("material.poisson=0.5", "material_poisson", ""),
            ("arm.radius[1][0]=0.1", "arm_radius_1_0_m", "m"),
            ("name=a,b", "name", ""),
        ] {
            let axis: Axis = text.parse().unwrap();
            assert_eq!((axis.column().as_str(), axis.unit), (column, unit), "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        for text in ["", "flow.speed", "=1", "flow.speed=0:1:2:3"] {
            assert!(error(text).contains("expected KEY=FROM:TO:COUNT"), "{text}");
        }
        // What is no index was read over, and stood in messages with its ends of lines.
        assert!(error("cable[x\n].tension=0:1:2").starts_with("cable[x\\n].tension: "));
        for text in ["flow.speed=", "flow.speed=1,,2", "flow.law="] {
            assert!(error(text).contains("at least one value"), "{text}");
        }
        for text in ["flow.speed=0:1:0", "flow.speed=0:1:-3", "flow.speed=0:1:x", "flow.speed=0:1:2.5"] {
            assert!(error(text).contains("as COUNT"), "{text}");
        }
        assert!(error("flow.speed=0:1:1").contains("with one value"));
        assert!(error("flow.speed=1:1:5").contains("two different ends"));
        assert!(error("flow.speed=0:1 N:5").contains("expected a speed"));
        assert!(error("flow.speed=0:nan:5").contains("does not start with a number"));
        assert!(error("flow.sped=0:1:5").ends_with("did you mean `flow.speed`?"));
        assert!(error("K=0:1:20").ends_with("`hydrostat check ARM` lists the keys, such as cable[0].tension"));
        assert!(error("young=1,2").ends_with("did you mean `material.young`?"));
        assert!(error("flow.law=a:b").contains("words separated by commas"));
    }
}
