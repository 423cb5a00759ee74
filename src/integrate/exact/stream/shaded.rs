//! From cubics to shaded light, by nodes: cells are cut at the knots, and pieces whose nodes may miss too much are halved.
//!
//! Most pieces need no halving. Those that do wait in a list, so that registers are full of them too.

use super::function::Function;
use super::light::{LIGHTS, Lighting, Lights, Seen};
use super::lit::Allowance;
use super::nodes::{AtNodes, Powers, powers};
use super::pieces::{Runs, load_fields, put};
use super::queue::{Results, Shown, Way, Ways};
use super::voxels::Voxels;
use crate::field::Voxel;
use crate::integrate::exact::piece::Integral;
use crate::math::bernstein::{Cubic, restrict, trilinear_along};
use crate::math::each;
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
    fn sight<L: Lanes>(&self, way: &Way<L>, are_cells: L::Mask) -> Sight<L> {
        let gradients = if self.voxels.are_inner::<L>(&way.corners.cell, are_cells) {
            self.voxels.inner_gradients::<L>(way.corners.base)
        } else {
            let corners = self.voxels.corners::<L>(way.corners.base);
            self.voxels.gradients(&way.corners, &corners)
        };
        let mut lights = Lights { towards: [[L::ZERO; 3]; LIGHTS], half: [[L::ZERO; 3]; LIGHTS] };
        for n in 0..self.lighting.lights() {
            for a in 0..3 {
                lights.towards[n][a] = L::pick16(&self.seen.towards[n][a], way.seat);
                if !self.lighting.are_at_the_eye {
                    lights.half[n][a] = L::pick16(&self.seen.half[n][a], way.seat);
                }
            }
        }
        let gradient = each(
            #[inline(always)]
            |a| powers(&trilinear_along(&gradients[a], way.from, way.to)),
        );
        let variance = L::pick16(&self.allowance.variance, way.seat);
        let largest_square = L::pick16(&self.allowance.largest_square, way.seat);
        Sight { gradient, lights, variance, error_per_mm: L::pick16(&self.allowance.per_mm, way.seat), largest_square }
    }

    /// Whether the proven error of a piece of this length is what it may be, its transmittance aside.
    #[inline(always)]
    fn allows<L: Lanes>(&self, sight: &Sight<L>, piece: &Integral<L>, length_mm: L) -> L::Mask {
        let by_absorption = L::from_f64(f64::from(self.allowance.by_absorption));
        piece.error.le(by_absorption * piece.absorbed + sight.error_per_mm * length_mm)
    }

    /// Standard deviation of what the nodes of a piece miss.
    #[inline(always)]
    fn missed<L: Lanes>(&self, light: &AtNodes<'_, L>, integral: &Integral<L>) -> L {
        light.deviation * L::from_f64(self.lighting.largest_color) * integral.absorbed
    }
}

/// Pieces of which more nodes are wanted, by the place of their cells among those shown.
#[derive(Debug)]
pub(super) struct Parts<const F: usize> {
    waiting: Vec<Part<F>>,
}

#[derive(Debug, Clone, Copy)]
struct Part<const F: usize> {
    place: usize,
    is_whole: bool,
    ends: [f32; 2],
    interval: [i32; F],
    /// From the front of the cell to the front of the piece.
    transmittance: f32,
    /// What may be missed.
    allowed: f32,
}

impl<const F: usize> Parts<F> {
    pub(super) fn new() -> Self {
        Parts { waiting: Vec::new() }
    }

    /// Puts off the chosen ones of a register's pieces.
    #[expect(clippy::too_many_arguments, reason = "a piece, and where it is")]
    #[inline(always)]
    fn put_off<L: Lanes>(
        &mut self,
        chosen: L::Mask,
        first: usize,
        is_whole: bool,
        [from, to]: [L; 2],
        interval: [L::Ints; F],
        transmittance: L,
        allowed: L,
    ) {
        let mut numbers = [[0.0; BATCH]; 4];
        for (lanes, x) in numbers.iter_mut().zip([from, to, transmittance, allowed]) {
            x.store(lanes);
        }
        let mut intervals = [[0; BATCH]; F];
        for f in 0..F {
            interval[f].store(&mut intervals[f]);
        }
        let mut rest = chosen.bits();
        while rest != 0 {
            let k = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let [from, to, transmittance, allowed] = numbers.map(|lanes| lanes[k]);
            let interval = intervals.map(|lanes| lanes[k]);
            self.waiting.push(Part { place: first + k, is_whole, ends: [from, to], interval, transmittance, allowed });
        }
    }
}

/// Integrates cells whose fields stay in their intervals.
#[inline(always)]
pub(super) fn whole<L: Lanes, V: Voxel + Pairs, const F: usize>(
    shown: &Shown<F>,
    function: &impl Function<F>,
    scenery: &Scenery<'_, '_, V>,
    parts: &mut Parts<F>,
    results: &mut Results,
) {
    for first in (0..shown.count).step_by(L::LANES) {
        let is_cell = (L::Ints::count() + L::Ints::splat(first as i32)).lt(L::Ints::splat(shown.count as i32));
        let fields = load_fields::<L, F>(shown, first);
        let mut interval = [L::Ints::splat(0); F];
        for f in 0..F {
            interval[f] = L::Ints::load(&shown.interval[f][first..]);
        }
        let length_mm = L::load(&shown.length_mm[first..]);
        let sight = scenery.sight::<L>(&shown.way.load(first), is_cell);
        let light = scenery.lighting.at_nodes(&sight.gradient, &sight.lights, [L::ZERO, L::ONE]);
        let mut integral = function.integrate(interval, &fields, length_mm, &light);
        let missed = scenery.missed(&light, &integral);
        let allowed = sight.may_miss(integral.absorbed);
        let refused = is_cell.and_not(missed.le(allowed).and(scenery.allows(&sight, &integral, length_mm)));
        let mut missed = missed;
        if refused.any() {
            parts.put_off(refused, first, true, [L::ZERO, L::ONE], interval, L::ONE, allowed);
            for radiance in &mut integral.radiance {
                *radiance = L::select(refused, L::ZERO, *radiance);
            }
            missed = L::select(refused, L::ZERO, missed);
            integral.error = L::select(refused, L::ZERO, integral.error);
        }
        put(results, shown, first, &integral, missed * missed, L::ONE);
    }
}

/// Cuts cells where a field crosses a knot, and integrates the pieces.
#[inline(always)]
pub(super) fn cut<L: Lanes, V: Voxel + Pairs, const F: usize>(
    shown: &Shown<F>,
    function: &impl Function<F>,
    scenery: &Scenery<'_, '_, V>,
    parts: &mut Parts<F>,
    results: &mut Results,
) {
    for first in (0..shown.count).step_by(L::LANES) {
        let fields = load_fields::<L, F>(shown, first);
        let length_mm = L::load(&shown.length_mm[first..]);
        let harm = L::from_f64(f64::from(scenery.harm_per_mm)) * length_mm;
        let is_cell = (L::Ints::count() + L::Ints::splat(first as i32)).lt(L::Ints::splat(shown.count as i32));
        let sight = scenery.sight::<L>(&shown.way.load(first), is_cell);
        let mut runs = Runs::new(&fields, function);
        let mut total = Integral { absorbed: L::ZERO, radiance: [L::ZERO; 3], error: L::ZERO };
        let (mut transmittance, mut from, mut pieces, mut variance) = (L::ONE, L::ZERO, L::ZERO, L::ZERO);
        loop {
            let open = is_cell.and(from.lt(L::ONE));
            if !open.any() {
                break;
            }
            let part = runs.part(function, from);
            let ends = [from, part.to];
            let along = part.fields(&fields, from, part.to);
            let light = scenery.lighting.at_nodes(&sight.gradient, &sight.lights, ends);
            let piece_mm = length_mm * (part.to - from);
            let piece = function.integrate(part.interval, &along, piece_mm, &light);
            let missed = transmittance * scenery.missed(&light, &piece);
            let allowed = sight.may_miss(transmittance * piece.absorbed);
            let refused = open.and_not(missed.le(allowed).and(scenery.allows(&sight, &piece, piece_mm)));
            if refused.any() {
                parts.put_off(refused, first, false, ends, part.interval, transmittance, allowed);
            }
            let counts = L::select(refused, L::ZERO, transmittance);
            for c in 0..3 {
                total.radiance[c] += counts * piece.radiance[c];
            }
            total.error += counts * piece.error;
            variance += L::select(refused, L::ZERO, missed * missed);
            total.absorbed += transmittance * piece.absorbed;
            transmittance -= transmittance * piece.absorbed;
            pieces += L::select(open, L::ONE, L::ZERO);
            runs.advance(function, &part, part.to, open, harm);
            from = part.to;
        }
        total.error = runs.checked(total.error);
        put(results, shown, first, &total, variance, pieces);
    }
}

/// Halves the pieces that wait until what each may miss is allowed.
#[inline(always)]
pub(super) fn halved<L: Lanes, V: Voxel + Pairs, const F: usize>(
    [whole, cut]: [&Shown<F>; 2],
    function: &impl Function<F>,
    scenery: &Scenery<'_, '_, V>,
    parts: &mut Parts<F>,
    results: &mut Results,
) {
    let mut at = 0;
    while at < parts.waiting.len() {
        let count = L::LANES.min(parts.waiting.len() - at);
        let mut staged = Staged::<F>::new();
        let mut slots = [0; BATCH];
        for k in 0..count {
            let part = parts.waiting[at + k];
            let shown = if part.is_whole { whole } else { cut };
            staged.stage(k, &part, shown);
            slots[k] = shown.slot[part.place] as usize;
        }
        let is_part = L::Ints::count().lt(L::Ints::splat(count as i32));
        let sight = scenery.sight::<L>(&staged.way.load(0), is_part);
        let fields: [Cubic<L>; F] = each(
            #[inline(always)]
            |f| {
                each(
                    #[inline(always)]
                    |k| L::load(&staged.fields[f][k]),
                )
            },
        );
        let mut interval = [L::Ints::splat(0); F];
        for f in 0..F {
            interval[f] = L::Ints::load(&staged.interval[f]);
        }
        let [start, end, length_mm, mut transmittance, allowed] = each(
            #[inline(always)]
            |n| L::load(&staged.numbers[n]),
        );
        let middle = L::from_f64(0.5) * (start + end);
        let is_small = (middle - start).le(L::from_f64(SMALLEST_PIECE));
        let mut added = [[0.0; BATCH]; 5];
        let mut sums = [L::ZERO; 5];
        let mut refused = [0; 2];
        let mut fronts = [transmittance; 2];
        for (half, [from, to]) in [[start, middle], [middle, end]].into_iter().enumerate() {
            let part: [Cubic<L>; F] = each(
                #[inline(always)]
                |f| restrict(&fields[f], from, to),
            );
            let light = scenery.lighting.at_nodes(&sight.gradient, &sight.lights, [from, to]);
            let piece_mm = length_mm * (to - from);
            let piece = function.integrate(interval, &part, piece_mm, &light);
            let missed = transmittance * scenery.missed(&light, &piece);
            let keeps = missed.le(allowed).and(scenery.allows(&sight, &piece, piece_mm));
            let refuses = is_part.and_not(keeps.or(is_small));
            refused[half] = refuses.bits();
            fronts[half] = transmittance;
            let counts = L::select(refuses, L::ZERO, transmittance);
            for c in 0..3 {
                sums[c] += counts * piece.radiance[c];
            }
            sums[3] += L::select(refuses, L::ZERO, missed * missed);
            sums[4] += counts * piece.error;
            transmittance -= transmittance * piece.absorbed;
        }
        for (lanes, sum) in added.iter_mut().zip(sums) {
            sum.store(lanes);
        }
        let mut front_lanes = [[0.0; BATCH]; 2];
        for (lanes, front) in front_lanes.iter_mut().zip(fronts) {
            front.store(lanes);
        }
        for k in 0..count {
            for c in 0..3 {
                results.radiance[c][slots[k]] += added[c][k];
            }
            results.variance[slots[k]] += added[3][k];
            results.error[slots[k]] += added[4][k];
            results.pieces[slots[k]] += 2.0;
            let part = parts.waiting[at + k];
            let [from, to] = part.ends;
            let middle = 0.5 * (from + to);
            for (half, ends) in [[from, middle], [middle, to]].into_iter().enumerate() {
                if refused[half] >> k & 1 == 1 {
                    parts.waiting.push(Part { ends, transmittance: front_lanes[half][k], ..part });
                }
            }
        }
        at += count;
    }
    parts.waiting.clear();
}

/// Pieces side by side.
struct Staged<const F: usize> {
    way: Ways<BATCH>,
    fields: [[[f32; BATCH]; 4]; F],
    interval: [[i32; BATCH]; F],
    /// Front, back, length of the cell, transmittance in front, what may be missed.
    numbers: [[f32; BATCH]; 5],
}

impl<const F: usize> Staged<F> {
    #[inline(always)]
    fn new() -> Self {
        Staged {
            way: Ways::new(),
            fields: [[[0.0; BATCH]; 4]; F],
            interval: [[0; BATCH]; F],
            numbers: [[0.0; BATCH]; 5],
        }
    }

    #[inline(always)]
    fn stage(&mut self, k: usize, part: &Part<F>, shown: &Shown<F>) {
        let place = part.place;
        self.way.copy(k, &shown.way, place);
        for f in 0..F {
            for n in 0..4 {
                self.fields[f][n][k] = shown.fields[f][n][place];
            }
            self.interval[f][k] = part.interval[f];
        }
        let numbers = [part.ends[0], part.ends[1], shown.length_mm[place], part.transmittance, part.allowed];
        for (lanes, x) in self.numbers.iter_mut().zip(numbers) {
            lanes[k] = x;
        }
    }
}
