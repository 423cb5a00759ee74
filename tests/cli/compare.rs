//! `pellucid compare`: numbers, figures and exit codes.

use pellucid::Image;
use pellucid::io::png::{self, Depth};

use super::program::{Folder, pellucid};

/// A grey picture with one pixel that is brighter by this much.
fn picture(folder: &Folder, name: &str, brighter: f32) -> String {
    let mut image = Image::from_pixels(24, 16, vec![[0.25, 0.25, 0.25, 1.0]; 384]);
    image.pixels_mut()[100][1] += brighter;
    let path = folder.path(name);
    png::write(path.as_ref(), &image, Depth::Sixteen, &[]).expect("the folder is writable");
    path
}

#[test]
fn pictures_further_apart_than_allowed_are_exit_code_9_and_the_numbers_are_there() {
    let folder = Folder::new("compare_limits");
    let (a, b) = (picture(&folder, "a.png", 0.0), picture(&folder, "b.png", 0.1));
    pellucid(&["compare", &a, &b]).success();
    pellucid(&["compare", &a, &b, "--tolerance", "26/255"]).success();
    pellucid(&["compare", &a, &b, "--tolerance", "1/255", "--share", "0.003"]).success();
    let over = pellucid(&["compare", &a, &b, "--tolerance", "1/255", "--format", "json"]);
    assert_eq!(over.code, Some(9), "found:\n{}", over.stderr);
    let found: serde_json::Value = serde_json::from_str(&over.stdout).expect("JSON in spite of the exit code");
    let comparison = &found["comparison"];
    assert_eq!(comparison["pixels_over"], 1, "found {comparison}");
    let largest = comparison["max_abs_all"].as_f64().expect("a number");
    assert!((largest - 0.1).abs() < 1e-4, "found {largest}");
    over.says(&["1 pixels above", "b.png"]);
    let over = pellucid(&["compare", &a, &b, "--rms-tolerance", "0.001"]);
    assert_eq!(over.code, Some(9), "an RMS of 0.0026:\n{}", over.stdout);
}

#[test]
fn figures_show_both_pictures_and_where_they_differ() {
    let folder = Folder::new("compare_figures");
    let (a, b) = (picture(&folder, "a.png", 0.0), picture(&folder, "b.png", 0.1));
    let (side, map) = (folder.path("side.png"), folder.path("map.png"));
    pellucid(&["compare", &a, &b, "--side-by-side", &side, "--difference", &map]).success();
    let read = |path: &str| png::read(path.as_ref()).expect("a picture").image;
    let (side, map) = (read(&side), read(&map));
    assert_eq!((side.height(), map.height()), (16, 16));
    assert_eq!(side.width(), map.width() + 2 * (24 + 8), "both pictures and the map, with gaps");
    let (bad, good) = (map.pixel(100 % 24, 100 / 24), map.pixel(0, 0));
    assert!(bad[1] > 0.5 && good[1] < 0.01, "the pixel stands out: {bad:?}, the others {good:?}");
}

#[test]
fn a_pipeline_is_rendered_to_be_compared() {
    let folder = Folder::new("compare_pipeline");
    let pipeline = folder.pipeline();
    let rendered = folder.path("head.exr");
    pellucid(&["render", &pipeline, "-o", &rendered]).success();
    pellucid(&["compare", &rendered, &pipeline, "--tolerance", "0"]).success();
    let turned = pellucid(&["compare", &rendered, &pipeline, "--set", "camera.azimuth=31", "--tolerance", "1/255"]);
    assert_eq!(turned.code, Some(9), "another azimuth:\n{}", turned.stdout);
}

#[test]
fn what_cannot_be_compared_is_said() {
    let folder = Folder::new("compare_refused");
    let a = picture(&folder, "a.png", 0.0);
    let small = folder.path("small.png");
    png::write(small.as_ref(), &Image::transparent(3, 3), Depth::Eight, &[]).expect("the folder is writable");
    pellucid(&["compare", &a, &small]).failure(4).says(&["small.png", "same size", "3 x 3"]);
    pellucid(&["compare", &a, "--vtk"]).failure(3).says(&["a.png", "pipelines, not pictures"]);
    pellucid(&["compare", &a, &folder.path("a.gif")]).failure(4).says(&[".png, .exr or .npy"]);
    assert_eq!(pellucid(&["compare", &a]).code, Some(2), "one picture is not two");
    let pipeline = folder.pipeline();
    let nowhere = pellucid(&["compare", &pipeline, "--vtk", "--python", "/nowhere/python"]);
    nowhere.failure(4).says(&["Python cannot be run", "--python"]);
}

/// A Python without VTK, and one in which a mapper of VTK has no equal of the scene, as the exported script says it.
#[cfg(unix)]
#[test]
fn what_python_says_is_passed_on() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("compare_python");
    let pipeline = folder.pipeline();
    let python = folder.path("python");
    for (exit, said, fault, remedy) in
        [(1, "No module named 'vtk'", 4, "--python"), (3, "no 2D transfer functions", 5, "--mapper gpu")]
    {
        std::fs::write(&python, format!("#!/bin/sh\necho \"{said}\" >&2\nexit {exit}\n")).expect("writable");
        std::fs::set_permissions(&python, PermissionsExt::from_mode(0o755)).expect("ours");
        let refused = pellucid(&["compare", &pipeline, "--vtk", "--mapper", "cpu", "--python", &python]);
        refused.failure(fault).says(&[said, remedy]);
    }
}
