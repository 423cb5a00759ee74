//! What a fixed step brings with it.

use pellucid::Fault;
use pellucid::integrate::{Schedule, render, render_scheduled};
use pellucid::plan::{Exact, Method, SampleRule};
use pellucid::scene::Ray;

use super::{march, settings, slab};
use crate::support::scenes::{
    BLUE, BONE, RED, difference, function_1d, grid, noise_hu, ray, rays_through, rough_volume, scene, scene_around,
    thin_shell, two_colors, two_lights, unit_grid, volume_i16,
};

fn along_x() -> Ray {
    ray([-4.0, 1.25, 0.6], [1.0, 0.0, 0.0])
}

#[test]
fn a_hundred_thousand_thin_steps_lose_what_rounding_loses() {
    let volume = volume_i16(unit_grid([11, 3, 3]), vec![0; 99]);
    for alpha in [1e-8, 1e-7, 1e-6, 1e-5, 1e-3] {
        let fog = scene(function_1d(&[(0.0, alpha / 1e-4, RED)]));
        let found = march(&volume, &fog, &along_x(), &settings(1e-4));
        let error = difference(found, slab(RED, 1e5 * alpha));
        // Half a unit in the last place of a transmittance below 1, per step.
        let allowed = 1e5 * (-25_f64).exp2() + 1e-5;
        assert!(error <= allowed, "1e5 steps of {alpha:e}: error {error:e} above {allowed:e}, found {found:?}");
    }
}

#[test]
fn steps_are_counted_and_never_added_up() {
    // 1e5 steps of 0.1 mm through nothing to a wall of fog 5 mm before the end; f32 sums of 0.1 are 1.4 mm off by then.
    let mut samples = vec![0; 1001 * 4];
    for row in 0..4 {
        samples[1001 * row + 1000] = 1000;
    }
    let volume =
        volume_i16(grid([1001, 2, 2], [[10.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]), samples);
    let fog = scene(function_1d(&[(0.0, 0.0, BONE), (500.0, 0.0, BONE), (500.0, 0.2, BONE), (1000.0, 0.2, BONE)]));
    let found = march(&volume, &fog, &ray([-50.0, 0.4, 0.3], [1.0, 0.0, 0.0]), &settings(0.1));
    let error = difference(found, slab(BONE, 1.0));
    assert!(error <= 0.2 * 0.1, "off by {error}, more than one step of fog: found {found:?}");
}

#[test]
fn a_step_longer_than_the_volume_is_one_interval() {
    let volume = volume_i16(unit_grid([11, 3, 3]), vec![50; 99]);
    let fog = scene(function_1d(&[(0.0, 0.1, BLUE)]));
    for rule in [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid] {
        for step_mm in [10.0, 11.0, 1e6, 1e300] {
            let found = march(&volume, &fog, &along_x(), &pellucid::plan::March { rule, ..settings(step_mm) });
            let error = difference(found, slab(BLUE, 1.0));
            assert!(error < 1e-6, "{rule:?}, a step of {step_mm:e} mm: found {found:?}");
        }
    }
}

#[test]
fn a_step_of_a_millionth_of_a_voxel_is_refused() {
    let volume = volume_i16(unit_grid([200, 2, 2]), vec![0; 800]);
    let fog = scene(function_1d(&[(0.0, 0.1, RED)]));
    let refused = render(&volume, &fog, &Method::March(settings(1e-6)), &|_| ()).expect_err("4e8 samples on a ray");
    assert_eq!(refused.fault(), Fault::Limit, "{refused}");
    for step_mm in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = render(&volume, &fog, &Method::March(settings(step_mm)), &|_| ()).expect_err("no step at all");
        assert_eq!(refused.fault(), Fault::Spec, "a step of {step_mm}: {refused}");
    }
}

#[test]
fn early_termination_errs_by_no_more_than_it_leaves() {
    let volume = noise_hu(unit_grid([9, 8, 7]), 12);
    let thick = scene(function_1d(&[(-500.0, 0.0, RED), (-100.0, 1.0, BLUE), (300.0, 0.1, BONE), (700.0, 3.0, RED)]));
    for ray in rays_through(volume.grid(), 30, 14) {
        let whole = march(&volume, &thick, &ray, &settings(0.01));
        let mut last = 0.0;
        for least in [1e-4, 1e-3, 1e-2, 0.1, 0.5] {
            let stops = pellucid::plan::March { termination_transmittance: least, ..settings(0.01) };
            let error = difference(march(&volume, &thick, &ray, &stops), whole);
            assert!(error <= least, "stopped at {least}: error {error}");
            assert!(error >= last, "stopped at {least}: error {error} after {last} with less left");
            last = error;
        }
    }
}

#[test]
fn threads_and_tile_order_change_no_bit() {
    let volume = rough_volume(14);
    let terms = vec![two_colors(), thin_shell()];
    let scene = scene_around(&volume, terms, Some(two_lights(true)), [53, 37]);
    for method in [Method::March(settings(0.3)), Method::Exact(Exact::within(1e-3))] {
        let picture = |threads: usize, shuffled_tiles: Option<u64>| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let schedule = Schedule { shuffled_tiles, ..Schedule::default() };
            let rendered = pool.install(|| render_scheduled(&volume, &scene, &method, schedule, &|_| ()));
            let rendered = rendered.expect("a picture");
            let bits: Vec<_> = rendered.image.pixels().iter().map(|pixel| pixel.map(f32::to_bits)).collect();
            (bits, rendered.statistics)
        };
        let (expected, statistics) = picture(1, None);
        for (threads, order) in [(1, Some(7)), (2, None), (2, Some(7)), (2, Some(8)), (3, Some(9))] {
            let (found, took) = picture(threads, order);
            let off = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
            assert_eq!(off, 0, "{}: pixels differ with {threads} threads, tiles {order:?}", statistics.kernel);
            assert_eq!(took, statistics, "{threads} threads, tiles {order:?}");
        }
    }
}
