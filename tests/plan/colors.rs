//! Plans for RGBA volumes, and for transfer functions evaluated at the voxels.

use std::path::Path;

use glam::DVec3;
use pellucid::plan::{Plan, Storage, VolumeInfo, explain, explain_json};
use pellucid::scene::ClassifyAt;
use pellucid::spec::Spec;
use pellucid::volume::{ColorEncoding, Grid, Quantity, RgbaEncoding};

use super::plan;

const ENCODING: RgbaEncoding = RgbaEncoding { opacity_length_mm: 0.5, color: ColorEncoding::Srgb };

fn colors() -> VolumeInfo {
    VolumeInfo {
        grid: Grid::axis_aligned([33, 17, 9], DVec3::new(1.0, 0.5, 2.0)).unwrap(),
        storage: Storage::Rgba8(ENCODING),
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
    insta::assert_snapshot!(explain(&plan), @r"
    volume     33 x 17 x 9 voxels of 1.000 x 0.500 x 2.000 mm, rgba8, alpha 0 to 200     20.2 kB
    classify   the volume's own colours (sRGB), alpha is the opacity of 0.5000 mm         4.1 kB
    field      macrocells: blocks of 8 x 8 x 8 cells with a voxel that shows                 8 B
    integrate  march/rgba8/unlit: steps of 0.2500 mm, midpoint samples, front to back   320.0 kB
    image      PNG, 8 bits, sRGB, straight alpha                                         80.0 kB
    memory     424.3 kB

    light      none: emission and absorption alone
    behind     linear RGB (0.000, 0.000, 0.000)
    camera     at (16.0, -31.3, 8.0) mm LPS, looking along (0.00, 1.00, 0.00), up (0.00, 0.00, 1.00), perspective of 30.00 degrees, 200 x 100 pixels
    output     pipelines/scene.png

    not computed
      classification        the volume has colours of its own
      gradient              the volume has no values
      jitter                integrate.march has none: all rays share one lattice
      early ray termination termination_transmittance is 0, so that it costs no accuracy
      certificate           certify asks for no pixels
    ");
    let json = explain_json(&plan);
    assert_eq!(json["colors"], serde_json::json!({ "opacity_length_mm": 0.5, "encoding": "srgb" }));
}

#[test]
fn classification_at_the_voxels_in_words() {
    let plan = plan("effects: { classify: voxels, shading: {} }\nimage: { size: [200, 100] }\n");
    assert_eq!(plan.scene.effects.classify, ClassifyAt::Voxels);
    insta::assert_snapshot!(explain(&plan), @r"
    volume     64 x 48 x 33 voxels of 1.000 x 2.000 x 3.000 mm, i16, values -1000 to 1800 HU                          202.8 kB
    field      gradient at the voxels that show, by central differences, not stored                                          -
    classify   1D transfer function of 1 layer, 4 knots, values -1024 to 3071, evaluated at the voxels, shaded, f32     1.6 MB
    integrate  exact/voxels/tf1d/lit: each channel of a pixel within 3.922e-3                                         320.0 kB
    image      PNG, 8 bits, sRGB, straight alpha                                                                       80.0 kB
    memory     2.2 MB

    layers     layer 1
    light      ambient 0.2, diffuse 0.7, specular 0.2 with exponent 20, two-sided, half strength at 20 HU/mm, headlight
    behind     linear RGB (0.000, 0.000, 0.000)
    camera     at (31.5, -188.1, 48.0) mm LPS, looking along (0.00, 1.00, 0.00), up (0.00, 0.00, 1.00), perspective of 30.00 degrees, 200 x 100 pixels
    output     pipelines/scene.png

    not computed
      gradient magnitude    no layer depends on it within the range of gradient magnitudes
      macrocells            the exact integrator skips cell by cell, by the values at their corners
      certificate           certify asks for no pixels
    ");
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
