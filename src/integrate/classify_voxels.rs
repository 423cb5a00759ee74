//! The transfer function and the shading, evaluated at the voxels once per picture.

use glam::DVec3;
use rayon::prelude::*;

use crate::scene::Scene;
use crate::transfer::Optics;
use crate::volume::Volume;

/// Shaded emission in red, green and blue, and extinction, 1/mm, at every voxel, x fastest: the definition in f64, rounded
/// to f32. 16 bytes per voxel, computed in parallel.
pub(super) fn classify_voxels(volume: &Volume, scene: &Scene) -> Vec<[f32; 4]> {
    let grid = volume.grid();
    (0..grid.voxel_count()).into_par_iter().map(|voxel| optics(volume, scene, grid.unflatten(voxel))).collect()
}

fn optics(volume: &Volume, scene: &Scene, voxel: [usize; 3]) -> [f32; 4] {
    let tf = &scene.transfer_function;
    let value = volume.value(voxel);
    let optics = if tf.reads_gradient() {
        tf.evaluate(value, gradient_per_mm(volume, voxel).length())
    } else {
        tf.evaluate(value, 0.0)
    };
    if optics == Optics::NOTHING {
        return [0.0; 4];
    }
    let Optics { extinction_per_mm: extinction, emission_per_mm: emission } = optics;
    let [r, g, b] = match &scene.shading {
        None => emission,
        Some(shading) => {
            let point_mm = volume.grid().index_to_lps_mm().transform_point3(voxel.map(|i| i as f64).into());
            let direction = scene.camera.direction_to(point_mm);
            let (reflected, highlight) = shading.factors(gradient_per_mm(volume, voxel), direction);
            std::array::from_fn(|c| emission[c] * reflected[c] + extinction * highlight[c])
        }
    };
    [r, g, b, extinction].map(|x| x as f32)
}

/// Central differences, one-sided at the border and 0 along an axis of one voxel, mapped to LPS; HU/mm.
fn gradient_per_mm(volume: &Volume, voxel: [usize; 3]) -> DVec3 {
    let grid = volume.grid();
    let per_index = std::array::from_fn(|axis| {
        let neighbour = |i: usize| {
            let mut at = voxel;
            at[axis] = i;
            volume.value(at)
        };
        let (before, after) = (voxel[axis].saturating_sub(1), (voxel[axis] + 1).min(grid.dims()[axis] - 1));
        if after == before { 0.0 } else { (neighbour(after) - neighbour(before)) / (after - before) as f64 }
    });
    grid.gradient_to_per_mm() * DVec3::from_array(per_index)
}
