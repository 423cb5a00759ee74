//! Integrals that have a closed form.

use pellucid::oracle::Oracle;
use pellucid::scene::Ray;
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction};
use pellucid::volume::Volume;

use crate::support::scenes::{
    BLUE, BONE, RED, difference, function, function_1d, noise_hu, ray, rays_through, scene, unit_grid, volume_of,
};

fn radiance(volume: &Volume, function: TransferFunction, ray: &Ray) -> [f64; 4] {
    Oracle::new(volume, &scene(function)).radiance(ray)
}

/// The value is 100 x HU at x mm along the x axis.
fn ramp_volume() -> Volume {
    volume_of(unit_grid([11, 3, 3]), |[i, _, _]| 100.0 * i as f64)
}

fn along_x() -> Ray {
    ray([-4.0, 1.25, 0.6], [1.0, 0.0, 0.0])
}

#[test]
fn constant_extinction_is_an_exponential() {
    let volume = volume_of(unit_grid([11, 3, 3]), |_| 50.0);
    for extinction in [1e-12, 1e-6, 1e-3, 0.1, 1.0, 7.0, 300.0] {
        let found = radiance(&volume, function_1d(&[(50.0, extinction, BONE)]), &along_x());
        let alpha = -(-10.0 * extinction).exp_m1();
        for (found, color) in found.into_iter().zip([BONE[0], BONE[1], BONE[2], 1.0]) {
            let error = (found - color * alpha).abs();
            assert!(error <= 3e-15 * alpha, "extinction {extinction:e}: found {found}, expected {}", color * alpha);
        }
    }
}

#[test]
fn constant_color_is_opacity_times_color_whatever_the_extinction() {
    let grid = unit_grid([6, 5, 7]);
    let volume = noise_hu(grid, 3);
    let points = [(-400.0, 0.0, RED), (0.0, 0.7, RED), (0.0, 0.2, RED), (300.0, 0.0, RED), (900.0, 2.5, RED)];
    for ray in rays_through(&grid, 200, 11) {
        let [r, g, b, alpha] = radiance(&volume, function_1d(&points), &ray);
        let error = difference([r, g, b], RED.map(|c| c * alpha));
        assert!(error < 2e-15, "{ray:?}: found {:?}, expected {:?}", [r, g, b], RED.map(|c| c * alpha));
    }
}

#[test]
fn emission_without_extinction_is_the_mean_value_theorem() {
    // q = v per 1000 HU: along 10 mm through the ramp, ∫ q = 10 · 0.5.
    let knot = |value: f64, r: f64| Knot {
        value,
        optics: Optics { extinction_per_mm: 0.0, emission_per_mm: [r, 0.0, 2.0 * r] },
    };
    let curve = Curve::new(vec![knot(0.0, 0.0), knot(1000.0, 1.0)]).unwrap();
    let found = radiance(&ramp_volume(), function(vec![Term { curve, weight: None }]), &along_x());
    assert!(difference(found, [5.0, 0.0, 10.0, 0.0]) < 1e-14, "found {found:?}");
}

/// `∫₀ˣ e^{-t²} dt` by its series with positive terms.
fn gauss_integral(x: f64) -> f64 {
    let (mut term, mut sum) = (x, x);
    for n in 1..400 {
        term *= 2.0 * x * x / f64::from(2 * n + 1);
        sum += term;
    }
    (-x * x).exp() * sum
}

#[test]
fn linear_extinction_is_an_error_function() {
    // σ = k x for x in [0, 10] mm. Red emits as much as is absorbed, so that it is the opacity; green emits k evenly:
    // ∫ k e^{-k x²/2} dx.
    for k in [1e-3, 0.02, 0.1, 0.5] {
        let knot = |x: f64| Knot {
            value: 100.0 * x,
            optics: Optics { extinction_per_mm: k * x, emission_per_mm: [k * x, k, 0.0] },
        };
        let curve = Curve::new(vec![knot(0.0), knot(10.0)]).unwrap();
        let found = radiance(&ramp_volume(), function(vec![Term { curve, weight: None }]), &along_x());
        let alpha = -(-50.0 * k).exp_m1();
        let root = (0.5 * k).sqrt();
        let green = k / root * gauss_integral(10.0 * root);
        assert!(difference(found, [alpha, green, 0.0, alpha]) < 2e-15, "k = {k}: found {found:?}, green {green}");
    }
}

#[test]
fn a_step_is_crossed_where_it_is() {
    // 3/mm above 333 HU, which the ramp reaches at 3.33 mm; red before it at 0.05/mm.
    let points = [(0.0, 0.05, RED), (333.0, 0.05, RED), (333.0, 3.0, BLUE), (1000.0, 3.0, BLUE)];
    let found = radiance(&ramp_volume(), function_1d(&points), &along_x());
    let (front, behind) = (-(-0.05_f64 * 3.33).exp_m1(), -(-3.0_f64 * 6.67).exp_m1());
    let [r, g, b]: [f64; 3] = std::array::from_fn(|c| RED[c] * front + (1.0 - front) * BLUE[c] * behind);
    let expected = [r, g, b, front + (1.0 - front) * behind];
    assert!(difference(found, expected) < 2e-15, "found {found:?}, expected {expected:?}");
}
