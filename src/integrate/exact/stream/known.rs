//! Pieces that are known before they are walked to: one where every field stays in its interval, two where one field crosses one
//! knot once.
//!
//! Nearly all cells are such; they fill registers as they come, and no lane waits for its neighbours.

use super::function::Function;
use super::levels::{Between, crossing};
use crate::math::bernstein::{Cubic, range, split};
use crate::math::powers;
use crate::simd::{Ints, Lanes, Mask};

/// The pieces of as many cells as a register has lanes, in order.
pub(super) struct Known<L: Lanes, const F: usize, const N: usize> {
    /// The fields along each, and their intervals.
    pub(super) fields: [[Cubic<L>; F]; N],
    pub(super) interval: [[L::Ints; F]; N],
    /// Where each begins and ends, in `[0, 1]` of the cell.
    pub(super) ends: [[L; 2]; N],
    /// Cells of which these are the pieces; others have more.
    pub(super) are_known: L::Mask,
}

/// Finds the pieces of cells in some lanes, given their fields and the intervals of the fields' lower ends.
pub(super) trait Find<const F: usize, const N: usize> {
    fn find<L: Lanes>(
        function: &impl Function<F>,
        fields: [Cubic<L>; F],
        interval: [L::Ints; F],
        are_cells: L::Mask,
    ) -> Known<L, F, N>;
}

/// Cells whose fields stay in their intervals.
pub(super) struct Whole;

impl<const F: usize> Find<F, 1> for Whole {
    #[inline(always)]
    fn find<L: Lanes>(
        _: &impl Function<F>,
        fields: [Cubic<L>; F],
        interval: [L::Ints; F],
        are_cells: L::Mask,
    ) -> Known<L, F, 1> {
        Known { fields: [fields], interval: [interval], ends: [[L::ZERO, L::ONE]], are_known: are_cells }
    }
}

/// Cells along which one field reaches beyond the next knot and no further, and the others stay in their intervals.
pub(super) struct Halved;

impl<const F: usize> Find<F, 2> for Halved {
    #[inline(always)]
    fn find<L: Lanes>(
        function: &impl Function<F>,
        fields: [Cubic<L>; F],
        interval: [L::Ints; F],
        are_cells: L::Mask,
    ) -> Known<L, F, 2> {
        let mut at = L::ONE;
        let (mut intervals, mut levels) = ([interval; 2], [L::ZERO; F]);
        let (mut rise, mut cross) = ([are_cells; F], [are_cells; F]);
        for f in 0..F {
            let (axis, [first, _, _, last]) = (function.axis(f), fields[f]);
            let next = interval[f] + L::Ints::splat(1);
            let level = axis.end::<L>(next);
            let rises = first.lt(last);
            let crosses = first.min(last).lt(level).and(level.le(first.max(last)));
            let between = Between { from: L::ZERO, to: L::ONE, at_from: first - level, at_to: last - level };
            let wanted = are_cells.and(crosses);
            let found = crossing(&powers::of(&fields[f]), level, rises, wanted, &between, axis.precision());
            at = L::select(crosses, found, at);
            intervals[0][f] = L::Ints::select(crosses.and_not(rises), next, interval[f]);
            intervals[1][f] = L::Ints::select(crosses.and(rises), next, interval[f]);
            (levels[f], rise[f], cross[f]) = (level, rises, crosses);
        }
        let mut known = Known {
            fields: [fields; 2],
            interval: intervals,
            ends: [[L::ZERO, at], [at, L::ONE]],
            are_known: are_cells,
        };
        for f in 0..F {
            let halves = split(&fields[f], at);
            (known.fields[0][f], known.fields[1][f]) = (halves[0], halves[1]);
            let [_, most] = range(&fields[f]);
            let once = cross[f].and(cross_once(&halves, levels[f], rise[f]));
            let never = most.lt(levels[f]).and_not(cross[f]);
            known.are_known = known.are_known.and(once.or(never));
        }
        known
    }
}

/// Whether cubics, cut in two about where they cross a level, stay on one side of it before the cut and on the other behind it: so
/// far as their coefficients say so, and but for what the cut is off by.
#[inline(always)]
fn cross_once<L: Lanes>([front, back]: &[Cubic<L>; 2], level: L, rises: L::Mask) -> L::Mask {
    let [start, p, s, middle] = *front;
    let [_, t, r, end] = *back;
    let (least, most) = (level.min(middle), level.max(middle));
    let up = start.max(p).max(s).le(most).and(least.le(t.min(r).min(end)));
    let down = least.le(start.min(p).min(s)).and(t.max(r).max(end).le(most));
    rises.and(up).or(down.and_not(rises))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::{Baked, bake};
    use crate::integrate::exact::stream::OfValue;
    use crate::math::bernstein::value;
    use crate::transfer::{Curve, Knot, Optics, Term, TransferFunction};
    use crate::volume::Rescale;

    /// With a knot at 0, and none between -100 and 50 besides.
    fn tent() -> OfValue {
        let knot = |value, s| Knot { value, optics: Optics::colored(s, [0.25, 0.5, 1.0]) };
        let curve = Curve::new(vec![knot(-100.0, 0.0), knot(0.0, 2.0), knot(50.0, 0.0)]).unwrap();
        let terms = vec![Term { curve, weight: None }];
        let tent = TransferFunction::new([-1024.0, 3071.0], 1000.0, terms).unwrap();
        match bake(&tent, Rescale::IDENTITY) {
            Baked::OneD(tent) => OfValue::new(&tent, 1e-3),
            Baked::TwoD(_) => unreachable!("it reads no gradient"),
        }
    }

    #[test]
    fn halves_meet_at_the_knot_and_lie_on_their_sides_of_it() {
        let function = tent();
        let [below, above] = [-1.0f32, 1.0].map(|x| function.axis(0).interval(x));
        assert_eq!(above, below + 1);
        for n in 0..1000 {
            let u = |k: f64| (f64::from(n) * k + 0.13).fract() as f32;
            let mut cubic = [-90.0 * u(0.618_034), 40.0 * u(0.414_214), 130.0 * u(0.732_051) - 90.0, 0.0];
            cubic[3] = 130.0 * u(0.236_068) - 90.0;
            cubic.sort_by(f32::total_cmp);
            let rises = n % 2 == 0;
            if !rises {
                cubic.reverse();
            }
            let known = Halved::find::<f32>(&function, [cubic], [below], true);
            assert!(known.are_known, "{cubic:?}");
            let [[_, at], [from, _]] = known.ends;
            assert_eq!(at, from);
            assert!(value(&cubic, at).abs() < 0.5, "{cubic:?} is {} at {at}", value(&cubic, at));
            assert_eq!(known.interval, if rises { [[below], [above]] } else { [[above], [below]] });
            for (half, is_above) in known.fields.iter().zip([!rises, rises]) {
                let strays = half[0].into_iter().any(|x| if is_above { x < -0.5 } else { x > 0.5 });
                assert!(!strays, "{half:?} of {cubic:?}");
            }
        }
    }

    #[test]
    fn what_may_cross_more_than_once_is_not_known() {
        let function = tent();
        let below = function.axis(0).interval(-1.0f32);
        let known = |cubic: Cubic<f32>| Halved::find::<f32>(&function, [cubic], [below], true).are_known;
        // It turns, but on one side of the knot.
        assert!(known([-50.0, -20.0, -30.0, 40.0]) && known([40.0, 20.0, 30.0, -50.0]));
        // Over it and back, from either side; three times; with a number that is none.
        assert!(!known([-50.0, 40.0, 40.0, -50.0]) && !known([40.0, -50.0, -50.0, 40.0]));
        assert!(!known([-40.0, 40.0, 40.0, -50.0]) && !known([40.0, -50.0, -50.0, 45.0]));
        assert!(!known([-1.0, 45.0, -45.0, 1.0]) && !known([1.0, -45.0, 45.0, -1.0]));
        assert!(!known([-50.0, f32::NAN, -30.0, 40.0]));
    }
}
