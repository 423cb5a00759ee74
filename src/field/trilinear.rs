//! Trilinear interpolation on the lattice.

use super::{Cell, Even, Position, Spacing, Voxel};
use crate::error::Result;
use crate::simd::Stencil;

/// A scalar channel on the lattice, interpolated trilinearly. `K` is how its slices follow each other.
#[derive(Debug, Clone, Copy)]
pub struct Trilinear<'v, V, K = Even> {
    pub(super) voxels: &'v [V],
    pub(super) dims: [usize; 3],
    /// Distance in memory to the next voxel along each axis; 0 along an axis of one voxel, which is its own neighbour.
    pub(super) strides: [usize; 3],
    pub(super) spacing: K,
    /// Where lanes read.
    pub(super) stencil: Stencil,
}

impl<'v, V: Voxel> Trilinear<'v, V> {
    /// A channel of these samples, x fastest, then y, then z.
    ///
    /// # Errors
    /// `Fault::Limit` for an axis longer than positions can address. Panics if the number of samples is not that of the
    /// lattice.
    pub fn new(voxels: &'v [V], dims: [usize; 3]) -> Result<Self> {
        assert_eq!(voxels.len(), dims.iter().product::<usize>(), "samples of a lattice of {dims:?}");
        Position::check(dims)?;
        let step = |axis: usize, stride: usize| if dims[axis] == 1 { 0 } else { stride };
        Ok(Trilinear {
            voxels,
            dims,
            strides: [step(0, 1), step(1, dims[0]), step(2, dims[0] * dims[1])],
            spacing: Even,
            stencil: Stencil::new(step(1, dims[0]), step(2, dims[0] * dims[1])),
        })
    }
}

impl<'v, V: Voxel, K: Spacing> Trilinear<'v, V, K> {
    /// The same channel with slices at other places. Panics later if the table is not of this lattice.
    pub fn with_spacing<L: Spacing>(self, spacing: L) -> Trilinear<'v, V, L> {
        let Trilinear { voxels, dims, strides, stencil, .. } = self;
        Trilinear { voxels, dims, strides, spacing, stencil }
    }

    /// The cell of a position, and where in it.
    #[inline(always)]
    pub fn cell(&self, position: Position) -> Cell {
        self.spacing.cell(position)
    }

    /// Number of voxels along i, j and k.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// The stored sample of a voxel, as f32.
    #[inline(always)]
    pub fn voxel(&self, [i, j, k]: [usize; 3]) -> f32 {
        let [sx, sy, sz] = self.strides;
        self.voxels[i * sx + j * sy + k * sz].to_f32()
    }

    /// Distances in memory from a cell's lower corner to its eight corners; corner `c` is the upper one along axis `a`
    /// if bit `a` of `c` is set.
    #[inline(always)]
    pub(super) fn corner_offsets(&self) -> [usize; 8] {
        let [sx, sy, sz] = self.strides;
        [0, sx, sy, sx + sy, sz, sx + sz, sy + sz, sx + sy + sz]
    }

    /// Place in memory of a cell's lower corner.
    #[inline(always)]
    pub(super) fn base(&self, cell: &Cell) -> usize {
        let ([i, j, k], [sx, sy, sz]) = (cell.corner, self.strides);
        i * sx + j * sy + k * sz
    }

    /// The stored samples at a cell's corners, in the order of [`interpolate`].
    #[inline(always)]
    pub fn corners(&self, cell: &Cell) -> [f32; 8] {
        let base = self.base(cell);
        let mut corners = [0.0; 8];
        for (corner, offset) in corners.iter_mut().zip(self.corner_offsets()) {
            *corner = self.voxels[base + offset].to_f32();
        }
        corners
    }

    /// The interpolated stored sample.
    #[inline(always)]
    pub fn value(&self, cell: &Cell) -> f32 {
        interpolate(self.corners(cell), cell.fraction)
    }
}

/// Trilinear interpolation between the corners of a cell; corner `c` is the upper one along axis `a` if bit `a` of `c` is
/// set. Each step is `low + u · (high − low)`, which stays within one rounding of the corners' range.
#[inline(always)]
pub fn interpolate(corners: [f32; 8], [u, v, w]: [f32; 3]) -> f32 {
    let lerp = |a: f32, b: f32, t: f32| a + t * (b - a);
    let [c0, c1, c2, c3, c4, c5, c6, c7] = corners;
    let lower = lerp(lerp(c0, c1, u), lerp(c2, c3, u), v);
    let upper = lerp(lerp(c4, c5, u), lerp(c6, c7, u), v);
    lerp(lower, upper, w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// The definition, in f64 and without any of the code above.
    fn value_by_definition(voxels: &[f64], dims: [usize; 3], at: DVec3) -> f64 {
        let mut sum = 0.0;
        for (index, v) in voxels.iter().enumerate() {
            let ijk = [index % dims[0], index / dims[0] % dims[1], index / (dims[0] * dims[1])];
            let hat = |a: usize| if dims[a] == 1 { 1.0 } else { (1.0 - (at[a] - ijk[a] as f64).abs()).max(0.0) };
            sum += v * hat(0) * hat(1) * hat(2);
        }
        sum
    }

    #[test]
    fn it_equals_the_definition_on_any_lattice() {
        for dims in [[5, 4, 3], [1, 4, 3], [5, 1, 3], [5, 4, 1], [1, 1, 3], [1, 1, 1], [2, 2, 2]] {
            let count: usize = dims.iter().product();
            let voxels: Vec<i16> = (0..count).map(|i| ((i * 7919) % 4096) as i16 - 1024).collect();
            let exact: Vec<f64> = voxels.iter().map(|&v| f64::from(v)).collect();
            let field = Trilinear::new(&voxels, dims).unwrap();
            for i in 0..500 {
                let u = |k: f64| (f64::from(i) * k).fract();
                let end = DVec3::from_array(dims.map(|n| (n - 1) as f64));
                // Every fifth point on the border.
                let at = if i % 5 == 0 {
                    end * DVec3::new(1.0, u(0.3).round(), u(0.7))
                } else {
                    end * DVec3::new(u(0.618), u(0.414), u(0.732))
                };
                let found = f64::from(field.value(&field.cell(Position::new(at, dims))));
                let expected = value_by_definition(&exact, dims, at);
                assert!((found - expected).abs() < 2e-3, "{dims:?} at {at}: found {found}, expected {expected}");
            }
        }
    }
}
