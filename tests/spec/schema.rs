//! The JSON Schema says what the reader accepts.

use std::path::Path;

use pellucid::spec::{BUILT_IN_PRESETS, pipeline_schema, preset_schema, stack_schema};
use serde_json::{Map, Value, json};

/// What is wrong with an instance, by the part of JSON Schema that our schemas use; panics on any other keyword.
fn complaint(root: &Value, schema: &Value, instance: &Value) -> Option<String> {
    let Value::Object(keywords) = schema else {
        return (schema == &json!(false)).then(|| "nothing may be here".into());
    };
    keywords.iter().find_map(|(keyword, value)| {
        let holds = match keyword.as_str() {
            "$ref" => {
                let name = value.as_str().and_then(|r| r.strip_prefix("#/")).expect("a local reference");
                let target = name.split('/').fold(root, |node, part| &node[part]);
                assert!(target.is_object(), "{value} leads nowhere");
                return complaint(root, target, instance);
            }
            "type" => is_of_type(value.as_str().expect("one type"), instance),
            "const" => value == instance,
            "enum" => value.as_array().expect("choices").contains(instance),
            "anyOf" => value.as_array().expect("schemas").iter().any(|s| complaint(root, s, instance).is_none()),
            "oneOf" => {
                value.as_array().expect("schemas").iter().filter(|s| complaint(root, s, instance).is_none()).count()
                    == 1
            }
            "minimum" => instance.as_f64().is_none_or(|x| Some(x) >= value.as_f64()),
            "maximum" => instance.as_f64().is_none_or(|x| Some(x) <= value.as_f64()),
            "minItems" => instance.as_array().is_none_or(|a| a.len() as u64 >= value.as_u64().unwrap()),
            "maxItems" => instance.as_array().is_none_or(|a| a.len() as u64 <= value.as_u64().unwrap()),
            "items" => return instance.as_array()?.iter().find_map(|item| complaint(root, value, item)),
            "required" => {
                let object = instance.as_object()?;
                value.as_array().unwrap().iter().all(|key| object.contains_key(key.as_str().unwrap()))
            }
            "properties" => {
                let object = instance.as_object()?;
                return object
                    .iter()
                    .find_map(|(key, v)| complaint(root, value.get(key)?, v).map(|c| format!("{key}: {c}")));
            }
            "additionalProperties" if value.is_object() => {
                // A map: every key stands for itself.
                let object = instance.as_object()?;
                return object.iter().find_map(|(key, v)| complaint(root, value, v).map(|c| format!("{key}: {c}")));
            }
            "additionalProperties" => {
                let known = keywords.get("properties").and_then(Value::as_object).cloned().unwrap_or_else(Map::new);
                let mut others = instance.as_object()?.iter().filter(|(key, _)| !known.contains_key(*key));
                return others.find_map(|(key, v)| complaint(root, value, v).map(|c| format!("{key}: {c}")));
            }
            // A fraction needs its stroke and a colour its mark; that much of the patterns is checked here.
            "pattern" => {
                let mark = if value.as_str().unwrap().starts_with("^#") { '#' } else { '/' };
                instance.as_str().is_none_or(|text| text.contains(mark))
            }
            "$schema" | "$defs" | "title" | "description" | "format" | "default" => true,
            other => panic!("keyword {other} is not understood"),
        };
        (!holds).then(|| format!("{keyword} {value} does not hold for {instance}"))
    })
}

fn is_of_type(name: &str, instance: &Value) -> bool {
    match name {
        "object" => instance.is_object(),
        "array" => instance.is_array(),
        "string" => instance.is_string(),
        "number" => instance.is_number(),
        "integer" => instance.is_u64() || instance.is_i64(),
        "boolean" => instance.is_boolean(),
        other => panic!("type {other} is not understood"),
    }
}

fn yaml(text: &str) -> Value {
    serde_saphyr::from_str(text).unwrap()
}

#[test]
fn examples_and_presets_satisfy_it() {
    let (scans, stacks) = (pipeline_schema(), stack_schema());
    assert_eq!(scans["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let pipelines = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines");
    for entry in std::fs::read_dir(pipelines).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "yaml") {
            let instance = yaml(&std::fs::read_to_string(&path).unwrap());
            let schema = if instance.get("layers").is_some() { &stacks } else { &scans };
            assert_eq!(complaint(schema, schema, &instance), None, "{}", path.display());
        }
    }
    let schema = preset_schema();
    for (name, text) in BUILT_IN_PRESETS {
        assert_eq!(complaint(&schema, &schema, &yaml(text)), None, "{name}");
    }
}

#[test]
fn mistakes_do_not() {
    let schema = pipeline_schema();
    let good = "version: 1\nvolume: { phantom: head }\ntransfer_function: [{ preset: bone }]\nintegrate: exact\n";
    assert_eq!(complaint(&schema, &schema, &yaml(good)), None);
    for (right, wrong) in [
        ("version: 1", "version: 2"),
        ("preset: bone", "presett: bone"),
        ("preset: bone", "preset: bone, opacity_scale: -1"),
        ("preset: bone", "preset: bone, opacity_scale: much"),
        ("[{ preset: bone }]", "[]"),
        ("integrate: exact", "integrate: precise"),
        ("integrate: exact", "integrate: { exact: { tolerance: null } }"),
        ("phantom: head", "phantom: 3"),
        ("integrate: exact", "effects: { mask: { source: a.nrrd, labels: { 1: hidden } } }"),
        ("integrate: exact", "effects: { mask: { source: a.nrrd, labels: { 1: { presett: bone } } } }"),
        ("integrate: exact", "effects: { clip: { box: { mm: [open, closed, open] } } }"),
        ("integrate: exact", "clean: { bone: [fill-hole] }"),
        ("integrate: exact", "clean: { bone: [{ closing_mm: far }] }"),
    ] {
        let bad = good.replace(right, wrong);
        assert!(complaint(&schema, &schema, &yaml(&bad)).is_some(), "this satisfies the schema:\n{bad}");
        assert!(super::read(&bad).is_err(), "this is read:\n{bad}");
    }
}
