//! From cells to cubics: reads corners, drops cells in which nothing shows, and sets apart those that cross a knot.

use super::axis::Axis;
use super::function::{Function, Intervals};
use super::queue::{Passed, Results, Shown, Way};
use super::voxels::{Corners, Voxels, magnitudes};
use super::walk::{AHEAD, Cells, Lines, RAYS};
use crate::field::Voxel;
use crate::math::bernstein::{Cubic, range, trilinear_along};
use crate::math::each;
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

/// Looks into the cells that rays pass at several steps, the first lane's slot at the first step being `first`. Those of which the
/// pieces are known go to `whole` and `halved`, and `results` are told of them; others that may cross knots go to `cut`.
/// `corners` is room for samples.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "what is read, what with, and where it goes")]
pub(super) fn look<L: Lanes, V: Voxel + Pairs, const F: usize>(
    lines: &Lines<L>,
    steps: &[Cells<L>; AHEAD],
    first: usize,
    voxels: &Voxels<'_, V>,
    corners: &mut [[L; 8]; AHEAD],
    function: &impl Function<F>,
    is_lit: bool,
    passed: &mut Passed,
    whole: &mut Shown<F>,
    halved: &mut Shown<F>,
    cut: &mut Shown<F>,
    results: &mut Results,
) where
    Read: Fields<F>,
{
    // Corners alone already say that most cells are dark. First those of all steps, so that no read waits for another.
    let mut may_show = [<L::Mask as Mask>::ALL; AHEAD];
    for n in 0..AHEAD {
        // Where no ray passes a cell, memory is left alone.
        let base = L::Ints::select(steps[n].passes, steps[n].base, L::Ints::splat(0));
        corners[n] = voxels.corners::<L>(base);
        let [low, high] = range(&corners[n]);
        may_show[n] = steps[n].passes.and_not(function.is_dark(low, high));
    }
    for n in 0..AHEAD {
        if !may_show[n].any() {
            continue;
        }
        let (cells, corners, slot) = (&steps[n], &corners[n], first + n * RAYS);
        let at = Corners { cell: lines.cell(cells), base: cells.base };
        let (from, to) = (lines.coordinates(cells, cells.from_mm), lines.coordinates(cells, cells.to_mm));
        let fields = <Read as Fields<F>>::along(voxels, &at, corners, from, to);
        let Intervals { first: interval, stay, one_knot, are_empty } = function.intervals(&each(
            #[inline(always)]
            |f| all_of(function.axis(f), &fields[f]),
        ));
        let shows = may_show[n].and_not(are_empty);
        if !shows.any() {
            continue;
        }
        at.base.store(&mut passed.base[slot..]);
        cells.exit_mm().store(&mut passed.exit_mm[slot..]);
        let slots = L::Ints::count() + L::Ints::splat(slot as i32);
        let length_mm = cells.to_mm - cells.from_mm;
        let way = is_lit.then_some(Way { base: at.base, from, to });
        if is_lit {
            let are_inner = voxels.are_inner::<L>(&at.cell, shows);
            whole.are_inner &= are_inner;
            halved.are_inner &= are_inner;
            cut.are_inner &= are_inner;
        }
        let is_whole = shows.and(stay);
        let mut is_halved = shows.and(one_knot);
        for f in 0..F {
            // Where rounding might misplace a cut, it is looked into.
            if function.axis(f).steep().is_some() {
                is_halved = shows.and_not(shows);
            }
        }
        let pieces = L::select(is_whole, L::ONE, L::select(is_halved, L::from_f64(2.0), L::ZERO));
        results.expect(slot, pieces);
        whole.append(is_whole, slots, &fields, Some(&interval), length_mm, way.as_ref());
        halved.append(is_halved, slots, &fields, Some(&interval), length_mm, way.as_ref());
        cut.append(shows.and_not(is_whole.or(is_halved)), slots, &fields, None, length_mm, way.as_ref());
    }
}

/// From the smallest to the largest coefficient; where a knot is steep, all that rounding may make of them.
#[inline(always)]
fn all_of<L: Lanes>(axis: &Axis, cubic: &Cubic<L>) -> [L; 2] {
    let [low, high] = range(cubic);
    if axis.steep().is_none() {
        return [low, high];
    }
    let rounding = L::from_f64(ROUNDINGS * f64::from(f32::EPSILON)) * low.abs().max(high.abs());
    [low - rounding, high + rounding]
}
