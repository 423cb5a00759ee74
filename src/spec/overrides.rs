//! `--set a.b.0.c=value`: overrides on the tree, before it gets a type.

use super::tree::{self, Key, Node, Origin, Value};
use crate::error::{Error, Fault, Result};

/// Keys that exclude each other, by their paths: a scan is one or the other, and so is a method.
const ALTERNATIVES: [&[&str]; 6] = [
    &["volume.source", "volume.phantom", "volume.analytic"],
    &["integrate.exact", "integrate.march", "integrate.reference", "integrate.auto"],
    &["integrate.auto.tolerance", "integrate.auto.budget_ms"],
    &["integrate.march.step_mm", "integrate.march.step_voxels"],
    &["effects.mask.source", "effects.mask.phantom"],
    &["effects.fog.linear", "effects.fog.exp", "effects.fog.exp2"],
];

/// Applies the override of this index: `path=value`, with the value in YAML, and `null` to remove a key. What the file
/// says in a key that excludes this one goes: `--set volume.source=…` renders another scan in place of a phantom.
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
    if value.value != Value::Null {
        remove_alternatives(tree, path);
    }
    set(tree, &parts, value, origin).map_err(|what| refused(&what).element(path))
}

/// Removes the keys of the file that the key at `path`, or one above it, excludes. Those that another override has set
/// stay, so that two overrides that exclude each other are still an error.
fn remove_alternatives(tree: &mut Node, path: &str) {
    let is_within = |key: &str| path == key || path.strip_prefix(key).is_some_and(|rest| rest.starts_with('.'));
    for keys in ALTERNATIVES.iter().filter(|keys| keys.iter().any(|key| is_within(key))) {
        for excluded in keys.iter().filter(|key| !is_within(key)) {
            remove_from_file(tree, excluded);
        }
    }
}

fn remove_from_file(tree: &mut Node, key_path: &str) {
    let mut node = tree;
    let mut parts = key_path.split('.').peekable();
    while let Some(part) = parts.next() {
        let Value::Map(entries) = &mut node.value else { return };
        if parts.peek().is_none() {
            entries.retain(|(key, node)| key.name != part || matches!(node.origin, Origin::Override(_)));
            return;
        }
        let Some((_, child)) = entries.iter_mut().find(|(key, _)| key.name == part) else { return };
        node = child;
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn keys_after(file: &str, overrides: &[&str], of: &str) -> Vec<String> {
        let mut tree = tree::parse(file).expect("valid YAML");
        for (index, text) in overrides.iter().enumerate() {
            apply(&mut tree, index, text).expect("a valid override");
        }
        let Value::Map(entries) = &tree.child(of).expect("the mapping").value else { panic!("{of} is no mapping") };
        entries.iter().map(|(key, _)| key.name.clone()).collect()
    }

    #[test]
    fn an_override_takes_the_place_of_what_it_excludes() {
        let phantom = "volume: { phantom: { head: {} } }";
        assert_eq!(keys_after(phantom, &["volume.source=scan"], "volume"), ["source"]);
        let exact = "integrate: { exact: { tolerance: 1/100 } }";
        assert_eq!(keys_after(exact, &["integrate.march.step_mm=1"], "integrate"), ["march"]);
        assert_eq!(keys_after(exact, &["integrate.exact.tolerance=1/50"], "integrate"), ["exact"]);
    }

    #[test]
    fn overrides_that_exclude_each_other_both_stay() {
        let found = keys_after("volume: { source: a }", &["volume.phantom.head={}", "volume.source=b"], "volume");
        assert_eq!(found, ["phantom", "source"], "so that the check of the pipeline refuses them");
    }
}
