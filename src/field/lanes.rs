//! Value and gradient of many samples of a ray at a time, operation by operation what [`Trilinear::value`] and
//! [`Trilinear::gradient_per_index`] are of one.

use super::{Batch, Trilinear, Voxel};
use crate::math::{Number, each};
use crate::simd::{Around, Away, Ints, Lanes, Mask, Pairs};

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

    /// Distances in memory, of all lanes, to the next lines along j, along k, and along both.
    #[inline(always)]
    fn next_lines<L: Lanes>(&self) -> [L::Ints; 3] {
        let (down, back) = (L::Ints::splat(self.strides[1] as i32), L::Ints::splat(self.strides[2] as i32));
        [down, back, down + back]
    }

    /// The interpolated stored samples.
    #[inline(always)]
    pub(crate) fn values<L: Lanes>(&self, cells: &Cells<L>) -> L {
        trilinear(V::rises::<L, 4>(self.voxels, cells.base, &self.stencil.edges), cells.fraction)
    }

    /// A line through cells that may be at the border, this far in memory from their lower corners.
    #[inline(always)]
    fn line_at_border<L: Lanes>(&self, cells: &Cells<L>, away: L::Ints) -> [V::Stored<L>; 4] {
        let (one, last) = (L::Ints::splat(1), L::Ints::splat(self.dims[0] as i32 - 2));
        let (at, i) = (cells.base + away, cells.corner[0]);
        let [[first, _]] = V::pairs::<L, 1>(self.voxels, at - i + (i.max(one) - one), &Away::HERE);
        let [[second, third]] = V::pairs::<L, 1>(self.voxels, at, &Away::HERE);
        let [[_, fourth]] = V::pairs::<L, 1>(self.voxels, at - i + (i + one).min(last), &Away::HERE);
        [first, second, third, fourth]
    }

    /// The gradients of cells none of which is at the border.
    #[inline(always)]
    pub(crate) fn gradients<L: Lanes>(&self, cells: &Cells<L>) -> [L; 3] {
        gradients_by::<V, L>(cells, V::around(self.voxels, cells.base, &self.stencil), [[L::ONE; 2]; 3])
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
        let away = [none, down, back, both];
        let lines = each(
            #[inline(always)]
            |n| self.line_at_border(cells, away[n]),
        );
        let [rows, slabs] = each(
            #[inline(always)]
            |n| {
                let ([before, after], next) = [(steps[1], back), (steps[2], down)][n];
                let away = [before, before + next, after, after + next];
                each(
                    #[inline(always)]
                    |n| V::pairs::<L, 1>(self.voxels, cells.base + away[n], &Away::HERE)[0],
                )
            },
        );
        gradients_by::<V, L>(cells, Around { lines, rows, slabs }, times)
    }
}

/// The gradients by differences of the corners' neighbours, in the order of operations of the scalar definition; `times` are what the
/// differences at the lower and the upper corner of each axis are multiplied by. On the border what would be outside is what is there.
#[inline(always)]
fn gradients_by<V: Pairs, L: Lanes>(
    cells: &Cells<L>,
    Around { lines, rows, slabs }: Around<V, L>,
    times: [[L; 2]; 3],
) -> [L; 3] {
    let at = cells.fraction;
    let [above_a, above_c, below_b, below_d] = rows;
    let [front_a, front_b, behind_c, behind_d] = slabs;
    let ends = each(
        #[inline(always)]
        |n| [[lines[n][0], lines[n][1]], [lines[n][2], lines[n][3]]],
    );
    let along_i = across::<V, L>(ends, [times[0]; 4], at);
    let [a, b, c, d] = each(
        #[inline(always)]
        |n| [lines[n][1], lines[n][2]],
    );
    let [near, far] = [[times[1][0]; 2], [times[1][1]; 2]];
    let along_j = across::<V, L>([[above_a, b], [a, below_b], [above_c, d], [c, below_d]], [near, far, near, far], at);
    let [near, far] = [[times[2][0]; 2], [times[2][1]; 2]];
    let along_k =
        across::<V, L>([[front_a, c], [front_b, d], [a, behind_c], [b, behind_d]], [near, near, far, far], at);
    [along_i, along_j, along_k]
}

/// Between the lines of a cell.
#[inline(always)]
fn bilinear<L: Lanes>([a, b, c, d]: [L; 4], [_, v, w]: [L; 3]) -> L {
    lerp(lerp(a, b, v), lerp(c, d, v), w)
}

/// Half the differences of pairs of samples, line by line, `times` their factors, interpolated.
#[inline(always)]
fn across<V: Pairs, L: Lanes>(pairs: [[[V::Stored<L>; 2]; 2]; 4], times: [[L; 2]; 4], at: [L; 3]) -> L {
    let mut ends = [L::ZERO; 2];
    for (x, end) in ends.iter_mut().enumerate() {
        let mut differences = [L::ZERO; 4];
        for n in 0..4 {
            let [before, after] = pairs[n];
            differences[n] = V::to_lanes::<L>(after[x] - before[x]) * times[n][x];
        }
        *end = bilinear(differences, at);
    }
    L::from_f64(0.5) * lerp(ends[0], ends[1], at[0])
}

/// [`interpolate`](super::interpolate) between pairs along i: their first samples, and how much more the second ones are.
#[inline(always)]
pub(super) fn trilinear<L: Number>(pairs: [[L; 2]; 4], [u, v, w]: [L; 3]) -> L {
    let [a, b, c, d] = each(
        #[inline(always)]
        |n| u.mul_plus(pairs[n][1], pairs[n][0]),
    );
    lerp(lerp(a, b, v), lerp(c, d, v), w)
}

#[inline(always)]
fn lerp<L: Number>(a: L, b: L, t: L) -> L {
    t.mul_plus(b - a, a)
}
