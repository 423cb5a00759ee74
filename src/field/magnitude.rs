//! The gradient magnitude at the voxels, as a channel of its own.

use rayon::prelude::*;

use super::{GradientUnits, Trilinear, Voxel};
use crate::error::Result;
use crate::volume::{Samples, Volume};

/// The gradient magnitude at every voxel, HU/mm, x fastest: 4 bytes per voxel, computed in parallel. Only 2D transfer
/// functions read it.
pub fn gradient_magnitude_per_mm<V: Voxel>(field: &Trilinear<'_, V>, units: &GradientUnits) -> Vec<f32> {
    let [nx, ny, _] = field.dims;
    let mut magnitude = vec![0.0; field.voxels.len()];
    magnitude.par_chunks_mut(nx * ny).enumerate().for_each(|(k, slice)| {
        for (j, row) in slice.chunks_mut(nx).enumerate() {
            fill_row(field, units, j, k, row);
        }
    });
    magnitude
}

/// The gradient magnitude at every voxel of a volume, HU/mm, x fastest.
///
/// # Errors
/// As [`Trilinear::new`].
pub fn gradient_magnitudes(volume: &Volume) -> Result<Vec<f32>> {
    let (grid, units) = (volume.grid(), GradientUnits::new(volume.grid(), volume.rescale()));
    Ok(match volume.samples() {
        Samples::I16(voxels) => gradient_magnitude_per_mm(&Trilinear::new(voxels, grid.dims())?, &units),
        Samples::F32(voxels) => gradient_magnitude_per_mm(&Trilinear::new(voxels, grid.dims())?, &units),
    })
}

/// Smallest and largest of [`gradient_magnitudes`].
///
/// # Errors
/// As [`Trilinear::new`].
pub fn gradient_range_per_mm(volume: &Volume) -> Result<[f64; 2]> {
    let magnitudes = gradient_magnitudes(volume)?;
    let ends = magnitudes.iter().fold([f32::INFINITY, 0.0], |[low, high], &m| [low.min(m), high.max(m)]);
    Ok(ends.map(f64::from))
}

fn fill_row<V: Voxel>(field: &Trilinear<'_, V>, units: &GradientUnits, j: usize, k: usize, row: &mut [f32]) {
    let [nx, ny, nz] = field.dims;
    let line = |j: usize, k: usize| &field.voxels[nx * (j + ny * k)..][..nx];
    let (j0, j1, per_j) = neighbours(j, ny);
    let (k0, k1, per_k) = neighbours(k, nz);
    let (here, front, back, below, above) = (line(j, k), line(j0, k), line(j1, k), line(j, k0), line(j, k1));
    let length = |x: f32, i: usize| {
        let [gx, gy, gz] = units.per_mm([x, back[i].minus(front[i]) * per_j, above[i].minus(below[i]) * per_k]);
        (gx * gx + gy * gy + gz * gz).sqrt()
    };
    for end in [0, nx - 1] {
        let (i0, i1, per_i) = neighbours(end, nx);
        row[end] = length(here[i1].minus(here[i0]) * per_i, end);
    }
    for i in 1..nx.max(2) - 1 {
        row[i] = length(0.5 * here[i + 1].minus(here[i - 1]), i);
    }
}

/// The neighbours of a voxel along an axis of `n`, and one over their distance (1 where both are the voxel itself: the
/// difference is 0 then).
fn neighbours(i: usize, n: usize) -> (usize, usize, f32) {
    let (before, after) = (i.saturating_sub(1), (i + 1).min(n - 1));
    (before, after, if after - before == 2 { 0.5 } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Cell, Position};
    use crate::volume::{Grid, Rescale};
    use glam::DVec3;

    #[test]
    fn at_the_voxels_it_is_the_length_of_the_gradient() {
        for dims in [[7, 6, 5], [2, 3, 2], [1, 4, 4], [4, 1, 1]] {
            let count: usize = dims.iter().product();
            let voxels: Vec<i16> = (0..count).map(|i| ((i * 7919) % 4096) as i16 - 1024).collect();
            let field = Trilinear::new(&voxels, dims).unwrap();
            let grid = Grid::axis_aligned(dims, DVec3::new(0.5, 0.7, 3.0)).unwrap();
            let units = GradientUnits::new(&grid, Rescale { slope: 2.0, intercept: -1000.0 });
            let magnitude = gradient_magnitude_per_mm(&field, &units);
            for (index, found) in magnitude.iter().enumerate() {
                let at = grid.unflatten(index);
                let cell: Cell = Position::new(DVec3::from_array(at.map(|i| i as f64)), dims).cell();
                let [x, y, z] = units.per_mm(field.gradient_per_index(&cell));
                let expected = (x * x + y * y + z * z).sqrt();
                assert!((found - expected).abs() < 0.01, "{dims:?} at {at:?}: found {found}, expected {expected}");
            }
        }
    }
}
