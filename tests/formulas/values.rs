//! Values at known points, and formulas that say the same in other words.

use glam::DVec3;
use pellucid::volume::Quantity;

use super::volume;

#[test]
fn known_points_have_known_values() {
    for (analytic, voxel, expected) in [
        ("{ field: { sphere: { radius_mm: 10 } }, size: 5, spacing_mm: 5 }", [2, 2, 2], 10.0),
        ("{ field: { sphere: { radius_mm: 10 } }, size: 5, spacing_mm: 5 }", [0, 2, 2], 0.0),
        (
            "{ field: { sphere: { radius_mm: 5, surface_value: 300, value_per_mm: -2 } }, size: 5, extent_mm: 20 }",
            [2, 2, 4],
            310.0,
        ),
        (
            "{ field: { torus: { major_radius_mm: 10, minor_radius_mm: 4 } }, size: [5, 5, 3], spacing_mm: [5, 5, 4] }",
            [0, 2, 1],
            4.0,
        ),
        (
            "{ field: { torus: { major_radius_mm: 10, minor_radius_mm: 4 } }, size: [5, 5, 3], spacing_mm: [5, 5, 4] }",
            [2, 4, 0],
            0.0,
        ),
        (
            "{ field: { ramp: { gradient_per_mm: [1, 2, 3], origin_value: 50 } }, size: [3, 3, 3], extent_mm: [2, 4, 6] }",
            [2, 0, 2],
            56.0,
        ),
        ("{ field: marschner_lobb, size: 41, extent_mm: 2 }", [20, 20, 20], 0.6),
        ("{ field: marschner_lobb, size: 41, extent_mm: 2 }", [40, 20, 20], 0.6),
        ("{ field: { marschner_lobb: { unit_mm: 25, alpha: 0 } }, size: 41, extent_mm: 50 }", [7, 9, 40], 0.0),
        ("{ field: { expression: 100 - x^2 - 10*y + z/2 }, size: [3, 3, 1], spacing_mm: 1/2 }", [2, 0, 0], 104.75),
    ] {
        let found = volume(analytic).value(voxel);
        assert!((found - expected).abs() < 1e-6, "{analytic} at {voxel:?}: found {found}, expected {expected}");
    }
}

#[test]
fn an_expression_is_its_built_in_twin() {
    let lattice = "size: [21, 20, 19], spacing_mm: [1, 1.1, 1.2]";
    for (built_in, expression) in [
        ("{ sphere: { radius_mm: 8, value_per_mm: 100 } }", "100 * (8 - sqrt(x^2 + y^2 + z^2))"),
        (
            "{ torus: { major_radius_mm: 7, minor_radius_mm: 3, surface_value: 5 } }",
            "5 + 3 - hypot(hypot(x, y) - 7, z)",
        ),
        ("{ ramp: { gradient_per_mm: [3, -4, 5], origin_value: -1 } }", "3*x - 4*y + 5*z - 1"),
        ("{ marschner_lobb: { unit_mm: 10 } }", "(1 - sin(pi*z/20) + (1 + cos(12*pi*cos(pi*hypot(x, y)/20)))/4) / 2.5"),
    ] {
        let a = volume(&format!("{{ field: {built_in}, {lattice} }}"));
        let b = volume(&format!("{{ field: {{ expression: \"{expression}\" }}, {lattice} }}"));
        let [low, high] = a.value_range();
        // Each is rounded to f32.
        let allowed = 1.2e-7 * low.abs().max(high.abs());
        for index in 0..a.grid().voxel_count() {
            let voxel = a.grid().unflatten(index);
            let (a, b) = (a.value(voxel), b.value(voxel));
            assert!((a - b).abs() <= allowed, "{expression} at {voxel:?}: {b}, and {built_in}: {a}");
        }
    }
}

#[test]
fn the_lattice_is_centred_and_as_large_as_asked_for() {
    let ramp = "field: { ramp: { gradient_per_mm: [1, 1, 1] } }";
    for (lattice, spacing_mm, last_mm) in [
        ("size: 11, extent_mm: 40", [4.0, 4.0, 4.0], [20.0, 20.0, 20.0]),
        ("size: [11, 5, 2], extent_mm: [40, 1/2, 3]", [4.0, 0.125, 3.0], [20.0, 0.25, 1.5]),
        ("size: [2, 2, 1], extent_mm: 10", [10.0, 10.0, 10.0], [5.0, 5.0, 5.0]),
        ("size: [3, 4, 5], spacing_mm: 2", [2.0, 2.0, 2.0], [2.0, 3.0, 4.0]),
    ] {
        let made = volume(&format!("{{ {ramp}, {lattice} }}"));
        assert_eq!(made.grid().spacing_mm(), DVec3::from_array(spacing_mm), "{lattice}");
        assert_eq!(made.grid().corners_mm()[7], DVec3::from_array(last_mm), "{lattice}");
        assert_eq!(made.quantity(), Quantity::Arbitrary, "nothing says that they are HU");
    }
}
