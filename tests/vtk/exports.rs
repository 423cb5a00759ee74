//! What `pellucid export-vtk` writes.

use pellucid::interchange::vtk;
use pellucid::io::npy;
use pellucid::pipeline::{self, Options};
use pellucid::{Error, Fault};

use super::spec;

fn exported(name: &str, overrides: &[&str]) -> Result<tempfile::TempDir, Error> {
    let spec = spec(name, overrides).expect("a scene without a scan");
    let scan = pipeline::load(&spec, &pipeline::Options::default())?;
    let plan = pipeline::plan(&spec, &scan, &Options::default())?;
    let folder = tempfile::tempdir().expect("a folder");
    vtk::export(folder.path(), &scan.volume, &plan)?;
    Ok(folder)
}

fn scene(folder: &tempfile::TempDir) -> serde_json::Value {
    let text = std::fs::read_to_string(folder.path().join("scene.json")).expect("readable");
    serde_json::from_str(&text).expect("JSON")
}

fn names(folder: &tempfile::TempDir) -> Vec<String> {
    let entries = std::fs::read_dir(folder.path()).expect("readable");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn the_gradient_magnitude_comes_along_where_it_is_read() {
    let one_d = exported("balls-rotated", &[]).unwrap();
    assert_eq!(names(&one_d), ["render.py", "scene.json", "transfer_function.npy", "volume.npy"]);
    let two_d = exported("balls-rotated-2d", &[]).unwrap();
    assert!(names(&two_d).contains(&"gradient_magnitude.npy".to_string()), "found {:?}", names(&two_d));
    let shape = |name: &str| npy::read(&two_d.path().join(name)).expect("an array").0;
    assert_eq!(shape("transfer_function.npy"), [1024, 4096, 4], "gradient, value, RGB and extinction");
    assert_eq!(shape("volume.npy"), [20, 24, 28], "slices, rows, columns");
}

#[test]
fn the_scene_says_where_vtk_cannot_follow() {
    let folder = exported("head-lit", &["effects.shading.soft_gradient_hu_per_mm=20"]).unwrap();
    let scene = scene(&folder);
    let notes = scene["notes"].to_string();
    assert!(notes.contains("Phong") && notes.contains("fade"), "found {notes}");
    assert_eq!(scene["camera"]["size"], serde_json::json!([96, 96]));
}

#[test]
fn the_table_is_the_transfer_function() {
    let folder = exported("balls-rotated", &[]).unwrap();
    let (shape, table) = npy::read(&folder.path().join("transfer_function.npy")).expect("an array");
    assert_eq!(shape, [1, 4096, 4]);
    let highest = table.chunks(4).map(|entry| entry[3]).fold(0.0, f32::max);
    let expected = -(1.0_f32 - 0.4).ln();
    assert!((highest - expected).abs() < 1e-6, "the extinction of 0.4 per mm: found {highest}, expected {expected}");
}

#[test]
fn what_vtk_has_no_equal_of_is_refused() {
    let fault = |overrides: &[&str]| exported("balls-rotated", overrides).err().map(|error| error.fault());
    let depth =
        ["effects={ project: { show: optical-depth, window_optical_depth: [0, 2] } }", "integrate={ exact: {} }"];
    let planes: Vec<String> = (0..9).map(|i| format!("{{ normal: [1, 0.{i}, 0.5], offset_mm: 0 }}")).collect();
    let planes = format!("effects={{ clip: {{ planes: [{}] }} }}", planes.join(", "));
    for overrides in [
        &depth[..],
        &["effects={ fog: { linear: { start_mm: 0, end_mm: 900 } } }"],
        &["effects={ classify: voxels }", "integrate={ exact: {} }"],
        &[&planes],
    ] {
        assert_eq!(fault(overrides), Some(Fault::Unsupported), "{overrides:?}");
    }
}

#[test]
fn projections_and_surfaces_are_blend_modes() {
    for (name, mode, columns) in [
        ("head-mip", "maximum", [1.0, 1.0]),
        ("head-minip", "minimum", [1.0, 1.0]),
        ("head-mean", "average", [1.0, 1.0]),
        ("head-surfaces", "isosurface", [0.4, 0.9]),
    ] {
        let folder = exported(name, &[]).unwrap();
        assert_eq!(scene(&folder)["blend"]["mode"], mode, "{name}");
        let (_, table) = npy::read(&folder.path().join("transfer_function.npy")).expect("an array");
        let opacity = [table[3], table[table.len() - 1]];
        assert_eq!(opacity, columns, "{name}: opacity at the lowest and at the highest value");
    }
}

#[test]
fn boxes_of_voxels_are_cropped_and_planes_clip() {
    let cropped = scene(&exported("head-cropped", &[]).unwrap());
    assert_eq!(cropped["clipping_planes"], serde_json::json!([]));
    let expected = [[10.0, 40.0], [8.5, 30.0], [12.0, 104.0]];
    let found: [[f64; 2]; 3] = serde_json::from_value(cropped["crop_voxels"].clone()).expect("three ranges");
    let off = (0..6).map(|i| (found[i / 2][i % 2] - expected[i / 2][i % 2]).abs()).fold(0.0, f64::max);
    assert!(off < 1e-9, "found {found:?}, expected {expected:?}");
    let wedge = scene(&exported("balls-rotated-planes-lit", &[]).unwrap());
    assert!(wedge["crop_voxels"].is_null(), "found {}", wedge["crop_voxels"]);
    assert_eq!(wedge["clipping_planes"].as_array().map(Vec::len), Some(2));
    let projection = scene(&exported("head-minip", &[]).unwrap());
    assert!(projection["crop_voxels"].is_null(), "a cropped projection has a frame");
    assert_eq!(projection["clipping_planes"].as_array().map(Vec::len), Some(6));
}
