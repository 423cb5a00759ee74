//! `phantom` and `info`: a scan written and read back.

use super::program::{Folder, pellucid};

#[test]
fn the_phantom_is_the_same_scan_in_both_formats() {
    let folder = Folder::new("both_formats");
    let (nrrd, dicom) = (folder.path("head.nrrd"), folder.path("head"));
    let run = pellucid(&["phantom", "head", "--size", "24", "--nrrd", &nrrd, "--dicom", &dicom]).success();
    assert_eq!(run.stdout, format!("{nrrd}\n{dicom}\n"), "the paths written");
    let info = |path: &str| -> serde_json::Value {
        let text = pellucid(&["info", path, "--format", "json"]).success().stdout;
        serde_json::from_str(&text).expect("valid JSON")
    };
    let (a, b) = (info(&nrrd), info(&dicom));
    for key in ["dims", "values_sha256", "value_range", "quantity"] {
        assert_eq!(a[key], b[key], "{key}");
        assert!(!a[key].is_null(), "{key} is given");
    }
    for row in 0..3 {
        for column in 0..4 {
            let at = |info: &serde_json::Value| info["index_to_lps_mm"][row][column].as_f64().expect("a number");
            assert!((at(&a) - at(&b)).abs() < 1e-6, "row {row}, column {column}: {} and {}", at(&a), at(&b));
        }
    }
    let slices = a["dims"][2].as_u64().expect("a number") as usize;
    assert_eq!(b["files"].as_array().map(Vec::len), Some(slices), "a file per slice");
    assert_eq!(b["series"].as_array().map(Vec::len), Some(1));
}

#[test]
fn a_scan_is_described_for_people() {
    let folder = Folder::new("described");
    let nrrd = folder.path("head.nrrd");
    pellucid(&["phantom", "head", "--size", "24", "--nrrd", &nrrd]).success();
    let text = pellucid(&["info", &nrrd]).success().stdout;
    for part in ["dimensions", "24 x 24 x ", "spacing", "HU", "histogram", "█", "to the head"] {
        assert!(text.contains(part), "expected {part:?} in:\n{text}");
    }
}

#[test]
fn the_same_seed_gives_the_same_scan_and_another_another() {
    let folder = Folder::new("seed");
    let hash = |name: &str, seed: &str| {
        let path = folder.path(name);
        pellucid(&["phantom", "head", "--size", "16", "--seed", seed, "--nrrd", &path]).success();
        let text = pellucid(&["info", &path, "--format", "json"]).success().stdout;
        let info: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
        info["values_sha256"].to_string()
    };
    assert_eq!(hash("a.nrrd", "3"), hash("b.nrrd", "3"));
    assert_ne!(hash("a.nrrd", "3"), hash("c.nrrd", "4"));
}

/// A series that makes no volume is still described; the reason is the error.
#[test]
fn what_cannot_be_rendered_is_described_all_the_same() {
    let folder = Folder::new("refused");
    let series = folder.path("series");
    pellucid(&["phantom", "head", "--size", "16", "--dicom", &series]).success();
    let mut slices: Vec<_> =
        std::fs::read_dir(&series).expect("written").map(|e| e.expect("readable").path()).collect();
    slices.sort();
    std::fs::remove_file(&slices[slices.len() / 2]).expect("a slice is taken out");
    let run = pellucid(&["info", &series, "--format", "json"]);
    assert_eq!(run.code, Some(6), "the geometry is refused: {}", run.stderr);
    let report: serde_json::Value = serde_json::from_str(&run.stdout).expect("valid JSON");
    assert!(report.get("dims").is_none(), "no volume, no dimensions");
    assert!(report["series"][0]["refused"].is_string(), "found {report:#}");
    assert_eq!(report["files"].as_array().map(Vec::len), Some(slices.len() - 1));
}

#[test]
fn a_formula_is_written_as_it_is_rendered() {
    let folder = Folder::new("formula");
    let pipeline = folder.write(
        "ring.yaml",
        "version: 1\nvolume: { values: hu, analytic: { field: { expression: 3*x + sin(y) }, size: [5, 4, 3], spacing_mm: 2 } }\n\
         effects: { surfaces: [{ hu: 0 }] }\n",
    );
    let nrrd = folder.path("ring.nrrd");
    pellucid(&["phantom", "analytic", &pipeline, "--nrrd", &nrrd]).success();
    let info = |path: &str| -> serde_json::Value {
        let text = pellucid(&["info", path, "--format", "json"]).success().stdout;
        serde_json::from_str(&text).expect("valid JSON")
    };
    let (written, made) = (info(&nrrd), info(&pipeline));
    for key in ["dims", "values_sha256", "value_range", "quantity", "index_to_lps_mm"] {
        assert_eq!(written[key], made[key], "{key}");
    }
    assert_eq!(made["facts"]["formula"], "3*x + sin(y)", "info says what was made");
    let head = folder.pipeline();
    pellucid(&["phantom", "analytic", &head, "--nrrd", &nrrd]).failure(3).says(&["head.yaml:2", "is no formula"]);
}
