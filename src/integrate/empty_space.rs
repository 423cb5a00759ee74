//! Empty-space skipping: how far a ray can go until something absorbs or emits again.
//!
//! For each block of cells the distance, in blocks, to the nearest active one (Chebyshev distance, as Deakin and Knoll
//! 2019); a ray then leaps over whole neighbourhoods. Samples are on the same lattice with and without: a leap counts
//! steps, exactly, and what it leaps over would have added 0.

use rayon::prelude::*;

use super::march::ByPlace;
use crate::field::{BLOCK_CELLS, Macrocells, Pace, Position};

/// Distances to the nearest active block.
#[derive(Debug, Clone)]
pub(super) struct EmptySpace {
    blocks: [usize; 3],
    /// 0 for an active block; `d` if all blocks nearer than `d` are empty.
    distance: Vec<u8>,
}

/// A stretch of equal steps that is all in active blocks, or all in empty ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Leap {
    pub(super) active: bool,
    pub(super) samples: usize,
}

impl EmptySpace {
    /// The blocks in which this transfer function shows something.
    pub(super) fn new<C: ByPlace>(values: &Macrocells, magnitudes: Option<&Macrocells>, classifier: &C) -> Self {
        let active: Vec<bool> = (0..values.ranges().len())
            .map(|b| {
                let magnitude = magnitudes.map_or([0.0; 2], |m| m.ranges()[b]);
                !classifier.is_empty_in(b, widened(values.ranges()[b]), widened(magnitude))
            })
            .collect();
        EmptySpace::from_active(values.blocks(), &active)
    }

    /// The blocks of which `is_active` holds, given the range of their values with what rounding makes of it.
    pub(super) fn by_values(values: &Macrocells, is_active: impl Fn([f32; 2]) -> bool) -> Self {
        let active: Vec<bool> = values.ranges().iter().map(|&range| is_active(widened(range))).collect();
        EmptySpace::from_active(values.blocks(), &active)
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
        EmptySpace::from_active(blocks, &active)
    }

    fn from_active(blocks: [usize; 3], active: &[bool]) -> Self {
        let mut distance: Vec<u8> = active.iter().map(|&a| if a { 0 } else { u8::MAX }).collect();
        // Chessboard distance in two passes over the neighbours already seen (Rosenfeld and Pfaltz 1966).
        let count = distance.len();
        for b in 0..count {
            distance[b] = nearest(&distance, blocks, b, -1);
        }
        for b in (0..count).rev() {
            distance[b] = nearest(&distance, blocks, b, 1);
        }
        EmptySpace { blocks, distance }
    }

    /// How many samples at this pace, from `position` on, are in active blocks, or surely in empty ones.
    #[inline(always)]
    pub(super) fn leap(&self, position: Position, pace: &Pace) -> Leap {
        let [i, j, k] = position.block(Macrocells::LOG2_CELLS);
        let distance = self.distance[i + self.blocks[0] * (j + self.blocks[1] * k)];
        let reach = i64::from(distance.max(1));
        let cells = |block: i64| block << Macrocells::LOG2_CELLS;
        let block = [i as i64, j as i64, k as i64];
        let samples = position.steps_within(pace, block.map(|b| cells(b + 1 - reach)), block.map(|b| cells(b + reach)));
        Leap { active: distance == 0, samples }
    }
}

/// A range that also holds what rounding makes of interpolated values.
pub(super) fn widened([low, high]: [f32; 2]) -> [f32; 2] {
    let margin = 1e-6 * low.abs().max(high.abs());
    [low - margin, high + margin]
}

/// The distance of block `b` by way of those neighbours that come before it (`side` -1) or after it (1) in memory.
fn nearest(distance: &[u8], blocks: [usize; 3], b: usize, side: isize) -> u8 {
    let [nx, ny, _] = blocks;
    let at = [b % nx, b / nx % ny, b / (nx * ny)];
    let mut least = distance[b];
    for dk in -1..=1 {
        for dj in -1..=1 {
            for di in -1..=1 {
                let offset = [di, dj, dk];
                let neighbour: [Option<usize>; 3] =
                    std::array::from_fn(|a| at[a].checked_add_signed(offset[a]).filter(|&x| x < blocks[a]));
                let [Some(i), Some(j), Some(k)] = neighbour else { continue };
                let n = i + nx * (j + ny * k);
                let seen = if side < 0 { n < b } else { n > b };
                if seen {
                    least = least.min(distance[n].saturating_add(1));
                }
            }
        }
    }
    least
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
        let space = EmptySpace::from_active(blocks, &active);
        for b in 0..active.len() {
            let at = [b % 9, b / 9 % 7, b / 63];
            let to = |l: [usize; 3]| (0..3).map(|a| at[a].abs_diff(l[a])).max().unwrap();
            let expected = lit.into_iter().map(to).min().unwrap();
            assert_eq!(usize::from(space.distance[b]), expected, "block {at:?}");
        }
    }

    #[test]
    fn a_leap_never_passes_an_active_block() {
        let blocks = [9, 7, 5];
        let mut active = vec![false; 9 * 7 * 5];
        active[4 + 9 * (3 + 7 * 2)] = true;
        let space = EmptySpace::from_active(blocks, &active);
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
