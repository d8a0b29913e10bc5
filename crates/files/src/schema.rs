//! The JSON Schema of the arm file, from the same table as the parser.
//!
//! It says which keys there are, of which types, and which are required. What depends on numbers
//! (a cable inside the section, a table that covers the arm) only the parser knows.

use hydrostat::Join;
use serde_json::{Map, Value, json};

use crate::format::{self, COEFFICIENTS, DRAG, HOMOGENEOUS, Key, Kind, MAX_CABLES, MAX_NAME, MAX_POINTS, PULL, SPACES};
use crate::quantity::Dimension;

/// The JSON Schema (draft 2020-12) of the arm file.
pub fn arm_schema() -> Value {
    let mut schema = table(format::FILE);
    let mut used = schema.to_string();
    let mut definitions = Map::new();
    // Profiles first, because they use quantities.
    for (name, definition) in Dimension::ALL
        .map(|d| (id("profile", d), profile(d)))
        .into_iter()
        .chain(Dimension::ALL.map(|d| (id("quantity", d), quantity(d))))
    {
        if used.contains(&format!("\"#/$defs/{name}\"")) {
            used.push_str(&definition.to_string());
            definitions.insert(name, definition);
        }
    }
    schema["if"] = json!({
        "required": ["arm"],
        "properties": { "arm": { "required": ["space"], "properties": { "space": { "const": SPACES[1] } } } },
    });
    schema["else"] = in_the_plane();
    if let Some(root) = schema.as_object_mut() {
        root.insert("$schema".to_owned(), json!("https://json-schema.org/draft/2020-12/schema"));
        root.insert("title".to_owned(), json!("Hydrostat arm file"));
        root.insert("$defs".to_owned(), Value::Object(definitions));
    }
    schema
}

/// What a file of an arm in the plane does not have.
fn in_the_plane() -> Value {
    let without = |names: &[&str]| -> Value {
        let none: Map<String, Value> = names.iter().map(|name| ((*name).to_owned(), json!(false))).collect();
        json!({ "properties": none })
    };
    let scalar = json!({ "not": { "type": "array" } });
    let pair = json!({ "maxItems": 2 });
    let couple = json!({ "$ref": format!("#/$defs/{}", id("profile", Dimension::MomentPerLength)) });
    json!({
        "properties": {
            "arm": { "properties": { "base": without(&["z", "direction", "section"]) } },
            "material": without(&["c4"]),
            "reference": without(&["zeta", "tau", "kappa"]),
            "cable": { "items": without(&["angle"]) },
            "flow": { "properties": { "direction": scalar } },
            "gravity": { "properties": { "direction": scalar } },
            "tip": { "properties": { "force": pair, "follower": pair, "moment": scalar } },
            "distributed": { "properties": { "force": pair, "couple": couple } },
        },
    })
}

/// The schema as the text of a file.
pub fn arm_schema_text() -> String {
    format!("{:#}\n", arm_schema())
}

fn table(keys: &[Key]) -> Value {
    let properties: Map<String, Value> = keys.iter().map(|k| (k.name.to_owned(), property(k))).collect();
    let required: Vec<&str> = keys.iter().filter(|k| k.required).map(|k| k.name).collect();
    let mut schema = json!({ "type": "object", "additionalProperties": false, "properties": properties });
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}

fn property(key: &Key) -> Value {
    let mut schema = kind(key.kind);
    match key.name {
        "material" => {
            let absent = |names: [&str; 3]| json!({ "not": { "anyOf": names.map(|n| json!({ "required": [n] })) } });
            schema["oneOf"] = json!([
                { "required": ["young"], "allOf": [absent(COEFFICIENTS)] },
                { "required": COEFFICIENTS, "allOf": [absent(HOMOGENEOUS)] },
            ]);
            schema["dependentRequired"] = json!({ "c4": ["c1"] });
        }
        "base" => {
            schema["not"] = json!({ "required": ["angle", "direction"] });
            schema["dependentRequired"] = json!({ "section": ["direction"] });
        }
        "cable" => schema["items"]["not"] = json!({ "required": PULL }),
        "dynamics" => schema["not"] = json!({ "required": format::RATE }),
        "flow" => {
            schema["if"] = json!({ "required": ["law"], "properties": { "law": { "const": "quadratic-drag" } } });
            schema["then"] = json!({ "required": DRAG });
        }
        _ => {}
    }
    schema["description"] = json!(key.doc);
    if let Some(default) = key.default {
        schema["default"] = default_value(default);
    }
    schema
}

/// A default as JSON, from the TOML in which the format has it.
fn default_value(default: &str) -> Value {
    use crate::document::{Node, parse_setting};
    fn json_of(node: Node) -> Value {
        match node {
            Node::Text(text) | Node::Datetime(text) => json!(text),
            Node::Number(value) => json!(value),
            Node::Boolean(value) => json!(value),
            Node::Array(entries) => entries.into_iter().map(|e| json_of(e.node)).collect(),
            Node::Table(fields) => fields.into_iter().map(|f| (f.name, json_of(f.entry.node))).collect(),
        }
    }
    json_of(parse_setting(default, 0))
}

fn kind(kind: Kind) -> Value {
    let one = |id: String| json!({ "$ref": format!("#/$defs/{id}") });
    let parts = |part: Value, fewest: usize| {
        let all = vec![part; 3];
        json!({ "type": "array", "prefixItems": all, "minItems": fewest, "maxItems": 3 })
    };
    let number = || json!({ "type": "number" });
    match kind {
        Kind::Text => json!({ "type": "string", "maxLength": MAX_NAME }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Quantity(d) => json!({ "$ref": format!("#/$defs/{}", id("quantity", d)) }),
        Kind::Pair(d) => parts(one(id("quantity", d)), 2),
        Kind::Axial(d) => json!({ "anyOf": [one(id("quantity", d)), parts(one(id("quantity", d)), 3)] }),
        Kind::Heading => json!({ "anyOf": [one(id("quantity", Dimension::Angle)), parts(number(), 3)] }),
        Kind::Direction => parts(number(), 3),
        Kind::Profile(d) => json!({ "$ref": format!("#/$defs/{}", id("profile", d)) }),
        Kind::ProfilePair(d) => parts(one(id("profile", d)), 2),
        Kind::AxialProfile(d) => json!({ "anyOf": [one(id("profile", d)), parts(one(id("profile", d)), 3)] }),
        Kind::Offset(d) => along(&json!({
            "anyOf": [{ "$ref": format!("#/$defs/{}", id("quantity", d)) }, { "type": "string", "pattern": with_unit(&["%"]) }],
        })),
        Kind::Part => {
            let units: Vec<&str> = Dimension::Length.spellings().chain(["%"]).collect();
            json!({ "anyOf": [{ "type": "number" }, { "type": "string", "pattern": with_unit(&units) }] })
        }
        Kind::Table(keys) => table(keys),
        Kind::Tables(keys) => json!({ "type": "array", "maxItems": MAX_CABLES, "items": table(keys) }),
    }
}

fn id(kind: &str, dimension: Dimension) -> String {
    let name = dimension.name().trim_start_matches("an ").trim_start_matches("a ").replace(' ', "_");
    format!("{kind}_{name}")
}

fn quantity(dimension: Dimension) -> Value {
    if dimension == Dimension::Number {
        return json!({ "type": "number" });
    }
    let pattern = with_unit(&dimension.spellings().collect::<Vec<_>>());
    json!({
        "description": format!("{}; a bare number is in {}", dimension.name(), dimension.bare_unit()),
        "anyOf": [{ "type": "number" }, { "type": "string", "pattern": pattern }],
    })
}

/// A number with one of these units.
fn with_unit(units: &[&str]) -> String {
    let units: Vec<String> = units.iter().map(|unit| escaped(unit)).collect();
    // White space around and between is that of the parser; `\s` differs between engines.
    format!(r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*({})\s*$", units.join("|"))
}

fn escaped(unit: &str) -> String {
    unit.replace('^', r"\^").replace('*', r"\*")
}

fn profile(dimension: Dimension) -> Value {
    along(&json!({ "$ref": format!("#/$defs/{}", id("quantity", dimension)) }))
}

/// Such a value along the arm.
fn along(value: &Value) -> Value {
    let place = json!({ "$ref": format!("#/$defs/{}", id("quantity", Dimension::Length)) });
    let points = json!({
        "type": "array",
        "minItems": 2,
        "maxItems": MAX_POINTS,
        "items": { "type": "array", "prefixItems": [place, value], "minItems": 2, "maxItems": 2 },
    });
    let [all, way] = format::JOINED;
    json!({
        "description": "along the arm: one value, linear from base to tip, or points from 0 to the length, joined by a monotone cubic or by straight lines",
        "anyOf": [
            value,
            {
                "type": "object",
                "additionalProperties": false,
                "properties": { "base": value, "tip": value },
                "required": format::ENDS,
            },
            points,
            {
                "type": "object",
                "additionalProperties": false,
                "properties": { all: points, way: { "enum": Join::NAMES } },
                "required": [all],
            },
        ],
    })
}
