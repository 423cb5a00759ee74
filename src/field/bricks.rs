//! A channel of which only some blocks are kept, each with all voxels that its cells need.

use rayon::prelude::*;

use super::lanes::{Cells, trilinear};
use super::macrocell::{BLOCK_CELLS, LOG2_BLOCK_CELLS, Macrocells};
use super::{Cell, interpolate};
use crate::simd::{Ints, Lanes, Pairs, Stencil};

/// Voxels along the edge of a brick: its upper faces are kept with it, so that a cell lies in one brick.
const EDGE: usize = BLOCK_CELLS + 1;

/// Distances in a brick to the next voxel along each axis.
const STRIDES: [usize; 3] = [1, EDGE, EDGE * EDGE];

/// Where lanes read.
const STENCIL: Stencil = Stencil::new(STRIDES[1], STRIDES[2]);

/// Voxels of a brick.
const VOXELS: usize = EDGE * EDGE * EDGE;

/// Bricks of a channel of 16 bits.
#[derive(Debug, Clone)]
pub(super) struct Bricks {
    /// Of the lattice, along each axis.
    blocks: [usize; 3],
    /// Where each block begins in what is kept; those that are not kept have the first brick.
    first: Vec<i32>,
    /// Brick by brick, x fastest.
    kept: Vec<i16>,
}

/// A row of bricks that are to be filled, side by side along x but for those that are left out.
pub(super) struct Row<'a> {
    /// Which row of blocks it is.
    block: [usize; 2],
    /// The blocks along x, rising.
    across: &'a [usize],
    bricks: &'a mut [i16],
}

impl Bricks {
    /// The bricks of the blocks of which `is_kept` holds; `None` if the whole channel has no more voxels than they have. `fill` is
    /// called for each row of them, in parallel. Where nothing is kept, `missing` is read.
    pub(super) fn new(
        dims: [usize; 3],
        missing: i16,
        is_kept: impl Fn([usize; 3]) -> bool + Sync,
        fill: impl Fn(Row<'_>) + Sync + Send,
    ) -> Option<Self> {
        let blocks = Macrocells::blocks_of(dims);
        let [nx, ny, nz] = blocks;
        let kept_of = |row: usize| (0..nx).filter(|&i| is_kept([i, row % ny, row / ny])).collect::<Vec<_>>();
        let rows: Vec<_> = (0..ny * nz).into_par_iter().map(kept_of).collect();
        let bricks = 1 + rows.iter().map(Vec::len).sum::<usize>();
        let voxels = dims.iter().product::<usize>().min(i32::MAX as usize);
        if bricks * VOXELS >= voxels {
            return None;
        }
        let (mut first, mut kept) = (vec![0; nx * ny * nz], vec![missing; bricks * VOXELS]);
        let mut rest = &mut kept[VOXELS..];
        let mut begins = VOXELS;
        let mut parts = Vec::with_capacity(rows.len());
        for (row, across) in rows.iter().enumerate() {
            for &i in across {
                first[i + nx * row] = begins as i32;
                begins += VOXELS;
            }
            let (bricks, behind) = rest.split_at_mut(across.len() * VOXELS);
            rest = behind;
            if !across.is_empty() {
                parts.push(Row { block: [row % ny, row / ny], across, bricks });
            }
        }
        parts.into_par_iter().for_each(fill);
        Some(Bricks { blocks, first, kept })
    }

    /// Bytes of what is kept.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.kept) + size_of_val(&*self.first)
    }

    /// What is stored, interpolated at a place in a cell.
    #[inline(always)]
    pub(super) fn value(&self, cell: &Cell) -> f32 {
        let [i, j, k] = cell.corner.map(|c| c >> LOG2_BLOCK_CELLS);
        let [nx, ny, _] = self.blocks;
        let mut base = self.first[i + nx * (j + ny * k)] as usize;
        for a in 0..3 {
            base += (cell.corner[a] % BLOCK_CELLS) * STRIDES[a];
        }
        let mut corners = [0.0; 8];
        for (c, corner) in corners.iter_mut().enumerate() {
            let away: usize = (0..3).map(|a| (c >> a & 1) * STRIDES[a]).sum();
            *corner = f32::from(self.kept[base + away]);
        }
        interpolate(corners, cell.fraction)
    }

    /// In lanes.
    #[inline(always)]
    pub(super) fn values<L: Lanes>(&self, cells: &Cells<L>) -> L {
        let [nx, ny, _] = self.blocks.map(|n| n as i32);
        let (mut block, mut inside) = (L::Ints::splat(0), L::Ints::splat(0));
        for (a, blocks) in [1, nx, nx * ny].into_iter().enumerate() {
            let corner = cells.corner[a];
            block = block + corner.shifted_right(LOG2_BLOCK_CELLS) * L::Ints::splat(blocks);
            inside = inside + corner.and(L::Ints::splat(BLOCK_CELLS as i32 - 1)) * L::Ints::splat(STRIDES[a] as i32);
        }
        let base = L::Ints::gather(&self.first, block) + inside;
        trilinear(i16::rises::<L, 4>(&self.kept, base, &STENCIL.edges), cells.fraction)
    }
}

impl Row<'_> {
    /// Fills the bricks by lines of voxels: `line` overwrites a part of line `(j, k)` from voxel `i` on.
    #[inline(always)]
    pub(super) fn fill(self, [nx, ny, nz]: [usize; 3], mut line: impl FnMut(usize, [usize; 2], &mut [i16])) {
        let Row { block: [block_j, block_k], across, bricks } = self;
        let (Some(first), Some(last)) = (across.first(), across.last()) else { return };
        let start = first * BLOCK_CELLS;
        let mut part = vec![0; (last - first) * BLOCK_CELLS + EDGE];
        // What would be outside is never read but with a weight of 0.
        let there = part.len().min(nx - start);
        for z in 0..EDGE {
            for y in 0..EDGE {
                let at = [(block_j * BLOCK_CELLS + y).min(ny - 1), (block_k * BLOCK_CELLS + z).min(nz - 1)];
                line(start, at, &mut part[..there]);
                let to = y * STRIDES[1] + z * STRIDES[2];
                for (brick, &i) in bricks.chunks_exact_mut(VOXELS).zip(across) {
                    brick[to..to + EDGE].copy_from_slice(&part[(i - first) * BLOCK_CELLS..][..EDGE]);
                }
            }
        }
    }
}
