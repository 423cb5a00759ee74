//! Label masks end to end: from a label file to a picture and its sidecar.

use super::program::{Folder, pellucid};

/// The hash of a picture's pixels by its sidecar, and the sidecar.
fn rendered(pipeline: &str, picture: &str, sets: &[&str]) -> (String, serde_json::Value) {
    let mut arguments = vec!["render", pipeline, "-o", picture];
    arguments.extend(sets.iter().flat_map(|set| ["--set", *set]));
    pellucid(&arguments).success();
    let text = std::fs::read_to_string(format!("{picture}.json")).expect("the sidecar");
    let sidecar: serde_json::Value = serde_json::from_str(&text).expect("valid JSON");
    (sidecar["picture"]["pixels_sha256"].to_string(), sidecar)
}

#[test]
fn a_label_file_masks_as_the_phantoms_own_structures_do() {
    let folder = Folder::new("mask");
    let (pipeline, labels) = (folder.pipeline(), folder.path("DOE^JANE.seg.nrrd"));
    let run = pellucid(&["phantom", "head", "--size", "32", "--labels", &labels]).success();
    assert_eq!(run.stdout, format!("{labels}\n"), "the label map alone");
    let looks = "labels: { skull: hide, 10: { preset: vessels } }";
    let picture = |name: &str| folder.path(name);
    let by_file = format!("effects.mask={{ source: \"{labels}\", {looks} }}");
    let (from_file, sidecar) = rendered(&pipeline, &picture("file.png"), &[&by_file]);
    let by_rule = format!("effects.mask={{ phantom: structures, {looks} }}");
    let (from_rule, _) = rendered(&pipeline, &picture("rule.png"), &[&by_rule]);
    let (without, plain) = rendered(&pipeline, &picture("plain.png"), &[]);
    assert_eq!(from_file, from_rule, "the same labels");
    assert_ne!(from_file, without, "the mask takes part");
    let info = pellucid(&["info", &labels, "--format", "json"]).success().stdout;
    let info: serde_json::Value = serde_json::from_str(&info).expect("valid JSON");
    assert_eq!(sidecar["labels"]["values_sha256"], info["values_sha256"], "the labels' hash as `info` gives it");
    assert!(sidecar["labels"]["voxels"]["5"].as_u64() > Some(0), "found {}", sidecar["labels"]);
    assert_eq!(plain["labels"], serde_json::Value::Null);
    assert!(!sidecar.to_string().contains("DOE"), "neither the labels' path nor its name");
    let inputs: Vec<&str> = sidecar["inputs_sha256"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|input| input["name"].as_str())
        .collect();
    assert_eq!(inputs, ["pipeline", "skin", "bone", "vessels"], "the labels' presets are inputs too");
}

#[test]
fn a_mask_that_shows_all_gives_the_same_bytes_as_none() {
    let folder = Folder::new("mask-all");
    let pipeline = folder.pipeline();
    let (without, _) = rendered(&pipeline, &folder.path("plain.png"), &[]);
    let whole = "effects.clip={ box: { trim_mm: { left: 0, superior: 0 } } }";
    let all = "effects.mask={ phantom: structures, labels: { skull: show } }";
    let (with, sidecar) = rendered(&pipeline, &folder.path("all.png"), &[whole, all]);
    assert_eq!(with, without);
    assert_eq!((&sidecar["labels"], &sidecar["plan"]["mask"]), (&serde_json::Value::Null, &serde_json::Value::Null));
}

#[test]
fn labels_of_another_size_or_none_at_all_are_refused() {
    let folder = Folder::new("mask-size");
    let (pipeline, labels) = (folder.pipeline(), folder.path("small.nrrd"));
    pellucid(&["phantom", "head", "--size", "24", "--labels", &labels]).success();
    let mask = format!("effects.mask={{ source: \"{labels}\", labels: {{ skull: hide }} }}");
    pellucid(&["explain", &pipeline, "--set", &mask]).failure(6).says(&[
        "small.nrrd: the labels are not on the scan's lattice: found 24 x 24 x 22 voxels, expected 32 x 32 x 30, as the scan",
        "remedy: write the labels on the scan's own lattice",
    ]);
    let absent = "effects.mask={ source: nowhere.nrrd, labels: { 1: hide } }";
    pellucid(&["explain", &pipeline, "--set", absent]).failure(4).says(&["nowhere.nrrd: there is no such file"]);
}
