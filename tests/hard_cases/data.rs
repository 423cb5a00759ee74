//! Samples that are constant, extreme or not numbers, and what the lattice means.

use glam::DVec3;
use pellucid::Fault;
use pellucid::scene::Ray;
use pellucid::volume::{Quantity, Rescale, Samples, Volume};

use super::{assert_sees, renderers, slab};
use crate::support::scenes::{
    BLUE, BONE, RED, function_1d, function_2d, grid, headlight, lamp, noise_hu, ray, rays_through, scene, shaded,
    unit_grid, volume_i16, volume_of,
};

fn along_x() -> Ray {
    ray([-4.0, 1.25, 0.6], [1.0, 0.0, 0.0])
}

#[test]
fn a_constant_volume_has_no_gradient_and_the_ambient_light() {
    let volume = volume_i16(unit_grid([11, 3, 3]), vec![40; 99]);
    for renderer in renderers() {
        for shading in [headlight(), lamp(0.0), lamp(50.0)] {
            let lit = shaded(scene(function_1d(&[(40.0, 0.1, BONE)])), shading);
            let found = renderer.sees(&volume, &lit, &along_x());
            let mut expected = slab(BONE.map(|c| 0.125 * c), 1.0);
            expected[3] = -(-1.0_f64).exp_m1();
            assert_sees(&renderer, "ambient light", found, expected, 0.0);
        }
        let flat = scene(function_2d(&[(40.0, 0.1, RED)], &[[0.0, 1.0], [10.0, 0.0]]));
        assert_sees(&renderer, "|g| = 0", renderer.sees(&volume, &flat, &along_x()), slab(RED, 1.0), 0.0);
        let edges = scene(function_2d(&[(40.0, 0.1, RED)], &[[0.0, 0.0], [10.0, 1.0]]));
        assert_eq!(renderer.sees(&volume, &edges, &along_x()), [0.0; 4], "{}: no edges", renderer.name);
    }
}

#[test]
fn a_gradient_that_vanishes_at_a_point_is_passed_without_harm() {
    // A dome: the gradient is 0 at its top, through which the ray goes, and nearly 0 beside it.
    let dome = |[i, j, k]: [usize; 3]| {
        let x = DVec3::new(i as f64, j as f64, k as f64) - DVec3::splat(2.0);
        1000.0 - 100.0 * x.length_squared()
    };
    let volume = volume_of(unit_grid([5, 5, 5]), dome);
    let points = [(0.0, 0.0, BONE), (1000.0, 0.75, BONE)];
    for renderer in renderers() {
        for shading in [headlight(), lamp(0.0), lamp(20.0)] {
            let lit = shaded(scene(function_1d(&points)), shading);
            let through = Ray { origin_mm: DVec3::new(-3.0, 2.0, 2.0), direction: DVec3::X };
            let top = renderer.sees(&volume, &lit, &through);
            for offset in [1e-7, 1e-10, 1e-13] {
                let beside = Ray { origin_mm: through.origin_mm + DVec3::new(0.0, offset, -0.5 * offset), ..through };
                let found = renderer.sees(&volume, &lit, &beside);
                assert_sees(&renderer, &format!("{offset:e} mm beside"), found, top, 30.0 * offset);
            }
        }
    }
}

#[test]
fn sixteen_bit_extremes_are_apart_by_all_of_65535() {
    let samples = (0..27).map(|i| if i % 3 == 0 { i16::MIN } else { i16::MAX }).collect();
    let volume = volume_i16(unit_grid([3, 3, 3]), samples);
    // The ramp takes 1 mm; the gradient is 65535 at x = 0, half that at x = 1 and 0 at x = 2.
    let fog = function_1d(&[(-32_768.0, 0.0, RED), (32_767.0, 2.0, RED)]);
    let edge = function_2d(&[(0.0, 1.0, BLUE)], &[[0.0, 0.0], [4000.0, 1.0]]);
    for renderer in renderers() {
        let found = renderer.sees(&volume, &scene(fog.clone()), &along_x());
        assert_sees(&renderer, "a ramp over 16 bits", found, slab(RED, 1.0 + 2.0), 0.0);
        let found = renderer.sees(&volume, &scene(edge.clone()), &along_x());
        // Full weight down to 4000 per mm, then a ramp over the last 4000 / 32767.5 mm.
        assert_sees(&renderer, "a gradient of 65535", found, slab(BLUE, 2.0 - 0.5 * 4000.0 / 32_767.5), 0.0);
    }
}

#[test]
fn the_rescale_maps_samples_to_values_also_downwards_and_far_up() {
    let stored: Vec<i16> = (0..99).map(|i| 100 * (i % 11)).collect();
    let lattice = unit_grid([11, 3, 3]);
    for (slope, intercept) in [(1.0, -1024.0), (0.5, 0.0), (-2.0, 700.0), (30.0, -30_000.0), (1e-3, 5.0)] {
        let rescale = Rescale { slope, intercept };
        let volume = Volume::new(lattice, Samples::I16(stored.clone()), rescale, Quantity::Hu).unwrap();
        let ends = [rescale.value(0.0), rescale.value(1000.0)];
        let scene = scene(function_1d(&[(ends[0], 0.1, BONE), (ends[1], 0.3, BONE)]));
        for renderer in renderers() {
            let found = renderer.sees(&volume, &scene, &along_x());
            assert_sees(&renderer, &format!("slope {slope}, intercept {intercept}"), found, slab(BONE, 2.0), 0.0);
        }
    }
}

#[test]
fn integers_and_floats_of_the_same_value_are_the_same() {
    let integers = noise_hu(unit_grid([5, 5, 5]), 30);
    let Samples::I16(stored) = integers.samples() else { panic!("16-bit samples") };
    let floats = Samples::F32(stored.iter().map(|&s| f32::from(s)).collect());
    let floats = Volume::new(*integers.grid(), floats, Rescale::IDENTITY, Quantity::Hu).unwrap();
    let points = [(-300.0, 0.0, RED), (100.0, 2.0, RED), (100.0, 0.5, BLUE), (700.0, 1.0, BONE)];
    for renderer in renderers() {
        for ray in rays_through(integers.grid(), 20, 31) {
            let scene = scene(function_2d(&points, &[[0.0, 0.5], [300.0, 1.0]]));
            let (found, expected) = (renderer.sees(&floats, &scene, &ray), renderer.sees(&integers, &scene, &ray));
            assert_sees(&renderer, "f32 for i16", found, expected, 0.0);
        }
    }
}

#[test]
fn numbers_that_are_none_are_refused_at_the_door() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut samples = vec![0.0; 27];
        samples[14] = bad;
        let refused = Volume::new(unit_grid([3, 3, 3]), Samples::F32(samples), Rescale::IDENTITY, Quantity::Hu);
        let error = refused.expect_err("a voxel that is no number");
        assert_eq!(error.fault(), Fault::Input, "{error}");
        assert!(error.to_string().contains("voxel (2, 1, 1)"), "the voxel is named: {error}");
    }
    for (slope, intercept) in [(f64::NAN, 0.0), (1.0, f64::INFINITY), (0.0, 1.0)] {
        let rescale = Rescale { slope, intercept };
        let refused = Volume::new(unit_grid([1, 1, 1]), Samples::I16(vec![0]), rescale, Quantity::Hu);
        assert!(refused.is_err(), "slope {slope}, intercept {intercept}");
    }
}

#[test]
fn the_domain_ends_at_the_outermost_voxels() {
    // Neither half a voxel beyond them nor faded to nothing: n voxels are n - 1 spacings long.
    let lattice = grid([6, 5, 4], [[0.5, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]], [0.0; 3]);
    let volume = volume_of(lattice, |_| 1000.0);
    let scene = scene(function_1d(&[(0.0, 0.0, BONE), (1000.0, 0.125, BONE)]));
    for renderer in renderers() {
        for (axis, length) in [(0, 2.5), (1, 8.0), (2, 9.0)] {
            let inside = DVec3::new(0.6, 0.7, 0.8) * (DVec3::ONE - DVec3::AXES[axis]);
            let ray = Ray { origin_mm: inside - 30.0 * DVec3::AXES[axis], direction: DVec3::AXES[axis] };
            let found = renderer.sees(&volume, &scene, &ray);
            assert_sees(&renderer, &format!("along axis {axis}"), found, slab(BONE, 0.125 * length), 0.0);
        }
    }
}

#[test]
fn sampling_a_trilinear_field_more_finely_changes_nothing() {
    // The data set refinement of Etiene et al. (2014): order 0, so a shift by part of a voxel cannot hide.
    let field = |x: DVec3| {
        let corner = |c: usize| [-512.0, 256.0, 768.0, -128.0, 384.0, 0.0, -256.0, 1024.0][c];
        let weight = |c: usize| (0..3).map(|a| if c >> a & 1 == 1 { x[a] } else { 1.0 - x[a] }).product::<f64>();
        (0..8).map(|c| weight(c) * corner(c)).sum::<f64>()
    };
    let points = [(-300.0, 0.0, RED), (100.0, 0.2, RED), (100.0, 0.05, BLUE), (300.0, 0.0, BONE), (600.0, 0.5, BONE)];
    let side_mm = 16.0;
    let sampled = |n: usize| {
        let step = side_mm / (n - 1) as f64;
        let lattice = grid([n; 3], [[step, 0.0, 0.0], [0.0, step, 0.0], [0.0, 0.0, step]], [0.0; 3]);
        volume_of(lattice, |v| field(DVec3::from_array(v.map(|i| i as f64 / (n - 1) as f64))))
    };
    let coarse = sampled(2);
    for renderer in renderers() {
        for n in [3, 5, 9, 17, 33] {
            let fine = sampled(n);
            for ray in rays_through(coarse.grid(), 15, 33) {
                let scene = scene(function_1d(&points));
                let (found, expected) = (renderer.sees(&fine, &scene, &ray), renderer.sees(&coarse, &scene, &ray));
                assert_sees(&renderer, &format!("{n} voxels a side"), found, expected, 1e-12);
            }
        }
    }
}
