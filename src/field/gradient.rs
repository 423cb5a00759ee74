//! The gradient: central differences at the voxels, interpolated trilinearly.

use std::ops::{Add, Mul, Sub};

use glam::{DMat3, Vec4, Vec4Swizzles};

use super::{Cell, Even, Spacing, Trilinear, Voxel};
use crate::math::{Number, each};
use crate::volume::{Grid, Rescale};

impl<V: Voxel, K: Spacing> Trilinear<'_, V, K> {
    /// The gradient at a point, in stored units per index step: differences between the neighbours of the eight corners over
    /// their distance, one-sided on the border, 0 along an axis of one voxel; the vector is interpolated trilinearly.
    #[inline(always)]
    pub fn gradient_per_index(&self, cell: &Cell) -> [f32; 3] {
        let inside = (0..3).all(|a| cell.corner[a] >= 1 && cell.corner[a] + 2 < self.dims[a]);
        if inside { self.gradient_inside(cell) } else { self.gradient_at_border(cell) }
    }

    /// All 32 voxels around the cell exist. Twelve lines of four voxels along i, differences first: they are exact for
    /// 16-bit samples, so a constant volume has no gradient at all.
    #[inline(always)]
    fn gradient_inside(&self, cell: &Cell) -> [f32; 3] {
        let [_, down, back] = self.strides;
        let base = self.base(cell) - 1;
        let [u, v, w] = cell.fraction;
        let bilinear = |a: Vec4, b: Vec4, c: Vec4, d: Vec4| lerp(lerp(a, b, v), lerp(c, d, v), w);

        let (a, b) = (self.line(base), self.line(base + down));
        let (c, d) = (self.line(base + back), self.line(base + back + down));
        let along_i = bilinear(a.zwzw() - a, b.zwzw() - b, c.zwzw() - c, d.zwzw() - d);

        let (before_a, after_b) = (self.line(base - down), self.line(base + 2 * down));
        let (before_c, after_d) = (self.line(base + back - down), self.line(base + back + 2 * down));
        let along_j = bilinear(b - before_a, after_b - a, d - before_c, after_d - c);

        let (below_a, below_b) = (self.line(base - back), self.line(base - back + down));
        let (above_c, above_d) = (self.line(base + 2 * back), self.line(base + 2 * back + down));
        let [near, far] = [self.spacing.central(cell.corner[2]), self.spacing.central(cell.corner[2] + 1)];
        let (near, far) = (Vec4::splat(near), Vec4::splat(far));
        let along_k = bilinear((c - below_a) * near, (d - below_b) * near, (above_c - a) * far, (above_d - b) * far);

        let half = |low: f32, high: f32| 0.5 * (low + u * (high - low));
        [half(along_i.x, along_i.y), half(along_j.y, along_j.z), half(along_k.y, along_k.z)]
    }

    /// Four voxels along i.
    #[inline(always)]
    fn line(&self, first: usize) -> Vec4 {
        let line = &self.voxels[first..][..4];
        Vec4::new(line[0].to_f32(), line[1].to_f32(), line[2].to_f32(), line[3].to_f32())
    }

    /// In the order of operations of [`Trilinear::gradient_inside`].
    #[cold]
    fn gradient_at_border(&self, cell: &Cell) -> [f32; 3] {
        let [u, v, w] = cell.fraction;
        each(|axis| {
            // Twice the derivative, as the difference between both neighbours of an inner voxel is.
            let twice = |c: usize| {
                let corner: [usize; 3] = each(|a| (cell.corner[a] + (c >> a & 1)).min(self.dims[a] - 1));
                2.0 * self.difference(corner, axis)
            };
            let bilinear = |x: usize| lerp(lerp(twice(x), twice(x + 2), v), lerp(twice(x + 4), twice(x + 6), v), w);
            0.5 * lerp(bilinear(0), bilinear(1), u)
        })
    }

    /// The difference along `axis` between the neighbours of a voxel over their distance, stored units per index step;
    /// one-sided on the border.
    fn difference(&self, voxel: [usize; 3], axis: usize) -> f32 {
        let (mut before, mut after) = (voxel, voxel);
        before[axis] = voxel[axis].saturating_sub(1);
        after[axis] = (voxel[axis] + 1).min(self.dims[axis] - 1);
        let place = |[i, j, k]: [usize; 3]| i * self.strides[0] + j * self.strides[1] + k * self.strides[2];
        let difference = self.voxels[place(after)].minus(self.voxels[place(before)]);
        let per_step = match axis {
            2 => self.spacing.per_step(before[2], after[2]),
            _ => Even.per_step(before[axis], after[axis]),
        };
        per_step * difference
    }
}

#[inline(always)]
fn lerp<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>>(a: T, b: T, t: f32) -> T {
    a + (b - a) * t
}

/// The linear map from a gradient in stored units per index step to HU/mm.
#[derive(Debug, Clone, Copy)]
pub struct GradientUnits {
    rows: [[f32; 3]; 3],
    /// Whether the axes of the grid are those of the patient.
    is_diagonal: bool,
}

impl GradientUnits {
    /// The inverse transpose of the grid's affine, times the slope of the rescale.
    pub fn new(grid: &Grid, rescale: Rescale) -> Self {
        let matrix = (grid.gradient_to_per_mm() * rescale.slope).transpose();
        GradientUnits {
            rows: matrix.to_cols_array_2d().map(|row| row.map(|x| x as f32)),
            is_diagonal: matrix == DMat3::from_diagonal(matrix.diagonal()),
        }
    }

    /// HU/mm along the axes of the patient (LPS).
    #[inline(always)]
    pub fn per_mm<N: Number>(&self, [x, y, z]: [N; 3]) -> [N; 3] {
        if self.is_diagonal {
            let [a, b, c] = [self.rows[0][0], self.rows[1][1], self.rows[2][2]].map(f64::from);
            return [N::from_f64(a) * x, N::from_f64(b) * y, N::from_f64(c) * z];
        }
        let mut along = [N::ZERO; 3];
        for (along, row) in along.iter_mut().zip(&self.rows) {
            let (a, b, c) = (f64::from(row[0]), f64::from(row[1]), f64::from(row[2]));
            *along = N::from_f64(a) * x + N::from_f64(b) * y + N::from_f64(c) * z;
        }
        along
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Position;
    use glam::{DAffine3, DMat3, DVec3};

    /// The definition in f64: differences at lattice points, weighted by hat functions.
    fn gradient_by_definition(voxels: &[i16], dims: [usize; 3], at: DVec3) -> DVec3 {
        let value = |p: [usize; 3]| f64::from(voxels[p[0] + dims[0] * (p[1] + dims[1] * p[2])]);
        let mut sum = DVec3::ZERO;
        for index in 0..voxels.len() {
            let p = [index % dims[0], index / dims[0] % dims[1], index / (dims[0] * dims[1])];
            let hat = |a: usize| if dims[a] == 1 { 1.0 } else { (1.0 - (at[a] - p[a] as f64).abs()).max(0.0) };
            for axis in 0..3 {
                let (mut low, mut high) = (p, p);
                low[axis] = p[axis].max(1) - 1;
                high[axis] = (p[axis] + 1).min(dims[axis] - 1);
                if high[axis] > low[axis] {
                    let slope = (value(high) - value(low)) / (high[axis] - low[axis]) as f64;
                    sum[axis] += hat(0) * hat(1) * hat(2) * slope;
                }
            }
        }
        sum
    }

    #[test]
    fn it_equals_the_definition_inside_and_on_the_border() {
        for dims in [[7, 6, 5], [4, 4, 4], [3, 7, 6], [2, 2, 2], [1, 5, 6], [6, 1, 5], [6, 5, 1], [1, 1, 1]] {
            let count: usize = dims.iter().product();
            let voxels: Vec<i16> = (0..count).map(|i| ((i * 7919) % 4096) as i16 - 1024).collect();
            let field = Trilinear::new(&voxels, dims).unwrap();
            for i in 0..300 {
                let u = |k: f64| (f64::from(i) * k).fract();
                let at = DVec3::from_array(dims.map(|n| (n - 1) as f64)) * DVec3::new(u(0.618), u(0.414), u(0.732));
                let found = field.gradient_per_index(&Position::new(at, dims).even_cell());
                let expected = gradient_by_definition(&voxels, dims, at);
                let apart = (DVec3::from_array(found.map(f64::from)) - expected).length();
                assert!(apart < 4e-3, "{dims:?} at {at}: found {found:?}, expected {expected}");
            }
        }
    }

    #[test]
    fn units_are_covariant_and_scaled() {
        let m = DMat3::from_cols(DVec3::new(0.3, 0.1, 0.0), DVec3::new(-0.2, 0.5, 0.3), DVec3::new(0.0, 0.7, -5.0));
        let grid = Grid::new([4, 4, 4], DAffine3::from_mat3(m)).unwrap();
        let units = GradientUnits::new(&grid, Rescale { slope: -2.0, intercept: 9.0 });
        let a = DVec3::new(3.0, -2.0, 0.5);
        // What a linear field of slope a (HU/mm) stores per index step.
        let per_index = (m.transpose() * a / -2.0).to_array().map(|x| x as f32);
        let found = units.per_mm(per_index);
        let apart = (DVec3::from_array(found.map(f64::from)) - a).length();
        assert!(apart < 1e-6, "found {found:?}, expected {a}");
    }
}
