//! Slices across the line of sight, composited by *over*, are ray marching: with parallel rays, samples on view planes are
//! the pixels of textured planes.

use glam::DVec3;
use pellucid::image::over;
use pellucid::integrate::render;
use pellucid::plan::{Lattice, March, Method};
use pellucid::scene::{Camera, Projection, Scene};
use pellucid::transfer::{Optics, TransferFunction};
use pellucid::volume::{Grid, Volume};

use crate::march::scenes::MARCH;
use crate::support::scenes::{BLUE, RED, difference, function_1d, noise_hu, scene, volume_i16};

/// The value at a point, by hat functions around it; `None` outside.
fn value(volume: &Volume, point_mm: DVec3) -> Option<f64> {
    let index = volume.grid().lps_mm_to_index().transform_point3(point_mm);
    let (low, high) = volume.grid().index_bounds();
    if index.cmplt(low - 1e-9).any() || index.cmpgt(high + 1e-9).any() {
        return None;
    }
    let lowest = index.clamp(low, high - 1.0).floor();
    let at = (index - lowest).clamp(DVec3::ZERO, DVec3::ONE);
    Some(
        (0..8)
            .map(|c| {
                let bit = |axis: usize| c >> axis & 1;
                let voxel: [usize; 3] = std::array::from_fn(|axis| lowest[axis] as usize + bit(axis));
                let weight: f64 = (0..3).map(|a| if bit(a) == 1 { at[a] } else { 1.0 - at[a] }).product();
                weight * volume.value(voxel)
            })
            .sum(),
    )
}

/// A pixel of a slice: what the transfer function shows there, its opacity corrected for the slab that the slice stands for.
fn pixel(tf: &TransferFunction, value: f64, slab_mm: f64) -> [f64; 4] {
    let Optics { extinction_per_mm, emission_per_mm } = tf.evaluate(value, 0.0);
    let alpha = -(-extinction_per_mm * slab_mm).exp_m1();
    let color = if extinction_per_mm > 0.0 { emission_per_mm.map(|q| q / extinction_per_mm) } else { [0.0; 3] };
    over::associated([color[0], color[1], color[2], alpha])
}

/// Largest difference of the slices' picture to the marched one, and the largest alpha.
fn apart(volume: &Volume, scene: &Scene, step_mm: f64) -> (f64, f64) {
    let method = Method::March(March { step_mm, lattice: Lattice::ViewPlanes, ..MARCH });
    let marched = render(volume, scene, &method, &|_| ()).expect("a valid scene").image;
    let (camera, center) = (&scene.camera, volume.grid().center_mm());
    let (mut worst, mut densest) = (0.0_f64, 0.0_f64);
    for row in 0..marched.height() {
        for column in 0..marched.width() {
            let ray = camera.pixel_ray(column, row);
            let depth_of_center = (center - ray.origin_mm).dot(camera.forward());
            let slice = |n: i32| {
                // Half way between two cuts, one of which passes the centre.
                let depth_mm = depth_of_center + (f64::from(n) + 0.5) * step_mm;
                value(volume, ray.origin_mm + depth_mm * ray.direction)
            };
            let layers = (-200..200).filter_map(slice).map(|v| pixel(&scene.transfer_function, v, step_mm));
            let expected = over::front_to_back(layers);
            worst = worst.max(difference(marched.pixel(column, row).map(f64::from), expected));
            densest = densest.max(expected[3]);
        }
    }
    (worst, densest)
}

fn seen_along(volume: &Volume, mut scene: Scene, direction: DVec3) -> Scene {
    let center = volume.grid().center_mm();
    let projection = Projection::Parallel { height_mm: 9.0 };
    let up = direction.any_orthonormal_vector();
    scene.camera = Camera::look_at(center - 60.0 * direction, center, up, projection, [23, 19]).expect("a camera");
    scene
}

#[test]
fn slices_across_an_axis_are_marching() {
    // Seen along an axis, faces and slabs coincide: 12 mm are 24 slabs of half a millimetre.
    let volume = noise_hu(Grid::axis_aligned([11, 11, 7], DVec3::new(1.0, 1.0, 2.0)).unwrap(), 7);
    let points = [(-400.0, 0.0, RED), (0.0, 0.3, RED), (200.0, 0.02, BLUE), (900.0, 1.5, BLUE)];
    let scene = seen_along(&volume, scene(function_1d(&points)), DVec3::Z);
    let (worst, densest) = apart(&volume, &scene, 0.5);
    assert!(worst < 3e-6, "pixels differ by up to {worst:e}");
    assert!(densest > 0.5, "the volume shows: alpha up to {densest}");
    assert!(apart(&volume, &scene, 0.49).0 > 1e-4, "slabs that do not fit the volume are another cut of it");
}

#[test]
fn oblique_slices_are_marching_where_the_border_is_empty() {
    // Slabs are cut off by the border, where nothing is; elsewhere they are whole.
    let grid = Grid::axis_aligned([13, 12, 11], DVec3::new(0.8, 0.9, 1.1)).unwrap();
    let inner = noise_hu(grid, 3);
    let samples = (0..grid.voxel_count()).map(|voxel| {
        let at = grid.unflatten(voxel);
        let border = (0..3).any(|a| at[a] < 2 || at[a] + 2 >= grid.dims()[a]);
        if border { -1000 } else { inner.value(at) as i16 }
    });
    let volume = volume_i16(grid, samples.collect());
    let points = [(-700.0, 0.0, RED), (0.0, 0.4, RED), (100.0, 0.1, BLUE), (900.0, 2.0, BLUE)];
    let scene = seen_along(&volume, scene(function_1d(&points)), DVec3::new(0.48, -0.6, 0.64));
    for step_mm in [0.3, 0.11] {
        let (worst, densest) = apart(&volume, &scene, step_mm);
        assert!(worst < 5e-6, "step {step_mm}: pixels differ by up to {worst:e}");
        assert!(densest > 0.5, "the volume shows: alpha up to {densest}");
    }
}
