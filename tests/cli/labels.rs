//! `classify`, `evaluate` and `presets fit`: from a scan to labels, to how good they are, and back to a preset.

use serde_json::Value;

use super::program::{Folder, pellucid};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error} in:\n{text}"))
}

/// A small phantom, its bone as .seg.nrrd, and the table that was printed.
fn labelled(folder: &Folder) -> (String, String, Value) {
    let (scan, labels) = (folder.path("head.nrrd"), folder.path("bone.seg.nrrd"));
    pellucid(&["phantom", "head", "--size", "32", "--nrrd", &scan]).success();
    let arguments = ["classify", &scan, "--preset", "bone", "-o", &labels, "--format", "json"];
    let printed = json(&pellucid(&arguments).success().stdout);
    (scan, labels, printed)
}

#[test]
fn labels_agree_with_themselves_and_a_preset_fits_them() {
    let folder = Folder::new("labels");
    let (scan, labels, printed) = labelled(&folder);
    let bone = &printed["tissues"][0];
    let voxels = bone["voxels"].as_u64().expect("a number");
    assert!(voxels > 500 && bone["mean_hu"].as_f64().expect("a number") > 200.0, "bone of the phantom: {bone}");

    let picture = folder.path("differences.png");
    let evaluate = ["evaluate", &labels, "--reference", &labels, "--scan", &scan, "--bound", "--picture", &picture];
    let found = json(&pellucid(&[&evaluate[..], &["--format", "json"]].concat()).success().stdout);
    let tissue = &found["tissues"][0];
    assert_eq!((tissue["dice"].as_f64(), tissue["hausdorff_95_mm"].as_f64()), (Some(1.0), Some(0.0)), "{tissue}");
    assert_eq!(found["confusion"]["voxels"][0][0].as_u64(), Some(voxels), "{found}");
    assert!(std::fs::metadata(&picture).is_ok_and(|file| file.len() > 1000), "a picture was drawn");
    // The label is a threshold of 90 HU, and bins are of 10 HU.
    assert_eq!(found["bounds"][0]["by_value"].as_f64(), Some(1.0), "{found}");

    let preset = pellucid(&["presets", "fit", &scan, &labels, "--tissue", "bone"]).success().stdout;
    let fitted = folder.write("bone.yaml", &preset);
    let again = json(&pellucid(&["classify", &scan, "--preset", &fitted, "--format", "json"]).success().stdout);
    assert_eq!(again["tissues"][0]["voxels"].as_u64(), Some(voxels), "the proposal gives the same labels:\n{preset}");
}

#[test]
fn tables_are_for_people_and_for_spreadsheets() {
    let folder = Folder::new("tables");
    let (scan, labels, _) = labelled(&folder);
    let text = pellucid(&["classify", &scan, "--preset", "bone"]).success().stdout;
    assert!(text.starts_with("tissue  label  voxels") && text.lines().count() == 2, "found:\n{text}");
    let csv = pellucid(&["evaluate", &labels, "--reference", &labels, "--format", "csv"]).success().stdout;
    assert!(csv.starts_with("tissue,Dice,") && csv.contains("\nbone,1.0000,1.0000,"), "found:\n{csv}");
}

#[test]
fn a_membership_is_written_if_asked_for() {
    let folder = Folder::new("membership");
    let (scan, share) = (folder.path("head.nrrd"), folder.path("share.nrrd"));
    pellucid(&["phantom", "head", "--size", "16", "--nrrd", &scan]).success();
    let ask = |tissue: &str| {
        let named = format!("{tissue}={share}");
        pellucid(&["classify", &scan, "--preset", "bone", "--membership", &named])
    };
    ask("bnoe").failure(3).says(&["bnoe", "one of bone"]);
    ask("bone").success();
    let info = json(&pellucid(&["info", &share, "--format", "json"]).success().stdout);
    assert_eq!(info["value_range"], serde_json::json!([0.0, 1.0]), "{info}");
}

#[test]
fn what_cannot_be_is_refused_before_the_scan_is_read() {
    let folder = Folder::new("refused");
    let scan = folder.path("none.nrrd");
    pellucid(&["classify", &scan]).failure(3).says(&["--preset bone"]);
    pellucid(&["classify", &folder.pipeline(), "--preset", "bone"]).failure(3).says(&["layers of a pipeline"]);
    pellucid(&["classify", &scan, "--preset", "bone", "-o", "x.tif"]).failure(8).says(&["x.tif", ".seg.nrrd"]);
    pellucid(&["classify", &scan, "--preset", "bone", "--set", "clean.fat=[fill-holes]"]).failure(4).says(&["none"]);
    let phantom = ["classify", &folder.pipeline(), "--set", "clean.fat=[fill-holes]"].map(String::from);
    pellucid(&phantom.each_ref().map(String::as_str)).failure(3).says(&["clean.fat", "skin, bone"]);
}
