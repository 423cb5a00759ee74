//! Plans for RGBA volumes, and for transfer functions evaluated at the voxels.

use std::path::Path;

use glam::DVec3;
use pellucid::plan::{Plan, Storage, VolumeInfo, explain, explain_json};
use pellucid::scene::ClassifyAt;
use pellucid::spec::Spec;
use pellucid::volume::{ColorEncoding, Grid, Quantity, Rescale, RgbaEncoding};

use super::plan;

const ENCODING: RgbaEncoding = RgbaEncoding { opacity_length_mm: 0.5, color: ColorEncoding::Srgb };

fn colors() -> VolumeInfo {
    VolumeInfo {
        grid: Grid::axis_aligned([33, 17, 9], DVec3::new(1.0, 0.5, 2.0)).unwrap(),
        storage: Storage::Rgba8(ENCODING),
        rescale: Rescale::IDENTITY,
        value_range: [0.0, 200.0],
        quantity: Quantity::Arbitrary,
        uneven_slices_mm: None,
        labels: None,
        reading_bytes: 0,
    }
}

fn plan_of(volume: &VolumeInfo, rest: &str) -> pellucid::Result<Plan> {
    let text = format!("version: 1\nvolume: {{ source: a.nrrd }}\n{rest}");
    Plan::new(&Spec::from_text(&text, Path::new("pipelines/scene.yaml"), &[])?, volume, None)
}

#[test]
fn colors_in_words() {
    let plan = plan_of(&colors(), "image: { size: [200, 100] }\nintegrate: march\n").unwrap();
    insta::assert_snapshot!(explain(&plan));
    let json = explain_json(&plan);
    assert_eq!(json["colors"], serde_json::json!({ "opacity_length_mm": 0.5, "encoding": "srgb" }));
}

#[test]
fn classification_at_the_voxels_in_words() {
    let plan = plan("effects: { classify: voxels, shading: {} }\nimage: { size: [200, 100] }\n");
    assert_eq!(plan.scene.effects.classify, ClassifyAt::Voxels);
    insta::assert_snapshot!(explain(&plan));
}

#[test]
fn sixteen_bytes_per_voxel_are_counted() {
    let plan = plan("effects: { classify: voxels }\n");
    let stage = plan.stages.iter().find(|stage| stage.name == "classify").expect("a stage that classifies");
    assert_eq!(stage.bytes, 16 * 64 * 48 * 33);
    assert!(!plan.stages.iter().any(|stage| stage.name == "field"), "nobody reads a field: {:?}", plan.stages);
}

#[test]
fn keys_that_a_volume_of_colors_leaves_unread_are_refused() {
    for (rest, key) in [
        ("transfer_function: [{ preset: bone }]\n", "transfer_function"),
        ("normalise: { hu: [0, 9] }\n", "normalise"),
        ("gradient: { range_hu_per_mm: [0, 9] }\n", "gradient"),
        ("effects: { shading: {} }\n", "effects.shading"),
        ("effects: { classify: voxels }\n", "effects.classify"),
        ("effects: { project: { show: maximum } }\n", "effects.project"),
        ("effects: { surfaces: [{ hu: 9 }] }\n", "effects.surfaces"),
    ] {
        let error = plan_of(&colors(), rest).expect_err(rest);
        assert_eq!(error.element_name(), Some(key), "{error}");
        assert!(error.to_string().contains("nothing would read this key"), "{error}");
    }
}

#[test]
fn values_need_a_transfer_function_and_have_no_colors_to_understand() {
    let error = plan_of(&super::volume(), "").expect_err("values alone show nothing");
    assert_eq!(error.element_name(), Some("transfer_function"), "{error}");
    for key in ["opacity_length_mm: 2", "color_encoding: linear"] {
        let text = format!("version: 1\nvolume: {{ phantom: head, {key} }}\ntransfer_function: [{{ preset: bone }}]\n");
        let spec = Spec::from_text(&text, Path::new("scene.yaml"), &[]).unwrap();
        let error = Plan::new(&spec, &super::volume(), None).expect_err(key);
        assert!(error.to_string().contains("the volume has values, and no colours"), "{error}");
    }
}
