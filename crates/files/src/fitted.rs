//! What is to be fitted: `KEY`, `KEY=START`, `KEY=START:LOWER:UPPER`, and what was known of it, `KEY=MEAN±SD`.

use std::str::FromStr;

use hydrostat::parameter::{Unfit, names};
use hydrostat::{Arm, Parameter};
use hydrostat_identify::{Fitted, Prior, Unknown};

use crate::error::shortened;
use crate::format::{bracketed, dimension_at, is_key, nearest, synonym};
use crate::quantity::{Dimension, WrongValue};
use crate::shared_unit::{PartialUnit, bare, shared_unit};
use crate::varied::hint;

/// A parameter to be fitted, as a user gives it: values in SI units (rad for angles).
///
/// ```
/// use hydrostat::Parameter;
/// use hydrostat_files::FitKey;
///
/// let key: FitKey = "young=100 kPa:50 kPa:200 kPa".parse().unwrap();
/// assert_eq!((key.parameter, key.start), (Parameter::Young.into(), Some(100e3)));
/// assert_eq!(key.bounds, [Some(50e3), Some(200e3)]);
/// assert!("arm.length".parse::<FitKey>().unwrap_err().to_string().contains("no derivative"));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FitKey {
    /// Which.
    pub parameter: Unknown,
    /// Where to start, in place of the arm's value.
    pub start: Option<f64>,
    /// The bounds that are given.
    pub bounds: [Option<f64>; 2],
}

/// What was known of a parameter, as a user gives it.
///
/// ```
/// let key: hydrostat_files::PriorKey = "flow.cn=2.5±0.5".parse().unwrap();
/// assert_eq!((key.prior.mean, key.prior.sd), (2.5, 0.5));
/// let key: hydrostat_files::PriorKey = "material.young=110 +- 5 kPa".parse().unwrap();
/// assert_eq!((key.prior.mean, key.prior.sd), (110e3, 5e3));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriorKey {
    /// Of which.
    pub parameter: Unknown,
    /// Its distribution.
    pub prior: Prior,
}

/// Why a text names nothing that can be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitKeyError {
    /// Not of the form.
    #[error("{}: expected {expected}", shortened(.text))]
    Form {
        /// What was given.
        text: String,
        /// The form.
        expected: &'static str,
    },
    /// A key of the arm file without a derivative.
    #[error("{} cannot be fitted, because there is no derivative with respect to it; keys that can be fitted: {}", shortened(.key), fittable().join(", "))]
    NoDerivative {
        /// The key.
        key: String,
    },
    /// No key at all.
    #[error("{} is not a key of the arm file{}", shortened(.key), hint_or_list(.suggestion.as_ref()))]
    Unknown {
        /// What was given.
        key: String,
        /// The key that may have been meant.
        suggestion: Option<String>,
    },
    /// A value that is none of this quantity.
    #[error(transparent)]
    Value(#[from] WrongValue),
    /// A unit behind some of the numbers.
    #[error(transparent)]
    Unit(#[from] PartialUnit),
    /// The arm does not have it.
    #[error(transparent)]
    Unfit(#[from] Unfit),
    /// A prior of something that is not fitted.
    #[error("{0} has a prior and is not fitted; add it to --fit")]
    NotFitted(Unknown),
}

/// The names of what can be fitted: by the length there are derivatives at fractions of the arm, and what is measured is
/// at places in m.
fn fittable() -> Vec<String> {
    let others =
        [Unknown::Base(0), Unknown::Base(1), Unknown::Base(2), Unknown::TensionFactor, Unknown::CableFactor(0)];
    let others = others.map(|other| other.to_string());
    names().into_iter().filter(|name| *name != Parameter::Length.to_string()).chain(others).collect()
}

/// What is fitted under a key, or under its last part.
fn unknown(key: &str) -> Result<Unknown, FitKeyError> {
    match bracketed(key).parse() {
        Ok(other @ (Unknown::TensionFactor | Unknown::CableFactor(_) | Unknown::Base(_))) => Ok(other),
        _ => parameter(key).map(Unknown::Of),
    }
}

/// With a suggestion the list of all keys is left out: it is long.
fn hint_or_list(suggestion: Option<&String>) -> String {
    match suggestion {
        Some(_) => hint(suggestion),
        None => format!("; keys that can be fitted: {}", fittable().join(", ")),
    }
}

/// The parameter of a key, or of its last part where that says enough: `c1` for `material.c1`.
pub(crate) fn parameter(key: &str) -> Result<Parameter, FitKeyError> {
    let key = bracketed(key);
    let key = key.as_str();
    let known = fittable();
    if let Ok(parameter) = key.parse()
        && parameter != Parameter::Length
    {
        return Ok(parameter);
    }
    let ending = format!(".{key}");
    let mut ends = known.iter().filter(|name| name.ends_with(&ending) && !name.contains('['));
    if let (Some(one), None) = (ends.next(), ends.next())
        && let Ok(parameter) = one.parse()
    {
        return Ok(parameter);
    }
    if is_key(key) && key.contains('.') {
        return Err(FitKeyError::NoDerivative { key: key.to_owned() });
    }
    let meant = synonym(key.rsplit('.').next().unwrap_or(key)).filter(|meant| known.iter().any(|name| name == meant));
    let suggestion = meant.or_else(|| nearest(key, known.iter().map(String::as_str))).map(str::to_owned);
    Err(FitKeyError::Unknown { key: key.to_owned(), suggestion })
}

/// Numbers that stand together, `None` for an empty text. A unit behind the last holds for all without one.
fn values(parameter: Unknown, texts: &[&str], join: &str) -> Result<Vec<Option<f64>>, FitKeyError> {
    let key = parameter.to_string();
    let dimension = dimension_at(&key).unwrap_or(Dimension::Number);
    let read = |text: &String| -> Result<Option<f64>, FitKeyError> {
        let given = !text.is_empty();
        Ok(given.then(|| dimension.value_of(&key, text)).transpose()?.map(|(value, _)| value))
    };
    shared_unit(dimension, &key, texts, join)?.iter().map(read).collect()
}

impl FromStr for FitKey {
    type Err = FitKeyError;

    fn from_str(text: &str) -> Result<Self, FitKeyError> {
        let expected =
            "KEY, KEY=START, KEY=START:LOWER:UPPER or KEY:LOWER:UPPER, such as young=\"100 kPa:50 kPa:200 kPa\"";
        let form = || FitKeyError::Form { text: text.to_owned(), expected };
        let mut parts = text.split(':');
        let head = parts.next().unwrap_or_default();
        let (key, start) = match head.split_once('=') {
            Some((key, start)) => (key, Some(start)),
            None => (head, None),
        };
        let parameter = unknown(key.trim())?;
        if start.is_some_and(|start| start.trim().is_empty()) {
            return Err(form());
        }
        let bounds: Vec<&str> = parts.collect();
        let texts: Vec<&str> = start.iter().chain(&bounds).copied().collect();
        let mut read = values(parameter, &texts, ":")?.into_iter();
        let start = start.and_then(|_| read.next().flatten());
        let bounds = match read.collect::<Vec<_>>()[..] {
            [] => [None, None],
            [lower, upper] => [lower, upper],
            _ => return Err(form()),
        };
        Ok(Self { parameter, start, bounds })
    }
}

impl FromStr for PriorKey {
    type Err = FitKeyError;

    fn from_str(text: &str) -> Result<Self, FitKeyError> {
        let expected = "KEY=MEAN±SD, such as young=\"110±5 kPa\"; +- may stand for ±";
        let form = || FitKeyError::Form { text: text.to_owned(), expected };
        let (key, rest) = text.split_once('=').ok_or_else(form)?;
        let parameter = unknown(key.trim())?;
        let ends = ["±", "+/-", "+-"].iter().find_map(|sign| rest.split_once(sign));
        let (mean, sd) = ends.ok_or_else(form)?;
        match values(parameter, &[mean, sd], "±")?[..] {
            [Some(mean), Some(sd)] => Ok(Self { parameter, prior: Prior { mean, sd } }),
            _ => Err(form()),
        }
    }
}

/// What is to be fitted of `arm`.
///
/// # Errors
/// [`FitKeyError::Unfit`] for what the arm does not have, [`FitKeyError::NotFitted`] for a prior too many.
pub fn fitted(arm: &Arm, keys: &[FitKey], priors: &[PriorKey]) -> Result<Vec<Fitted>, FitKeyError> {
    let mut out = Vec::new();
    for key in keys {
        let mut one = Fitted::new(key.parameter, arm)?;
        one.start = key.start.unwrap_or(one.start);
        for (own, given) in one.bounds.iter_mut().zip(key.bounds) {
            *own = given.unwrap_or(*own);
        }
        one.prior = priors.iter().find(|prior| prior.parameter == key.parameter).map(|prior| prior.prior);
        out.push(one);
    }
    match priors.iter().find(|prior| !keys.iter().any(|key| key.parameter == prior.parameter)) {
        Some(prior) => Err(FitKeyError::NotFitted(prior.parameter)),
        None => Ok(out),
    }
}

/// The unit of a bare number at a key of the arm file, or at the short name of one that can be fitted; empty for a plain number, `None` where
/// there is no number.
///
/// ```
/// assert_eq!(hydrostat_files::bare_unit("arm.base.angle"), Some("deg"));
/// assert_eq!(hydrostat_files::bare_unit("young"), Some("Pa"));
/// assert_eq!(hydrostat_files::bare_unit("flow.law"), None);
/// ```
pub fn bare_unit(key: &str) -> Option<&'static str> {
    dimension_at(key).or_else(|| dimension_at(&parameter(key).ok()?.to_string())).map(bare)
}

#[cfg(test)]
mod tests {
    use hydrostat::Point;
    use hydrostat::parameter::Curvature;

    use super::*;

    fn error(text: &str) -> String {
        text.parse::<FitKey>().unwrap_err().to_string()
    }

    #[test]
    fn keys_take_starts_and_bounds() {
        let read = |text: &str| text.parse::<FitKey>().unwrap();
        let key = |parameter: Parameter, start, bounds| FitKey { parameter: parameter.into(), start, bounds };
        for (text, want) in [
            ("flow.cn", key(Parameter::DragNormal, None, [None, None])),
            ("cn=2", key(Parameter::DragNormal, Some(2.0), [None, None])),
            ("c3=150:100:200 N", key(Parameter::Coefficient(2), Some(150.0), [Some(100.0), Some(200.0)])),
            ("c1 = 1 MPa : : 2 MPa", key(Parameter::Coefficient(0), Some(1e6), [None, Some(2e6)])),
            ("arm.density:900:1200", key(Parameter::Density, None, [Some(900.0), Some(1200.0)])),
            ("cable[1].tension=20 mN", key(Parameter::Tension(1), Some(0.02), [None, None])),
            ("flow.direction=180", key(Parameter::FlowDirection, Some(std::f64::consts::PI), [None, None])),
            ("reference.kappa=0.5", key(Parameter::Reference(Curvature::Kappa, Point::Whole), Some(0.5), [None, None])),
        ] {
            assert_eq!(read(text), want, "{text}");
        }
        let factor = |parameter| FitKey { parameter, start: Some(0.9), bounds: [Some(0.5), Some(1.0)] };
        assert_eq!(read("tension_factor=0.9:0.5:1"), factor(Unknown::TensionFactor));
        assert_eq!(read("cable[1].tension_factor=0.9:0.5:1"), factor(Unknown::CableFactor(1)));
    }

    #[test]
    fn a_unit_behind_the_last_number_holds_for_all() {
        let key: FitKey = "young=100:50:200 kPa".parse().unwrap();
        assert_eq!((key.start, key.bounds), (Some(100e3), [Some(50e3), Some(200e3)]));
        let key: FitKey = "young=100::200 kPa".parse().unwrap();
        assert_eq!((key.start, key.bounds), (Some(100e3), [None, Some(200e3)]));
        let said = error("young=100 kPa:50:200");
        assert!(said.contains("\"100:50:200 kPa\"") && said.contains("\"100 kPa:50 Pa:200 Pa\""), "{said}");
        let said = "young=110 kPa±5".parse::<PriorKey>().unwrap_err().to_string();
        assert!(said.contains("\"110±5 kPa\"") && said.contains("\"110 kPa±5 Pa\""), "{said}");
    }

    #[test]
    fn what_cannot_be_fitted_is_said_with_what_can() {
        for key in ["arm.length", "arm.inner_radius", "model.volume", "cable[0].end"] {
            let message = error(key);
            assert!(message.starts_with(&format!("{key} cannot be fitted")), "{message}");
            assert!(message.contains("cable[0].tension") && message.contains("flow.ct"), "{message}");
        }
        assert!(error("materiel.young").contains("did you mean `material.young`?"));
        // Of arm and of water.
        assert!(error("density").contains("is not a key"));
        assert!(error("young=3 N").contains("a pressure"));
        assert!(error("young=1:2").contains("expected KEY"));
        assert!("cn=2".parse::<PriorKey>().is_err());
    }
}
