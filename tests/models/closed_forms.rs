//! Numbers along rays that anybody can work out.

use glam::DVec3;
use pellucid::image::srgb;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::oracle::Oracle;
use pellucid::scene::{Model, Ray, Scene, ValueModel, ValueOf};
use pellucid::transfer::Term;
use pellucid::volume::Volume;

use crate::support::scenes::{BONE, RED, curve, ray, scene_around, unit_grid, volume_of, weighted};

/// The number of a ray, from the display's grey, by the exact integrator; the oracle must say the same.
fn number(volume: &Volume, terms: Vec<Term>, of: ValueOf, [low, high]: [f64; 2], ray: &Ray) -> f64 {
    let model = Model::Value(ValueModel { of, window: [low, high] });
    let scene = Scene { model, ..scene_around(volume, terms, None, [4, 4]) };
    let light =
        tracer(volume, &scene, 1e-3, Precision::Single).trace(ray).expect("the ray meets the volume").radiance[0];
    let truth = Oracle::new(volume, &scene).radiance(ray)[0];
    assert!((light - truth).abs() < 1e-12, "{of:?}: exact {light}, oracle {truth}");
    low + (high - low) * srgb::encode(light)
}

#[test]
fn the_maximum_inside_a_trilinear_cell_is_found() {
    // One corner of 1000, (1, 1, 0): along the diagonal 1000 t² (1 − t), largest at t = 2/3.
    let volume = volume_of(unit_grid([2; 3]), |[i, j, k]| if [i, j, k] == [1, 1, 0] { 1000.0 } else { 0.0 });
    let diagonal = ray([-1.0; 3], [1.0; 3]);
    let expected = 1000.0 * 4.0 / 27.0;
    for of in [ValueOf::Maximum, ValueOf::LocalMaximum { threshold: 100.0 }] {
        let found = number(&volume, vec![], of, [0.0, 1000.0], &diagonal);
        assert!((found - expected).abs() < 1e-9, "{of:?}: found {found}, expected {expected}");
    }
    let found = number(&volume, vec![], ValueOf::Sum, [0.0, 1000.0], &diagonal);
    let expected = 1000.0 * 3f64.sqrt() / 12.0;
    assert!((found - expected).abs() < 1e-9, "∫ t²(1 − t) = 1/12: found {found}, expected {expected}");
}

#[test]
fn the_sum_is_the_mean_times_the_length() {
    let volume = volume_of(unit_grid([11, 5, 5]), |[i, j, _]| 100.0 * i as f64 - 30.0 * (j * j) as f64);
    for ray in [ray([-4.0, 2.2, 1.7], [1.0, 0.0, 0.0]), ray([-4.0, 1.0, 0.5], [1.0, 0.05, 0.1])] {
        let mean = number(&volume, vec![], ValueOf::Mean, [-1000.0, 2000.0], &ray);
        let sum = number(&volume, vec![], ValueOf::Sum, [-10_000.0, 20_000.0], &ray);
        // The volume is 10 mm long, and the second ray leaves it at its end, too.
        let length_mm = 10.0 / ray.direction.x;
        assert!((sum - mean * length_mm).abs() < 1e-7, "sum {sum} HU mm, mean {mean} HU over {length_mm} mm");
    }
}

#[test]
fn a_ramp_ends_at_its_largest_value_and_holds_half_of_it_on_average() {
    let volume = volume_of(unit_grid([11, 5, 5]), |[i, _, _]| 100.0 * i as f64);
    for direction in [1.0, -1.0] {
        let ray = ray([5.0 - 20.0 * direction, 2.2, 1.7], [direction, 0.0, 0.0]);
        for (of, expected) in [
            (ValueOf::Sum, 5000.0),
            (ValueOf::LocalMaximum { threshold: 300.0 }, 1000.0),
            (ValueOf::LocalMaximum { threshold: 5000.0 }, 1000.0),
        ] {
            let found = number(&volume, vec![], of, [0.0, 6000.0], &ray);
            assert!((found - expected).abs() < 1e-8, "{of:?} along {direction}: found {found}, expected {expected}");
        }
    }
}

#[test]
fn a_vessel_hides_the_bone_behind_it() {
    // A vessel of 250 HU at x = 8, and bone of 1200 HU at x = 24.
    let volume = volume_of(unit_grid([33, 9, 9]), |[i, _, _]| {
        let hill = |center: f64, height: f64, width: f64| height * (1.0 - (i as f64 - center).abs() / width).max(0.0);
        hill(8.0, 250.0, 3.0) + hill(24.0, 1200.0, 4.0)
    });
    let shown = |threshold, direction: f64| {
        let ray = ray([16.0 - 50.0 * direction, 4.3, 3.9], [direction, 0.0, 0.0]);
        number(&volume, vec![], ValueOf::LocalMaximum { threshold }, [0.0, 2000.0], &ray)
    };
    for (threshold, direction, expected) in
        [(150.0, 1.0, 250.0), (250.0, 1.0, 250.0), (251.0, 1.0, 1200.0), (150.0, -1.0, 1200.0), (1500.0, 1.0, 1200.0)]
    {
        let found = shown(threshold, direction);
        assert!(
            (found - expected).abs() < 1e-8,
            "from {threshold} HU along {direction}: found {found}, expected {expected}"
        );
    }
}

#[test]
fn the_optical_depth_of_a_slab_is_extinction_times_length() {
    let volume = volume_of(unit_grid([11, 5, 5]), |_| 40.0);
    let slab = |extinction| vec![Term { curve: curve(&[(0.0, extinction, BONE)]), weight: None }];
    for extinction in [0.0, 1e-9, 0.03, 7.0, 500.0] {
        let oblique = ray([-3.0, 1.9, 2.0], [1.0, 0.02, -0.01]);
        let length_mm = 10.0 / oblique.direction.x;
        let expected = extinction * length_mm;
        let window = [0.0, 2.0 * expected + 1e-3];
        let found = number(&volume, slab(extinction), ValueOf::OpticalDepth, window, &oblique);
        assert!((found - expected).abs() < 1e-12 * window[1], "found {found}, expected {expected}");
    }
}

#[test]
fn the_optical_depth_across_a_knot_and_a_gradient_weight_is_known() {
    // v = 100 x over 10 mm; σ rises from 0 at 200 HU to 0.5/mm at 600 HU, and stays.
    let volume = volume_of(unit_grid([11, 5, 5]), |[i, _, _]| 100.0 * i as f64);
    let points = [(200.0, 0.0, RED), (600.0, 0.5, RED)];
    let along_x = ray([-4.0, 2.2, 1.7], [1.0, 0.0, 0.0]);
    let plain = vec![Term { curve: curve(&points), weight: None }];
    let found = number(&volume, plain, ValueOf::OpticalDepth, [0.0, 4.0], &along_x);
    assert!((found - 3.0).abs() < 1e-12, "half of 4 mm and all of 4 mm of 0.5/mm: found {found}");
    // The gradient is 100 HU/mm everywhere, where this weight is 0.25.
    let weighted = vec![weighted(&points, &[[0.0, 0.0], [400.0, 1.0]])];
    let found = number(&volume, weighted, ValueOf::OpticalDepth, [0.0, 4.0], &along_x);
    assert!((found - 0.75).abs() < 1e-12, "a quarter of 3: found {found}");
}

#[test]
fn a_ray_that_misses_shows_nothing() {
    let volume = volume_of(unit_grid([4; 3]), |_| 500.0);
    let aside = Ray { origin_mm: DVec3::new(-5.0, 50.0, 0.0), direction: DVec3::X };
    for of in [ValueOf::Sum, ValueOf::LocalMaximum { threshold: 0.0 }, ValueOf::OpticalDepth] {
        let model = Model::Value(ValueModel { of, window: [0.0, 1.0] });
        let scene = Scene { model, ..scene_around(&volume, vec![], None, [4, 4]) };
        assert!(tracer(&volume, &scene, 1e-3, Precision::Single).trace(&aside).is_none(), "{of:?}");
        assert_eq!(Oracle::new(&volume, &scene).radiance(&aside), [0.0; 4], "{of:?}");
    }
}
