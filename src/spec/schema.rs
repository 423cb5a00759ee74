//! JSON Schema (draft 2020-12) of pipelines and presets, from the types that read them.

use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};

use super::{Pipeline, Preset, Stack};

/// Schema of a pipeline of a scan.
pub fn pipeline_schema() -> Value {
    schema::<Pipeline>()
}

/// Schema of a stack of pictures.
pub fn stack_schema() -> Value {
    schema::<Stack>()
}

/// Schema of a preset.
pub fn preset_schema() -> Value {
    schema::<Preset>()
}

fn schema<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12().with_transform(Plain).with_transform(Fractions);
    let mut schema = settings.into_generator().into_root_schema_for::<T>().to_value();
    allow_bare_choices(&mut schema);
    schema
}

/// `Option<T>` means that a key may be left out, not that it may be null: takes `null` out of types.
#[derive(Clone)]
struct Plain;

impl Transform for Plain {
    fn transform(&mut self, schema: &mut Schema) {
        if let Some(Value::Array(types)) = schema.get_mut("type") {
            types.retain(|t| t != "null");
            if let [only] = types.as_slice() {
                let only = only.clone();
                schema.insert("type".to_owned(), only);
            }
        }
        if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
            choices.retain(|choice| choice != &json!({ "type": "null" }));
            if let [Value::Object(only)] = choices.as_slice() {
                let only = only.clone();
                schema.remove("anyOf");
                schema.ensure_object().extend(only);
            }
        }
        transform_subschemas(self, schema);
    }
}

/// A number may be a fraction: `1/255`.
#[derive(Clone)]
struct Fractions;

impl Transform for Fractions {
    fn transform(&mut self, schema: &mut Schema) {
        transform_subschemas(self, schema);
        if schema.get("type").is_some_and(|t| t == "number") {
            let keys = ["type", "minimum", "maximum", "format"];
            let mut number = Map::new();
            for key in keys {
                number.extend(schema.remove(key).map(|value| (key.to_owned(), value)));
            }
            number.remove("format");
            let fraction = json!({ "type": "string", "pattern": "^\\s*[-+0-9.eE]+\\s*/\\s*[-+0-9.eE]+\\s*$" });
            schema.insert("anyOf".to_owned(), json!([number, fraction]));
        }
    }
}

/// A choice all of whose settings have defaults may be written by its name alone.
fn allow_bare_choices(root: &mut Value) {
    let definitions = root.get("$defs").cloned().unwrap_or(Value::Null);
    let all_optional = |content: &Value| -> bool {
        let named = content.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix("#/$defs/"));
        let content = named.map_or(content, |name| &definitions[name]);
        content.get("type").is_some_and(|t| t == "object") && content.get("required").is_none()
    };
    let Some(Value::Object(schemas)) = root.get_mut("$defs") else { return };
    for schema in schemas.values_mut() {
        let Some(Value::Array(choices)) = schema.get_mut("oneOf") else { continue };
        let bare: Vec<Value> = choices
            .iter()
            .filter_map(|choice| {
                let [name] = choice.get("required")?.as_array()?.as_slice() else { return None };
                let content = &choice["properties"][name.as_str()?];
                all_optional(content).then(|| json!({ "const": name, "description": "With all its defaults." }))
            })
            .collect();
        choices.extend(bare);
    }
}

#[cfg(test)]
mod tests {
    use schemars::json_schema;

    use super::*;

    #[test]
    fn numbers_may_be_fractions() {
        let mut schema = json_schema!({ "type": "number", "minimum": 0, "format": "double" });
        Fractions.transform(&mut schema);
        assert_eq!(schema.as_value()["anyOf"][0], json!({ "type": "number", "minimum": 0 }));
        assert_eq!(schema.as_value()["anyOf"][1]["type"], "string");
    }
}
