//! From cubics to shaded light, by nodes: cells are cut at the knots, and pieces whose nodes may miss too much are halved.
//!
//! Most pieces need no halving. Those that do wait in a list, so that registers are full of them too.

use super::crossing::{Beginnings, Crossing};
use super::function::Function;
use super::known::Find;
use super::light::{Lighting, Lights, Seen};
use super::lit::Allowance;
use super::nodes::AtNodes;
use super::parts::{Part, Parts};
use super::pieces::{load_fields, load_intervals, put};
use super::queue::{ROOM, Results, Shown, Way};
use super::voxels::Voxels;
use crate::field::Voxel;
use crate::integrate::exact::piece::Integral;
use crate::math::bernstein::{Cubic, trilinear_along};
use crate::math::each;
use crate::math::powers::{self, Powers};
use crate::simd::{BATCH, Ints, Lanes, Mask, Pairs};

/// A piece is not made shorter than this fraction of a cell; what it may then miss is charged to the estimate.
const SMALLEST_PIECE: f64 = 1.0 / 65536.0;

/// What is the same for all cells of a round.
pub(super) struct Scenery<'s, 'v, V> {
    pub(super) voxels: &'s Voxels<'v, V>,
    pub(super) lighting: &'s Lighting,
    pub(super) seen: &'s Seen,
    pub(super) allowance: &'s Allowance,
    pub(super) harm_per_mm: f32,
}

/// Shares of a tolerance.
#[derive(Debug, Clone, Copy)]
pub(in crate::integrate::exact) struct Estimate {
    /// For proven errors.
    pub(in crate::integrate::exact) proven: f64,
    /// For what the nodes of pieces miss: a standard deviation.
    deviation: f64,
}

/// A share of the tolerance is for errors that are proven, the rest for so many standard deviations of estimated ones.
const PROVEN: f64 = 0.6;
pub(in crate::integrate::exact) const DEVIATIONS: f64 = 4.0;

impl Estimate {
    /// The shares of a tolerance.
    pub(in crate::integrate::exact) fn within(tolerance: f64) -> Self {
        Estimate { proven: PROVEN * tolerance, deviation: (1.0 - PROVEN) / DEVIATIONS * tolerance }
    }

    pub(super) fn variance(&self) -> f64 {
        self.deviation * self.deviation
    }
}

/// Cells as their rays see them.
struct Sight<L> {
    /// Along the ray, HU/mm.
    gradient: [Powers<L>; 3],
    lights: Lights<L>,
    /// Variance over what a cell absorbs.
    variance: L,
    error_per_mm: L,
    /// Over what a piece may miss by its share of the variance: what it may miss at most.
    largest_square: L,
}

/// Gradients along cells: rows by axis and power.
pub(super) type Gradients = [[[f32; ROOM]; 4]; 3];

/// Small enough for any picture, and large enough for f32 to square.
const NOTHING: f64 = 1e-12;

impl<L: Lanes> Sight<L> {
    /// What a piece that absorbs so much may miss, a standard deviation: its share of the variance. Few pieces miss much more than a
    /// deviation, but where a few pieces are all that is seen, few are too many; so the more is absorbed the less of the share.
    #[inline(always)]
    fn may_miss(&self, absorbed: L) -> L {
        let share = (self.variance * absorbed).sqrt().max(L::from_f64(NOTHING));
        share.min(self.largest_square / share)
    }
}

impl<V: Voxel + Pairs> Scenery<'_, '_, V> {
    #[inline(always)]
    fn sight<L: Lanes>(&self, way: &Way<L>, are_inner: bool, seat: L::Ints) -> Sight<L> {
        self.seen_from(self.gradient(way, are_inner), seat)
    }

    /// The gradient along cells.
    #[inline(always)]
    fn gradient<L: Lanes>(&self, way: &Way<L>, are_inner: bool) -> [Powers<L>; 3] {
        let gradients = if are_inner {
            self.voxels.inner_gradients::<L>(way.base)
        } else {
            let corners = self.voxels.corners::<L>(way.base);
            self.voxels.gradients(&self.voxels.corners_at::<L>(way.base), &corners)
        };
        each(
            #[inline(always)]
            |a| powers::of(&trilinear_along(&gradients[a], way.from, way.to)),
        )
    }

    /// Cells with this gradient, as rays in these seats see them.
    #[inline(always)]
    fn seen_from<L: Lanes>(&self, gradient: [Powers<L>; 3], seat: L::Ints) -> Sight<L> {
        Sight {
            gradient,
            lights: self.seen.lights(self.lighting, seat),
            variance: L::pick32(&self.allowance.variance, seat),
            error_per_mm: L::pick32(&self.allowance.per_mm, seat),
            largest_square: L::pick32(&self.allowance.largest_square, seat),
        }
    }

    /// Whether the proven error of a piece of this length is what it may be, its transmittance aside.
    #[inline(always)]
    fn allows<L: Lanes>(&self, error_per_mm: L, piece: &Integral<L>, length_mm: L) -> L::Mask {
        let by_absorption = L::from_f64(f64::from(self.allowance.by_absorption));
        piece.error.le(by_absorption.mul_plus(piece.absorbed, error_per_mm * length_mm))
    }

    /// Standard deviation of what the nodes of a piece miss.
    #[inline(always)]
    fn missed<L: Lanes>(&self, light: &AtNodes<'_, L>, integral: &Integral<L>) -> L {
        light.deviation * L::from_f64(self.lighting.largest_color) * integral.absorbed
    }
}

/// Pieces of which more nodes are wanted.
#[derive(Debug)]
pub(super) struct Waiting<const F: usize> {
    parts: Parts<F>,
    /// First and second halves of these that are to be halved again.
    halves: [Parts<F>; 2],
}

impl<const F: usize> Waiting<F> {
    pub(super) fn new() -> Self {
        Waiting { parts: Parts::new(), halves: [Parts::new(), Parts::new()] }
    }
}

/// Integrates cells of which the pieces are known. Those that turn out to have more go to `cut`.
#[inline(always)]
pub(super) fn known<L: Lanes, V: Voxel + Pairs, P: Find<F, N>, const F: usize, const N: usize>(
    shown: &Shown<F>,
    function: &impl Function<F>,
    scenery: &Scenery<'_, '_, V>,
    cut: &mut Shown<F>,
    waiting: &mut Waiting<F>,
    results: &mut Results,
) {
    for first in (0..shown.count).step_by(L::LANES) {
        let (is_cell, fields) = (shown.are_cells::<L>(first), load_fields::<L, F>(shown, first));
        let length_mm = L::load(&shown.length_mm[first..]);
        let known = P::find(function, fields, load_intervals::<L, F>(shown, first), is_cell);
        let seat = shown.seats::<L>(first);
        let (slot, way) = (L::Ints::load(&shown.slot[first..]), shown.way.load(first));
        let has_more = is_cell.and_not(known.are_known);
        if has_more.any() {
            cut.are_inner &= shown.are_inner;
            cut.append(has_more, slot, &fields, None, length_mm, Some(&way));
        }
        let sight = scenery.sight::<L>(&way, shown.are_inner, seat);
        let (mut total, mut variance) = (Integral::nothing(), L::ZERO);
        for n in 0..N {
            let (interval, ends) = (known.interval[n], known.ends[n]);
            let light = scenery.lighting.at_nodes(&sight.gradient, &sight.lights, ends);
            let piece_mm = length_mm * (ends[1] - ends[0]);
            let mut piece = function.integrate(interval, &known.fields[n], piece_mm, &light);
            let transmittance = L::ONE - total.absorbed;
            let mut missed = transmittance * scenery.missed(&light, &piece);
            let allowed = sight.may_miss(transmittance * piece.absorbed);
            let keeps = missed.le(allowed).and(scenery.allows(sight.error_per_mm, &piece, piece_mm));
            let refused = known.are_known.and_not(keeps);
            if refused.any() {
                let fields = each(
                    #[inline(always)]
                    |f| powers::of(&fields[f]),
                );
                let gradient = sight.gradient;
                let part = Part { slot, seat, fields, interval, gradient, length_mm, ends, transmittance, allowed };
                waiting.parts.append(refused, &part);
                piece.forget_light(refused);
                missed = L::select(refused, L::ZERO, missed);
            }
            total = if n == 0 { piece } else { total.followed_by(&piece) };
            variance = missed.mul_plus(missed, variance);
        }
        put(results, shown, first, &total, Some(variance), None);
    }
}

/// Cuts cells where a field crosses a knot, and integrates the pieces.
#[inline(always)]
pub(super) fn cut<L: Lanes, V: Voxel + Pairs, const F: usize>(
    shown: &Shown<F>,
    function: &impl Function<F>,
    scenery: &Scenery<'_, '_, V>,
    beginnings: &mut Beginnings<F>,
    gradients: &mut Gradients,
    waiting: &mut Waiting<F>,
    results: &mut Results,
) {
    beginnings.prepare::<L>(shown, function);
    for first in (0..shown.count).step_by(L::LANES) {
        let gradient = scenery.gradient::<L>(&shown.way.load(first), shown.are_inner);
        for (rows, powers) in gradients.iter_mut().flatten().zip(gradient.iter().flatten()) {
            powers.store(&mut rows[first..]);
        }
    }
    let harm_per_mm = L::from_f64(f64::from(scenery.harm_per_mm));
    let mut cells = Crossing::<L, F>::new();
    let mut seat = splat::<L>(0);
    let mut sight = scenery.seen_from::<L>([[L::ZERO; 4]; 3], seat);
    loop {
        let open = cells.attend(
            shown,
            beginnings,
            true,
            results,
            #[inline(always)]
            |taken| {
                let mut gradient = sight.gradient;
                for a in 0..3 {
                    taken.powers(&gradients[a], &mut gradient[a]);
                }
                seat = taken.seats(shown, seat);
                sight = scenery.seen_from(gradient, seat);
            },
        );
        if !open.any() {
            break;
        }
        let (from, transmittance) = (cells.from, cells.transmittance);
        let part = cells.runs.part(function, from);
        let ends = [from, part.to];
        let along = cells.runs.fields(from, part.to);
        let light = scenery.lighting.at_nodes(&sight.gradient, &sight.lights, ends);
        let piece_mm = cells.length_mm * (part.to - from);
        let piece = function.integrate(part.interval, &along, piece_mm, &light);
        let missed = transmittance * scenery.missed(&light, &piece);
        let allowed = sight.may_miss(transmittance * piece.absorbed);
        let refused = open.and_not(missed.le(allowed).and(scenery.allows(sight.error_per_mm, &piece, piece_mm)));
        if refused.any() {
            let part = Part {
                slot: cells.slot,
                seat,
                fields: cells.runs.powers(),
                interval: part.interval,
                gradient: sight.gradient,
                length_mm: cells.length_mm,
                ends,
                transmittance,
                allowed,
            };
            waiting.parts.append(refused, &part);
        }
        cells.add(&piece, L::select(refused, L::ZERO, transmittance));
        cells.variance += L::select(refused, L::ZERO, missed * missed);
        cells.pass(&piece, open, part.to);
        cells.runs.advance(function, &part, part.to, open, harm_per_mm * cells.length_mm);
    }
}

/// Halves the pieces that wait until what each may miss is allowed. The halves of all are first halves, in order, and then second
/// ones, so that those of a cell are summed in the same order however many lanes there are.
#[inline(always)]
pub(super) fn halved<L: Lanes, V: Voxel + Pairs, const F: usize>(
    function: &impl Function<F>,
    scenery: &Scenery<'_, '_, V>,
    waiting: &mut Waiting<F>,
    results: &mut Results,
) {
    let Waiting { parts, halves } = waiting;
    while parts.count() > 0 {
        for first in (0..parts.count()).step_by(L::LANES) {
            let part = parts.load::<L>(first);
            let is_part = parts.are_parts::<L>(first);
            let [start, end] = part.ends;
            let middle = L::from_f64(0.5) * (start + end);
            let is_small = (middle - start).le(L::from_f64(SMALLEST_PIECE));
            let lights = scenery.seen.lights::<L>(scenery.lighting, part.seat);
            let error_per_mm = L::pick32(&scenery.allowance.per_mm, part.seat);
            let mut transmittance = part.transmittance;
            let mut sums = [L::ZERO; 5];
            for (ends, halves) in [[start, middle], [middle, end]].into_iter().zip(&mut *halves) {
                let fields: [Cubic<L>; F] = each(
                    #[inline(always)]
                    |f| powers::restrict(&part.fields[f], ends[0], ends[1]),
                );
                let light = scenery.lighting.at_nodes(&part.gradient, &lights, ends);
                let piece_mm = part.length_mm * (ends[1] - ends[0]);
                let piece = function.integrate(part.interval, &fields, piece_mm, &light);
                let missed = transmittance * scenery.missed(&light, &piece);
                let keeps = missed.le(part.allowed).and(scenery.allows(error_per_mm, &piece, piece_mm));
                let refused = is_part.and_not(keeps.or(is_small));
                if refused.any() {
                    halves.append(refused, &Part { ends, transmittance, ..part });
                }
                let counts = L::select(refused, L::ZERO, transmittance);
                for c in 0..3 {
                    sums[c] = counts.mul_plus(piece.radiance[c], sums[c]);
                }
                sums[3] += L::select(refused, L::ZERO, missed * missed);
                sums[4] = counts.mul_plus(piece.error, sums[4]);
                transmittance = transmittance.minus_product(transmittance, piece.absorbed);
            }
            let mut lanes = [[0.0; BATCH]; 5];
            for (lanes, sum) in lanes.iter_mut().zip(sums) {
                sum.store(lanes);
            }
            for (k, &slot) in parts.slots(first, L::LANES).iter().enumerate() {
                let slot = slot as usize;
                for c in 0..3 {
                    results.light[slot][c] += lanes[c][k];
                }
                results.variance[slot] += lanes[3][k];
                results.error[slot] += lanes[4][k];
                results.pieces[slot] += 2.0;
            }
        }
        parts.clear();
        let [first_halves, second_halves] = halves;
        std::mem::swap(parts, first_halves);
        parts.take::<L>(second_halves);
    }
}

#[inline(always)]
fn splat<L: Lanes>(x: usize) -> L::Ints {
    L::Ints::splat(x as i32)
}
