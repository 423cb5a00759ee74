//! Who may use whom. The table below is the one of ARCHITECTURE.md; the source is read and held to it.

mod paths;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use paths::{Use, root_names, uses};

/// The library's modules by layer. A module may use modules of lower layers, and itself.
const LAYERS: [&[&str]; 7] = [
    &["math", "simd", "error", "demand"],
    &["volume", "transfer", "image", "scene"],
    &["field", "classify", "spec", "io", "synthetic"],
    &["histogram", "plan", "oracle"],
    &["chart", "integrate", "tissue"],
    &["interchange", "study", "verify"],
    &["pipeline"],
];

/// Modules that may use less than their layer allows: `(user, what it may use, why)`.
const ONLY: [(&str, &[&str], &str); 1] = [(
    "oracle",
    &["math", "volume", "transfer", "scene", "error"],
    "the truth shares definitions with the integrators, and nothing that could be wrong in both",
)];

/// Uses that the layers allow and a rule forbids: `(user, used, why)`.
const NEVER: [(&str, &str, &str); 2] = [
    ("integrate", "spec", "what may be written is resolved by the plan before the first ray"),
    ("tissue", "spec", "what may be written is resolved by the plan before the first voxel"),
];

/// Uses that the layers forbid and are right all the same: `(user, used, why)`.
const EXCEPTIONS: [(&str, &str, &str); 4] = [
    ("simd", "math", "registers are numbers: formulas are written once for both"),
    ("scene", "transfer", "a scene holds its transfer function, which knows of no scene"),
    ("volume", "image", "the colours of an RGBA volume are what a picture's are: sRGB"),
    ("scene", "image", "the grey of a projected value is defined by what a display shows: sRGB"),
];

/// The layer of a module of the library.
fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

/// Why `user` may not use `used`, or `None` if it may.
fn objection(user: &str, used: &str) -> Option<String> {
    if user == used || EXCEPTIONS.iter().any(|(a, b, _)| (*a, *b) == (user, used)) {
        return None;
    }
    let (Some(above), Some(below)) = (layer(user), layer(used)) else {
        return Some(format!("`{user}` or `{used}` stands in no layer: add it to the table"));
    };
    if below >= above {
        return Some(format!("`{user}` is in layer {above} and `{used}` in layer {below}"));
    }
    if let Some((_, may, why)) = ONLY.iter().find(|(module, ..)| *module == user)
        && !may.contains(&used)
    {
        return Some(format!("`{user}` may use {may:?} only: {why}"));
    }
    NEVER.iter().find(|(a, b, _)| (*a, *b) == (user, used)).map(|(_, _, why)| format!("`{user}` never: {why}"))
}

/// All violations in a file of the library: `path:line: …`.
fn violations(path: &str, source: &str, names: &[(String, String)]) -> Vec<String> {
    let Some(user) = module_of(path) else { return Vec::new() };
    let complain = |Use { line, used }: Use| {
        objection(&user, &used).map(|why| format!("{path}:{line}: uses crate::{used}, but {why}"))
    };
    uses(path, source, names).into_iter().filter_map(complain).collect()
}

/// The top-level module of a source file, `None` for the roots and the binary's own modules.
fn module_of(path: &str) -> Option<String> {
    let inside = path.strip_prefix("src/")?;
    let first = inside.split('/').next()?.trim_end_matches(".rs");
    (!["lib", "main", "cli"].contains(&first)).then(|| first.to_string())
}

/// The files below a folder of the repository with this extension, as `(path from the root with slashes, text)`.
pub(crate) fn files_below(folder: &str, extension: &str) -> Vec<(String, String)> {
    fn collect(folder: &Path, extension: &str, found: &mut BTreeSet<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("the repository's own folders are readable") {
            let path = entry.expect("the repository's own files are readable").path();
            if path.is_dir() {
                collect(&path, extension, found);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.insert(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = BTreeSet::new();
    collect(&root.join(folder), extension, &mut found);
    let named = |path: PathBuf| {
        let name = path.strip_prefix(root).expect("found below the root").to_string_lossy().replace('\\', "/");
        let text = std::fs::read_to_string(&path).expect("sources are UTF-8");
        (name, text)
    };
    found.into_iter().map(named).collect()
}

#[test]
fn modules_use_lower_layers_only() {
    let files = files_below("src", "rs");
    let lib = &files.iter().find(|(path, _)| path == "src/lib.rs").expect("the library has a root").1;
    let names = root_names(lib);
    let found: Vec<String> = files.iter().flat_map(|(path, text)| violations(path, text, &names)).collect();
    assert!(found.is_empty(), "{} uses against the layers:\n{}", found.len(), found.join("\n"));
}

#[test]
fn every_module_stands_in_a_layer() {
    let modules: BTreeSet<String> = files_below("src", "rs").iter().filter_map(|(path, _)| module_of(path)).collect();
    let homeless: Vec<&String> = modules.iter().filter(|m| layer(m).is_none()).collect();
    assert!(homeless.is_empty(), "modules in no layer of tests/layering.rs: {homeless:?}");
    assert!(modules.len() > 10, "the source was looked for in the wrong place: found only {modules:?}");
}

#[test]
fn the_architecture_names_every_layer_as_the_test_does() {
    let text = include_str!("../ARCHITECTURE.md");
    for (number, modules) in LAYERS.iter().enumerate() {
        for module in *modules {
            let row = text.lines().find(|l| l.starts_with(&format!("| {number} | `{module}`")));
            assert!(row.is_some(), "ARCHITECTURE.md has no row `| {number} | `{module}` | … |`");
        }
    }
}

#[test]
fn no_source_file_is_longer_than_500_lines() {
    let mut files = files_below("src", "rs");
    files.extend(files_below("tests", "rs"));
    let long: Vec<String> = files
        .iter()
        .map(|(path, text)| (path, text.lines().count()))
        .filter(|(_, lines)| *lines > 500)
        .map(|(path, lines)| format!("{path}: {lines}"))
        .collect();
    assert!(long.is_empty(), "files of more than 500 lines: {long:?}");
}

/// The check is worth what it finds: each kind of violation, planted.
#[test]
fn a_planted_violation_is_found() {
    let names = vec![("Volume".to_string(), "volume".to_string()), ("Spec".to_string(), "spec".to_string())];
    let planted = [
        ("src/volume/grid.rs", "use crate::io::nrrd;", "a higher layer"),
        ("src/field/mod.rs", "use crate::classify::Table;", "the same layer"),
        ("src/volume/mod.rs", "use crate::{error::Error, io::nrrd};", "one of a group"),
        ("src/math/mod.rs", "fn f(v: &crate::Volume) {}", "a name re-exported at the root, within code"),
        ("src/math/hash.rs", "use super::super::volume::Grid;", "a path by super"),
        ("src/oracle/mod.rs", "use crate::field::Sampler;", "the oracle shares no method"),
        ("src/integrate/march.rs", "use crate::Spec;", "an integrator reads no spec"),
        ("src/novelty/mod.rs", "use crate::error::Error;", "a module in no layer"),
    ];
    for (path, source, what) in planted {
        let found = violations(path, source, &names);
        assert_eq!(found.len(), 1, "{what}: `{source}` in {path} should be one violation, found {found:?}");
        assert!(found[0].starts_with(&format!("{path}:1: ")), "names the place: found {}", found[0]);
    }
}

#[test]
fn what_is_allowed_is_not_complained_of() {
    let names = vec![("Error".to_string(), "error".to_string())];
    let fine = [
        ("src/io/nrrd/header.rs", "use super::encoding;\nuse super::super::whole_file;\nuse crate::io::png;"),
        ("src/plan/mod.rs", "use crate::spec::Spec;\nuse crate::Error;"),
        ("src/volume/mod.rs", "//! See [`crate::integrate`].\n/* crate::integrate */ const S: &str = \"crate::io\";"),
        ("src/scene/mod.rs", "use std::fmt;\nuse crate::transfer::{self, TransferFunction};"),
        ("src/lib.rs", "pub use crate::pipeline::run;"),
        ("src/cli/mod.rs", "use crate::cli::report;"),
    ];
    for (path, source) in fine {
        let found = violations(path, source, &names);
        assert!(found.is_empty(), "{path} is fine, found {found:?}");
    }
}
