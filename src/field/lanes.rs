//! Value and gradient of many samples of a ray at a time, operation by operation what [`Trilinear::value`] and
//! [`Trilinear::gradient_per_index`] are of one.

use super::{Batch, Trilinear, Voxel};
use crate::math::Number;
use crate::simd::{Ints, Lanes, Mask, Pairs};

/// The cells of some samples of a batch, on even slices.
#[derive(Clone, Copy)]
pub(crate) struct Cells<L: Lanes> {
    /// Place in memory of the lower corner.
    base: L::Ints,
    /// Lower corner, counted from voxel 0 of each axis.
    pub(super) corner: [L::Ints; 3],
    /// Where in the cell.
    pub(super) fraction: [L; 3],
}

/// The samples `[i − 1, i, i + 1, i + 2]` of the four lines along i that hold a cell's corners `i` and `i + 1`, in the order
/// `(j, k), (j + 1, k), (j, k + 1), (j + 1, k + 1)`. On the border what would be outside is what is there.
type Lines<L> = [[L; 4]; 4];

/// The memory of which samples are read fits indices of 32 bits, and each line has a pair.
const MOST_SAMPLES: usize = i32::MAX as usize;

#[expect(private_bounds, reason = "for use in the crate")]
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
        let (first, units) = batch.first.corner_and_fraction();
        let mask = L::Ints::splat((1 << 24) - 1);
        let unit = L::from_f64(1.0 / f64::from(1 << 24));
        let mut base = L::Ints::splat(0);
        let (mut corner, mut fraction) = ([base; 3], [L::ZERO; 3]);
        for a in 0..3 {
            let moved = L::Ints::load(&batch.offsets[a][at..]) + L::Ints::splat(units[a]);
            corner[a] = L::Ints::splat(first[a] as i32) + moved.shifted_right(24);
            fraction[a] = L::from_ints(moved.and(mask)) * unit;
            base = base + corner[a] * L::Ints::splat(self.strides[a] as i32);
        }
        Cells { base, corner, fraction }
    }

    /// The cells with these lower corners, and where in them: 0 to 1 of each axis.
    #[inline(always)]
    pub(crate) fn cells_at<L: Lanes>(&self, corner: [L::Ints; 3], fraction: [L; 3]) -> Cells<L> {
        let mut base = L::Ints::splat(0);
        for (corner, &stride) in corner.iter().zip(&self.strides) {
            base = base + *corner * L::Ints::splat(stride as i32);
        }
        Cells { base, corner, fraction }
    }

    /// Which cells are not at the border, where gradients are one-sided.
    #[inline(always)]
    pub(crate) fn are_inside<L: Lanes>(&self, cells: &Cells<L>) -> L::Mask {
        let mut inside = <L::Mask as Mask>::ALL;
        for a in 0..3 {
            let end = L::Ints::splat(self.dims[a] as i32 - 2);
            inside = inside.and(L::Ints::splat(0).lt(cells.corner[a])).and(cells.corner[a].lt(end));
        }
        inside
    }

    /// Distances in memory of a cell's lines along i from its lower corner.
    #[inline(always)]
    fn lines_away(&self) -> [i32; 4] {
        let [_, down, back] = self.strides.map(|stride| stride as i32);
        [0, down, back, down + back]
    }

    /// Distances in memory, of all lanes, to the next lines along j, along k, and along both.
    #[inline(always)]
    fn next_lines<L: Lanes>(&self) -> [L::Ints; 3] {
        let (down, back) = (L::Ints::splat(self.strides[1] as i32), L::Ints::splat(self.strides[2] as i32));
        [down, back, down + back]
    }

    /// The interpolated stored samples.
    #[inline(always)]
    pub(crate) fn values<L: Lanes>(&self, cells: &Cells<L>) -> L {
        trilinear(V::pairs_around::<L, 4>(self.voxels, cells.base, self.lines_away()), cells.fraction)
    }

    /// The lines through the cells, none of which is at the border.
    #[inline(always)]
    pub(crate) fn lines<L: Lanes>(&self, cells: &Cells<L>) -> Lines<L> {
        V::quads_around::<L, 4>(self.voxels, cells.base - L::Ints::splat(1), self.lines_away())
    }

    /// A line through cells that may be at the border, this far in memory from their lower corners.
    #[inline(always)]
    fn line_at_border<L: Lanes>(&self, cells: &Cells<L>, away: L::Ints) -> [L; 4] {
        let (one, last) = (L::Ints::splat(1), L::Ints::splat(self.dims[0] as i32 - 2));
        let (at, i) = (cells.base + away, cells.corner[0]);
        let [first, _] = V::pairs::<L>(self.voxels, at - i + (i.max(one) - one));
        let [second, third] = V::pairs::<L>(self.voxels, at);
        let [_, fourth] = V::pairs::<L>(self.voxels, at - i + (i + one).min(last));
        [first, second, third, fourth]
    }

    /// The gradients, given the lines through the cells, none of which is at the border.
    #[inline(always)]
    pub(crate) fn gradients<L: Lanes>(&self, cells: &Cells<L>, lines: &Lines<L>) -> [L; 3] {
        let [_, down, back] = self.strides.map(|stride| stride as i32);
        let rows = [-down, back - down, 2 * down, back + 2 * down];
        let slabs = [-back, down - back, 2 * back, down + 2 * back];
        let rows = V::pairs_around::<L, 4>(self.voxels, cells.base, rows);
        let slabs = V::pairs_around::<L, 4>(self.voxels, cells.base, slabs);
        gradients_by(cells, lines, [rows, slabs], [[L::ONE; 2]; 3])
    }

    /// The gradients of cells that may be at the border.
    #[inline(always)]
    pub(crate) fn gradients_at_border<L: Lanes>(&self, cells: &Cells<L>) -> [L; 3] {
        let (none, one, two) = (L::Ints::splat(0), L::Ints::splat(1), L::ONE + L::ONE);
        let (mut steps, mut times) = ([[none; 2]; 3], [[L::ONE; 2]; 3]);
        for a in 0..3 {
            // One step to the neighbours, or none where there is none; differences over one step count twice.
            let stride = L::Ints::splat(self.strides[a] as i32);
            let is_first = cells.corner[a].lt(one);
            let is_last = L::Ints::splat(self.dims[a] as i32 - 3).lt(cells.corner[a]);
            steps[a] =
                [L::Ints::select(is_first, none, none - stride), L::Ints::select(is_last, stride, stride + stride)];
            times[a] = [L::select(is_first, two, L::ONE), L::select(is_last, two, L::ONE)];
        }
        let [down, back, both] = self.next_lines::<L>();
        let (a, b) = (self.line_at_border(cells, none), self.line_at_border(cells, down));
        let (c, d) = (self.line_at_border(cells, back), self.line_at_border(cells, both));
        let mut beyond = [[[L::ZERO; 2]; 4]; 2];
        for (pairs, ([before, after], next)) in beyond.iter_mut().zip([(steps[1], back), (steps[2], down)]) {
            for (pair, away) in pairs.iter_mut().zip([before, before + next, after, after + next]) {
                *pair = V::pairs::<L>(self.voxels, cells.base + away);
            }
        }
        gradients_by(cells, &[a, b, c, d], beyond, times)
    }
}

/// The gradients by differences of the corners' neighbours, in the order of operations of the scalar definition: `beyond` are
/// the pairs above and below the four lines, and in front of and behind them, `times` what the differences at the lower and the
/// upper corner of each axis are multiplied by.
#[inline(always)]
fn gradients_by<L: Lanes>(
    cells: &Cells<L>,
    [a, b, c, d]: &Lines<L>,
    [[above_a, above_c, below_b, below_d], [front_a, front_b, behind_c, behind_d]]: [[[L; 2]; 4]; 2],
    times: [[L; 2]; 3],
) -> [L; 3] {
    let at = cells.fraction;
    let [near, far] = times[0];
    let along_i = half(
        bilinear([(a[2] - a[0]) * near, (b[2] - b[0]) * near, (c[2] - c[0]) * near, (d[2] - d[0]) * near], at),
        bilinear([(a[3] - a[1]) * far, (b[3] - b[1]) * far, (c[3] - c[1]) * far, (d[3] - d[1]) * far], at),
        at,
    );
    let [a, b, c, d] = [[a[1], a[2]], [b[1], b[2]], [c[1], c[2]], [d[1], d[2]]];
    let along_j = across([above_a, a, above_c, c], [b, below_b, d, below_d], [times[1], times[1]], at);
    let [near, far] = times[2];
    let along_k = across([front_a, front_b, a, b], [c, d, behind_c, behind_d], [[near; 2], [far; 2]], at);
    [along_i, along_j, along_k]
}

/// Between the lines of a cell.
#[inline(always)]
fn bilinear<L: Lanes>([a, b, c, d]: [L; 4], [_, v, w]: [L; 3]) -> L {
    lerp(lerp(a, b, v), lerp(c, d, v), w)
}

/// Half of what lies between the ends of a cell's lines.
#[inline(always)]
fn half<L: Lanes>(low: L, high: L, [u, _, _]: [L; 3]) -> L {
    L::from_f64(0.5) * lerp(low, high, u)
}

/// Half the differences across the lines of a cell, `times` their factors line by line, interpolated.
#[inline(always)]
fn across<L: Lanes>(low: [[L; 2]; 4], high: [[L; 2]; 4], times: [[L; 2]; 2], at: [L; 3]) -> L {
    let mut ends = [L::ZERO; 2];
    for (x, end) in ends.iter_mut().enumerate() {
        let mut differences = [L::ZERO; 4];
        for n in 0..4 {
            differences[n] = (high[n][x] - low[n][x]) * times[n / 2][n % 2];
        }
        *end = bilinear(differences, at);
    }
    half(ends[0], ends[1], at)
}

/// The interpolated stored samples of the lines through the cells.
#[inline(always)]
pub(crate) fn values_of<L: Lanes>(cells: &Cells<L>, lines: &Lines<L>) -> L {
    let [a, b, c, d] = lines;
    trilinear([[a[1], a[2]], [b[1], b[2]], [c[1], c[2]], [d[1], d[2]]], cells.fraction)
}

/// [`interpolate`](super::interpolate) between pairs along i.
#[inline(always)]
pub(super) fn trilinear<L: Number>([a, b, c, d]: [[L; 2]; 4], [u, v, w]: [L; 3]) -> L {
    let (lower, upper) =
        (lerp(lerp(a[0], a[1], u), lerp(b[0], b[1], u), v), lerp(lerp(c[0], c[1], u), lerp(d[0], d[1], u), v));
    lerp(lower, upper, w)
}

#[inline(always)]
fn lerp<L: Number>(a: L, b: L, t: L) -> L {
    t.mul_plus(b - a, a)
}
