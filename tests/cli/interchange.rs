//! `presets import`, `export` and `check`.

use std::path::Path;

use super::program::{Folder, pellucid};

fn slicer(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/interchange/slicer").join(name);
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn a_file_of_slicers_becomes_presets_that_render() {
    let folder = Folder::new("presets_import");
    let presets = folder.path("presets");
    let listed = pellucid(&["presets", "import", &slicer("presets.xml"), "-o", &presets]).success();
    let files: Vec<&str> = listed.stdout.lines().collect();
    assert_eq!(files.len(), 22, "found {files:?}");
    listed.says(&["ct-aaa: ", "points; opacity and colour within"]);
    let bone = folder.path("presets/ct-bone.yaml");
    pellucid(&["presets", "check", &bone]).success();
    let pipeline = folder.write(
        "p.yaml",
        "version: 1\nvolume: { phantom: { head: { size: 16 } } }\ntransfer_function: [{ preset: ct-bone }]\n",
    );
    pellucid(&["render", &pipeline, "--size", "8x8", "-o", &folder.path("p.png")]).success();
}

#[test]
fn one_preset_goes_to_stdout() {
    let shown = pellucid(&["presets", "import", &slicer("ct-bone.vp"), "--name", "My bone"]).success();
    assert!(shown.stdout.contains("name: \"my-bone\""), "found:\n{}", shown.stdout);
    let one = pellucid(&["presets", "import", &slicer("presets.xml"), "--name", "CT-Lung"]).success();
    assert!(one.stdout.contains("CT-Lung, imported"), "found:\n{}", one.stdout);
    pellucid(&["presets", "import", &slicer("presets.xml")]).failure(3).says(&["several", "--name"]);
    pellucid(&["presets", "import", &slicer("presets.xml"), "--name", "CT-Lungs"]).failure(3).says(&["CT-Lung,"]);
}

#[test]
fn exports_say_what_they_lose() {
    let folder = Folder::new("presets_export");
    for (format, name) in [("vp", "bone.vp"), ("vp-json", "bone.vp.json"), ("paraview", "bone.json")] {
        let path = folder.path(name);
        let run = pellucid(&["presets", "export", "bone", "--format", format, "-o", &path]).success();
        run.says(&["lost with the gradient axis", "HU/mm"]);
        let checked = pellucid(&["presets", "check", &path]).success().stdout;
        assert!(checked.contains("1 to import: bone"), "found {checked}");
    }
    let path = folder.path("x.vp");
    pellucid(&["presets", "export", "bnoe", "--format", "vp", "-o", &path]).failure(3).says(&["did you mean bone?"]);
}

#[test]
fn a_check_names_each_mistake() {
    let folder = Folder::new("presets_check");
    let good = folder.write(
        "good.yaml",
        "version: 1\nname: good\nwidgets:\n  - rectangle: { hu: [7, 8] }\n    opacity_per_mm: 0.5\n    color: red\n",
    );
    let bad = folder.write("bad.yaml", "version: 1\nname: bad\nwidgets:\n  - rectangel: { hu: [7, 8] }\n");
    let run = pellucid(&["presets", "check", &good, &bad]);
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert!(run.stdout.contains("good.yaml: 1 widgets"), "found {}", run.stdout);
    run.says(&["bad.yaml:4:5", "rectangel", "1 of 2 with errors"]);
}
