//! Empty-space skipping: how far a ray can go until something absorbs or emits again.
//!
//! For each block of cells the distance, in blocks, to the nearest active one (Chebyshev distance, as Deakin and Knoll
//! 2019), and for each active one to the nearest empty one; a ray then leaps over whole neighbourhoods, and looks around no more
//! often inside what shows. Samples are on the same lattice with and without: a leap counts
//! steps, exactly, and what it leaps over would have added 0.

use rayon::prelude::*;

use super::march::ByPlace;
use crate::field::{BLOCK_CELLS, BlockRanges, Macrocells, Pace, Position};
use crate::simd::{Ints, Kernel, Lanes, Level};

/// How far around each block all blocks are like it.
#[derive(Debug, Clone)]
pub(super) struct EmptySpace {
    blocks: [usize; 3],
    /// Base-2 logarithm of the cells per axis of a block.
    log2_cells: u32,
    /// `d`, from 1 on, if all blocks nearer than `d` are empty; [`ACTIVE`] more if all of them are active. Three bytes more than
    /// blocks, so that four can be read at any of them.
    alike: Vec<u8>,
}

/// Added to the distances of active blocks; larger than any.
const ACTIVE: u8 = 128;

/// A stretch of equal steps that is all in active blocks, or all in empty ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Leap {
    pub(super) active: bool,
    pub(super) samples: usize,
}

impl EmptySpace {
    /// The blocks in which this transfer function shows something.
    pub(super) fn new<const LOG2: u32, C: ByPlace>(
        values: &BlockRanges<LOG2>,
        magnitudes: Option<&BlockRanges<LOG2>>,
        classifier: &C,
    ) -> Self {
        let active: Vec<bool> = (0..values.ranges().len())
            .into_par_iter()
            .map(|b| {
                let magnitude = magnitudes.map_or([0.0; 2], |m| m.ranges()[b]);
                !classifier.is_empty_in(b, widened(values.ranges()[b]), widened(magnitude))
            })
            .collect();
        EmptySpace::from_active(values.blocks(), LOG2, &active)
    }

    /// The blocks of which `is_active` holds, given the range of their values with what rounding makes of it.
    pub(super) fn by_values(values: &Macrocells, is_active: impl Fn([f32; 2]) -> bool + Sync) -> Self {
        let active: Vec<bool> = values.ranges().par_iter().map(|&range| is_active(widened(range))).collect();
        EmptySpace::from_active(values.blocks(), Macrocells::LOG2_CELLS, &active)
    }

    /// The blocks of a lattice in which some voxel shows something, those on their upper faces included: what is
    /// interpolated in other blocks is nothing.
    pub(super) fn around(dims: [usize; 3], is_lit: impl Fn(usize) -> bool + Sync) -> Self {
        let blocks = Macrocells::blocks_of(dims);
        let [across, down, _] = blocks;
        let voxels = |block: usize, a: usize| block * BLOCK_CELLS..=((block + 1) * BLOCK_CELLS).min(dims[a] - 1);
        let is_active = |b: usize| {
            let [i, j, k] = [b % across, b / across % down, b / (across * down)];
            let line = |y: usize, z: usize| dims[0] * (y + dims[1] * z);
            voxels(k, 2).any(|z| voxels(j, 1).any(|y| voxels(i, 0).any(|x| is_lit(line(y, z) + x))))
        };
        let active: Vec<bool> = (0..blocks.iter().product()).into_par_iter().map(is_active).collect();
        EmptySpace::from_active(blocks, Macrocells::LOG2_CELLS, &active)
    }

    fn from_active(blocks: [usize; 3], log2_cells: u32, active: &[bool]) -> Self {
        let to = |to: bool| Level::widest().run(Distances { blocks, active, to });
        let (mut alike, to_empty) = rayon::join(|| to(true), || to(false));
        for (alike, to_empty) in alike.iter_mut().zip(to_empty) {
            *alike = if *alike == 0 { ACTIVE + to_empty.min(ACTIVE - 1) } else { (*alike).min(ACTIVE - 1) };
        }
        alike.extend([0; 3]);
        EmptySpace { blocks, log2_cells, alike }
    }

    /// How many samples at this pace, from `position` on, are in active blocks, or surely in empty ones.
    #[inline(always)]
    pub(super) fn leap(&self, position: Position, pace: &Pace) -> Leap {
        let [i, j, k] = position.block(self.log2_cells);
        let alike = self.alike[i + self.blocks[0] * (j + self.blocks[1] * k)];
        let reach = i64::from(alike % ACTIVE);
        let cells = |block: i64| block << self.log2_cells;
        let block = [i as i64, j as i64, k as i64];
        let samples = position.steps_within(pace, block.map(|b| cells(b + 1 - reach)), block.map(|b| cells(b + reach)));
        Leap { active: alike > ACTIVE, samples }
    }

    /// Whether something may show in the block that holds the cell with this lower corner.
    #[inline(always)]
    pub(super) fn is_active(&self, corner: [i32; 3]) -> bool {
        let [i, j, k] = corner.map(|x| x as usize >> self.log2_cells);
        self.alike[i + self.blocks[0] * (j + self.blocks[1] * k)] > ACTIVE
    }

    /// The blocks of cells with these lower corners: base-2 logarithm of the cells per axis of a block; how many blocks to
    /// either side, the one in the middle included, are known to be like it; and which of them are active.
    #[inline(always)]
    pub(super) fn beside<L: Lanes>(&self, [i, j, k]: [L::Ints; 3]) -> (u32, L::Ints, L::Mask) {
        let [nx, ny, _] = self.blocks;
        let (row, slab) = (L::Ints::splat(nx as i32), L::Ints::splat((nx * ny) as i32));
        let block = [i, j, k].map(
            #[inline(always)]
            |x| x.shifted_right(self.log2_cells),
        );
        let alike = L::Ints::bytes(&self.alike, block[0] + block[1] * row + block[2] * slab);
        let active = i32::from(ACTIVE);
        (self.log2_cells, alike.and(L::Ints::splat(active - 1)), L::Ints::splat(active).lt(alike))
    }
}

/// Chessboard distances from blocks to the nearest that is active, or that is not; 255 if there is none. Compiled for the processor's
/// registers, which parts of rows fill.
struct Distances<'a> {
    blocks: [usize; 3],
    active: &'a [bool],
    to: bool,
}

impl Kernel for Distances<'_> {
    type Output = Vec<u8>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<u8> {
        let Distances { blocks, active, to } = self;
        let mut rows = Rows::new(blocks, active, to);
        let [nx, ny, nz] = blocks;
        // In two passes over the neighbours already seen (Rosenfeld and Pfaltz 1966).
        let [_, height, depth] = blocks.map(|n| n as isize);
        for k in 0..depth {
            for j in 0..height {
                rows.lower(j, k, 1);
            }
        }
        for k in (0..depth).rev() {
            for j in (0..height).rev() {
                rows.lower(j, k, -1);
            }
        }
        let mut distance = Vec::with_capacity(nx * ny * nz + 3);
        for row in rows.distance.chunks_exact(rows.stride) {
            distance.extend_from_slice(&row[..nx]);
        }
        distance
    }
}

/// A range that also holds what rounding makes of interpolated values.
pub(super) fn widened([low, high]: [f32; 2]) -> [f32; 2] {
    let margin = 1e-6 * low.abs().max(high.abs());
    [low - margin, high + margin]
}

/// Blocks that are worked on at a time: a whole register of them.
const PART: usize = 64;

/// Blocks beyond a row's ends, as far from everything as can be: at least as many as the largest step along a row.
const MARGIN: usize = 128;

/// Distances, row by row of blocks along i; rows are padded to whole parts.
struct Rows {
    blocks: [usize; 3],
    stride: usize,
    distance: Vec<u8>,
    /// A row between margins.
    line: Vec<u8>,
}

impl Rows {
    #[inline(always)]
    fn new(blocks: [usize; 3], active: &[bool], to: bool) -> Self {
        let [nx, ny, nz] = blocks;
        let stride = nx.next_multiple_of(PART);
        let mut distance = vec![u8::MAX; stride * ny * nz];
        for (row, active) in distance.chunks_exact_mut(stride).zip(active.chunks_exact(nx)) {
            for (distance, &active) in row.iter_mut().zip(active) {
                *distance = if active == to { 0 } else { u8::MAX };
            }
        }
        Rows { blocks, stride, distance, line: vec![u8::MAX; MARGIN + stride + MARGIN] }
    }

    #[inline(always)]
    fn row(&self, j: isize, k: isize) -> Option<std::ops::Range<usize>> {
        let [_, ny, nz] = self.blocks;
        let (j, k) = (usize::try_from(j).ok().filter(|&j| j < ny)?, usize::try_from(k).ok().filter(|&k| k < nz)?);
        let first = self.stride * (j + ny * k);
        Some(first..first + self.stride)
    }

    /// Lowers the distances of a row to one more than those of the neighbours that come before in this direction, and then along the
    /// row from ever further away.
    #[inline(always)]
    fn lower(&mut self, j: isize, k: isize, direction: isize) {
        let Some(row) = self.row(j, k) else { return };
        let within = MARGIN..MARGIN + self.stride;
        self.line[within.clone()].fill(u8::MAX);
        for [dj, dk] in [[-1, 0], [-1, -1], [0, -1], [1, -1]] {
            let Some(before) = self.row(j + dj * direction, k + dk * direction) else { continue };
            lower(&mut self.line[within.clone()], &self.distance[before], 0);
        }
        let row = &mut self.distance[row];
        for from in [MARGIN - 1, MARGIN, MARGIN + 1] {
            lower(row, &self.line[from..], 1);
        }
        // Distances of more than the margin are as good as any.
        let mut away = 1;
        while away <= MARGIN && away < self.blocks[0] {
            self.line[within.clone()].copy_from_slice(row);
            let from = MARGIN.wrapping_add_signed(-direction * away as isize);
            lower(row, &self.line[from..], away as u8);
            away *= 2;
        }
    }
}

/// Lowers distances to those of as many others and so much more.
#[inline(always)]
fn lower(distance: &mut [u8], others: &[u8], more: u8) {
    let (parts, _) = distance.as_chunks_mut::<PART>();
    let (others, _) = others.as_chunks::<PART>();
    for (part, others) in parts.iter_mut().zip(others) {
        for (d, &n) in part.iter_mut().zip(others) {
            *d = (*d).min(n.saturating_add(more));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn distances_are_chebyshev() {
        let blocks = [9, 7, 5];
        let mut active = vec![false; 9 * 7 * 5];
        let lit = [[1, 1, 1], [7, 2, 4]];
        for [i, j, k] in lit {
            active[i + 9 * (j + 7 * k)] = true;
        }
        let inverse: Vec<bool> = active.iter().map(|a| !a).collect();
        let [space, other] = [&active, &inverse].map(|active| EmptySpace::from_active(blocks, 3, active));
        for b in 0..active.len() {
            let at = [b % 9, b / 9 % 7, b / 63];
            let to = |l: [usize; 3]| (0..3).map(|a| at[a].abs_diff(l[a])).max().unwrap();
            let expected = lit.into_iter().map(to).min().unwrap();
            let [same, inverse] = [&space, &other].map(|space| (space.alike[b] > ACTIVE, space.alike[b] % ACTIVE));
            // Alone among others, a block is like itself.
            assert_eq!(same, (expected == 0, expected.max(1) as u8), "block {at:?}");
            assert_eq!(inverse, (expected != 0, expected.max(1) as u8), "block {at:?}, the other way round");
        }
        let all = EmptySpace::from_active(blocks, 3, &vec![true; active.len()]);
        assert!(all.alike[..active.len()].iter().all(|&alike| alike == u8::MAX), "active as far as can be told");
    }

    #[test]
    fn a_leap_never_passes_an_active_block() {
        let blocks = [9, 7, 5];
        let mut active = vec![false; 9 * 7 * 5];
        active[4 + 9 * (3 + 7 * 2)] = true;
        let space = EmptySpace::from_active(blocks, 3, &active);
        let dims = blocks.map(|n| n * 8 + 1);
        let mut leapt = 0;
        for i in 0..500 {
            let u = |k: f64| (f64::from(i) * k).fract();
            let end = DVec3::from_array(dims.map(|n| (n - 1) as f64));
            let first = Position::new(end * DVec3::new(u(0.618), u(0.414), u(0.732)), dims);
            let last = Position::new(end * DVec3::new(u(0.271), u(0.828), u(0.577)), dims);
            let step = first.step_to(last, 200);
            let mut at = 0;
            while at < 200 {
                let leap = space.leap(first.advanced(step, at), &Pace::new(step));
                let end = (at + leap.samples).min(200);
                for n in at..end {
                    let inside = first.advanced(step, n).block(3) == [4, 3, 2];
                    assert!(leap.active || !inside, "sample {n} of ray {i} is in the active block");
                }
                leapt += if leap.active { 0 } else { end - at };
                at = end;
            }
        }
        assert!(leapt > 90_000, "of 100000 samples, nearly all empty, {leapt} were leapt over");
    }
}
