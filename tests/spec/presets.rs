//! Presets: those built in are those of the folder, and how a name is found.

use std::fs;
use std::path::{Path, PathBuf};

use pellucid::spec::{BUILT_IN_PRESETS, Document, Spec, built_in_preset, load_preset};

use super::{SHORT, mistake};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("presets")
}

#[test]
fn built_in_presets_are_those_of_the_folder() {
    let mut files: Vec<String> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "yaml"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    files.sort();
    let built_in: Vec<&str> = BUILT_IN_PRESETS.iter().map(|(name, _)| *name).collect();
    assert_eq!(built_in, files, "the table in src/spec/library.rs, and the files in presets/, by name");
}

#[test]
fn every_preset_is_valid_and_described() {
    for (name, text) in BUILT_IN_PRESETS {
        let built_in = built_in_preset(name).unwrap().unwrap_or_else(|error| panic!("{error}"));
        let file = load_preset(&folder().join(format!("{name}.yaml"))).unwrap();
        assert_eq!(built_in.preset, file.preset);
        assert_eq!(built_in.text, *text);
        assert!(built_in.preset.description.is_some(), "{name} says what it shows");
    }
    assert!(built_in_preset("no such preset").is_none());
}

#[test]
fn every_example_is_valid() {
    let pipelines = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines");
    let mut count = 0;
    for entry in fs::read_dir(pipelines).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "yaml") {
            Document::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
            count += 1;
        }
    }
    assert!(count >= 4, "found {count} examples");
}

#[test]
fn a_folder_near_the_pipeline_comes_before_what_is_built_in() {
    let root = std::env::temp_dir().join(format!("pellucid-presets-{}", std::process::id()));
    fs::create_dir_all(root.join("pipelines")).unwrap();
    fs::create_dir_all(root.join("presets")).unwrap();
    let own =
        "version: 1\nname: bone\nwidgets:\n  - rectangle: { hu: [7, 8] }\n    extinction_per_mm: 1\n    color: red\n";
    fs::write(root.join("presets/bone.yaml"), own).unwrap();
    fs::write(root.join("pipelines/scene.yaml"), SHORT).unwrap();
    let spec = Spec::load(&root.join("pipelines/scene.yaml"), &[]).unwrap();
    let loaded = spec.layers().next().unwrap().1.unwrap().clone();

    let mistaken = own.replace("rectangle", "rectangel");
    fs::write(root.join("presets/bone.yaml"), mistaken).unwrap();
    let error = Spec::load(&root.join("pipelines/scene.yaml"), &[]).unwrap_err();
    fs::remove_dir_all(&root).unwrap();

    assert_eq!(loaded.text, own, "from {}", loaded.path.display());
    let message = error.to_string();
    assert!(message.contains("bone.yaml:4:5: there is no such key (widgets.0.rectangel)"), "found {message}");
}

#[test]
fn a_preset_path_that_leads_nowhere_says_where_it_looked() {
    let error = mistake(&SHORT.replace("bone", "looks/bone.yaml"));
    assert!(error.to_string().contains("there is no such preset file"), "{error}");
    assert!(error.to_string().contains("looks/bone.yaml"), "{error}");
}
