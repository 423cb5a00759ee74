//! The plan in words. These texts are snapshots: they say what we print, not that it is right.

use pellucid::plan::{explain, explain_json};

use super::plan;

#[test]
fn a_plain_plan() {
    insta::assert_snapshot!(explain(&plan("image: { size: [200, 100] }\n")), @r"
    volume     64 x 48 x 33 voxels of 1.000 x 2.000 x 3.000 mm, i16, values -1000 to 1800 HU   202.8 kB
    classify   1D transfer function of 1 layer, 4 knots, values -1024 to 3071                      96 B
    integrate  exact/i16/tf1d/unlit: each channel of a pixel within 3.922e-3                   320.0 kB
    image      PNG, 8 bits, sRGB, straight alpha                                                80.0 kB
    memory     602.8 kB

    layers     layer 1
    light      none: emission and absorption alone
    behind     linear RGB (0.000, 0.000, 0.000)
    camera     at (31.5, -188.1, 48.0) mm LPS, looking along (0.00, 1.00, 0.00), up (0.00, 0.00, 1.00), perspective of 30.00 degrees, 200 x 100 pixels
    output     pipelines/scene.png

    not computed
      gradient magnitude    no layer depends on it within the range of gradient magnitudes
      gradient              no effect asks for shading
      macrocells            the exact integrator skips cell by cell, by the values at their corners
      certificate           certify asks for no pixels
      depth cue             the pipeline does not name it
      shadows               the pipeline does not name it
      scattering            the pipeline does not name it
      fog                   the pipeline does not name it
      haze                  the pipeline does not name it
    ");
}

#[test]
fn a_rich_plan() {
    let rest = "transfer_function:
  - preset: skin
    opacity_scale: 0.5
  - widgets:
      - ellipse: { hu: 40, hu_radius: 60, gradient_hu_per_mm: 0, gradient_radius_hu_per_mm: 80 }
        opacity_per_mm: 0.01
        color: red
normalise: { hu: [-1024, 1500] }
effects: { shading: { lights: [headlight, { directional: { towards: [1, -1, 1] } }] } }
camera: { view: left, projection: parallel }
integrate: { march: { step_voxels: 1, jitter: { seed: 1 } } }
image: { size: [200, 100], background: transparent, bits: 16 }
certify: 500
";
    insta::assert_snapshot!(explain(&plan(rest)), @r"
    volume     64 x 48 x 33 voxels of 1.000 x 2.000 x 3.000 mm, i16, values -1000 to 1800 HU                     202.8 kB
    field      gradient magnitude at the voxels, by central differences, f32                                     405.5 kB
    field      gradient at samples, by central differences, not stored                                                  -
    field      macrocells: value ranges of blocks of 8 x 8 x 8 cells                                               3.1 kB
    classify   2D transfer function of 2 layers, 23 x 12 knots, values -1024 to 1500, gradients to 1500 per mm    15.5 kB
    integrate  march/i16/tf2d/lit: steps of 1.0000 mm, midpoint samples, front to back, white jitter of seed 1   320.0 kB
    image      PNG, 16 bits, sRGB, straight alpha                                                                160.0 kB
    oracle     500 random pixels again in f64                                                                           -
    memory     1.1 MB

    layers     skin + layer 2
    light      ambient 0.2, diffuse 0.7, specular 0.2 with exponent 20, two-sided, half strength at 20 HU/mm, headlight and light from (0.58, -0.58, 0.58)
    behind     nothing: the picture keeps its alpha
    camera     at (179.9, 47.0, 48.0) mm LPS, looking along (-1.00, 0.00, 0.00), up (0.00, 0.00, 1.00), parallel, 100.8 mm high, 200 x 100 pixels
    output     pipelines/scene.png

    not computed
      early ray termination termination_transmittance is 0, so that it costs no accuracy
      depth cue             the pipeline does not name it
      shadows               the pipeline does not name it
      scattering            the pipeline does not name it
      fog                   the pipeline does not name it
      haze                  the pipeline does not name it

    warnings
      values from -1000 to 1800 go beyond the window -1024 to 1500 and look like its ends; normalise.hu widens it
      layer 2 is rendered by terms within 0.0312 of the height of its shapes; max_deviation lowers it
    ");
}

#[test]
fn as_json_it_has_all_numbers_in_full() {
    let plan = plan("integrate: { march: { step_mm: 0.7 } }\n");
    let json = explain_json(&plan);
    assert_eq!(json["method"]["march"]["step_mm"], 0.7);
    assert_eq!(json["method"]["march"]["rule"], "midpoint");
    assert_eq!(json["memory_bytes"], plan.memory_bytes());
    assert_eq!(json["stages"].as_array().map(Vec::len), Some(plan.stages.len()));
    assert_eq!(json["camera"]["size"], serde_json::json!([1024, 1024]));
    assert_eq!(json["shading"], serde_json::Value::Null);
    assert_eq!(json["not_computed"][0]["what"], "gradient magnitude");
}
