//! Macrocells: value ranges of blocks of cells, for skipping empty space.

use rayon::prelude::*;

use super::{Spacing, Trilinear, Voxel};
use crate::simd::{Kernel, Lanes, Level};

/// Base-2 logarithm of the cells per axis of a block of [`Macrocells`].
pub(super) const LOG2_BLOCK_CELLS: u32 = 3;

/// Cells per axis of a block of [`Macrocells`].
pub const BLOCK_CELLS: usize = 1 << LOG2_BLOCK_CELLS;

/// Value ranges of blocks of `2^LOG2` cells per axis, including the voxels on their upper faces: whatever is interpolated in a block lies
/// in its range.
#[derive(Debug, Clone)]
pub struct BlockRanges<const LOG2: u32> {
    blocks: [usize; 3],
    ranges: Vec<[f32; 2]>,
}

/// Value ranges of blocks of 8³ cells.
pub type Macrocells = BlockRanges<LOG2_BLOCK_CELLS>;

impl<const LOG2: u32> BlockRanges<LOG2> {
    /// Base-2 logarithm of the cells per axis of a block.
    pub const LOG2_CELLS: u32 = LOG2;

    /// Number of blocks along each axis of a lattice of so many voxels.
    pub fn blocks_of(dims: [usize; 3]) -> [usize; 3] {
        dims.map(|n| (n - 1).div_ceil(1 << LOG2).max(1))
    }

    /// The ranges of a channel, computed in parallel.
    pub fn new<V: Voxel, K: Spacing>(field: &Trilinear<'_, V, K>) -> Self {
        let voxels = field.dims[0] * field.dims[1];
        Self::of_planes(field.dims, || Stored { planes: field.voxels, voxels })
    }

    /// The ranges of a channel by its planes, which each thread asks for one after the other.
    pub(super) fn of_planes<P: Planes>(dims: [usize; 3], planes: impl Fn() -> P + Sync + Send) -> Self {
        let blocks = Self::blocks_of(dims);
        let [across, down, _] = blocks;
        let mut ranges = vec![[0.0; 2]; blocks.iter().product()];
        let level = Level::widest();
        ranges.par_chunks_mut(across * down).enumerate().for_each_init(planes, |planes, (k, ranges)| {
            level.run(Slab::<P, LOG2> { dims, planes, k, ranges });
        });
        BlockRanges { blocks, ranges }
    }

    /// The ranges of what a rising function makes of the values.
    #[must_use]
    pub fn mapped(mut self, rising: impl Fn(f32) -> f32) -> Self {
        for range in &mut self.ranges {
            *range = range.map(&rising);
        }
        self
    }

    /// Number of blocks along i, j and k.
    pub fn blocks(&self) -> [usize; 3] {
        self.blocks
    }

    /// Lowest and highest stored value of each block, x fastest.
    pub fn ranges(&self) -> &[[f32; 2]] {
        &self.ranges
    }
}

/// Voxels of a block along an axis of `n` voxels, its upper face included.
fn voxels_of<const LOG2: u32>(block: usize, n: usize) -> std::ops::RangeInclusive<usize> {
    let first = block << LOG2;
    first..=(first + (1 << LOG2)).min(n - 1)
}

/// The voxels of a channel, plane by plane.
pub(super) trait Planes {
    /// What a voxel is stored as.
    type Sample: Voxel;

    /// The voxels of a plane, x fastest.
    fn plane(&mut self, k: usize) -> &[Self::Sample];
}

/// Planes that lie in memory.
struct Stored<'v, V> {
    planes: &'v [V],
    /// Of a plane.
    voxels: usize,
}

impl<V: Voxel> Planes for Stored<'_, V> {
    type Sample = V;

    #[inline(always)]
    fn plane(&mut self, k: usize) -> &[V] {
        &self.planes[k * self.voxels..][..self.voxels]
    }
}

/// A slab of blocks, to be filled with their ranges.
struct Slab<'p, 'r, P, const LOG2: u32> {
    dims: [usize; 3],
    planes: &'p mut P,
    /// Its place among the slabs.
    k: usize,
    ranges: &'r mut [[f32; 2]],
}

/// The planes of a slab are read one after the other, as they lie in memory: row by row of blocks memory was slower. Whole
/// lines of voxels are reduced across the line first, and along it in steps that double; loops over neighbours, which the
/// compiler fills registers with.
impl<P: Planes, const LOG2: u32> Kernel for Slab<'_, '_, P, LOG2> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Slab { dims, planes, k, ranges } = self;
        let [nx, ny, nz] = dims;
        let [across, down, _] = BlockRanges::<LOG2>::blocks_of(dims);
        // Of each row of blocks, all voxels along x.
        let (mut low, mut high) = (Vec::with_capacity(nx * down), Vec::new());
        for z in voxels_of::<LOG2>(k, nz) {
            let plane = planes.plane(z);
            if low.is_empty() {
                let rows = (0..down).map(|j| &plane[nx * (j << LOG2)..][..nx]);
                rows.for_each(|row| low.extend_from_slice(row));
                high.clone_from(&low);
            }
            for (j, (low, high)) in low.chunks_exact_mut(nx).zip(high.chunks_exact_mut(nx)).enumerate() {
                let lines = voxels_of::<LOG2>(j, ny);
                extend(low, high, &plane[nx * lines.start()..nx * (lines.end() + 1)]);
            }
        }
        for (j, row) in ranges.chunks_exact_mut(across).enumerate() {
            let (low, high) = (&low[j * nx..][..nx], &high[j * nx..][..nx]);
            // Of each voxel and as many behind it as a block has cells, less one.
            let (mut least_from, mut most_from) = (low.to_vec(), high.to_vec());
            for log2 in 0..LOG2 {
                join(&mut least_from, 1 << log2, Voxel::least);
                join(&mut most_from, 1 << log2, Voxel::most);
            }
            for (i, range) in row.iter_mut().enumerate() {
                let voxels = voxels_of::<LOG2>(i, nx);
                let (first, last) = (*voxels.start(), *voxels.end());
                *range = [least_from[first].least(low[last]).to_f32(), most_from[first].most(high[last]).to_f32()];
            }
        }
    }
}

/// Extends ranges of voxels along a line by those of other lines: four at a time, so that ranges are read and written a
/// quarter as often.
#[inline(always)]
fn extend<V: Voxel>(low: &mut [V], high: &mut [V], lines: &[V]) {
    let nx = low.len();
    let mut fours = lines.chunks_exact(4 * nx);
    for four in &mut fours {
        let (ab, cd) = four.split_at(2 * nx);
        let ((a, b), (c, d)) = (ab.split_at(nx), cd.split_at(nx));
        let high = &mut high[..nx];
        for x in 0..nx {
            low[x] = low[x].least(a[x].least(b[x]).least(c[x].least(d[x])));
            high[x] = high[x].most(a[x].most(b[x]).most(c[x].most(d[x])));
        }
    }
    for line in fours.remainder().chunks_exact(nx) {
        for ((&v, low), high) in line.iter().zip(&mut *low).zip(&mut *high) {
            *low = low.least(v);
            *high = high.most(v);
        }
    }
}

/// Joins each element of a line with the one so far behind it, where there is one.
#[inline(always)]
fn join<V: Voxel>(line: &mut [V], distance: usize, both: impl Fn(V, V) -> V) {
    let all = line.to_vec();
    let behind = &all[distance.min(all.len())..];
    for (x, &y) in line.iter_mut().zip(behind) {
        *x = both(*x, y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Position;
    use glam::DVec3;

    #[test]
    fn every_interpolated_value_lies_in_the_range_of_its_block() {
        for dims in [[20, 17, 9], [9, 8, 1], [1, 1, 1], [2, 30, 3]] {
            let count: usize = dims.iter().product();
            let voxels: Vec<i16> = (0..count).map(|i| ((i * 7919) % 4096) as i16 - 1024).collect();
            let field = Trilinear::new(&voxels, dims).unwrap();
            let macrocells = Macrocells::new(&field);
            let [across, down, _] = macrocells.blocks();
            for i in 0..20_000 {
                let u = |k: f64| (f64::from(i) * k).fract();
                let at = DVec3::from_array(dims.map(|n| (n - 1) as f64)) * DVec3::new(u(0.618), u(0.414), u(0.732));
                let position = Position::new(at, dims);
                let [bi, bj, bk] = position.block(Macrocells::LOG2_CELLS);
                let [low, high] = macrocells.ranges()[bi + across * (bj + down * bk)];
                let value = field.value(&field.cell(position));
                assert!(
                    low - 1e-3 <= value && value <= high + 1e-3,
                    "{dims:?} at {at}: {value} not in [{low}, {high}]"
                );
            }
        }
    }

    #[test]
    fn the_upper_face_counts() {
        let mut voxels = vec![0i16; 17 * 2 * 2];
        voxels[8] = 100;
        let macrocells = Macrocells::new(&Trilinear::new(&voxels, [17, 2, 2]).unwrap());
        assert_eq!(macrocells.ranges(), [[0.0, 100.0], [0.0, 100.0]], "voxel 8 is a corner of cells 7 and 8");
    }
}
