//! All kinds of steps as JSON Schema: the page and other programs make forms of it.

use kerfold::recipe::{KeySchema, StepSchema, ValueKind, schema};
use kerfold::shape::solid_names;
use serde_json::{Map, Value, json};

/// The schema of a recipe (JSON Schema 2020-12). What the standard has no word for stands under
/// `x-kerfold`: the group of a step, the kind of a value, its unit.
pub fn json_schema() -> Value {
    let steps: Vec<Value> = schema().iter().map(step).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A recipe of kerfold",
        "type": "object",
        "properties": {
            "name": { "type": "string", "description": "What the recipe makes." },
            "parameters": {
                "type": "object",
                "description": "Names and values that steps use as \"{size}\".",
                "additionalProperties": { "type": ["string", "number"] },
            },
            "step": { "type": "array", "items": { "anyOf": steps } },
        },
        "required": ["step"],
        "additionalProperties": false,
    })
}

fn step(step: &StepSchema) -> Value {
    let title = match step.value {
        Some(value) => format!("{} {value}", step.verb),
        None => step.verb.to_owned(),
    };
    let keys: Map<String, Value> =
        step.keys.iter().map(|k| (k.key.clone(), key(step, k))).collect();
    let required: Vec<&str> =
        step.keys.iter().filter(|k| k.is_required).map(|k| k.key.as_str()).collect();
    let order: Vec<&str> = step.keys.iter().map(|k| k.key.as_str()).collect();
    json!({
        "title": title,
        "type": "object",
        "properties": keys,
        "required": required,
        "additionalProperties": false,
        "x-kerfold": {
            "verb": step.verb, "value": step.value, "group": step.group, "order": order,
        },
    })
}

fn key(step: &StepSchema, key: &KeySchema) -> Value {
    let mut told = json!({
        "description": key.help,
        "x-kerfold": {
            "kind": key.kind, "unit": unit(key.kind), "value_name": key.value_name,
            "choices": key.choices, "list": key.is_list,
        },
    });
    let kinds = match key.kind {
        ValueKind::Number | ValueKind::Length | ValueKind::Angle => json!(["number", "string"]),
        ValueKind::Integer => json!(["integer", "string"]),
        ValueKind::Switch => json!("boolean"),
        ValueKind::Selection => json!(["string", "integer", "array"]),
        ValueKind::Direction | ValueKind::Point => json!(["string", "array"]),
        ValueKind::Choice if !key.is_list => json!("string"),
        _ => json!(["string", "number", "array"]),
    };
    told["type"] = kinds;
    if key.is_verb
        && let Some(value) = step.value
    {
        told["const"] = json!(value);
    }
    if key.kind == ValueKind::Choice && !key.is_list {
        told["enum"] = key.choices.iter().map(|choice| choice.word.clone()).collect();
    }
    if let Some([low, high]) = key.range {
        (told["minimum"], told["maximum"]) = (json!(low), json!(high));
    }
    if key.is_verb && step.verb == "solid" {
        told["examples"] = solid_names().collect();
    }
    if let Some(default) = &key.default {
        told["default"] = match (key.kind, default.parse::<f64>()) {
            (ValueKind::Integer, Ok(number)) => json!(number as i64),
            (ValueKind::Number, Ok(number)) => json!(number),
            _ => json!(default),
        };
    }
    told
}

/// The unit of a bare number.
fn unit(kind: ValueKind) -> Option<&'static str> {
    match kind {
        ValueKind::Length | ValueKind::Point => Some("mm"),
        ValueKind::Angle => Some("deg"),
        _ => None,
    }
}
