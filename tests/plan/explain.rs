//! The plan in words. These texts are snapshots: they say what we print, not that it is right.

use pellucid::plan::{explain, explain_json};

use super::plan;

#[test]
fn a_plain_plan() {
    insta::assert_snapshot!(explain(&plan("image: { size: [200, 100] }\n")));
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
    insta::assert_snapshot!(explain(&plan(rest)));
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
