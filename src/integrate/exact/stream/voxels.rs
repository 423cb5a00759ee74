//! Samples at the corners of cells, in lanes.

use glam::DMat3;

use crate::field::{BlockRanges, Trilinear, Voxel};
use crate::integrate::occupancy::Occupancy;
use crate::math::{Number, each};
use crate::simd::{Around, Away, BATCH, Ints, Lanes, Mask, Pairs, Stencil};
use crate::volume::{Rescale, Volume};

/// Stored samples by voxel index, with what a gradient in HU/mm needs. Every axis has at least two voxels.
#[derive(Debug, Clone, Copy)]
pub(in crate::integrate::exact) struct Voxels<'a, V> {
    samples: &'a [V],
    dims: [usize; 3],
    to_value_per_mm: DMat3,
    /// Whether the axes are the patient's.
    is_diagonal: bool,
    stencil: Stencil,
}

/// The lower corners of cells, voxel indices.
#[derive(Debug, Clone, Copy)]
pub(in crate::integrate::exact) struct Corners<I> {
    pub(super) cell: [I; 3],
    /// Of the voxel, in memory.
    pub(super) base: I,
}

impl<'a, V: Voxel + Pairs> Voxels<'a, V> {
    /// `None` for a lattice that is flat along an axis, uneven, or longer than lanes can index.
    pub(in crate::integrate::exact) fn new(volume: &'a Volume, samples: &'a [V]) -> Option<Self> {
        let dims = volume.grid().dims();
        let fits = dims.iter().all(|&n| n >= 2) && samples.len() <= i32::MAX as usize && volume.slices().is_none();
        let Rescale { slope, .. } = volume.rescale();
        let to_value_per_mm = volume.grid().gradient_to_per_mm() * slope;
        let is_diagonal = to_value_per_mm == DMat3::from_diagonal(to_value_per_mm.diagonal());
        let stencil = Stencil::new(dims[0], dims[0] * dims[1]);
        fits.then_some(Voxels { samples, dims, to_value_per_mm, is_diagonal, stencil })
    }

    /// Where something may show, given the ranges of stored values at which it does.
    pub(in crate::integrate::exact) fn occupancy(&self, may_show: impl Fn([f32; 2]) -> bool + Sync) -> Occupancy {
        match Trilinear::new(self.samples, self.dims) {
            Ok(field) => Occupancy::new(&BlockRanges::new(&field), may_show),
            // Longer than macrocells address.
            Err(_) => Occupancy::full(self.dims),
        }
    }

    pub(super) fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Stored samples at the corners of cells, x fastest.
    #[inline(always)]
    pub(super) fn corners<L: Lanes>(&self, base: L::Ints) -> [L; 8] {
        let [[a, b], [c, d], [e, f], [g, h]] = V::pairs::<L, 4>(self.samples, base, &self.stencil.edges);
        let corners = [a, b, c, d, e, f, g, h];
        each(
            #[inline(always)]
            |c| V::to_lanes(corners[c]),
        )
    }

    /// From a voxel to the next along each axis, in memory.
    fn strides(&self) -> [i32; 3] {
        let [nx, ny, _] = self.dims;
        [1, nx as i32, (nx * ny) as i32]
    }

    /// The samples at places in memory, and their neighbours along x.
    #[inline(always)]
    fn pair<L: Lanes>(&self, at: L::Ints) -> [L; 2] {
        let [[first, second]] = V::pairs::<L, 1>(self.samples, at, &Away::HERE);
        [V::to_lanes(first), V::to_lanes(second)]
    }

    /// Gradients in HU/mm at the corners of cells, of which these are the samples: central differences, one-sided at the
    /// border.
    #[inline(always)]
    pub(super) fn gradients<L: Lanes>(&self, at: &Corners<L::Ints>, corners: &[L; 8]) -> [[L; 8]; 3] {
        let [nx, ny, _] = self.dims;
        let strides = [1, nx, nx * ny];
        let (half, one) = (L::from_f64(0.5), L::ONE);
        let mut per_index = [[L::ZERO; 8]; 3];
        for axis in 0..3 {
            // At the border, the voxel itself stands in for the neighbour that is not there.
            let first = at.cell[axis].eq(splat::<L>(0));
            let last = at.cell[axis].eq(splat::<L>(self.dims[axis] - 2));
            let below = L::Ints::select(first, splat::<L>(0), L::Ints::splat(-(strides[axis] as i32)));
            let above = L::Ints::select(last, splat::<L>(strides[axis]), splat::<L>(2 * strides[axis]));
            let (low_scale, high_scale) = (L::select(first, one, half), L::select(last, one, half));
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let component = &mut per_index[axis];
            // Edges of the cell along the axis by their lower corners, and the corners' places.
            let (p, q) = (u.min(v), u.max(v));
            for (low, offset) in [(0, 0), (1 << q, strides[q])] {
                let (before, after): ([L; 2], [L; 2]) = if axis == 0 {
                    // A pair along x has one voxel beyond the cell, for each of two rows.
                    let (base, next) = (at.base + splat::<L>(offset), at.base + splat::<L>(offset + strides[p]));
                    let one_less = above - splat::<L>(1);
                    let ([b0, _], [b1, _]) = (self.pair::<L>(base + below), self.pair::<L>(next + below));
                    let ([_, a0], [_, a1]) = (self.pair::<L>(base + one_less), self.pair::<L>(next + one_less));
                    ([b0, b1], [a0, a1])
                } else {
                    // A pair along x beyond the cell serves two edges.
                    let base = at.base + splat::<L>(offset);
                    (self.pair::<L>(base + below), self.pair::<L>(base + above))
                };
                for n in 0..2 {
                    let low = low | n << p;
                    let high = low | 1 << axis;
                    component[low] = (corners[high] - before[n]) * low_scale;
                    component[high] = (after[n] - corners[low]) * high_scale;
                }
            }
        }
        self.per_mm(&per_index)
    }

    /// The same of cells none of which is at the border, samples at their corners included.
    #[inline(always)]
    pub(super) fn inner_gradients<L: Lanes>(&self, base: L::Ints) -> [[L; 8]; 3] {
        let half = L::from_f64(0.5);
        let Around { lines, rows, slabs } = V::around::<L>(self.samples, base, &self.stencil);
        // Corner by corner, in place of loops over arrays that would be cleared first.
        let [[a, c0, c1, b], [d, c2, c3, e], [f, c4, c5, g], [h, c6, c7, i]] = lines;
        let x = [c1 - a, b - c0, c3 - d, e - c2, c5 - f, g - c4, c7 - h, i - c6];
        let [[a, b], [e, f], [c, d], [g, h]] = rows;
        let y = [c2 - a, c3 - b, c - c0, d - c1, c6 - e, c7 - f, g - c4, h - c5];
        let [[a, b], [e, f], [c, d], [g, h]] = slabs;
        let z = [c4 - a, c5 - b, c6 - e, c7 - f, c - c0, d - c1, g - c2, h - c3];
        let differences = [x, y, z];
        let per_index = each(
            #[inline(always)]
            |axis| {
                each(
                    #[inline(always)]
                    |c| V::to_lanes::<L>(differences[axis][c]) * half,
                )
            },
        );
        self.per_mm(&per_index)
    }

    /// Gradients in HU/mm from those in stored units per index.
    #[inline(always)]
    fn per_mm<L: Lanes>(&self, per_index: &[[L; 8]; 3]) -> [[L; 8]; 3] {
        let m = self.to_value_per_mm.to_cols_array_2d();
        // As in most scans.
        if self.is_diagonal {
            return each(
                #[inline(always)]
                |a| {
                    each(
                        #[inline(always)]
                        |c| L::from_f64(m[a][a]) * per_index[a][c],
                    )
                },
            );
        }
        each(
            #[inline(always)]
            |row| {
                each(
                    #[inline(always)]
                    |c| {
                        let [x, y, z] = per_index;
                        let z = L::from_f64(m[2][row]) * z[c];
                        x[c].mul_plus(L::from_f64(m[0][row]), y[c].mul_plus(L::from_f64(m[1][row]), z))
                    },
                )
            },
        )
    }

    /// The lower corner of a cell by its place in memory, voxel indices.
    pub(super) fn cell(&self, base: i32) -> [i32; 3] {
        let [_, row, slab] = self.strides();
        [base % row, base % slab / row, base / slab]
    }

    /// The same of many.
    #[inline(always)]
    pub(super) fn corners_at<L: Lanes>(&self, base: L::Ints) -> Corners<L::Ints> {
        let (mut bases, mut cells) = ([0; BATCH], [[0; BATCH]; 3]);
        base.store(&mut bases);
        for (k, &base) in bases[..L::LANES].iter().enumerate() {
            [cells[0][k], cells[1][k], cells[2][k]] = self.cell(base);
        }
        let cell = each(
            #[inline(always)]
            |a| L::Ints::load(&cells[a]),
        );
        Corners { cell, base }
    }

    /// Whether all these cells have neighbours on all sides.
    #[inline(always)]
    pub(super) fn are_inner<L: Lanes>(&self, cell: &[L::Ints; 3], are_cells: L::Mask) -> bool {
        let mut outer = are_cells.and_not(are_cells);
        for (cell, n) in cell.iter().zip(self.dims) {
            let last = cell.lt(splat::<L>(1)).or(L::Ints::splat(n as i32 - 3).lt(*cell));
            outer = outer.or(last);
        }
        !are_cells.and(outer).any()
    }
}

#[inline(always)]
fn splat<L: Lanes>(x: usize) -> L::Ints {
    L::Ints::splat(x as i32)
}

/// Gradient magnitudes at the corners of cells from the gradients there.
#[inline(always)]
pub(super) fn magnitudes<N: Number>([x, y, z]: &[[N; 8]; 3]) -> [N; 8] {
    each(
        #[inline(always)]
        |c| x[c].mul_plus(x[c], y[c].mul_plus(y[c], z[c] * z[c])).sqrt(),
    )
}
