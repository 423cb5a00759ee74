//! Lattice values at the corners of a cell.

use glam::DMat3;

use crate::field::Voxel;
use crate::math::bernstein::{Cubic, trilinear_along};
use crate::math::{Real, each};
use crate::volume::{Rescale, Slices, Volume};

use super::cells::Segment;

/// Stored samples by voxel index, with what a gradient in HU/mm needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice<'a, V> {
    samples: &'a [V],
    dims: [usize; 3],
    /// Step in `samples` from a voxel to its upper neighbour in a cell; 0 along an axis of one voxel.
    steps: [usize; 3],
    /// Places of slices at uneven distances.
    slices: Option<&'a [f64]>,
    to_value_per_mm: DMat3,
}

impl<'a, V: Voxel> Lattice<'a, V> {
    pub(super) fn new(volume: &'a Volume, samples: &'a [V]) -> Self {
        let Rescale { slope, .. } = volume.rescale();
        let dims = volume.grid().dims();
        let [nx, ny, _] = dims;
        let strides = [1, nx, nx * ny];
        let steps = each(|a| if dims[a] == 1 { 0 } else { strides[a] });
        let slices = volume.slices().map(Slices::positions);
        Lattice { samples, dims, steps, slices, to_value_per_mm: volume.grid().gradient_to_per_mm() * slope }
    }

    /// Stored samples at the corners of a cell, x fastest.
    #[inline(always)]
    pub(super) fn corners<R: Real>(&self, [i, j, k]: [usize; 3]) -> [R; 8] {
        let [nx, ny, _] = self.dims;
        let base = i + nx * (j + ny * k);
        let [sx, sy, sz] = self.steps;
        each(|c| real(self.samples[base + (c & 1) * sx + (c >> 1 & 1) * sy + (c >> 2) * sz]))
    }

    /// Difference between the neighbours of a voxel along an axis of even steps over their distance in these: one-sided at
    /// the border, 0 along an axis of one voxel.
    #[inline(always)]
    fn difference<R: Real>(&self, voxel: [usize; 3], axis: usize) -> R {
        let n = self.dims[axis];
        if n == 1 {
            return R::ZERO;
        }
        let i = voxel[axis];
        let difference = self.between_neighbours(voxel, axis);
        if i > 0 && i + 1 < n { R::from_f64(0.5) * difference } else { difference }
    }

    /// The same across slices at these places.
    #[inline(always)]
    fn difference_across<R: Real>(&self, places: &[f64], voxel: [usize; 3]) -> R {
        let (n, k) = (self.dims[2], voxel[2]);
        if n == 1 {
            return R::ZERO;
        }
        let distance = places[(k + 1).min(n - 1)] - places[k.saturating_sub(1)];
        R::from_f64(1.0 / distance) * self.between_neighbours(voxel, 2)
    }

    /// The stored sample after a voxel less the one before it, along an axis; on the border the voxel's own stands for what
    /// is beyond.
    #[inline(always)]
    fn between_neighbours<R: Real>(&self, voxel: [usize; 3], axis: usize) -> R {
        let [nx, ny, _] = self.dims;
        let at = voxel[0] + nx * (voxel[1] + ny * voxel[2]);
        let step = self.steps[axis];
        let i = voxel[axis];
        let (low, high) = (if i > 0 { at - step } else { at }, if i + 1 < self.dims[axis] { at + step } else { at });
        real::<R, V>(self.samples[high]) - real(self.samples[low])
    }

    /// Gradients in HU/mm at the corners of a cell: three components of eight corners.
    #[inline]
    pub(super) fn gradients<R: Real>(&self, cell: [usize; 3]) -> [[R; 8]; 3] {
        // Asked once a cell, so that even slices do not pay for the others at each corner.
        match self.slices {
            None => self.gradients_by(cell, |voxel| self.difference(voxel, 2)),
            Some(places) => self.gradients_by(cell, |voxel| self.difference_across(places, voxel)),
        }
    }

    /// The same, given the difference across slices.
    #[inline(always)]
    fn gradients_by<R: Real>(&self, cell: [usize; 3], along_k: impl Fn([usize; 3]) -> R) -> [[R; 8]; 3] {
        let m = self.to_value_per_mm.to_cols_array_2d();
        let mut result = [[R::ZERO; 8]; 3];
        for c in 0..8 {
            let offset = [c & 1, c >> 1 & 1, c >> 2];
            let voxel: [usize; 3] = each(|a| (cell[a] + offset[a]).min(self.dims[a] - 1));
            let per_index = [self.difference(voxel, 0), self.difference(voxel, 1), along_k(voxel)];
            for (row, component) in result.iter_mut().enumerate() {
                component[c] = (0..3).fold(R::ZERO, |s, col| R::from_f64(m[col][row]).mul_plus(per_index[col], s));
            }
        }
        result
    }
}

/// Gradient magnitudes at the corners of a cell from the gradients there.
#[inline]
pub(super) fn magnitudes<R: Real>(gradients: &[[R; 8]; 3]) -> [R; 8] {
    let [x, y, z] = gradients;
    each(|c| (x[c] * x[c] + y[c] * y[c] + z[c] * z[c]).sqrt())
}

/// The trilinear interpolant of corner values along a segment.
#[inline(always)]
pub(super) fn along<R: Real>(corners: &[R; 8], segment: &Segment) -> Cubic<R> {
    trilinear_along(corners, segment.from.map(R::from_f64), segment.to.map(R::from_f64))
}

#[inline(always)]
fn real<R: Real, V: Voxel>(stored: V) -> R {
    R::from_f32(stored.to_f32())
}
