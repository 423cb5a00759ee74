//! Rays and lattices in awkward positions.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pellucid::scene::{Light, Ray, Scene};
use pellucid::transfer::TransferFunction;
use pellucid::volume::{Grid, Rescale, Volume};

use super::{Renderer, assert_sees, renderers, renderers_without_march, slab};
use crate::support::scenes::{
    BLUE, BONE, RED, function, function_1d, function_2d, grid, lamp, noise_hu, ray, rays_through, scene, shaded,
    unit_grid, volume_i16, volume_of, weighted,
};

/// How much of the scene a perturbed ray may change: 1e-9 of a voxel.
const LIMIT: f64 = 1e-6;

const TISSUES: [(f64, f64, [f64; 3]); 5] =
    [(-300.0, 0.0, RED), (-100.0, 0.5, RED), (200.0, 0.1, BLUE), (400.0, 1.5, BONE), (1000.0, 2.0, BONE)];

fn tissues() -> TransferFunction {
    function_1d(&TISSUES)
}

fn scenes() -> [Scene; 3] {
    let two_dimensional = function(vec![weighted(&TISSUES, &[[50.0, 0.25], [400.0, 1.0]])]);
    [scene(tissues()), scene(two_dimensional.clone()), shaded(scene(two_dimensional), lamp(30.0))]
}

/// The ray must see what rays beside it see, shifted by 1e-9 along each of `shifts`.
fn assert_limit(renderer: &Renderer, volume: &Volume, scene: &Scene, ray: &Ray, shifts: &[DVec3]) {
    let found = renderer.sees(volume, scene, ray);
    assert!(found[3] > 0.01, "{}: the case must show something, found {found:?} along {ray:?}", renderer.name);
    for &shift in shifts {
        let beside = Ray { origin_mm: ray.origin_mm + 1e-9 * shift, ..*ray };
        let expected = renderer.sees(volume, scene, &beside);
        assert_sees(renderer, &format!("{ray:?} beside {shift}"), found, expected, LIMIT);
    }
}

#[test]
fn axis_parallel_rays_on_faces_and_edges_see_what_rays_beside_them_see() {
    let volume = noise_hu(unit_grid([5, 5, 5]), 1);
    for (renderer, scene) in renderers().iter().flat_map(|r| scenes().map(|s| (r, s))) {
        for axis in 0..3 {
            let [u, v] = [(axis + 1) % 3, (axis + 2) % 3].map(|a| DVec3::AXES[a]);
            for (across, up) in [(2.0, 1.5), (1.0, 3.0), (2.5, 2.0)] {
                for sign in [1.0, -1.0] {
                    let along = sign * DVec3::AXES[axis];
                    let middle = DVec3::AXES[axis] * 2.0;
                    let on_edge = Ray { origin_mm: middle + across * u + up * v - 9.0 * along, direction: along };
                    assert_limit(renderer, &volume, &scene, &on_edge, &[u, -u, v, -v, u + v, u - v]);
                }
            }
        }
    }
}

#[test]
fn rays_on_the_boundary_of_the_domain_belong_to_it() {
    let volume = noise_hu(unit_grid([5, 5, 5]), 2);
    for (renderer, scene) in renderers().iter().flat_map(|r| scenes().map(|s| (r, s))) {
        for (origin, inwards) in [
            ([-3.0, 0.0, 1.5], DVec3::Y),
            ([-3.0, 4.0, 1.5], DVec3::NEG_Y),
            ([-3.0, 4.0, 4.0], DVec3::new(0.0, -1.0, -1.0)),
            ([-3.0, 0.0, 4.0], DVec3::new(0.0, 1.0, -1.0)),
        ] {
            let ray = ray(origin, [1.0, 0.0, 0.0]);
            assert_limit(renderer, &volume, &scene, &ray, &[inwards]);
            let outside = Ray { origin_mm: ray.origin_mm - 1e-9 * inwards, ..ray };
            assert_eq!(renderer.sees(&volume, &scene, &outside), [0.0; 4], "{}: outside, {outside:?}", renderer.name);
        }
    }
}

#[test]
fn diagonals_through_edges_and_corners_see_what_rays_beside_them_see() {
    let volume = noise_hu(unit_grid([5, 5, 5]), 3);
    for (renderer, scene) in renderers().iter().flat_map(|r| scenes().map(|s| (r, s))) {
        for (origin, direction) in [
            ([-2.0, -2.0, -2.0], [1.0, 1.0, 1.0]),
            ([6.0, -2.0, 6.0], [-1.0, 1.0, -1.0]),
            ([-2.0, -1.0, 2.0], [1.0, 1.0, 0.0]),
            ([2.0, 5.0, -1.0], [0.0, -1.0, 1.0]),
        ] {
            let ray = ray(origin, direction);
            assert_limit(renderer, &volume, &scene, &ray, &[DVec3::X, DVec3::NEG_Y, DVec3::new(-1.0, 1.0, 1.0)]);
        }
    }
}

#[test]
fn directions_that_are_nearly_along_an_axis_are_those_along_it() {
    let volume = noise_hu(unit_grid([5, 5, 5]), 4);
    for (renderer, scene) in renderers().iter().flat_map(|r| scenes().map(|s| (r, s))) {
        let along = ray([-3.0, 2.0, 1.3], [1.0, 0.0, 0.0]);
        let expected = renderer.sees(&volume, &scene, &along);
        for tiny in [1e-12, -1e-12, 1e-30, -1e-30, 1e-300, -1e-300, 5e-324, -0.0] {
            for direction in [[1.0, tiny, 0.0], [1.0, 0.0, tiny], [1.0, tiny, -tiny]] {
                let nearly = Ray { direction: DVec3::from_array(direction), ..along };
                let found = renderer.sees(&volume, &scene, &nearly);
                assert_sees(renderer, &format!("{direction:?}"), found, expected, LIMIT);
            }
        }
    }
}

#[test]
fn what_lies_behind_the_eye_is_not_seen() {
    let volume = volume_i16(unit_grid([11, 3, 3]), vec![100; 99]);
    let scene = scene(function_1d(&[(100.0, 0.25, BONE)]));
    for renderer in renderers() {
        for (start, length) in [(-5.0, 10.0), (0.0, 10.0), (2.5, 7.5), (9.75, 0.25), (10.0, 0.0), (12.0, 0.0)] {
            let found = renderer.sees(&volume, &scene, &ray([start, 1.2, 0.7], [1.0, 0.0, 0.0]));
            assert_sees(&renderer, &format!("eye at {start} mm"), found, slab(BONE, 0.25 * length), 0.0);
        }
    }
}

#[test]
fn a_camera_a_kilometre_away_sees_the_same() {
    // 50 mm of volume from 1e6 mm: an f32 would be off by 0.03 mm.
    let volume = noise_hu(grid([26, 26, 26], [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]], [-25.0; 3]), 5);
    for (renderer, scene) in renderers().iter().flat_map(|r| scenes().map(|s| (r, s))) {
        for near in rays_through(volume.grid(), 12, 6) {
            let far = Ray { origin_mm: near.origin_mm - 1e6 * near.direction, ..near };
            let (found, expected) = (renderer.sees(&volume, &scene, &far), renderer.sees(&volume, &scene, &near));
            // The far origin is itself rounded to 1e-10 mm.
            assert_sees(renderer, "1e6 mm away", found, expected, 1e-7);
        }
    }
}

#[test]
fn axes_of_one_voxel_are_constant_over_their_spacing() {
    let (thin, thick) = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 5.0]], [0.0, 0.0, -2.5]);
    let plane: Vec<i16> = vec![-120, 340, 75, 610, -45, 220, 130, 480, 10];
    let one = volume_i16(grid([3, 3, 1], thin, [0.0; 3]), plane.clone());
    let two = volume_i16(grid([3, 3, 2], thin, thick), [plane.clone(), plane].concat());
    let dot = volume_i16(grid([1, 1, 1], [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 5.0]], [0.0; 3]), vec![7]);
    for renderer in renderers() {
        for scene in scenes() {
            for ray in [ray([0.3, 1.2, -9.0], [0.1, 0.05, 1.0]), ray([-4.0, 0.5, -2.0], [1.0, 0.1, 0.4])] {
                let (found, expected) = (renderer.sees(&one, &scene, &ray), renderer.sees(&two, &scene, &ray));
                assert_sees(&renderer, "one slice", found, expected, 0.0);
            }
        }
        let fog = scene(function_1d(&[(7.0, 0.2, RED)]));
        for (axis, length) in [(0, 2.0), (1, 3.0), (2, 5.0)] {
            let ray = Ray { origin_mm: DVec3::splat(0.25) - 20.0 * DVec3::AXES[axis], direction: DVec3::AXES[axis] };
            let found = renderer.sees(&dot, &fog, &ray);
            assert_sees(&renderer, &format!("one voxel along axis {axis}"), found, slab(RED, 0.2 * length), 0.0);
        }
    }
}

/// Anisotropic, sheared as by a tilted gantry, left-handed, and rotated with all of that.
fn lattices(dims: [usize; 3]) -> [Grid; 4] {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1));
    let sheared = DMat3::from_cols_array_2d(&[[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, -1.25, 4.0]]);
    let rotated = DAffine3::from_mat3_translation(turn * sheared, DVec3::new(-80.0, 12.0, 300.0));
    [
        grid(dims, [[0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 5.0]], [-100.0, 40.0, 7.0]),
        grid(dims, [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, -1.25, 4.0]], [1.0, 2.0, 3.0]),
        grid(dims, [[0.0, 0.75, 0.0], [0.75, 0.0, 0.0], [0.0, 0.0, 1.5]], [0.0, -9.0, 0.0]),
        Grid::new(dims, rotated).expect("a valid grid"),
    ]
}

#[test]
fn length_is_in_millimetres_on_every_lattice() {
    for grid in lattices([4, 5, 6]) {
        let volume = volume_of(grid, |_| 10.0);
        let scene = scene(function_1d(&[(10.0, 0.15, BLUE)]));
        let ends = [[0.0, 0.0, 0.0], [3.0, 4.0, 5.0]].map(|i| grid.index_to_lps_mm().transform_point3(i.into()));
        let through = ends[1] - ends[0];
        // From corner to corner, moved inwards by 1e-12 so that rounding cannot push it out of the domain.
        let inwards = 1e-12 * (grid.center_mm() - ends[0]);
        let ray = Ray { origin_mm: ends[0] - through + inwards, direction: through.normalize() };
        for renderer in renderers() {
            let found = renderer.sees(&volume, &scene, &ray);
            assert_sees(&renderer, &format!("{grid:?}"), found, slab(BLUE, 0.15 * through.length()), 1e-10);
        }
    }
}

#[test]
fn the_gradient_of_a_linear_field_is_the_same_on_every_lattice() {
    for grid in lattices([5, 4, 6]) {
        let per_index = DVec3::new(64.0, -32.0, 128.0);
        let volume = volume_of(grid, |voxel| per_index.dot(DVec3::from_array(voxel.map(|x| x as f64))));
        let magnitude = (grid.gradient_to_per_mm() * per_index).length();
        // A tent with its top of 2/mm at the magnitude: any error of the gradient, up or down, thins the fog.
        let tent = [[0.0, 0.0], [magnitude, 1.0], [2.0 * magnitude, 0.0]];
        let scene = scene(function_2d(&[(0.0, 2.0, BONE)], &tent));
        let center = grid.center_mm();
        let direction = DVec3::new(0.48, 0.6, 0.64);
        let ray = Ray { origin_mm: center, direction };
        let step = grid.lps_mm_to_index().transform_vector3(direction);
        let (_, high) = grid.index_bounds();
        let length = (0..3).map(|a| 0.5 * high[a] / step[a].abs()).fold(f64::INFINITY, f64::min);
        for renderer in renderers() {
            let found = renderer.sees(&volume, &scene, &ray);
            assert_sees(&renderer, &format!("{grid:?}"), found, slab(BONE, 2.0 * length), 1e-12);
        }
    }
}

#[test]
fn turning_or_reflecting_patient_and_camera_together_changes_nothing() {
    let source = noise_hu(lattices([5, 4, 6])[1], 8);
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.3, 0.9, -0.4).normalize(), 2.0));
    for (name, moved_by) in [("turned", turn), ("reflected", DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)))] {
        let affine = DAffine3::from_mat3(moved_by) * source.grid().index_to_lps_mm();
        let moved_grid = Grid::new(source.grid().dims(), affine).expect("a valid grid");
        let moved = Volume::new(moved_grid, source.samples().clone(), Rescale::IDENTITY, source.quantity()).unwrap();
        for (renderer, scene) in renderers().iter().flat_map(|r| scenes().map(|s| (r, s))) {
            let mut moved_scene = scene.clone();
            for light in moved_scene.shading.iter_mut().flat_map(|s| &mut s.lights) {
                if let Light::Directional { towards, .. } = light {
                    *towards = moved_by * *towards;
                }
            }
            for ray in rays_through(source.grid(), 20, 9) {
                let moved_ray = Ray { origin_mm: moved_by * ray.origin_mm, direction: moved_by * ray.direction };
                let expected = renderer.sees(&source, &scene, &ray);
                let found = renderer.sees(&moved, &moved_scene, &moved_ray);
                assert_sees(renderer, name, found, expected, 1e-11);
            }
        }
    }
}

#[test]
fn the_last_of_many_faces_is_found_where_it_is() {
    // 20 000 cells, and a step in the last of them: crossings that are added up would drift away from it.
    let mut samples = vec![0; 20_001 * 4];
    for row in 0..4 {
        samples[20_001 * row + 20_000] = 1000;
    }
    let volume =
        volume_i16(grid([20_001, 2, 2], [[0.1, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]), samples);
    let scene = scene(function_1d(&[(0.0, 0.0, BONE), (250.0, 0.0, BONE), (250.0, 20.0, BONE), (1000.0, 20.0, BONE)]));
    let ray = ray([-50.0, 0.4, 0.3], [1.0, 0.0, 0.0]);
    for renderer in renderers_without_march("its step would have to be a thousand times shorter") {
        let found = renderer.sees(&volume, &scene, &ray);
        assert_sees(&renderer, "0.075 mm at 20/mm", found, slab(BONE, 1.5), 1e-10);
    }
}
