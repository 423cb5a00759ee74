//! Mistakes in formulas and their lattices are errors with place, key path and what was expected.

use pellucid::Fault;

use super::made;

#[test]
fn a_mistake_has_a_place_and_says_what_was_expected() {
    let lattice = "size: 4, extent_mm: 6";
    for (analytic, parts) in [
        (
            format!("{{ field: {{ expression: x + t }}, {lattice} }}"),
            [
                "scene.yaml:3:36: this is no expression in x, y and z (volume.analytic.field.expression)",
                "t at character 5 of \"x + t\"",
                "a number, x, y, z",
            ],
        ),
        (
            format!("{{ field: {{ expression: 3 * (x }}, {lattice} }}"),
            ["scene.yaml:3:36", "the end at character 7", "an operator or )"],
        ),
        (
            format!("{{ field: {{ expression: ln(x + y + z + 6) }}, {lattice} }}"),
            [
                "scene.yaml:3:22: the formula has no usable value at a point (volume.analytic.field)",
                "NaN at x = -3, y = -3, z = -3 mm",
                "a finite number",
            ],
        ),
        (
            "{ field: { cube: {} }, size: 4, extent_mm: 6 }".into(),
            ["there is no such choice", "found cube", "marschner_lobb"],
        ),
        (
            format!("{{ field: sphere, {lattice} }}"),
            ["a key is missing", "(volume.analytic.field.sphere)", "radius_mm"],
        ),
        (
            format!("{{ field: {{ sphere: {{ radius_mm: -1 }} }}, {lattice} }}"),
            ["volume.analytic.field.sphere.radius_mm", "found -1", "above 0"],
        ),
        (
            "{ field: marschner_lobb, size: 4 }".into(),
            ["a key is missing (volume.analytic)", "exactly one of", "spacing_mm, extent_mm"],
        ),
        (
            "{ field: marschner_lobb, size: 4, extent_mm: 6, spacing_mm: 2 }".into(),
            ["exclude each other", "spacing_mm and extent_mm", "exactly one"],
        ),
        (
            "{ field: marschner_lobb, size: 0, extent_mm: 6 }".into(),
            ["volume.analytic.size", "found 0", "1 to 4096 voxels"],
        ),
        (
            "{ field: marschner_lobb, size: [4, 4], extent_mm: 6 }".into(),
            ["volume.analytic.size", "a list of 2", "[x, y, z]"],
        ),
        (
            "{ field: marschner_lobb, size: many, extent_mm: 6 }".into(),
            ["volume.analytic.size", "\"many\"", "a number, or a list"],
        ),
        (
            "{ field: marschner_lobb, size: 4.5, extent_mm: 6 }".into(),
            ["volume.analytic.size", "found 4.5", "whole number"],
        ),
        (
            "{ field: marschner_lobb, size: 4, extent_mm: [6, 0, 6] }".into(),
            ["volume.analytic.extent_mm", "a list of 3", "above 0"],
        ),
    ] {
        let error = made(&analytic).expect_err(&analytic);
        assert_eq!(error.fault(), Fault::Spec, "{analytic}: {error}");
        assert!(error.text_place().is_some(), "{analytic}: no place in {error}");
        for part in parts {
            assert!(error.to_string().contains(part), "{analytic}: expected {part:?} in: {error}");
        }
    }
}

#[test]
fn more_voxels_than_any_memory_holds_are_refused() {
    let error = made("{ field: marschner_lobb, size: 4096, extent_mm: 6 }").expect_err("256 GiB");
    assert_eq!(error.fault(), Fault::Limit, "found {error}");
    assert!(error.to_string().starts_with("scene.yaml:3:"), "found {error}");
}
