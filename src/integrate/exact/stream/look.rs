//! From cells to cubics: passes over cells whose corners are dark, reads those of the others, a register full at a time, and sets apart
//! those that cross a knot.

use super::axis::Axis;
use super::candidates::Candidates;
use super::function::Function;
use super::lit_cells::LitCells;
use super::queue::{Passed, Shown, Way};
use super::voxels::{Corners, Voxels, magnitudes};
use super::walk::{AHEAD, Cells, Lines, RAYS, Sides};
use crate::field::Voxel;
use crate::math::bernstein::{Cubic, range, trilinear_along};
use crate::simd::{Ints, Lanes, Mask, Pairs};

/// Roundings that a value of a cubic may have suffered: its own, and those of the coordinates that it was made from, which may be
/// off by 2e-6 after the [`AHEAD`] steps that rays are walked in f32.
pub(super) const ROUNDINGS: f64 = 64.0;

/// The field of one value, or of value and gradient magnitude.
pub(in crate::integrate::exact) trait Fields<const F: usize> {
    /// The fields along cells.
    fn along<L: Lanes, V: Voxel + Pairs>(
        voxels: &Voxels<'_, V>,
        at: &Corners<L::Ints>,
        corners: &[L; 8],
        from: [L; 3],
        to: [L; 3],
    ) -> [Cubic<L>; F];
}

/// Chooses what is read by the number of fields.
pub(in crate::integrate::exact) struct Read;

impl Fields<1> for Read {
    #[inline(always)]
    fn along<L: Lanes, V: Voxel + Pairs>(
        _: &Voxels<'_, V>,
        _: &Corners<L::Ints>,
        corners: &[L; 8],
        from: [L; 3],
        to: [L; 3],
    ) -> [Cubic<L>; 1] {
        [trilinear_along(corners, from, to)]
    }
}

impl Fields<2> for Read {
    #[inline(always)]
    fn along<L: Lanes, V: Voxel + Pairs>(
        voxels: &Voxels<'_, V>,
        at: &Corners<L::Ints>,
        corners: &[L; 8],
        from: [L; 3],
        to: [L; 3],
    ) -> [Cubic<L>; 2] {
        let gradients = voxels.gradients(at, corners);
        [trilinear_along(corners, from, to), trilinear_along(&magnitudes(&gradients), from, to)]
    }
}

/// What is looked into, and what with.
pub(super) struct View<'s, 'a, V, T> {
    pub(super) voxels: &'s Voxels<'a, V>,
    pub(super) lit_cells: &'s LitCells,
    pub(super) function: &'s T,
    pub(super) is_lit: bool,
}

/// Cells whose fields stay in one interval, and those that may cross a knot.
pub(super) struct Sorted<'s, const F: usize> {
    pub(super) whole: &'s mut Shown<F>,
    pub(super) cut: &'s mut Shown<F>,
}

impl<V, T> View<'_, '_, V, T>
where
    V: Voxel + Pairs,
{
    /// Lets those of the cells wait that rays pass at several steps, the first lane's slot at the first step being `first`, in which
    /// something may show: most do not, and what is read of the others is worth a register full of them.
    #[inline(always)]
    pub(super) fn choose<L: Lanes, const F: usize>(
        &self,
        lines: &Lines<L>,
        steps: &[Cells<L>; AHEAD],
        first: usize,
        passed: &mut Passed,
        candidates: &mut Candidates,
    ) {
        for (n, cells) in steps.iter().enumerate() {
            let chosen = self.lit_cells.among::<L>(cells.passes, cells.base);
            if !chosen.any() {
                continue;
            }
            let slot = first + n * RAYS;
            cells.base.store(&mut passed.base[slot..]);
            cells.exit_mm().store(&mut passed.exit_mm[slot..]);
            if self.is_lit {
                candidates.are_inner &= self.voxels.are_inner::<L>(&lines.cell(cells), chosen);
            }
            candidates.append(chosen, slot, cells, (F > 1).then(|| lines.cell(cells)));
        }
    }

    /// Looks into the cells that wait, registers full of them; or, at the end of a round, into all.
    #[inline(always)]
    pub(super) fn look<L: Lanes, const F: usize>(
        &self,
        candidates: &mut Candidates,
        corners: &mut [[L; 8]; AHEAD],
        sides: &Sides<'_>,
        all: bool,
        sorted: &mut Sorted<'_, F>,
    ) where
        T: Function<F>,
        Read: Fields<F>,
    {
        sorted.whole.are_inner &= candidates.are_inner;
        sorted.cut.are_inner &= candidates.are_inner;
        let count =
            if all { candidates.count.next_multiple_of(L::LANES) } else { candidates.count / L::LANES * L::LANES };
        if count == 0 {
            return;
        }
        for some in (0..count).step_by(AHEAD * L::LANES) {
            let registers = (some..count.min(some + AHEAD * L::LANES)).step_by(L::LANES);
            // First the corners of all, so that no read waits for another.
            for (n, first) in registers.clone().enumerate() {
                corners[n] = self.voxels.corners::<L>(L::Ints::load(&candidates.base[first..]));
            }
            for (n, first) in registers.enumerate() {
                self.sort::<L, F>(candidates, first, &corners[n], sides, sorted);
            }
        }
        candidates.forget(count);
    }

    /// Makes cubics of a register's cells, whose corners are given, and sorts them.
    #[inline(always)]
    fn sort<L: Lanes, const F: usize>(
        &self,
        candidates: &Candidates,
        first: usize,
        corners: &[L; 8],
        sides: &Sides<'_>,
        sorted: &mut Sorted<'_, F>,
    ) where
        T: Function<F>,
        Read: Fields<F>,
    {
        let slots = L::Ints::load(&candidates.slot[first..]);
        let waits = L::Ints::count().lt(L::Ints::splat(candidates.count.saturating_sub(first) as i32));
        let [from_mm, to_mm] = candidates.ends_mm::<L>(first);
        let seats = slots.and(L::Ints::splat(RAYS as i32 - 1));
        let [from, to] = sides.coordinates(seats, [from_mm, to_mm], candidates.next_mm::<L>(first));
        let at = Corners { cell: candidates.cell::<L>(first), base: L::Ints::load(&candidates.base[first..]) };
        let fields = <Read as Fields<F>>::along(self.voxels, &at, corners, from, to);
        let mut least = [L::Ints::splat(0); F];
        let mut most = least;
        let mut stays = <L::Mask as Mask>::ALL;
        for f in 0..F {
            [least[f], most[f]] = intervals(self.function.axis(f), &fields[f]);
            stays = stays.and(least[f].eq(most[f]));
        }
        let shows = waits.and_not(self.function.is_empty::<L>(least, most));
        let way = self.is_lit.then_some(Way { base: at.base, from, to });
        let length_mm = to_mm - from_mm;
        sorted.whole.append(shows.and(stays), slots, &fields, Some(&least), length_mm, way.as_ref());
        sorted.cut.append(shows.and_not(stays), slots, &fields, None, length_mm, way.as_ref());
    }
}

/// The intervals of the smallest and the largest coefficient; where a knot is steep, of all that rounding may make of them.
#[inline(always)]
fn intervals<L: Lanes>(axis: &Axis, cubic: &Cubic<L>) -> [L::Ints; 2] {
    let [mut low, mut high] = range(cubic);
    if axis.steep().is_some() {
        let rounding = L::from_f64(ROUNDINGS * f64::from(f32::EPSILON)) * low.abs().max(high.abs());
        (low, high) = (low - rounding, high + rounding);
    }
    axis.intervals_of([low, high])
}
