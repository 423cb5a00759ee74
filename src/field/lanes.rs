//! Value and gradient of many samples of a ray at a time, operation by operation what [`Trilinear::value`] and
//! [`Trilinear::gradient_per_index`] are of one.

use super::{Batch, Trilinear, Voxel};
use crate::math::{Number, each};
use crate::simd::{Ints, Lanes, Pairs};

/// The cells of some samples of a batch, on even slices.
#[derive(Clone, Copy)]
pub(crate) struct Cells<L: Lanes> {
    /// Place in memory of the lower corner.
    base: L::Ints,
    /// Lower corner, counted from voxel 0 of each axis.
    corner: [L::Ints; 3],
    /// Where in the cell.
    fraction: [L; 3],
}

/// The samples `[i − 1, i, i + 1, i + 2]` of the four lines along i that hold a cell's corners `i` and `i + 1`, in the order
/// `(j, k), (j + 1, k), (j, k + 1), (j + 1, k + 1)`. On the border what would be outside is what is there.
type Lines<L> = [[L; 4]; 4];

/// The memory of which samples are read fits indices of 32 bits, and each line has a pair.
const MOST_SAMPLES: usize = i32::MAX as usize;

impl<V: Voxel + Pairs> Trilinear<'_, V> {
    /// Whether samples can be read by lanes.
    pub(crate) fn suits_lanes(&self) -> bool {
        self.dims[0] >= 2 && (4..MOST_SAMPLES).contains(&self.voxels.len())
    }

    /// Whether a cell of a batch is at the border, where gradients are one-sided.
    #[inline(always)]
    pub(crate) fn meets_border(&self, batch: &Batch<'_>) -> bool {
        let inside = |corner: [i64; 3]| (0..3).all(|a| corner[a] >= 1 && corner[a] + 2 < self.dims[a] as i64);
        !batch.ends().into_iter().all(inside)
    }

    /// The cells of the samples from number `at` on.
    #[inline(always)]
    pub(crate) fn cells<L: Lanes>(&self, batch: &Batch<'_>, at: usize) -> Cells<L> {
        let (corner, fraction) = batch.first.corner_and_fraction();
        let moved: [L::Ints; 3] = each(|a| L::Ints::load(&batch.offsets[a][at..]) + L::Ints::splat(fraction[a]));
        let steps: [L::Ints; 3] = each(|a| moved[a].shifted_right(24));
        let [_, down, back] = self.strides;
        let first = corner[0] + corner[1] * down as i64 + corner[2] * back as i64;
        let inner = steps[0] + steps[1] * L::Ints::splat(down as i32) + steps[2] * L::Ints::splat(back as i32);
        let mask = L::Ints::splat((1 << 24) - 1);
        let unit = L::from_f64(1.0 / f64::from(1 << 24));
        Cells {
            base: L::Ints::splat(first as i32) + inner,
            corner: each(|a| L::Ints::splat(corner[a] as i32) + steps[a]),
            fraction: each(|a| L::from_ints(moved[a].and(mask)) * unit),
        }
    }

    /// The interpolated stored samples.
    #[inline(always)]
    pub(crate) fn values<L: Lanes>(&self, cells: &Cells<L>) -> L {
        let [_, down, back] = self.strides.map(|stride| L::Ints::splat(stride as i32));
        let pairs = [cells.base, cells.base + down, cells.base + back, cells.base + down + back]
            .map(|at| V::pairs::<L>(self.voxels, at));
        trilinear(pairs, cells.fraction)
    }

    /// The lines through the cells, none of which is at the border.
    #[inline(always)]
    pub(crate) fn lines<L: Lanes>(&self, cells: &Cells<L>) -> Lines<L> {
        let [_, down, back] = self.strides.map(|stride| L::Ints::splat(stride as i32));
        let first = cells.base - L::Ints::splat(1);
        [first, first + down, first + back, first + down + back].map(|at| V::quads::<L>(self.voxels, at))
    }

    /// The lines through cells that may be at the border.
    #[inline(always)]
    fn lines_at_border<L: Lanes>(&self, cells: &Cells<L>) -> Lines<L> {
        let [_, down, back] = self.strides.map(|stride| L::Ints::splat(stride as i32));
        let last = L::Ints::splat(self.dims[0] as i32 - 2);
        let before = cells.corner[0].max(L::Ints::splat(1)) - L::Ints::splat(1) - cells.corner[0];
        let after = (cells.corner[0] + L::Ints::splat(1)).min(last) - cells.corner[0];
        [cells.base, cells.base + down, cells.base + back, cells.base + down + back].map(|at| {
            let [first, _] = V::pairs::<L>(self.voxels, at + before);
            let [second, third] = V::pairs::<L>(self.voxels, at);
            let [_, fourth] = V::pairs::<L>(self.voxels, at + after);
            [first, second, third, fourth]
        })
    }

    /// The gradients, given the lines through the cells, none of which is at the border.
    #[inline(always)]
    pub(crate) fn gradients<L: Lanes>(&self, cells: &Cells<L>, lines: &Lines<L>) -> [L; 3] {
        let [_, down, back] = self.strides.map(|stride| L::Ints::splat(stride as i32));
        let double = |stride: L::Ints| stride + stride;
        let none = L::Ints::splat(0);
        self.gradients_by(cells, lines, [[none - down, double(down)], [none - back, double(back)]], [[L::ONE; 2]; 3])
    }

    /// The gradients of cells that may be at the border.
    #[inline(always)]
    pub(crate) fn gradients_at_border<L: Lanes>(&self, cells: &Cells<L>) -> [L; 3] {
        // One step to the neighbours, or none where there is none; differences over one step count twice.
        let ends = |axis: usize| {
            let (corner, end) = (cells.corner[axis], L::Ints::splat(self.dims[axis] as i32 - 2));
            [corner.lt(L::Ints::splat(1)), (end - L::Ints::splat(1)).lt(corner)]
        };
        let stride = |axis: usize| L::Ints::splat(self.strides[axis] as i32);
        let none = L::Ints::splat(0);
        let beyond = |axis: usize| {
            let ([first, last], stride) = (ends(axis), stride(axis));
            [L::Ints::select(first, none, none - stride), L::Ints::select(last, stride, stride + stride)]
        };
        let twice = |axis: usize| ends(axis).map(|end| L::select(end, L::ONE + L::ONE, L::ONE));
        let lines = self.lines_at_border(cells);
        self.gradients_by(cells, &lines, [beyond(1), beyond(2)], [twice(0), twice(1), twice(2)])
    }

    /// The gradients by differences of the corners' neighbours, in the order of operations of the scalar definition: `beyond` are
    /// the distances in memory from the lower corner to the neighbours along j and k, `times` what the differences at the lower
    /// and the upper corner of each axis are multiplied by.
    #[inline(always)]
    fn gradients_by<L: Lanes>(
        &self,
        cells: &Cells<L>,
        [a, b, c, d]: &Lines<L>,
        [[above, below], [front, behind]]: [[L::Ints; 2]; 2],
        times: [[L; 2]; 3],
    ) -> [L; 3] {
        let [_, down, back] = self.strides.map(|stride| L::Ints::splat(stride as i32));
        let [u, v, w] = cells.fraction;
        let pair = |at: L::Ints| V::pairs::<L>(self.voxels, cells.base + at);
        let middle = |line: &[L; 4]| [line[1], line[2]];
        let bilinear = |p: [L; 4]| lerp(lerp(p[0], p[1], v), lerp(p[2], p[3], v), w);
        let half = |low: L, high: L| L::from_f64(0.5) * lerp(low, high, u);
        let [near, far] = times[0];
        let along_i = half(
            bilinear([a, b, c, d].map(|line| (line[2] - line[0]) * near)),
            bilinear([a, b, c, d].map(|line| (line[3] - line[1]) * far)),
        );
        let [a, b, c, d] = [middle(a), middle(b), middle(c), middle(d)];
        let across = |low: [[L; 2]; 4], high: [[L; 2]; 4], times: [L; 4]| {
            let at = |x: usize| bilinear(each(|n| (high[n][x] - low[n][x]) * times[n]));
            half(at(0), at(1))
        };
        let [near, far] = times[1];
        let along_j = across(
            [pair(above), a, pair(above + back), c],
            [b, pair(below), d, pair(below + back)],
            [near, far, near, far],
        );
        let [near, far] = times[2];
        let along_k = across(
            [pair(front), pair(front + down), a, b],
            [c, d, pair(behind), pair(behind + down)],
            [near, near, far, far],
        );
        [along_i, along_j, along_k]
    }
}

/// The interpolated stored samples of the lines through the cells.
#[inline(always)]
pub(crate) fn values_of<L: Lanes>(cells: &Cells<L>, lines: &Lines<L>) -> L {
    trilinear(lines.map(|line| [line[1], line[2]]), cells.fraction)
}

/// [`interpolate`](super::interpolate) between pairs along i.
#[inline(always)]
fn trilinear<L: Number>(pairs: [[L; 2]; 4], [u, v, w]: [L; 3]) -> L {
    let [a, b, c, d] = pairs.map(|[low, high]| lerp(low, high, u));
    lerp(lerp(a, b, v), lerp(c, d, v), w)
}

#[inline(always)]
fn lerp<L: Number>(a: L, b: L, t: L) -> L {
    a + t * (b - a)
}
