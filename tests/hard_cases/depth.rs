//! Optical depths that are tiny, huge, or change abruptly.

use pellucid::transfer::{Curve, Knot, Optics, Term};
use pellucid::volume::Volume;

use super::{assert_sees, renderers, renderers_without_march, slab};
use crate::support::scenes::{
    BLUE, BONE, RED, difference, function, function_1d, noise_hu, ray, rays_through, scene, unit_grid, volume_i16,
    volume_of,
};
use pellucid::scene::Ray;

/// 10 mm of one value.
fn uniform() -> Volume {
    volume_i16(unit_grid([11, 3, 3]), vec![50; 99])
}

/// 100 HU per mm along x.
fn ramp() -> Volume {
    volume_of(unit_grid([11, 3, 3]), |[i, _, _]| 100.0 * i as f64)
}

fn along_x() -> Ray {
    ray([-4.0, 1.25, 0.6], [1.0, 0.0, 0.0])
}

#[test]
fn thin_fog_keeps_its_digits() {
    for extinction in [1e-15, 1e-12, 1e-9, 1e-8, 1e-6, 1e-4, 1e-2] {
        let expected = slab(BONE, 10.0 * extinction);
        for renderer in renderers_without_march("a transmittance in f32 loses what is below 6e-8 of it") {
            let found = renderer.sees(&uniform(), &scene(function_1d(&[(0.0, extinction, BONE)])), &along_x());
            assert_sees(&renderer, &format!("extinction {extinction:e}/mm"), found, expected, 0.0);
            // 1 - exp(-x) would have lost every digit of these, and so would 1 - transmittance.
            for channel in [0, 3] {
                let relative = (found[channel] / expected[channel] - 1.0).abs();
                assert!(relative < 1e-4, "{}: {extinction:e}/mm has a relative error of {relative:e}", renderer.name);
            }
        }
    }
}

#[test]
fn opaque_matter_is_opaque_at_any_extinction() {
    for extinction in [1e2, 1e4, 1e8, 1e16, 1e30] {
        for renderer in renderers() {
            let found = renderer.sees(&uniform(), &scene(function_1d(&[(0.0, extinction, BONE)])), &along_x());
            assert_sees(&renderer, &format!("{extinction:e}/mm"), found, slab(BONE, f64::INFINITY), 0.0);
            // A ramp from nothing: its start is as thin as fog.
            let ramped = scene(function_1d(&[(0.0, 0.0, BONE), (1000.0, extinction, BONE)]));
            let found = renderer.sees(&ramp(), &ramped, &along_x());
            assert_sees(&renderer, &format!("to {extinction:e}/mm"), found, slab(BONE, f64::INFINITY), 0.0);
        }
    }
}

#[test]
fn many_thin_cells_attenuate_like_one_thick_one() {
    let volume = volume_i16(unit_grid([50_001, 2, 2]), vec![0; 200_004]);
    let ray = ray([-1.0, 0.5, 0.25], [1.0, 0.0, 0.0]);
    for alpha in [1e-8, 1e-6, 1e-3] {
        for renderer in renderers() {
            let found = renderer.sees(&volume, &scene(function_1d(&[(0.0, alpha, RED)])), &ray);
            assert_sees(&renderer, &format!("50 000 cells of {alpha:e}"), found, slab(RED, 5e4 * alpha), 0.0);
        }
    }
}

#[test]
fn nearly_equal_attenuation_at_both_ends_is_that_of_their_mean() {
    // The case in which a difference of error functions cancels. Emission is σ₀ throughout; σ rises by a little.
    let (base, length) = (0.0711, 10.0);
    for rise in [1.0, 1e-1, 1e-2, 1e-3, 1e-5, 6e-8, 1e-12] {
        let knot = |value: f64, s: f64| Knot {
            value,
            optics: Optics { extinction_per_mm: s, emission_per_mm: [base, s, 0.0] },
        };
        let high = base + rise * base;
        let curve = Curve::new(vec![knot(0.0, base), knot(1000.0, high)]).unwrap();
        let scene = scene(function(vec![Term { curve, weight: None }]));
        let depth = 0.5 * (base + high) * length;
        // Simpson on 4000 intervals: an expectation without special functions, good to 1e-14.
        let emitted = |x: f64| base * (-(base * x + 0.5 * (high - base) * x * x / length)).exp();
        let h = length / 4000.0;
        let odd: f64 = (0..2000).map(|i| emitted(h * f64::from(2 * i + 1))).sum();
        let even: f64 = (1..2000).map(|i| emitted(h * f64::from(2 * i))).sum();
        let red = h / 3.0 * (emitted(0.0) + 4.0 * odd + 2.0 * even + emitted(length));
        let alpha = -(-depth).exp_m1();
        for renderer in renderers() {
            let found = renderer.sees(&ramp(), &scene, &along_x());
            assert_sees(&renderer, &format!("rise of {rise:e}"), found, [red, alpha, 0.0, alpha], 1e-13);
        }
    }
}

#[test]
fn extinction_that_jumps_from_nothing_to_everything_hides_what_is_behind() {
    let points = [(0.0, 0.0, RED), (420.0, 0.0, RED), (420.0, 1e12, BLUE), (500.0, 1e12, BLUE), (500.0, 3.0, BONE)];
    for renderer in renderers() {
        let found = renderer.sees(&ramp(), &scene(function_1d(&points)), &along_x());
        assert_sees(&renderer, "a wall", found, slab(BLUE, f64::INFINITY), 0.0);
    }
}

#[test]
fn a_translucent_layer_before_a_wall_lets_through_what_it_must() {
    let points = [(0.0, 0.05, RED), (600.0, 0.05, RED), (600.0, 1e9, BLUE), (1000.0, 1e9, BLUE)];
    let front = slab(RED, 0.3);
    let expected: [f64; 4] = std::array::from_fn(|c| front[c] + (1.0 - front[3]) * [BLUE[0], BLUE[1], BLUE[2], 1.0][c]);
    for renderer in renderers() {
        let found = renderer.sees(&ramp(), &scene(function_1d(&points)), &along_x());
        assert_sees(&renderer, "fog before a wall", found, expected, 0.0);
    }
}

#[test]
fn white_matter_before_white_light_is_white() {
    // C + T · 1 = 1 for white matter, whatever its extinction does.
    let volume = noise_hu(unit_grid([9, 8, 7]), 12);
    let white = [1.0; 3];
    let points =
        [(-500.0, 0.0, white), (-100.0, 3.0, white), (-100.0, 0.001, white), (300.0, 0.0, white), (310.0, 40.0, white)];
    for renderer in renderers() {
        for ray in rays_through(volume.grid(), 50, 13) {
            let found = renderer.sees(&volume, &scene(function_1d(&points)), &ray);
            let [r, g, b, alpha] = *found;
            let sum = [r, g, b].map(|c| c + (1.0 - alpha));
            let error = difference(sum, white);
            assert!(error <= 2.0 * found.bound, "{}: found {sum:?} along {ray:?}", renderer.name);
        }
    }
}

#[test]
fn light_that_is_emitted_without_absorption_adds_up() {
    let glow = Knot { value: 0.0, optics: Optics { extinction_per_mm: 0.0, emission_per_mm: [0.05, 1e-9, 0.1] } };
    let scene = scene(function(vec![Term { curve: Curve::new(vec![glow]).unwrap(), weight: None }]));
    for renderer in renderers() {
        let found = renderer.sees(&uniform(), &scene, &along_x());
        assert_sees(&renderer, "glow", found, [0.5, 1e-8, 1.0, 0.0], 0.0);
    }
}
