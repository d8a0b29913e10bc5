//! The description of the HTTP interface, `openapi.json`, with the arm file's schema put in; and of the session, `session.schema.json`.

use serde_json::{Value, json};

use crate::limits;

/// The OpenAPI document.
pub(crate) fn document() -> Value {
    let mut document: Value = serde_json::from_str(include_str!("openapi.json")).unwrap_or_default();
    let mut arm = hydrostat_files::schema::arm_schema();
    if let Some(schema) = arm.as_object_mut() {
        schema.remove("$schema");
        let definitions = schema.remove("$defs");
        let schemas = &mut document["components"]["schemas"];
        for (name, definition) in definitions.iter().filter_map(Value::as_object).flatten() {
            schemas[name] = moved(definition);
        }
        schemas["ArmFile"] = moved(&arm);
    }
    document["info"]["version"] = json!(env!("CARGO_PKG_VERSION"));
    let schemas = &mut document["components"]["schemas"];
    schemas["Stations"]["maximum"] = json!(limits::STATIONS);
    schemas["Points"]["maximum"] = json!(limits::POINTS);
    schemas["Settings"]["maxProperties"] = json!(limits::SETTINGS);
    document
}

/// The JSON Schema of the session's messages: `$defs/Wish` and `$defs/Reply`, with the documents that they hold.
pub(crate) fn session_schema() -> Value {
    let mut schema: Value = serde_json::from_str(include_str!("session.schema.json")).unwrap_or_default();
    let mut documents = document();
    schema["components"] = json!({ "schemas": documents["components"]["schemas"].take() });
    schema
}

/// With references to where OpenAPI keeps its schemas.
fn moved(schema: &Value) -> Value {
    match schema {
        Value::String(text) => json!(text.replace("#/$defs/", "#/components/schemas/")),
        Value::Array(values) => values.iter().map(moved).collect(),
        Value::Object(map) => Value::Object(map.iter().map(|(key, value)| (key.clone(), moved(value))).collect()),
        other => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn references(value: &Value, found: &mut Vec<String>) {
        match value {
            Value::Array(values) => values.iter().for_each(|v| references(v, found)),
            Value::Object(map) => {
                for (key, value) in map {
                    match value {
                        Value::String(text) if key == "$ref" => found.push(text.clone()),
                        value => references(value, found),
                    }
                }
            }
            _ => {}
        }
    }

    #[test]
    fn every_reference_leads_somewhere() {
        for document in [document(), session_schema()] {
            let mut found = Vec::new();
            references(&document, &mut found);
            assert!(found.len() > 50, "{}", found.len());
            for reference in found {
                let pointer = reference.strip_prefix('#').unwrap();
                assert!(document.pointer(pointer).is_some(), "{reference}");
            }
        }
    }
}
