//! Blocks of cells by the range of their values, for rays that pass over those that cannot matter to them any more.

use crate::field::{Macrocells, Pace, Position, Trilinear, Voxel};
use crate::integrate::empty_space::{Leap, widened};

/// Ranges of stored values, with what rounding makes of interpolated ones.
#[derive(Debug, Clone)]
pub(in super::super) struct Blocks {
    blocks: [usize; 3],
    ranges: Vec<[f32; 2]>,
}

impl Blocks {
    pub(super) fn new<V: Voxel>(field: &Trilinear<'_, V>) -> Self {
        let macrocells = Macrocells::new(field);
        Blocks {
            blocks: macrocells.blocks(),
            ranges: macrocells.ranges().iter().map(|&range| widened(range)).collect(),
        }
    }

    /// How many samples at this pace, from `position` on, lie in its block, and whether `matters` holds of its range.
    #[inline(always)]
    pub(super) fn leap(&self, position: Position, pace: &Pace, matters: impl Fn([f32; 2]) -> bool) -> Leap {
        let [i, j, k] = position.block(Macrocells::LOG2_CELLS);
        let range = self.ranges[i + self.blocks[0] * (j + self.blocks[1] * k)];
        let lower = [i, j, k].map(|b| (b as i64) << Macrocells::LOG2_CELLS);
        let upper = [i, j, k].map(|b| (b as i64 + 1) << Macrocells::LOG2_CELLS);
        Leap { active: matters(range), samples: position.steps_within(pace, lower, upper) }
    }
}
