//! The exact integrator against the oracle: every pixel within the tolerance, and within the bound it reports.

mod kernels;
mod levels;
mod schedule;

use crate::support::scenes::{rough_volume, scene_around, thin_shell, two_colors, two_lights};
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::oracle::Oracle;
use pellucid::scene::Scene;
use pellucid::transfer::{Curve, Knot, Optics, Term};
use pellucid::volume::Volume;

/// Largest error, and largest ratio of error to reported bound, over all pixels of a scene.
fn held_against_the_oracle(volume: &Volume, scene: &Scene, tolerance: f64, precision: Precision) -> (f64, f64) {
    let tracer = tracer(volume, scene, tolerance, precision);
    let oracle = Oracle::new(volume, scene);
    let [width, height] = scene.camera.size();
    let mut worst = (0.0f64, 0.0f64);
    for pixel in 0..width * height {
        let ray = scene.camera.pixel_ray(pixel % width, pixel / width);
        let truth = oracle.radiance(&ray);
        let Some(found) = tracer.trace(&ray) else {
            assert_eq!(truth, [0.0; 4], "pixel {pixel} is missed");
            continue;
        };
        let [r, g, b] = found.radiance;
        let error = [r, g, b, found.opacity]
            .iter()
            .zip(truth)
            // NaN counts as infinite.
            .map(|(x, t)| if x.is_nan() { f64::INFINITY } else { (x - t).abs() })
            .fold(0.0, f64::max);
        worst = (worst.0.max(error), worst.1.max(error / found.bound));
    }
    worst
}

#[test]
fn every_pixel_is_within_tolerance_and_bound() {
    let volume = rough_volume(14);
    let shell = vec![two_colors(), thin_shell()];
    for (name, terms, shading) in [
        ("1D", vec![two_colors()], None),
        ("2D", shell.clone(), None),
        ("1D lit", vec![two_colors()], Some(two_lights(true))),
        ("2D lit, one-sided", shell, Some(two_lights(false))),
    ] {
        let scene = scene_around(&volume, terms, shading, [24, 24]);
        for tolerance in [1.0 / 255.0, 1e-3, 1e-4] {
            for precision in [Precision::Double, Precision::Single, Precision::Estimated] {
                let (error, of_bound) = held_against_the_oracle(&volume, &scene, tolerance, precision);
                assert!(error <= tolerance, "{name}, {precision:?}: error {error:e} over tolerance {tolerance:e}");
                // What is estimated may be more.
                let most = if precision == Precision::Estimated { 1.5 } else { 1.0 };
                assert!(
                    of_bound <= most,
                    "{name}, {precision:?}, tolerance {tolerance:e}: error is {of_bound} x the bound"
                );
                assert!(
                    error > 1e-3 * tolerance,
                    "{name}: an error of {error:e} would mean that nothing was traded for time"
                );
            }
        }
    }
}

#[test]
fn tangential_crossings_of_jumps_hold_in_f32() {
    // Jumps between nothing and 8/mm every 10 HU: a few cells per picture graze one to within rounding.
    let mut knots = Vec::new();
    for step in -100..100 {
        let (at, height) = (10.0 * f64::from(step), if step % 2 == 0 { 8.0 } else { 0.0 });
        for h in [8.0 - height, height] {
            knots.push(Knot { value: at, optics: Optics::colored(h, [0.9, 0.5, 0.1]) });
        }
    }
    let stripes = Term { curve: Curve::new(knots).unwrap(), weight: None };
    let volume = rough_volume(12);
    let scene = scene_around(&volume, vec![stripes], None, [64, 64]);
    for tolerance in [1e-3, 1e-4] {
        let (error, of_bound) = held_against_the_oracle(&volume, &scene, tolerance, Precision::Single);
        assert!(
            error <= tolerance && of_bound <= 1.0,
            "tolerance {tolerance:e}: error {error:e}, {of_bound} x the bound"
        );
    }
}

#[test]
fn a_tighter_tolerance_is_never_worse() {
    let volume = rough_volume(10);
    let scene = scene_around(&volume, vec![two_colors(), thin_shell()], Some(two_lights(true)), [16, 16]);
    let mut last = f64::INFINITY;
    for tolerance in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        let (error, _) = held_against_the_oracle(&volume, &scene, tolerance, Precision::Double);
        assert!(error <= last + 1e-12, "tolerance {tolerance:e}: error {error:e} after {last:e}");
        last = error;
    }
}

#[test]
fn the_comparison_fails_for_a_picture_that_is_slightly_wrong() {
    let volume = rough_volume(10);
    let truth = scene_around(&volume, vec![two_colors()], None, [16, 16]);
    let mut knots = two_colors().curve.knots().to_vec();
    for knot in &mut knots {
        knot.value += 2.0;
    }
    let shifted = Term { curve: Curve::new(knots).unwrap(), weight: None };
    let wrong = scene_around(&volume, vec![shifted], None, [16, 16]);
    let tracer = tracer(&volume, &wrong, 1e-4, Precision::Double);
    let oracle = Oracle::new(&volume, &truth);
    let off = (0..256).filter(|&pixel| {
        let ray = truth.camera.pixel_ray(pixel % 16, pixel / 16);
        tracer.trace(&ray).is_some_and(|t| (t.opacity - oracle.radiance(&ray)[3]).abs() > t.bound)
    });
    assert!(off.count() > 20, "a transfer function shifted by 2 HU must break the bound");
}

#[test]
fn what_shines_without_absorbing_is_shaded_in_few_pieces() {
    let volume = rough_volume(14);
    let glow =
        |strength| Optics { extinction_per_mm: 0.0, emission_per_mm: [strength, 0.5 * strength, 0.1 * strength] };
    let knots = vec![Knot { value: -200.0, optics: glow(0.0) }, Knot { value: 900.0, optics: glow(0.05) }];
    let term = Term { curve: Curve::new(knots).expect("finite knots"), weight: None };
    let scene = scene_around(&volume, vec![term], Some(two_lights(true)), [12, 12]);
    let (tolerance, precision) = (1e-3, Precision::Estimated);
    let (error, of_bound) = held_against_the_oracle(&volume, &scene, tolerance, precision);
    assert!(error <= tolerance && of_bound <= 1.0, "error {error:e}, {of_bound} x the bound");
    let tracer = tracer(&volume, &scene, tolerance, precision);
    let rays = (0..144).map(|pixel| scene.camera.pixel_ray(pixel % 12, pixel / 12));
    let most = rays.filter_map(|ray| tracer.trace(&ray)).map(|traced| traced.pieces).max().expect("rays that meet it");
    assert!((1..100_000).contains(&most), "{most} pieces on a ray");
}
