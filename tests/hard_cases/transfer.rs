//! Transfer functions with knots in awkward places.

use pellucid::scene::Ray;
use pellucid::transfer::{Term, TransferFunction};
use pellucid::volume::Volume;

use super::{assert_sees, renderers, renderers_without_march, slab};
use crate::support::scenes::{
    BLUE, BONE, RED, curve, function_1d, function_2d, noise_hu, ray, rays_through, scene, unit_grid, volume_i16,
    volume_of,
};

/// 100 HU per mm along x, for 10 mm.
fn ramp() -> Volume {
    volume_of(unit_grid([11, 3, 3]), |[i, _, _]| 100.0 * i as f64)
}

fn along_x() -> Ray {
    ray([-4.0, 1.25, 0.6], [1.0, 0.0, 0.0])
}

#[test]
fn unsorted_and_repeated_knots_are_the_sorted_curve() {
    let sorted = [(-100.0, 0.0, RED), (50.0, 1.0, RED), (50.0, 0.25, BLUE), (400.0, 2.0, BONE)];
    let shuffled = [
        (400.0, 2.0, BONE),
        (50.0, 1.0, RED),
        (-100.0, 0.0, RED),
        // Between the first and the last of those at one position, nothing remains.
        (50.0, 77.0, BONE),
        (50.0, 0.25, BLUE),
        (400.0, 2.0, BONE),
    ];
    let volume = noise_hu(unit_grid([5, 5, 5]), 20);
    for renderer in renderers() {
        for ray in rays_through(volume.grid(), 20, 21) {
            let expected = renderer.sees(&volume, &scene(function_1d(&sorted)), &ray);
            let found = renderer.sees(&volume, &scene(function_1d(&shuffled)), &ray);
            assert_sees(&renderer, "shuffled knots", found, expected, 0.0);
        }
    }
}

#[test]
fn one_knot_is_fog_whatever_the_value() {
    let volume = noise_hu(unit_grid([5, 5, 5]), 22);
    for renderer in renderers() {
        for value in [-1000.0, 250.0, 3000.0] {
            let found = renderer.sees(
                &volume,
                &scene(function_1d(&[(value, 0.25, RED)])),
                &ray([-9.0, 2.0, 1.7], [1.0, 0.0, 0.0]),
            );
            assert_sees(&renderer, &format!("a knot at {value} HU"), found, slab(RED, 1.0), 0.0);
        }
    }
}

#[test]
fn a_ramp_of_no_width_is_a_step() {
    // From 1 HU down to neighbouring numbers; the ramp's own opacity shrinks with its width.
    let step = |width: f64| {
        function_1d(&[(0.0, 0.0, BONE), (430.0, 0.0, BONE), (430.0 + width, 0.5, BONE), (1000.0, 0.5, BONE)])
    };
    for renderer in renderers() {
        for width in [1.0, 1e-3, 1e-6, 1e-9, 1e-12, 430.0 * f64::EPSILON, 0.0] {
            let found = renderer.sees(&ramp(), &scene(step(width)), &along_x());
            let depth = 0.5 * (5.7 - 0.5 * width / 100.0);
            assert_sees(&renderer, &format!("a ramp of {width:e} HU"), found, slab(BONE, depth), 0.0);
        }
    }
}

#[test]
fn spikes_of_no_width_and_no_height_are_dropped() {
    let with = [(0.0, 0.1, RED), (300.0, 0.1, RED), (300.0, 1e6, BLUE), (300.0, 0.1, RED), (1000.0, 0.1, RED)];
    for renderer in renderers() {
        let found = renderer.sees(&ramp(), &scene(function_1d(&with)), &along_x());
        assert_sees(&renderer, "a spike of no width", found, slab(RED, 1.0), 0.0);
    }
}

#[test]
fn thin_shells_are_never_missed() {
    // A tent 2w wide and 1/w high has the optical depth 1/slope, however thin it is.
    for half_width in [20.0, 1.0, 1e-2, 1e-4, 1e-6] {
        let top = 200.0 / half_width;
        let shell = [(333.3 - half_width, 0.0, RED), (333.3, top, RED), (333.3 + half_width, 0.0, RED)];
        for renderer in renderers_without_march("a fixed step misses what is thinner") {
            let found = renderer.sees(&ramp(), &scene(function_1d(&shell)), &along_x());
            assert_sees(&renderer, &format!("a shell of {half_width:e} HU"), found, slab(RED, 2.0), 1e-12 / half_width);
        }
    }
}

#[test]
fn shells_within_one_steep_cell_are_each_found() {
    // From 0 to 3000 HU within one voxel, through fifty shells.
    let volume = volume_i16(unit_grid([2, 2, 2]), vec![0, 3000, 0, 3000, 0, 3000, 0, 3000]);
    let shells: Vec<_> = (1..=50)
        .flat_map(|i| {
            let center = 55.0 * f64::from(i);
            [(center - 2.0, 0.0, BONE), (center, 60.0, BONE), (center + 2.0, 0.0, BONE)]
        })
        .collect();
    for renderer in renderers_without_march("a fixed step misses what is thinner") {
        let found = renderer.sees(&volume, &scene(function_1d(&shells)), &ray([-1.0, 0.5, 0.5], [1.0, 0.0, 0.0]));
        // Fifty tents of area 120 HU/mm, at 3000 HU per mm.
        assert_sees(&renderer, "fifty shells", found, slab(BONE, 2.0), 0.0);
    }
}

/// Along the diagonal of the x-y face the value is a parabola with its top, 600 HU, in the middle of the cell.
fn saddle() -> (Volume, Ray) {
    let volume = volume_i16(unit_grid([2, 2, 2]), vec![0, 1200, 1200, 0, 0, 1200, 1200, 0]);
    (volume, ray([-1.0, -1.0, 0.25], [1.0, 1.0, 0.0]))
}

#[test]
fn a_value_that_only_touches_a_step_does_not_cross_it() {
    let (volume, ray) = saddle();
    for renderer in renderers_without_march("a value in f32 rounds across a step that it only touches") {
        for above in [0.0, 1e-9, 1e-3] {
            let top = 600.0 + above;
            let touching = [(0.0, 0.5, RED), (top, 0.5, RED), (top, 1e3, BLUE), (2000.0, 1e3, BLUE)];
            let found = renderer.sees(&volume, &scene(function_1d(&touching)), &ray);
            // Rounding of 1e-13 HU in the value may open a crossing of 1e-8 mm: the square root is in the problem.
            assert_sees(&renderer, &format!("a step {above:e} HU above"), found, slab(RED, 0.5 * 2.0_f64.sqrt()), 1e-4);
        }
    }
}

#[test]
fn a_value_that_barely_crosses_a_step_does_cross_it() {
    let (volume, ray) = saddle();
    for renderer in renderers_without_march("a fixed step misses what is thinner") {
        for below in [100.0, 1.0, 1e-4, 1e-8] {
            let top = 600.0 - below;
            let extinction = 1.0 / (below / 1200.0_f64).sqrt();
            let crossed = [(0.0, 0.0, BLUE), (top, 0.0, BLUE), (top, extinction, BLUE), (2000.0, extinction, BLUE)];
            let found = renderer.sees(&volume, &scene(function_1d(&crossed)), &ray);
            // v = 2400 t(1 - t) exceeds the step over 2 √(below/2400) of the diagonal's √2 mm.
            assert_sees(&renderer, &format!("{below:e} HU above"), found, slab(BLUE, 2.0), 1e-13 / below * 600.0);
        }
    }
}

#[test]
fn cubics_that_are_nearly_straight_need_no_case_of_their_own() {
    let points = [(-300.0, 0.0, RED), (100.0, 2.0, RED), (100.0, 0.5, BLUE), (700.0, 1.0, BONE)];
    let straight = |[i, j, k]: [usize; 3]| 250.0 * i as f64 - 125.0 * j as f64 + 64.0 * k as f64;
    let exact = volume_of(unit_grid([4, 4, 4]), straight);
    for renderer in renderers() {
        for bend in [6.2e-5, 1e-3] {
            // A twist of a few f32 bits, alternating so that every coefficient of the cubic is a residue.
            let bent =
                volume_of(unit_grid([4, 4, 4]), |v| straight(v) + bend * f64::from(v.iter().sum::<usize>() as u32 % 2));
            for ray in rays_through(exact.grid(), 30, 24) {
                let (found, expected) =
                    [&bent, &exact].map(|v| renderer.sees(v, &scene(function_1d(&points)), &ray)).into();
                assert_sees(&renderer, &format!("bend of {bend:e} HU"), found, expected, 0.02 * bend);
            }
        }
    }
}

#[test]
fn a_plateau_exactly_at_a_step_has_the_value_from_the_right() {
    let volume = volume_i16(unit_grid([11, 3, 3]), vec![100; 99]);
    let points = [(0.0, 0.05, RED), (100.0, 0.05, RED), (100.0, 0.1, BLUE), (300.0, 0.1, BLUE)];
    for renderer in renderers() {
        let found = renderer.sees(&volume, &scene(function_1d(&points)), &along_x());
        assert_sees(&renderer, "a plateau at a step", found, slab(BLUE, 1.0), 0.0);
        let terms = vec![Term { curve: curve(&points), weight: None }];
        let ends_there = TransferFunction::new([-50.0, 100.0], 1.0, terms).unwrap();
        let found = renderer.sees(&volume, &scene(ends_there), &along_x());
        assert_sees(&renderer, "a plateau at the end of the window", found, slab(RED, 0.5), 0.0);
    }
}

#[test]
fn values_beyond_the_window_are_as_at_its_end() {
    let terms = vec![Term { curve: curve(&[(0.0, 0.0, RED), (1000.0, 1.0, RED)]), weight: None }];
    let narrow = TransferFunction::new([200.0, 600.0], 1.0, terms).unwrap();
    for renderer in renderers() {
        let found = renderer.sees(&ramp(), &scene(narrow.clone()), &along_x());
        // 0.2 for 2 mm, a ramp to 0.6 over 4 mm, 0.6 for 4 mm.
        assert_sees(&renderer, "a narrow window", found, slab(RED, 0.4 + 1.6 + 2.4), 0.0);
    }
}

#[test]
fn a_step_along_the_gradient_axis_is_crossed_where_it_is() {
    // Values 0, 0, 200, 800: gradients 0, 100, 400, 600 per mm, interpolated linearly between the voxels.
    let volume = volume_of(unit_grid([4, 3, 3]), |[i, _, _]| [0.0, 0.0, 200.0, 800.0][i]);
    let steps = [[0.0, 0.0], [50.0, 0.0], [50.0, 1.0], [250.0, 1.0], [250.0, 3.0], [500.0, 3.0], [500.0, 0.0]];
    for renderer in renderers() {
        let found = renderer.sees(&volume, &scene(function_2d(&[(0.0, 0.5, BLUE)], &steps)), &along_x());
        // 50 is reached at 0.5 mm, 250 at 1.5 mm and 500 at 2.5 mm.
        assert_sees(&renderer, "steps along the gradient", found, slab(BLUE, 0.5 * (1.0 + 3.0)), 0.0);
    }
}

#[test]
fn the_color_of_what_is_invisible_does_not_bleed() {
    // Red that absorbs nothing beside bone: with straight colours interpolated it would tint the bone's edge.
    let points = |hidden| [(0.0, 0.0, hidden), (500.0, 0.0, hidden), (520.0, 2.0, BONE), (1000.0, 2.0, BONE)];
    for renderer in renderers() {
        let expected = renderer.sees(&ramp(), &scene(function_1d(&points(BONE))), &along_x());
        let found = renderer.sees(&ramp(), &scene(function_1d(&points([1.0, 0.0, 0.0]))), &along_x());
        assert_sees(&renderer, "hidden red", found, expected, 0.0);
    }
}
