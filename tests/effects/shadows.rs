//! Shadows where a formula says how dark they are, and the model's error.

use glam::DVec3;
use pellucid::oracle::Oracle;
use pellucid::scene::{Effects, Light, Scene, Shading, Shadows};
use pellucid::volume::Volume;

use super::{against_the_oracle, assert_everyone_sees, one_ray};
use crate::support::scenes::{
    BLUE, difference, function_1d, headlight, lamp, rough_volume, scene, scene_around, two_colors, unit_grid, volume_of,
};

/// A floor in the planes k = 0 and 1 and a slab in the planes 5 to 7, with air between and above.
fn floor_below_a_slab() -> Volume {
    volume_of(unit_grid([8, 8, 10]), |[_, _, k]| match k {
        0 | 1 => 100.0,
        5..=7 => 200.0,
        _ => 0.0,
    })
}

/// Along the plane k = 1, in which the value is 100 and the gradient points down.
fn along_the_floor(strength: f64) -> Scene {
    let mut scene = scene(function_1d(&[
        (50.0, 0.0, BLUE),
        (100.0, 0.3, BLUE),
        (150.0, 0.0, BLUE),
        (175.0, 0.0, BLUE),
        (200.0, 0.2, BLUE),
    ]));
    scene.camera = one_ray(DVec3::new(-5.0, 3.4, 1.0), DVec3::X);
    let sun = Light::Directional { towards: DVec3::Z, color: [1.0; 3] };
    scene.shading = Some(Shading { specular: 0.0, lights: vec![sun], ..headlight() });
    scene.effects.shadows = (strength > 0.0).then_some(Shadows { strength });
    scene
}

#[test]
fn a_slab_casts_its_shadow_on_the_floor() {
    // Up from the plane 1 the value falls from 100 to 0, rises to 200, stays, and falls to 0.
    let (leave_floor, meet_slab): (f64, f64) =
        (0.5 * 50.0 * 0.3 / 100.0, (0.5 * 100.0 * 0.3 + 0.5 * 25.0 * 0.2) / 200.0);
    let transmittance = (-(leave_floor + meet_slab + 2.0 * 0.2 + meet_slab)).exp();
    let opacity = 1.0 - (-0.3 * 7.0_f64).exp();
    for strength in [0.0, 0.5, 1.0] {
        let visibility = 1.0 - strength * (1.0 - transmittance);
        let seen = BLUE.map(|c| c * (0.125 + 0.75 * visibility) * opacity);
        let expected = [seen[0], seen[1], seen[2], opacity];
        assert_everyone_sees(
            &floor_below_a_slab(),
            &along_the_floor(strength),
            expected,
            [1e-6, 0.25, 2e-6],
            "the floor",
        );
    }
}

#[test]
fn an_axis_of_one_voxel_is_half_its_thickness_from_its_ends() {
    let volume = volume_of(unit_grid([8, 8, 1]), |[i, ..]| 100.0 + i as f64);
    let mut scene = along_the_floor(1.0);
    scene.transfer_function = function_1d(&[(0.0, 0.4, BLUE), (500.0, 0.4, BLUE)]);
    scene.camera = one_ray(DVec3::new(3.2, -5.0, 0.2), DVec3::Y);
    if let Some(shading) = &mut scene.shading {
        let towards = DVec3::new(0.6, 0.0, 0.8);
        shading.lights = vec![Light::Directional { towards, color: [1.0; 3] }];
    }
    // From the middle of the slice 0.5 mm up, along a ray of slope 0.8: the gradient is along x.
    let visibility = (-0.4 * 0.5 / 0.8_f64).exp();
    let opacity = 1.0 - (-0.4 * 7.0_f64).exp();
    let seen = BLUE.map(|c| c * (0.125 + 0.75 * 0.6 * visibility) * opacity);
    let expected = [seen[0], seen[1], seen[2], opacity];
    assert_everyone_sees(&volume, &scene, expected, [1e-6, 0.25, 2e-6], "one slice");
}

#[test]
fn shadows_agree_with_the_oracle_and_stronger_ones_are_darker() {
    let volume = rough_volume(9);
    let shadowed = |strength| Scene {
        effects: Effects { shadows: Some(Shadows { strength }), ..Effects::default() },
        ..scene_around(&volume, vec![two_colors()], Some(lamp(10.0)), [12, 12])
    };
    let mut before = f64::INFINITY;
    for strength in [0.25, 1.0] {
        let scene = shadowed(strength);
        let (error, of_bound) = against_the_oracle(&volume, &scene, 1e-3);
        assert!(error <= 1e-3 && of_bound <= 1.0, "strength {strength}: error {error:e}, {of_bound} x the bound");
        let oracle = Oracle::new(&volume, &scene);
        let sum: f64 = (0..144).map(|i| oracle.pixel(i % 12, i / 12)[0]).sum();
        assert!(sum < 0.98 * before, "strength {strength}: {sum} after {before}");
        before = sum;
    }
    // The comparison sees a shadow that is a little too strong.
    let wrong = Oracle::new(&volume, &shadowed(0.97)).pixel(6, 6);
    let right = Oracle::new(&volume, &shadowed(1.0)).pixel(6, 6);
    assert!(difference(wrong, right) > 1e-4, "found {wrong:?} and {right:?}");
}

#[test]
fn tracing_every_points_light_is_near_the_model_and_nearer_on_a_finer_lattice() {
    let model_error = |n: usize| {
        let spacing = 8.0 / (n - 1) as f64;
        let grid = pellucid::volume::Grid::axis_aligned([n; 3], DVec3::splat(spacing)).expect("a valid grid");
        let wave =
            |x: f64, y: f64, z: f64| 300.0 + 200.0 * (0.6 * x + 1.0).sin() * (0.4 * y).cos() + 60.0 * (0.7 * z).cos();
        let volume = volume_of(grid, |index| {
            let [x, y, z] = index.map(|i| i as f64 * spacing);
            wave(x, y, z)
        });
        let mut scene = along_the_floor(1.0);
        scene.transfer_function = function_1d(&[(0.0, 0.0, BLUE), (600.0, 0.6, BLUE)]);
        scene.camera = one_ray(DVec3::new(-5.0, 3.4, 2.7), DVec3::new(0.9, 0.1, 0.2).normalize());
        let oracle = Oracle::new(&volume, &scene);
        difference(oracle.pixel(0, 0), oracle.clone().with_traced_light().pixel(0, 0))
    };
    let (coarse, fine) = (model_error(5), model_error(17));
    assert!(coarse < 0.02 && coarse > 1e-5, "the model's error is {coarse:e} on a coarse lattice");
    assert!(fine < 0.15 * coarse, "{fine:e} on a fine lattice, {coarse:e} on a coarse one: not of second order");
}
