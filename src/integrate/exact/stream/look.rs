//! From cells to cubics: reads corners, drops cells in which nothing shows, and sets apart those that cross a knot.

use super::axis::Axis;
use super::function::Function;
use super::queue::{Passed, ROOM, Shown, Way};
use super::voxels::{Corners, Voxels, magnitudes};
use crate::field::Voxel;
use crate::math::bernstein::{Cubic, range, trilinear_along};
use crate::math::each;
use crate::simd::{Ints, Lanes, Mask, Pairs};

/// Roundings that a value of a cubic may have suffered.
pub(super) const ROUNDINGS: f64 = 8.0;

/// The field of one value, or of value and gradient magnitude.
pub(in crate::integrate::exact) trait Fields<const F: usize> {
    /// The fields along cells; `dark` says where nothing shows for corners in a range, whatever else is there.
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

/// Looks into the cells passed. Those whose fields stay in one interval go to `whole`, those that may cross a knot to `cut`.
#[inline(always)]
pub(super) fn look<L: Lanes, V: Voxel + Pairs, const F: usize>(
    passed: &Passed,
    voxels: &Voxels<'_, V>,
    function: &impl Function<F>,
    is_lit: bool,
    whole: &mut Shown<F>,
    cut: &mut Shown<F>,
) where
    Read: Fields<F>,
{
    whole.count = 0;
    cut.count = 0;
    let nothing = L::Ints::splat(0);
    for first in (0..passed.count).step_by(L::LANES) {
        let slot = L::Ints::count() + L::Ints::splat(first as i32);
        let is_cell = slot.lt(L::Ints::splat(passed.count as i32));
        let base = L::Ints::load(&passed.base[first..]);
        let corners = voxels.corners::<L>(base);
        // Corners alone already say that most cells are dark.
        let [low, high] = range(&corners);
        let values = function.axis(0);
        let mut all_low = [nothing; F];
        let mut all_high = [nothing; F];
        all_low[0] = values.interval(low);
        all_high[0] = values.interval(high);
        for f in 1..F {
            all_high[f] = L::Ints::splat(function.axis(f).intervals() as i32 - 1);
        }
        let may_show = is_cell.and_not(function.is_empty::<L>(all_low, all_high));
        if !may_show.any() {
            continue;
        }
        let at = Corners {
            cell: each(
                #[inline(always)]
                |a| L::Ints::load(&passed.cell[a][first..]),
            ),
            base,
        };
        let (from, to) = (load(&passed.from, first), load(&passed.to, first));
        let fields = <Read as Fields<F>>::along(voxels, &at, &corners, from, to);
        let mut least = [nothing; F];
        let mut most = [nothing; F];
        let mut stays = <L::Mask as Mask>::ALL;
        for f in 0..F {
            [least[f], most[f]] = intervals(function.axis(f), &fields[f]);
            stays = stays.and(least[f].eq(most[f]));
        }
        let shows = may_show.and_not(function.is_empty::<L>(least, most));
        let length_mm = L::load(&passed.length_mm[first..]);
        let way = is_lit.then(
            #[inline(always)]
            || Way { corners: at, seat: L::Ints::load(&passed.seat[first..]), from, to },
        );
        whole.append(shows.and(stays), slot, &fields, &least, length_mm, way.as_ref());
        cut.append(shows.and_not(stays), slot, &fields, &least, length_mm, way.as_ref());
    }
}

#[inline(always)]
fn load<L: Lanes>(all: &[[f32; ROOM]; 3], first: usize) -> [L; 3] {
    each(
        #[inline(always)]
        |a| L::load(&all[a][first..]),
    )
}

/// The intervals of the smallest and the largest coefficient; where a knot is steep, of all that rounding may make of them.
#[inline(always)]
fn intervals<L: Lanes>(axis: &Axis, cubic: &Cubic<L>) -> [L::Ints; 2] {
    let [mut low, mut high] = range(cubic);
    if axis.steep().is_some() {
        let rounding = L::from_f64(ROUNDINGS * f64::from(f32::EPSILON)) * low.abs().max(high.abs());
        (low, high) = (low - rounding, high + rounding);
    }
    [axis.interval(low), axis.interval(high)]
}
