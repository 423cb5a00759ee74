//! The checks of `pellucid verify` find what they are for: each broken integrator fails by name, the clean one passes.

mod broken;
mod march;

use std::collections::BTreeSet;

use pellucid::verify::steps::Orders;
use pellucid::verify::{Check, Integrator, lattices, of_marching, pixels, steps};

use broken::{Broken, REFERENCE};
use march::Reference;

/// Names of the checks that an integrator fails.
fn failed(checks: &[Check]) -> BTreeSet<&str> {
    checks.iter().filter(|check| !check.pass).map(|check| check.check.as_str()).collect()
}

fn checks_of(march: Reference) -> Vec<Check> {
    let integrator: &Integrator<'_> = &|volume, scene, step_mm| Ok(march.render(volume, scene, step_mm));
    of_marching("reference", Orders::plain(2.0), integrator).expect("a march that refuses nothing")
}

#[test]
fn a_clean_march_passes_every_check() {
    let checks = checks_of(REFERENCE);
    let failures: Vec<_> = checks.iter().filter(|check| !check.pass).collect();
    assert!(failures.is_empty(), "failed: {failures:#?}");
    assert!(checks.len() >= 10, "a march of second order is held to all checks, found {}", checks.len());
}

/// Each mistake must be caught by the checks that are named with it; more may fail.
#[test]
fn every_broken_march_is_caught_by_name() {
    for Broken { name, march, caught_by } in broken::MARCHES {
        let checks = checks_of(march);
        let failed = failed(&checks);
        for check in caught_by {
            let row = checks.iter().find(|row| row.check == *check);
            let row = row.unwrap_or_else(|| panic!("`{check}` is no check"));
            assert!(!row.pass, "{name}: passed `{check}` with {}; failed {failed:?}", row.measured_text());
        }
    }
}

#[test]
fn a_field_that_is_moved_by_half_a_voxel_is_caught_by_refining_the_lattice() {
    let moved = Reference { shift_voxels: 0.5, ..REFERENCE };
    let integrator: &Integrator<'_> = &|volume, scene, step_mm| Ok(moved.render(volume, scene, step_mm));
    let checks = lattices::checks("moved", lattices::MARCHING, integrator).expect("a march that refuses nothing");
    assert_eq!(failed(&checks).len(), 2, "both checks should fail: {checks:#?}");
}

#[test]
fn rays_through_corners_of_pixels_are_caught_by_refining_the_picture() {
    for (corner, caught) in [(false, vec![]), (true, vec!["order in the pixel, bilinear"])] {
        let integrator: &Integrator<'_> = &|volume, scene, _| {
            Ok(REFERENCE.render_through(volume, scene, 8.0 / 128.0, if corner { 0.0 } else { 0.5 }))
        };
        let checks = pixels::checks("reference", integrator).expect("a march that refuses nothing");
        assert_eq!(failed(&checks).into_iter().collect::<Vec<_>>(), caught, "corner: {corner}, {checks:#?}");
    }
}

#[test]
fn an_integrator_that_finds_no_number_fails_every_check() {
    let nowhere: &Integrator<'_> = &|_, scene, _| Ok(vec![[f64::NAN; 4]; scene.camera.size().iter().product()]);
    let checks = of_marching("nowhere", Orders::plain(2.0), nowhere).expect("checks");
    assert!(checks.iter().all(|check| !check.pass), "passed: {checks:#?}");
}

/// A first-order rule hides a sample that is left out: why orders are measured on rules of second order.
#[test]
fn a_left_rule_hides_what_a_midpoint_rule_shows() {
    let order_without_last = |place: f64| {
        let march = Reference { place, skip_last: true, ..REFERENCE };
        let integrator: &Integrator<'_> = &|volume, scene, step_mm| Ok(march.render(volume, scene, step_mm));
        let checks = steps::checks("march", Orders::plain(2.0), integrator).expect("a march that refuses nothing");
        checks.iter().find(|check| check.check == "order in the step, smooth").expect("the check").measured
    };
    let (left, midpoint) = (order_without_last(0.0), order_without_last(0.5));
    assert!((left - 1.0).abs() < 0.3, "the left rule is of order 1 with all samples or without one: found {left}");
    assert!((midpoint - 1.0).abs() < 0.3, "the midpoint rule loses an order: found {midpoint}");
}
