//! `histogram`: pictures, and counts that add up.

use serde_json::Value;

use super::program::{Folder, pellucid};

fn phantom(folder: &Folder) -> String {
    let scan = folder.path("head.nrrd");
    pellucid(&["phantom", "head", "--size", "32", "--nrrd", &scan]).success();
    scan
}

fn json(path: &str) -> Value {
    let text = std::fs::read_to_string(path).expect("the file was written");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error} in {path}"))
}

/// The sum of all bins.
fn sum(counts: &Value) -> u64 {
    let columns = counts.as_array().expect("columns").iter();
    columns.flat_map(|column| column.as_array().expect("bins")).map(|bin| bin.as_u64().expect("a count")).sum()
}

#[test]
fn counts_add_up_and_threads_do_not_matter() {
    let folder = Folder::new("histogram_counts");
    let scan = phantom(&folder);
    let count = |name: &str, options: &[&str]| {
        let output = folder.path(name);
        let run = pellucid(&[&["histogram", &scan, "-o", &output], options].concat()).success();
        assert_eq!(run.stdout, format!("{output}\n"), "the path written");
        json(&output)
    };
    let all = count("all.json", &["--hu", "-2000:4000", "--gradient", "0:5000", "--bins", "64", "--threads", "1"]);
    let voxels = all["voxels"].as_u64().expect("a number");
    assert!(voxels > 30_000 && sum(&all["counts"]) == voxels, "{} of {voxels}", sum(&all["counts"]));
    assert_eq!((all["x"]["bins"].as_u64(), all["y"]["high"].as_f64()), (Some(64), Some(5000.0)));
    let again = count("again.json", &["--hu", "-2000:4000", "--gradient", "0:5000", "--bins", "64", "--threads", "3"]);
    assert_eq!(all["counts"], again["counts"], "on one thread and on three");

    let some = count("some.json", &["--hu=-100:300", "--bins", "16"]);
    assert_eq!(some["counted"].as_u64(), Some(sum(&some["counts"])));
    assert!(some["counted"].as_u64() < some["voxels"].as_u64(), "air is beyond the axis");

    let materials = count("materials.json", &["--lh", "--flat", "60", "--hu", "-2000:4000", "--bins", "32"]);
    assert_eq!((sum(&materials["counts"]), materials["flat_per_mm"].as_f64()), (voxels, Some(60.0)));
    let above = |i: usize, j: usize| i <= j || materials["counts"][i][j] == 0;
    assert!((0..32).all(|i| (0..32).all(|j| above(i, j))), "the lower material is never above the higher");
}

#[test]
fn one_count_makes_all_files_and_presets_are_drawn() {
    let folder = Folder::new("histogram_files");
    let (scan, png, svg) = (phantom(&folder), folder.path("h.png"), folder.path("h.svg"));
    pellucid(&["histogram", &scan, "--preset", "bone", "--preset", "fat", "-o", &png, "-o", &svg]).success();
    let drawn = std::fs::read_to_string(&svg).expect("an SVG");
    for part in [">bone<", ">fat<", ">value, HU<", ">gradient magnitude |∇|, HU/mm<", "#f3e6cc"] {
        assert!(drawn.contains(part), "{part} should be drawn");
    }
    let info = std::fs::metadata(&png).expect("a PNG").len();
    assert!((10_000..500_000).contains(&info), "found {info} bytes");
    let pipeline = folder.pipeline();
    pellucid(&["histogram", &pipeline, "--set", "volume.phantom.head.size=24", "-o", &svg]).success();
    let drawn = std::fs::read_to_string(&svg).expect("an SVG");
    assert!(drawn.contains(">skin<") && drawn.contains(">bone<"), "the layers of the pipeline");
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let folder = Folder::new("histogram_refused");
    let (none, out) = (folder.path("none.nrrd"), folder.path("h.json"));
    pellucid(&["histogram", &none, "-o", "h.pdf"]).failure(8).says(&["h.pdf", ".svg"]);
    pellucid(&["histogram", &none, "-o", &out]).failure(4).says(&["none.nrrd"]);
    pellucid(&["histogram", &folder.pipeline(), "--preset", "bone", "-o", &out]).failure(3).says(&["--preset"]);
    let scan = phantom(&folder);
    pellucid(&["histogram", &scan, "--bins", "5000", "-o", &out]).failure(3).says(&["5000", "1 to 1024"]);
    pellucid(&["histogram", &scan, "--lh", "--flat", "0", "-o", &out]).failure(3).says(&["above 0"]);
    assert!(!std::path::Path::new(&out).exists(), "nothing was written");
}
