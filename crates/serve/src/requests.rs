//! The bodies of requests, and which field of one is wrong.

use hydrostat_files::{Dimension, Varied};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Number;

use crate::arm_source::{ArmSource, Settings, arm, overridden};
use crate::limits;
use crate::problem::Problem;

/// In which form an answer is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Format {
    #[default]
    Json,
    Csv,
    Svg,
    Pdf,
    Png,
}

/// What holds the cables of what reaches a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum By {
    #[default]
    Tensions,
    Strokes,
}

/// A number, or a text with a unit.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(untagged, expecting = "expected a number, or a text with a number and its unit, found neither")]
pub(crate) enum Amount {
    Number(f64),
    Text(String),
}

impl Amount {
    /// Its value in SI units (an angle in rad).
    pub(crate) fn value(&self, field: &str, dimension: Dimension) -> Result<f64, Problem> {
        let text = match self {
            Self::Number(number) => format!("{number:?}"),
            Self::Text(text) => text.trim().to_owned(),
        };
        let read = dimension.read(&text).map(|(value, _)| value);
        let fine = |value: &f64| value.is_finite();
        let wrong = |why: String| Problem::field(field, format!("{field}: expected {}{why}", dimension.expected()));
        match read {
            Ok(value) if fine(&value) => Ok(value),
            Ok(value) => Err(wrong(format!(", found {value}"))),
            Err(error) => Err(wrong(format!(": {error}"))),
        }
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckRequest {
    arm: Option<ArmSource>,
    #[serde(default)]
    set: Settings,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SolveRequest {
    arm: Option<ArmSource>,
    #[serde(default)]
    set: Settings,
    pub(crate) tol: Option<f64>,
    pub(crate) stations: Option<Number>,
    #[serde(default)]
    pub(crate) format: Format,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PathRequest {
    arm: Option<ArmSource>,
    #[serde(default)]
    set: Settings,
    pub(crate) vary: Option<String>,
    pub(crate) tol: Option<f64>,
    pub(crate) max_points: Option<Number>,
    pub(crate) max_step: Option<f64>,
    #[serde(default)]
    pub(crate) branches: bool,
    #[serde(default)]
    pub(crate) format: Format,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EquilibriaRequest {
    arm: Option<ArmSource>,
    #[serde(default)]
    set: Settings,
    pub(crate) tol: Option<f64>,
    pub(crate) stations: Option<Number>,
    #[serde(default)]
    pub(crate) format: Format,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ReachRequest {
    arm: Option<ArmSource>,
    #[serde(default)]
    set: Settings,
    /// x and y, in space also z.
    pub(crate) target: Option<Vec<Amount>>,
    pub(crate) angle: Option<Amount>,
    /// Of the normal a, in space.
    pub(crate) direction: Option<[f64; 3]>,
    pub(crate) station: Option<Amount>,
    #[serde(default)]
    pub(crate) by: By,
    pub(crate) max_tension: Option<Amount>,
    pub(crate) max_stroke: Option<Amount>,
    pub(crate) tol: Option<f64>,
    #[serde(default)]
    pub(crate) format: Format,
}

/// A body that is about an arm.
pub(crate) trait AboutAnArm {
    fn parts(&self) -> (&Option<ArmSource>, &Settings);

    /// The arm with its overrides.
    fn arm(&self) -> Result<hydrostat::Arm, Problem> {
        let (source, settings) = self.parts();
        let expected = "the name of a shipped arm, { \"toml\": text }, or an arm file as an object";
        let source = source.as_ref().ok_or_else(|| Problem::missing("arm", expected))?;
        arm(&overridden(source.file()?, settings)?)
    }
}

macro_rules! about_an_arm {
    ($($request:ty),*) => {$(
        impl AboutAnArm for $request {
            fn parts(&self) -> (&Option<ArmSource>, &Settings) {
                (&self.arm, &self.set)
            }
        }
    )*};
}

about_an_arm!(CheckRequest, SolveRequest, PathRequest, EquilibriaRequest, ReachRequest);

/// Reads a body.
pub(crate) fn read<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, Problem> {
    let mut json = serde_json::Deserializer::from_slice(bytes);
    let value = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let field = error.path().to_string();
        let inner = error.inner();
        if !inner.is_data() {
            return Problem::body(format!("expected a JSON object: {inner}"));
        }
        match field.as_str() {
            "." | "" => Problem::body(inner.to_string()),
            field => Problem::field(field, format!("{field}: {inner}")),
        }
    })?;
    json.end().map_err(|error| Problem::body(format!("expected one JSON object: {error}")))?;
    Ok(value)
}

/// A number of stations.
pub(crate) fn stations(asked: Option<Number>) -> Result<Option<usize>, Problem> {
    count("stations", asked, limits::STATIONS)
}

/// A whole number from 2 to `most`.
pub(crate) fn count(field: &str, asked: Option<Number>, most: usize) -> Result<Option<usize>, Problem> {
    let Some(found) = asked else { return Ok(None) };
    match found.as_u64().and_then(|count| usize::try_from(count).ok()) {
        Some(count) if (2..=most).contains(&count) => Ok(Some(count)),
        _ => Err(Problem::field(field, format!("{field}: expected a whole number from 2 to {most}, found {found}"))),
    }
}

/// What varies over which range.
pub(crate) fn varied(text: Option<&String>) -> Result<Varied, Problem> {
    let text = text.ok_or_else(|| Problem::missing("vary", "KEY=FROM:TO, such as cable[0].tension=0:20"))?;
    text.parse().map_err(|error| Problem::field("vary", format!("{error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(text: &str) -> (Option<String>, String) {
        let error = read::<SolveRequest>(text.as_bytes()).and_then(|r| r.arm().map(|_| ())).unwrap_err().body.error;
        (error.field, error.message)
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, field) in [
            ("", "body"),
            ("{", "body"),
            ("[]", "body"),
            ("{} {}", "body"),
            ("{}", "arm"),
            (r#"{"arm": 3}"#, "arm"),
            (r#"{"arm": {"toml": 3}}"#, "arm"),
            (r#"{"arm": "paper", "tol": "x"}"#, "tol"),
            (r#"{"arm": "paper", "stations": "many"}"#, "stations"),
            (r#"{"arm": "paper", "statons": 3}"#, "statons"),
            (r#"{"arm": "paper", "format": "gif"}"#, "format"),
            (r#"{"arm": "paper", "set": {"flow.speed": true}}"#, "set.flow.speed"),
            (r#"{"arm": "paper", "set": {"flow.speed": -1}}"#, "set"),
        ] {
            let (found, message) = problem(text);
            assert_eq!(found.as_deref(), Some(field), "{text}: {message}");
            assert!(!message.is_empty());
        }
    }

    /// They said names of types: "data did not match any variant of untagged enum Setting", "expected usize".
    #[test]
    fn messages_named_types() {
        let (field, message) = problem(r#"{"arm": "paper", "set": {"cable[0].tension": null}}"#);
        assert_eq!(field.as_deref(), Some("set.cable[0].tension"));
        assert!(message.starts_with("set.cable[0].tension: expected a number or a text, found neither"), "{message}");
        let reach = read::<ReachRequest>(br#"{"arm": "paper", "target": [null, 1]}"#).unwrap_err().body.error.message;
        let expected = "target[0]: expected a number, or a text with a number and its unit, found neither";
        assert!(reach.starts_with(expected), "{reach}");
        for number in ["-3", "2.5", "1", "1e300"] {
            let asked: SolveRequest = read(format!(r#"{{"arm": "paper", "stations": {number}}}"#).as_bytes()).unwrap();
            let message = stations(asked.stations).unwrap_err().body.error.message;
            let most = limits::STATIONS;
            assert!(
                message.starts_with(&format!("stations: expected a whole number from 2 to {most}, found ")),
                "{message}"
            );
        }
    }

    #[test]
    fn amounts_take_units() {
        let amount = |text: &str| serde_json::from_str::<Amount>(text).unwrap();
        assert_eq!(amount("0.2").value("station", Dimension::Length).unwrap(), 0.2);
        assert_eq!(amount(r#""20 mm""#).value("station", Dimension::Length).unwrap(), 0.02);
        assert_eq!(amount("90").value("angle", Dimension::Angle).unwrap(), std::f64::consts::FRAC_PI_2);
        assert!(
            amount(r#""20 N""#).value("station", Dimension::Length).unwrap_err().body.error.message.contains("length")
        );
    }
}
