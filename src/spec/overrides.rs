//! `--set a.b.0.c=value`: overrides on the tree, before it gets a type.

use super::tree::{self, Key, Node, Origin, Value};
use crate::error::{Error, Fault, Result};

/// Applies the override of this index: `path=value`, with the value in YAML, and `null` to remove a key.
///
/// # Errors
/// `Fault::Spec`, naming the override, for one that is not of that form or leads into a list where there is nothing.
pub(super) fn apply(tree: &mut Node, index: usize, text: &str) -> Result<()> {
    let refused = |what: &str| Error::new(Fault::Spec, what.to_owned()).at(format!("--set {text}"));
    let (path, value) = text
        .split_once('=')
        .ok_or_else(|| refused("an override has no value").expected("key.path=value, such as camera.azimuth=25"))?;
    let parts: Vec<&str> = path.split('.').collect();
    if parts.iter().any(|part| part.is_empty()) {
        return Err(refused("an override has an empty key").found(path).expected("keys with dots between them"));
    }
    let origin = Origin::Override(index);
    // A colour such as #f2e6d0 would be a comment, and nobody writes comments there.
    let value = if value.starts_with('#') {
        Node { value: Value::Text(value.to_owned()), origin }
    } else {
        let mut node = tree::parse(value).map_err(|error| {
            refused("the value of an override is not valid YAML").caused_by(error.without_snippet().to_string())
        })?;
        set_origin(&mut node, origin);
        node
    };
    set(tree, &parts, value, origin).map_err(|what| refused(&what).element(path))
}

fn set_origin(node: &mut Node, origin: Origin) {
    node.origin = origin;
    match &mut node.value {
        Value::List(items) => items.iter_mut().for_each(|item| set_origin(item, origin)),
        Value::Map(entries) => entries.iter_mut().for_each(|(key, node)| {
            key.origin = origin;
            set_origin(node, origin);
        }),
        _ => {}
    }
}

fn set(node: &mut Node, parts: &[&str], value: Node, origin: Origin) -> Result<(), String> {
    let [part, rest @ ..] = parts else {
        *node = value;
        return Ok(());
    };
    if let Value::List(items) = &mut node.value {
        let length = items.len();
        let item = part.parse::<usize>().ok().and_then(|index| items.get_mut(index));
        let item = item.ok_or_else(|| format!("there is no item {part} in a list of {length}; the first is 0"))?;
        return set(item, rest, value, origin);
    }
    if !matches!(node.value, Value::Map(_)) {
        // `integrate: exact` is `integrate: { exact: {} }`, so that its settings can be reached.
        let name = match &node.value {
            Value::Text(text) if text == part => Some(text.clone()),
            _ => None,
        };
        let empty = Node { value: Value::Map(Vec::new()), origin };
        node.value = Value::Map(name.map(|name| (Key { name, origin }, empty)).into_iter().collect());
        node.origin = origin;
    }
    let Value::Map(entries) = &mut node.value else { return Err("a mapping was expected".to_owned()) };
    if rest.is_empty() && value.value == Value::Null {
        entries.retain(|(key, _)| key.name != *part);
        return Ok(());
    }
    let at = entries.iter().position(|(key, _)| key.name == *part).unwrap_or_else(|| {
        let empty = Node { value: Value::Map(Vec::new()), origin };
        entries.push((Key { name: (*part).to_owned(), origin }, empty));
        entries.len() - 1
    });
    set(&mut entries[at].1, rest, value, origin)
}
