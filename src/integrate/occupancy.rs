//! Where something may show: blocks of cells, and the empty neighbourhoods around the others.

use rayon::prelude::*;

use crate::field::BlockRanges;
use crate::simd::{Ints, Lanes};

/// Base-2 logarithm of the cells per axis of a block.
pub(super) const LOG2_BLOCK: u32 = 2;

/// Base-2 logarithm of the cells per axis of the largest neighbourhood that is known to be empty.
const LOG2_LARGEST: u32 = 7;

/// For each block of cells the largest aligned cube of cells around it in which nothing shows.
#[derive(Debug, Clone)]
pub(super) struct Occupancy {
    blocks: [usize; 3],
    /// Base-2 logarithm of the cube's cells per axis; 0 where something may show. Three bytes more than blocks, so that
    /// four can be read at any of them.
    empty: Vec<u8>,
}

impl Occupancy {
    /// Nothing is known to be empty.
    pub(super) fn full(dims: [usize; 3]) -> Self {
        let blocks = BlockRanges::<LOG2_BLOCK>::blocks_of(dims);
        Occupancy { blocks, empty: vec![0; blocks.iter().product::<usize>() + 3] }
    }

    /// The blocks whose range of stored values, with what rounding makes of interpolated ones, may show something.
    pub(super) fn new(values: &BlockRanges<LOG2_BLOCK>, may_show: impl Fn([f32; 2]) -> bool + Sync) -> Self {
        let blocks = values.blocks();
        let is_empty = |range: &[f32; 2]| !may_show(super::empty_space::widened(*range));
        let known = values.ranges().par_iter().map(|range| if is_empty(range) { LOG2_BLOCK as u8 } else { 0 });
        let mut empty: Vec<u8> = known.collect();
        empty.extend([0; 3]);
        let mut occupancy = Occupancy { blocks, empty };
        for log2_cells in LOG2_BLOCK + 1..=LOG2_LARGEST {
            occupancy.join(log2_cells - LOG2_BLOCK, log2_cells as u8);
        }
        occupancy
    }

    /// Joins cubes of `1 << log2_blocks` blocks per axis that are empty all over: those of which the eighths are.
    fn join(&mut self, log2_blocks: u32, log2_cells: u8) {
        let [nx, ny, nz] = self.blocks;
        let (side, half) = (1 << log2_blocks, 1 << (log2_blocks - 1));
        let span = |from: usize, n: usize| from..(from + side).min(n);
        self.empty[..nx * ny * nz].par_chunks_mut(nx * ny * side).for_each(|slab| {
            let deep = slab.len() / (nx * ny);
            for y in (0..ny).step_by(side) {
                for x in (0..nx).step_by(side) {
                    // What lies beyond the lattice is empty, too.
                    let eighths = |from: usize, n: usize| span(from, n).step_by(half);
                    let is_empty = |i: usize, j: usize, k: usize| slab[i + nx * (j + ny * k)] + 1 >= log2_cells;
                    let mut corners = eighths(0, deep).flat_map(|k| eighths(y, ny).map(move |j| (j, k)));
                    if corners.all(|(j, k)| eighths(x, nx).all(|i| is_empty(i, j, k))) {
                        for k in 0..deep {
                            for j in span(y, ny) {
                                slab[nx * (j + ny * k)..][span(x, nx)].fill(log2_cells);
                            }
                        }
                    }
                }
            }
        });
    }

    /// The cubes of cells around cells in which nothing shows: the base-2 logarithm of their cells per axis, 0 where
    /// something may show.
    #[inline(always)]
    pub(super) fn around<L: Lanes>(&self, [i, j, k]: [L::Ints; 3]) -> L::Ints {
        let [nx, ny, _] = self.blocks;
        let (row, slab) = (L::Ints::splat(nx as i32), L::Ints::splat((nx * ny) as i32));
        let [i, j, k] = [i.shifted_right(LOG2_BLOCK), j.shifted_right(LOG2_BLOCK), k.shifted_right(LOG2_BLOCK)];
        L::Ints::bytes(&self.empty, i + j * row + k * slab)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Trilinear;

    #[test]
    fn cubes_are_empty_aligned_and_as_large_as_can_be() {
        let dims = [150, 90, 70];
        let mut samples = vec![0i16; dims.iter().product()];
        let lit = [[3, 5, 2], [149, 80, 40], [70, 33, 66]];
        for [i, j, k] in lit {
            samples[i + dims[0] * (j + dims[1] * k)] = 100;
        }
        let macrocells = BlockRanges::<LOG2_BLOCK>::new(&Trilinear::new(&samples, dims).unwrap());
        let occupancy = Occupancy::new(&macrocells, |[_, high]| high > 50.0);
        // A voxel lights the cells around it.
        let shows = |cell: [usize; 3]| lit.iter().any(|v| (0..3).all(|a| v[a] == cell[a] || v[a] == cell[a] + 1));
        let cube_shows = |cell: [usize; 3], log2: u32| {
            let low = cell.map(|c| c >> log2 << log2);
            let each = |a: usize| low[a]..(low[a] + (1 << log2)).min(dims[a] - 1);
            each(2).any(|k| each(1).any(|j| each(0).any(|i| shows([i, j, k]))))
        };
        let mut largest = 0;
        for n in 0..2000 {
            let cell = [n * 37 % 149, n * 53 % 89, n * 29 % 69];
            let log2 = occupancy.around::<f32>(cell.map(|c| c as i32)) as u32;
            let is_empty = log2 > 0;
            let log2 = if is_empty { log2 } else { LOG2_BLOCK };
            assert_eq!(is_empty, !cube_shows(cell, log2), "cell {cell:?}, cube of 2^{log2}");
            if is_empty && log2 < LOG2_LARGEST {
                assert!(cube_shows(cell, log2 + 1), "cell {cell:?} could leap further than 2^{log2}");
            }
            largest = u32::max(largest, log2);
        }
        assert!(largest >= 5, "found cubes of up to 2^{largest} cells");
        assert_eq!(Occupancy::full(dims).around::<f32>([5, 5, 5]), 0);
    }
}
