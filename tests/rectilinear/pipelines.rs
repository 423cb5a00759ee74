//! What a pipeline says of slices, and what is said of them.

use std::path::Path;

use pellucid::pipeline::{self, Options};
use pellucid::plan::{Method, explain};
use pellucid::spec::Spec;

fn spec(volume: &str, rest: &str) -> pellucid::Result<Spec> {
    let text = format!("version: 1\nvolume: {volume}\ntransfer_function: [{{ preset: bone }}]\n{rest}\n");
    Spec::from_text(&text, Path::new("scene.yaml"), &[])
}

const PLANES: &str = "{ values: hu, analytic: { field: { sphere: { radius_mm: 9, value_per_mm: 200 } }, size: [11, 9], \
                      extent_mm: 20, planes_mm: [-10, -9, -7, -2, 0, 1/2, 6, 10] } }";

#[test]
fn planes_lie_where_they_are_written() {
    let scan = pipeline::load(&spec(PLANES, "").unwrap(), &pipeline::Options::default()).unwrap();
    for (k, z) in [-10.0, -9.0, -7.0, -2.0, 0.0, 0.5, 6.0, 10.0].into_iter().enumerate() {
        let at = scan.volume.voxel_mm([0, 8, k]);
        assert!((at - glam::DVec3::new(-10.0, 10.0, z)).length() < 1e-12, "slice {k}: found {at}");
        let expected = 200.0 * (9.0 - at.length());
        assert!((scan.volume.value([0, 8, k]) - expected).abs() < 1e-3, "slice {k}: another value");
    }
}

#[test]
fn explain_says_how_far_apart_slices_are_and_that_nothing_is_skipped() {
    let spec = spec(PLANES, "integrate: march").unwrap();
    let scan = pipeline::load(&spec, &pipeline::Options::default()).unwrap();
    let plan = pipeline::plan(&spec, &scan, &Options::default()).unwrap();
    let text = explain(&plan);
    for part in ["2.000 x 2.500 x 0.500 to 5.500 (uneven, as they are) mm", "every sample is taken"] {
        assert!(text.contains(part), "expected {part:?} in:\n{text}");
    }
    let Method::March(march) = &plan.method else { panic!("marching was asked for") };
    assert!((march.step_mm - 0.25).abs() < 1e-12, "half of the smallest distance, found {}", march.step_mm);
}

#[test]
fn a_key_that_nothing_reads_and_planes_in_no_order_are_refused() {
    for (volume, part) in [
        ("{ phantom: head, slices: uneven }", "nothing would read this key"),
        ("{ source: a.nrrd, slices: even }", "nothing would read this key"),
        (&PLANES.replace("values: hu", "slices: uneven"), "nothing would read this key"),
        (&PLANES.replace("-9, -7", "-7, -9"), "each above the one before"),
        (&PLANES.replace("[-10, -9, -7, -2, 0, 1/2, 6, 10]", "[3]"), "2 to 4096 positions"),
        (&PLANES.replace("[11, 9]", "[11, 9, 8]"), "one number, or [x, y]"),
    ] {
        let error = spec(volume, "").map(|_| ()).expect_err(volume);
        assert!(error.to_string().contains(part), "{volume}: expected {part:?} in {error}");
    }
}
