//! Which arm a request is about: a shipped one by its name, or a text that comes with the request. Never a file.

use std::collections::BTreeMap;
use std::fmt::Write;

use hydrostat::Arm;
use hydrostat_files::{ArmFile, shipped};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value};

use crate::limits;
use crate::problem::Problem;

/// The arm that the program was started with.
#[derive(Debug, Clone)]
pub struct Given {
    /// What the user called it: the name of a shipped arm, or a file's name.
    pub name: String,
    /// The text of its arm file.
    pub text: String,
}

/// The arm of a request, before it is read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum ArmSource {
    /// The name of a shipped arm.
    Name(String),
    /// The text of an arm file.
    Toml(String),
    /// An arm file as JSON, as `inputs` of results are.
    Json(Map<String, Value>),
}

/// A value of an override.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a number or a text, found neither")]
pub(crate) enum Setting {
    Number(f64),
    Text(String),
}

/// Overrides by dotted key.
pub(crate) type Settings = BTreeMap<String, Setting>;

impl<'de> Deserialize<'de> for ArmSource {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        const EXPECTED: &str = "expected the name of a shipped arm, { \"toml\": text }, or an arm file as an object";
        match Value::deserialize(deserializer)? {
            Value::String(name) => Ok(Self::Name(name)),
            Value::Object(mut map) if map.contains_key("toml") => match (map.remove("toml"), map.is_empty()) {
                (Some(Value::String(text)), true) => Ok(Self::Toml(text)),
                _ => Err(D::Error::custom(EXPECTED)),
            },
            Value::Object(map) => Ok(Self::Json(map)),
            _ => Err(D::Error::custom(EXPECTED)),
        }
    }
}

impl ArmSource {
    /// The arm file, without overrides.
    pub(crate) fn file(&self) -> Result<ArmFile, Problem> {
        match self {
            Self::Name(name) => {
                let text = shipped::get(name).ok_or_else(|| {
                    let names: Vec<&str> = shipped::all_names().collect();
                    let names = names.join(", ");
                    Problem::field("arm", format!("arm: expected one of {names}, found \"{}\"", name.escape_debug()))
                })?;
                Ok(ArmFile::parse(text, name)?)
            }
            Self::Toml(text) => Ok(ArmFile::parse(text, "arm")?),
            Self::Json(map) => {
                let mut text = String::new();
                for (key, value) in map {
                    let _ = write!(text, "{} = ", quoted(key));
                    toml_value(&mut text, value)?;
                    text.push('\n');
                }
                Ok(ArmFile::parse(&text, "arm")?)
            }
        }
    }
}

/// The file with its overrides.
pub(crate) fn overridden(mut file: ArmFile, settings: &Settings) -> Result<ArmFile, Problem> {
    if settings.len() > limits::SETTINGS {
        let message = format!("set: expected at most {} overrides, found {}", limits::SETTINGS, settings.len());
        return Err(Problem::field("set", message));
    }
    for (key, value) in settings {
        let text = match value {
            Setting::Number(number) => format!("{number:?}"),
            Setting::Text(text) => text.clone(),
        };
        file.set_by("set", key, &text)?;
    }
    Ok(file)
}

/// The arm, if it is one that the server works on.
pub(crate) fn arm(file: &ArmFile) -> Result<Arm, Problem> {
    let arm = file.arm()?;
    if arm.cables.len() > limits::CABLES {
        let message = format!("arm: expected at most {} cables here, found {}", limits::CABLES, arm.cables.len());
        return Err(Problem::field("arm", message));
    }
    Ok(arm)
}

/// A tension (N) that slider ends of cables without a largest one are made of: C1 A of the unloaded section at the anchor, which
/// one cable alone does not exceed by much.
pub(crate) fn tension_scale(arm: &Arm, cable: usize) -> f64 {
    arm.stiffness_at(arm.cables[cable].end * arm.length)[0]
}

/// A JSON value as TOML, inline.
fn toml_value(out: &mut String, value: &Value) -> Result<(), Problem> {
    match value {
        Value::Null => {
            return Err(Problem::field("arm", "arm: expected a value, found null; leave the key out instead"));
        }
        Value::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
        Value::Number(number) => out.push_str(&number_text(number)),
        Value::String(text) => out.push_str(&quoted(text)),
        Value::Array(values) => {
            out.push('[');
            for value in values {
                toml_value(out, value)?;
                out.push_str(", ");
            }
            out.push(']');
        }
        Value::Object(map) => {
            out.push('{');
            for (k, (key, value)) in map.iter().enumerate() {
                let _ = write!(out, "{}{} = ", if k == 0 { "" } else { ", " }, quoted(key));
                toml_value(out, value)?;
            }
            out.push('}');
        }
    }
    Ok(())
}

/// Every number of the format is a real one; whole ones may be longer than TOML's.
fn number_text(number: &serde_json::Number) -> String {
    number.as_f64().map_or_else(|| "nan".to_owned(), |value| format!("{value:?}"))
}

/// A basic string of TOML.
fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat_files::Inputs;

    fn source(json: &str) -> ArmSource {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn every_shipped_arm_is_the_same_by_name_as_toml_and_as_json() {
        for name in shipped::all_names() {
            let by_name = ArmSource::Name(name.to_owned()).file().unwrap().arm().unwrap();
            let text = hydrostat_files::arm_to_toml(&by_name);
            let by_text = ArmSource::Toml(text).file().unwrap().arm().unwrap();
            let json = serde_json::to_string(&Inputs::new(&by_name)).unwrap();
            let by_json = source(&json).file().unwrap().arm().unwrap();
            assert_eq!(by_name, by_text, "{name}");
            assert_eq!(by_name, by_json, "{name}");
        }
    }

    #[test]
    fn any_text_of_a_json_arm_is_read_as_it_stands() {
        let name = "\" \\ \u{7f} \u{1} \n ' é [x] = #";
        let mut map = Map::new();
        map.insert("name".to_owned(), Value::from(name));
        map.insert("arm".to_owned(), serde_json::json!({ "length": 0.2, "radius": 0.01 }));
        map.insert("material".to_owned(), serde_json::json!({ "young": 100_000 }));
        assert_eq!(ArmSource::Json(map).file().unwrap().arm().unwrap().name, name);
    }

    #[test]
    fn what_is_wrong_names_the_field_and_the_key() {
        let problem = |json: &str| source(json).file().and_then(|f| arm(&f)).unwrap_err().body.error;
        let wrong = problem(r#"{ "arm": { "length": -1, "radius": 0.01 }, "material": { "young": 1e5 } }"#);
        assert_eq!((wrong.field.as_deref(), wrong.key.as_deref()), (Some("arm"), Some("arm.length")));
        let wrong = problem(r#"{ "arm": { "length": null } }"#);
        assert!(wrong.message.contains("null"));
        let wrong = problem(r#""papper""#);
        assert!(wrong.message.contains("one of paper, paper-statements, silicone"), "{}", wrong.message);

        let settings = Settings::from([("flow.sped".to_owned(), Setting::Number(1.0))]);
        let file = ArmSource::Name("paper".to_owned()).file().unwrap();
        let wrong = overridden(file, &settings).unwrap_err().body.error;
        assert_eq!((wrong.field.as_deref(), wrong.key.as_deref()), (Some("set"), Some("flow.sped")));
    }

    #[test]
    fn nothing_names_a_file() {
        for name in ["../../etc/passwd", "/etc/passwd", "Cargo.toml", "arms/paper.toml"] {
            let problem = ArmSource::Name(name.to_owned()).file().unwrap_err();
            assert_eq!(problem.status, axum::http::StatusCode::BAD_REQUEST, "{name}");
        }
    }
}
