//! How the program fails: exit codes, messages with places, and nothing half-written.

use super::program::{Folder, pellucid};

#[test]
fn a_command_line_that_cannot_be_read_is_2() {
    for arguments in
        [&["rendr", "x.yaml"][..], &["render"], &["render", "x.yaml", "--size", "12"], &["phantom", "head"]]
    {
        let run = pellucid(arguments);
        assert_eq!(run.code, Some(2), "pellucid {}:\n{}", run.arguments, run.stderr);
        assert_eq!(run.stdout, "", "usage errors are on stderr");
    }
}

#[test]
fn an_unknown_key_is_3_with_its_place_and_a_suggestion() {
    let folder = Folder::new("unknown_key");
    let text =
        "version: 1\nvolume: { phantom: { head: {} } }\ntransfer_function:\n  - preset: bone\ncamera:\n  azimut: 25\n";
    let pipeline = folder.write("typo.yaml", text);
    let run = pellucid(&["render", &pipeline]).failure(3);
    let first = run.stderr.lines().next().unwrap_or_default().to_string();
    assert!(first.contains("typo.yaml:6:3: "), "file, line and column on the first line; found: {first}");
    run.says(&["camera.azimut", "azimuth", "  azimut: 25", "remedy: "]);
    assert_eq!(folder.names(), ["typo.yaml"], "nothing was written");
}

#[test]
fn a_value_out_of_range_is_3_with_its_place() {
    let folder = Folder::new("out_of_range");
    let pipeline = folder.pipeline();
    let run = pellucid(&["render", &pipeline, "--set", "integrate.exact.tolerance=-1"]).failure(3);
    run.says(&["tolerance", "-1"]);
    assert_eq!(folder.names(), ["head.yaml"], "nothing was written");
}

#[test]
fn an_unknown_preset_is_3_with_a_suggestion() {
    pellucid(&["presets", "show", "bnoe"]).failure(3).says(&["bnoe", "did you mean bone?"]);
}

#[test]
fn a_scan_that_is_missing_is_4_with_the_nearest_name() {
    let folder = Folder::new("missing_scan");
    folder.write("head.nrrd", "");
    pellucid(&["info", &folder.path("haed.nrrd")]).failure(4).says(&["haed.nrrd", "head.nrrd"]);
}

#[test]
fn a_file_that_is_no_scan_is_4() {
    let folder = Folder::new("no_scan");
    pellucid(&["info", &folder.write("notes.txt", "not a scan")]).failure(4).says(&["notes.txt", "NRRD"]);
}

#[test]
fn a_format_that_is_not_read_is_5() {
    let folder = Folder::new("unsupported");
    pellucid(&["info", &folder.write("brain.mha", "ObjectType = Image")]).failure(5).says(&["MetaImage", "remedy: "]);
}

#[test]
fn a_series_with_a_gap_is_6() {
    let folder = Folder::new("gap");
    let series = folder.path("series");
    pellucid(&["phantom", "head", "--size", "16", "--dicom", &series]).success();
    let mut slices: Vec<_> =
        std::fs::read_dir(&series).expect("written").map(|e| e.expect("readable").path()).collect();
    slices.sort();
    std::fs::remove_file(&slices[slices.len() / 2]).expect("a slice is taken out");
    let run = pellucid(&["render", &folder.pipeline(), "--set", &format!("volume.source={series}")]);
    run.failure(6).says(&["mm"]);
    assert_eq!(folder.names(), ["head.yaml", "series"], "nothing was written");
}

#[test]
fn a_step_that_would_take_for_ever_is_7() {
    let folder = Folder::new("limit");
    let run = pellucid(&["render", &folder.pipeline(), "--set", "integrate={march: {step_mm: 1e-9}}"]);
    run.failure(7).says(&["step"]);
    assert_eq!(folder.names(), ["head.yaml"], "nothing was written");
}

#[test]
fn a_folder_that_cannot_be_made_is_8() {
    let folder = Folder::new("unwritable");
    // A file where a folder should be refuses even a user who may write anywhere.
    folder.write("file", "in the way");
    let picture = folder.path("file/head.png");
    pellucid(&["render", &folder.pipeline(), "-o", &picture]).failure(8).says(&["file", "remedy: "]);
    assert_eq!(folder.names(), ["file", "head.yaml"], "nothing was written");
}

#[test]
fn a_picture_that_is_a_folder_is_8_and_leaves_nothing_behind() {
    let folder = Folder::new("picture_is_folder");
    std::fs::create_dir(folder.path("head.png")).expect("a folder can be made");
    pellucid(&["render", &folder.pipeline()]).failure(8).says(&["head.png"]);
    assert_eq!(folder.names(), ["head.png", "head.yaml"], "neither a sidecar nor a temporary file");
}

#[test]
fn a_picture_of_no_known_format_is_3() {
    let folder = Folder::new("suffix");
    pellucid(&["render", &folder.pipeline(), "-o", &folder.path("head.jpg")]).failure(3).says(&["head.jpg", ".png"]);
    assert_eq!(folder.names(), ["head.yaml"], "nothing was written");
}

#[test]
fn a_failure_keeps_the_picture_of_an_earlier_run() {
    let folder = Folder::new("earlier_run");
    let pipeline = folder.pipeline();
    pellucid(&["render", &pipeline]).success();
    let before = std::fs::read(folder.path("head.png")).expect("the picture");
    pellucid(&["render", &pipeline, "--set", "camera.azimut=3"]).failure(3).says(&["--set"]);
    assert_eq!(std::fs::read(folder.path("head.png")).expect("still there"), before);
}
