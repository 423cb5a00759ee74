//! Positions in fixed point: a continuous voxel index whose integer part is the cell.
//!
//! An f32 index has no more than 2⁻¹⁵ voxels of resolution at index 512, and sums of steps drift further. In 23.40 fixed
//! point the cell is a shift, the fraction has full f32 precision in every cell, adding steps is exact, and comparing
//! with a block's face is exact too, so a sample is on one side of it and never on both.

use glam::DVec3;

use crate::error::{Error, Fault, Result};
use crate::math::each;

const FRACTION_BITS: u32 = 40;
/// Bits of the fraction that an f32 holds.
const KEPT_BITS: u32 = 24;
/// Bits of the fraction that it does not.
const LOST_BITS: u32 = FRACTION_BITS - KEPT_BITS;
/// The part of a voxel that is the last of the bits kept.
const KEPT_UNIT: i64 = 1 << LOST_BITS;

/// A continuous voxel index inside the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position([i64; 3]);

/// A displacement between [`Position`]s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step([i64; 3]);

/// The cell of a position, and where in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Voxel at the cell's lower corner, at most `n - 2` along an axis of `n` voxels, 0 along an axis of one.
    pub corner: [usize; 3],
    /// Position between lower and upper corner, in [0, 1); 0 along an axis of one voxel.
    pub fraction: [f32; 3],
}

impl Position {
    /// Axes with more voxels than this do not fit the fixed point.
    pub const MAX_VOXELS_PER_AXIS: usize = 1 << 22;

    /// Refuses lattices with an axis longer than positions can address.
    ///
    /// # Errors
    /// `Fault::Limit` for such an axis.
    pub fn check(dims: [usize; 3]) -> Result<()> {
        if dims.iter().any(|&n| n > Position::MAX_VOXELS_PER_AXIS) {
            return Err(Error::new(Fault::Limit, "the volume has too many voxels along an axis")
                .found(format!("{} x {} x {}", dims[0], dims[1], dims[2]))
                .expected(format!("at most {}", Position::MAX_VOXELS_PER_AXIS)));
        }
        Ok(())
    }

    /// The position nearest to a continuous index, clamped to the cells of a lattice of `dims` voxels. The upper border
    /// belongs to the last cell, at a fraction one part in 2²⁴ short of 1; an axis of one voxel has one position, 0.
    #[inline(always)]
    pub fn new(index: DVec3, dims: [usize; 3]) -> Self {
        Position(each(|a| {
            let end = (dims[a] as i64 - 1) << FRACTION_BITS;
            ((index[a] * (1i64 << FRACTION_BITS) as f64) as i64).min(end - KEPT_UNIT).max(0)
        }))
    }

    /// A continuous index of the domain along one axis, as positions hold it.
    pub(super) fn fixed(index: f64) -> i64 {
        (index * (1i64 << FRACTION_BITS) as f64).round() as i64
    }

    /// The position along k.
    #[inline(always)]
    pub(super) fn along_k(self) -> i64 {
        self.0[2]
    }

    /// The step that leads from here to `last` in `steps` equal parts, rounded towards 0 so that it never leads beyond.
    #[inline(always)]
    pub fn step_to(self, last: Position, steps: usize) -> Step {
        Step(each(|a| (last.0[a] - self.0[a]) / steps.max(1) as i64))
    }

    /// The position `count` steps on.
    #[inline(always)]
    #[must_use]
    pub fn advanced(self, step: Step, count: usize) -> Self {
        Position(each(|a| self.0[a] + step.0[a] * count as i64))
    }

    /// The position with no more of its fraction than an f32 holds, rounded against the direction of a step: towards where a
    /// ray comes from, which is inside.
    #[inline(always)]
    #[must_use]
    pub fn rounded_against(self, step: Step) -> Self {
        let add = |a: usize| if step.0[a] < 0 { KEPT_UNIT - 1 } else { 0 };
        Position(each(|a| (self.0[a] + add(a)) & -KEPT_UNIT))
    }

    /// The position, which has no more of its fraction than an f32 holds, moved by `count` steps rounded likewise.
    #[inline(always)]
    #[must_use]
    pub fn advanced_rounded(self, step: Step, count: usize) -> Self {
        Position(each(|a| self.0[a] + ((step.0[a] * count as i64) / KEPT_UNIT) * KEPT_UNIT))
    }

    /// The voxel at the lower corner of the cell, and the fraction in units of 2⁻²⁴ voxels.
    #[inline(always)]
    pub(super) fn corner_and_fraction(self) -> ([i64; 3], [i32; 3]) {
        let mask = (1i32 << KEPT_BITS) - 1;
        (each(|a| self.0[a] >> FRACTION_BITS), each(|a| (self.0[a] >> LOST_BITS) as i32 & mask))
    }

    /// How far this position is from another, in units of 2⁻²⁴ voxels, both of which have no more of their fractions than that.
    #[inline(always)]
    pub(super) fn units_from(self, other: Position) -> [i32; 3] {
        each(|a| ((self.0[a] - other.0[a]) >> LOST_BITS) as i32)
    }

    /// The position so many voxels further along an axis of a lattice of `dims` voxels, clamped as by [`Position::new`].
    #[inline(always)]
    #[must_use]
    pub fn beside(mut self, axis: usize, voxels: f64, dims: [usize; 3]) -> Self {
        let end = (dims[axis] as i64 - 1) << FRACTION_BITS;
        self.0[axis] = (self.0[axis] + (voxels * (1i64 << FRACTION_BITS) as f64) as i64).min(end - KEPT_UNIT).max(0);
        self
    }

    /// The cell, and where in it, if slices are one step apart.
    #[inline(always)]
    pub fn even_cell(self) -> Cell {
        let per_unit = 1.0 / (1u32 << KEPT_BITS) as f32;
        let mask = (1i32 << KEPT_BITS) - 1;
        Cell {
            corner: self.0.map(|x| (x >> FRACTION_BITS) as usize),
            fraction: self.0.map(|x| ((x >> LOST_BITS) as i32 & mask) as f32 * per_unit),
        }
    }

    /// The block of `2^log2_cells` steps per axis that the position lies in: of cells, where slices are one step apart.
    #[inline(always)]
    pub fn block(self, log2_cells: u32) -> [usize; 3] {
        self.0.map(|x| (x >> (FRACTION_BITS + log2_cells)) as usize)
    }

    /// How many positions, from this one on in equal steps, are surely inside the box of `lower ≤ cell < upper` that
    /// this one is in: at least 1, and short of the exact number only by rounding.
    #[inline(always)]
    pub fn steps_within(self, pace: &Pace, lower: [i64; 3], upper: [i64; 3]) -> usize {
        let mut steps = f32::INFINITY;
        for a in 0..3 {
            let face = if pace.step.0[a] < 0 { lower[a] } else { upper[a] };
            // What rounding may add to later positions is taken off.
            let distance = ((face << FRACTION_BITS) - self.0[a]).unsigned_abs().saturating_sub(2 * KEPT_UNIT as u64);
            steps = steps.min(distance as f32 * pace.steps_per_unit[a]);
        }
        // The n-th step is inside if n < distance / step; the product above exceeds that by less than 3e-7 of itself.
        // Through u32, which saturates where there is no step at all.
        (steps * (1.0 - 1e-6)) as u32 as usize + 1
    }
}

impl Step {
    /// So many steps, in units of 2⁻²⁴ voxels, rounded towards 0.
    #[inline(always)]
    pub(super) fn units(self, count: usize) -> [i32; 3] {
        each(|a| ((self.0[a] * count as i64) / KEPT_UNIT) as i32)
    }
}

/// A step with its reciprocals, to count steps without dividing.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// The step.
    pub step: Step,
    steps_per_unit: [f32; 3],
}

impl Pace {
    /// The pace of a step; along an axis it does not move on, any distance takes for ever.
    #[inline(always)]
    pub fn new(step: Step) -> Self {
        Pace { step, steps_per_unit: each(|a| 1.0 / step.0[a].unsigned_abs() as f32) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_border_belongs_to_the_last_cell() {
        let cell = Position::new(DVec3::new(4.0, 2.25, 9.0), [5, 4, 1]).even_cell();
        assert_eq!(cell.corner, [3, 2, 0]);
        assert_eq!(cell.fraction, [1.0 - 1.0 / 16_777_216.0, 0.25, 0.0]);
    }

    #[test]
    fn positions_outside_are_clamped() {
        let cell = Position::new(DVec3::new(-1e300, 1e300, f64::NAN), [5, 5, 5]).even_cell();
        assert_eq!(cell.corner, [0, 3, 0]);
        assert!(cell.fraction.iter().all(|f| (0.0..1.0).contains(f)), "found {:?}", cell.fraction);
    }

    #[test]
    fn a_million_steps_end_where_they_should() {
        let dims = [600, 600, 600];
        let (first, last) = (DVec3::new(0.1, 500.0, 7.0), DVec3::new(599.0, 1.0 / 3.0, 7.0));
        let (p, q) = (Position::new(first, dims), Position::new(last, dims));
        let end = p.advanced(p.step_to(q, 1_000_000), 1_000_000);
        for a in 0..3 {
            let apart = (end.0[a] - q.0[a]).unsigned_abs() as f64 / (1u64 << FRACTION_BITS) as f64;
            assert!(apart < 1e-6, "axis {a}: {apart:e} voxels from the end");
        }
    }

    #[test]
    fn steps_within_a_box_are_never_too_many_and_rarely_too_few() {
        let dims = [64, 64, 64];
        let (mut exact, mut tried) = (0, 0);
        for i in 0..2000 {
            let u = |k: f64| (f64::from(i) * k).fract();
            let from = DVec3::new(8.0 + 8.0 * u(0.618), 8.0 + 8.0 * u(0.414), 8.0 + 8.0 * u(0.732));
            let to = DVec3::new(63.0 * u(0.271), 63.0 * u(0.828), 63.0 * u(0.577));
            let p = Position::new(from, dims);
            let step = p.step_to(Position::new(to, dims), 1000);
            let within = p.steps_within(&Pace::new(step), [8; 3], [16; 3]);
            let inside = |n: usize| p.advanced(step, n).block(3) == [1, 1, 1];
            assert!(within >= 1 && inside(within - 1), "step {} of {within} is outside", within - 1);
            exact += usize::from(!inside(within));
            tried += 1;
        }
        assert!(exact * 100 > tried * 99, "exact in {exact} of {tried}");
    }
}
