//! Clipping, resolved against a volume.

use glam::DVec3;
use pellucid::plan::{Plan, explain, explain_json};
use pellucid::scene::Clip;

use super::plan;

fn clipped(clip: &str) -> Plan {
    plan(&format!("effects: {{ clip: {clip} }}\n"))
}

fn clip(text: &str) -> Clip {
    clipped(text).scene.effects.clip
}

#[test]
fn each_form_of_a_box_shows_the_same_points() {
    // 64 x 48 x 33 voxels of 1 x 2 x 3 mm, first voxel at the origin: it ends at x = 63, y = 94, z = 96.
    let forms = [
        "{ box: { voxels: [[10, 40], [open, 30], open] } }",
        "{ box: { mm: [[10, 40], [open, 60], [-5, 400]] } }",
        "{ box: { trim_mm: { right: 10, left: 23, posterior: 34, superior: 0 } } }",
        "{ planes: [{ normal: [2, 0, 0], offset_mm: 10 }, { normal: [-1, 0, 0], point_mm: [40, 7, 7] },
                    { normal: [0, -3, 0], offset_mm: -60 }] }",
    ];
    for form in forms {
        let clip = clip(form);
        assert_eq!(clip.half_spaces.len(), 3, "{form} resolves to {clip:?}");
        for [x, y, shown] in
            [[10.01, 59.9, 1.0], [39.99, 5.0, 1.0], [9.99, 5.0, 0.0], [40.01, 5.0, 0.0], [20.0, 60.1, 0.0]]
        {
            assert_eq!(clip.contains(DVec3::new(x, y, 50.0)), shown == 1.0, "{form} at ({x}, {y})");
        }
    }
}

#[test]
fn a_box_that_holds_the_volume_is_no_clipping_and_the_plan_says_so() {
    let whole =
        clipped("{ box: { voxels: [[0, 63], [-5, 47], [open, 32]] }, planes: [{ normal: [1, 1, 1], offset_mm: 0 }] }");
    assert_eq!(whole.scene, plan("").scene, "nothing is cut off");
    let why = |plan: &Plan| plan.not_computed.iter().find(|o| o.what == "clipping").map(|o| o.why.clone());
    assert_eq!(why(&whole).as_deref(), Some("effects.clip holds the whole volume"));
    assert_eq!(why(&plan("")).as_deref(), Some("the pipeline does not name it"));
    let part = clipped("{ box: { voxels: [[0, 62.5], open, open] } }");
    assert_eq!(part.scene.effects.clip.half_spaces.len(), 1);
    assert!(!part.not_computed.iter().any(|o| o.what == "clipping"), "found {:?}", part.not_computed);
}

#[test]
fn the_plan_tells_the_half_spaces_and_warns_where_nothing_is_left() {
    let part = clipped("{ planes: [{ normal: [0, 3, 4], point_mm: [0, 30, 40] }] }");
    let text = explain(&part);
    assert!(text.contains("clip       points x with x . (0.000, 0.600, 0.800) >= 50.00 mm\n"), "found\n{text}");
    assert_eq!(explain_json(&part)["clip"][0]["offset_mm"], 50.0);
    let is_warning = |plan: &Plan| plan.warnings.iter().any(|w| w.contains("leaves nothing"));
    assert!(!is_warning(&part), "found {:?}", part.warnings);
    for none in ["{ box: { mm: [[70, 80], open, open] } }", "{ box: { trim_mm: { left: 40, right: 23 } } }"] {
        assert!(is_warning(&clipped(none)), "{none}");
    }
}
