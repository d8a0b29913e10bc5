//! Numbers that are written together, as the ends of a range or a list: a unit behind the last one holds for all.

use crate::error::shortened;
use crate::quantity::{Dimension, parted};

/// A unit after some numbers only: the unit of the others is open.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "{}: only some of the numbers in \"{}\" have a unit; write {}",
    shortened(.key),
    shortened(.text),
    spellings(.shared.as_deref(), .each)
)]
pub struct PartialUnit {
    /// The key, or the option.
    pub key: String,
    /// What was given.
    pub text: String,
    /// The text where the unit holds for all numbers; `None` where several units are written.
    pub shared: Option<String>,
    /// The text where numbers without a unit are in the unit of bare numbers.
    pub each: String,
}

fn spellings(shared: Option<&str>, each: &str) -> String {
    let each = shortened(each);
    match shared {
        Some(shared) => {
            format!("\"{}\" if it is the unit of all, else \"{each}\"", shortened(shared))
        }
        None => format!("a unit after each number, such as \"{each}\""),
    }
}

/// The numbers of `parts` with their units, each as a text of its own. A unit behind the last part holds for every number without one; zero
/// needs none. What is no number, or an empty text, stays as it is.
///
/// ```
/// use hydrostat_files::{Dimension, shared_unit};
///
/// let read = |parts: &[&str]| shared_unit(Dimension::Speed, "flow.speed", parts, ":");
/// assert_eq!(read(&["5", "20 cm/s"]).unwrap(), ["5 cm/s", "20 cm/s"]);
/// assert_eq!(read(&["5 mm/s", "20 cm/s"]).unwrap(), ["5 mm/s", "20 cm/s"]);
/// assert_eq!(read(&["0.5 m/s", "0"]).unwrap(), ["0.5 m/s", "0"]);
/// let error = read(&["5 cm/s", "20"]).unwrap_err().to_string();
/// assert!(error.contains("\"5:20 cm/s\"") && error.contains("\"5 cm/s:20 m/s\""), "{error}");
/// ```
///
/// # Errors
/// [`PartialUnit`] where a number has no unit, another has one, and none stands behind the last part, or where units differ. `join` stands
/// between the parts of its texts.
pub fn shared_unit(dimension: Dimension, key: &str, parts: &[&str], join: &str) -> Result<Vec<String>, PartialUnit> {
    let parts: Vec<&str> = parts.iter().map(|part| part.trim().trim_matches('"').trim()).collect();
    let has_unit = |part: &&&str| dimension.spellings().any(|known| known == unit(part));
    let is_bare = |part: &str| parted(part).is_some_and(|(number, unit)| unit.is_empty() && number != Some(0.0));
    let mut units: Vec<&str> = parts.iter().filter(has_unit).map(|part| unit(part)).collect();
    units.dedup();
    if units.is_empty() || !parts.iter().any(|part| is_bare(part)) {
        return Ok(parts.into_iter().map(str::to_owned).collect());
    }
    let with = |unit: &str| -> Vec<String> {
        let each = |part: &&str| if is_bare(part) { format!("{part} {unit}") } else { (*part).to_owned() };
        parts.iter().map(each).collect()
    };
    if units.len() == 1 && parts.last().is_some_and(|last| has_unit(&last)) {
        return Ok(with(units[0]));
    }
    let bare = bare(dimension);
    let numbers = || parts.iter().map(|part| part.strip_suffix(unit(part)).unwrap_or(part).trim_end());
    let shared = format!("{} {}", numbers().collect::<Vec<_>>().join(join), units[0]);
    Err(PartialUnit {
        key: key.to_owned(),
        text: parts.join(join),
        shared: (units.len() == 1).then_some(shared),
        each: with(bare).join(join),
    })
}

/// The unit of a bare number as it can be written.
pub(crate) fn bare(dimension: Dimension) -> &'static str {
    if dimension == Dimension::Angle { "deg" } else { dimension.bare_unit() }
}

fn unit(part: &str) -> &str {
    parted(part).map_or("", |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(dimension: Dimension, parts: &[&str]) -> Result<Vec<String>, String> {
        shared_unit(dimension, "key", parts, ":").map_err(|error| error.to_string())
    }

    #[test]
    fn a_unit_behind_the_last_number_holds_for_all() {
        assert_eq!(read(Dimension::Angle, &["-1", "\"2 rad\""]).unwrap(), ["-1 rad", "2 rad"]);
        assert_eq!(read(Dimension::Pressure, &["1e2", "150", "2e2 kPa"]).unwrap(), ["1e2 kPa", "150 kPa", "2e2 kPa"]);
        assert_eq!(read(Dimension::Speed, &["1", "2"]).unwrap(), ["1", "2"]);
        assert_eq!(read(Dimension::Speed, &["1 cm/s", "0.0", "2 mm/s"]).unwrap(), ["1 cm/s", "0.0", "2 mm/s"]);
        assert_eq!(read(Dimension::Speed, &["", "1", "2 mm/s"]).unwrap(), ["", "1 mm/s", "2 mm/s"]);
        // What is wrong by itself is said of what was written.
        assert_eq!(read(Dimension::Speed, &["1", "2 N"]).unwrap(), ["1", "2 N"]);
        assert_eq!(read(Dimension::Number, &["1", "2 N"]).unwrap(), ["1", "2 N"]);
        assert_eq!(read(Dimension::Speed, &["x", "2 m/s"]).unwrap(), ["x", "2 m/s"]);
    }

    #[test]
    fn units_that_leave_others_open_are_refused() {
        let error = read(Dimension::Angle, &["1 rad", "20"]).unwrap_err();
        assert!(error.starts_with("key: only some of the numbers in \"1 rad:20\" have a unit"), "{error}");
        assert!(error.contains("\"1:20 rad\"") && error.contains("\"1 rad:20 deg\""), "{error}");
        let error = read(Dimension::Force, &["1", "2 mN", "3"]).unwrap_err();
        assert!(error.contains("\"1:2:3 mN\"") && error.contains("\"1 N:2 mN:3 N\""), "{error}");
        let error = read(Dimension::Force, &["1", "2 mN", "3 N"]).unwrap_err();
        assert!(error.ends_with("a unit after each number, such as \"1 N:2 mN:3 N\""), "{error}");
    }
}
