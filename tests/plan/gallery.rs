//! The plans of the example pipelines, in words: snapshots, so that whoever changes what is computed sees what else changes.
//! That each says what it does not compute, and why, is asserted.

use std::path::{Path, PathBuf};

use pellucid::pipeline::{self, Options};
use pellucid::plan::explain;
use pellucid::spec::{Document, PhantomSpec, Spec, VolumeSource};

/// The example pipelines that need no scan, with the head phantom made small.
fn pipelines() -> Vec<(String, Spec)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipelines");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        let load = |overrides: &[String]| Document::load(&path, overrides).unwrap_or_else(|error| panic!("{error}"));
        let Document::Scan(spec) = load(&[]) else { continue };
        let overrides = match spec.volume_source() {
            VolumeSource::File { .. } => continue,
            VolumeSource::Phantom(PhantomSpec::Head(_)) => vec!["volume.phantom={ head: { size: 32 } }".to_owned()],
            VolumeSource::Phantom(PhantomSpec::Chest(_)) => vec!["volume.phantom={ chest: { size: 32 } }".to_owned()],
            VolumeSource::Phantom(_) | VolumeSource::Analytic(_) => Vec::new(),
        };
        let Document::Scan(spec) = load(&overrides) else { unreachable!("it was one before") };
        found.push((path.file_stem().unwrap().to_string_lossy().into_owned(), *spec));
    }
    found
}

#[test]
fn every_example_says_what_it_does_not_compute_and_why() {
    let pipelines = pipelines();
    assert!(pipelines.len() >= 12, "a dozen examples need no scan: found {}", pipelines.len());
    for (name, spec) in pipelines {
        let options = Options { output: Some(format!("{name}.png").into()), ..Options::default() };
        let scan = pipeline::load(&spec, &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        let plan = pipeline::plan(&spec, &scan, &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(!plan.not_computed.is_empty(), "{name}: something is not computed");
        for omission in &plan.not_computed {
            assert!(omission.why.len() > 10, "{name}: {} is not computed, and why is not said", omission.what);
        }
        assert!(plan.memory_bytes() >= plan.volume_bytes() && plan.work().rays > 0, "{name}: {:?}", plan.work());
        insta::assert_snapshot!(name.clone(), explain(&plan));
    }
}
