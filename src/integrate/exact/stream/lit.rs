//! From cubics to shaded light: pieces are cut at the knots and where a light changes sides, and halved until their proven
//! error is what they may make.

use super::function::Function;
use super::light::{LIGHTS, Lighting, Lights, Seen, along_light};
use super::pieces::{Next, Run, Runs, load_fields, put};
use super::queue::{Results, Shown, Way};
use super::shaded::Estimate;
use super::voxels::Voxels;
use super::walk::{RAYS, STEPS};
use crate::field::Voxel;
use crate::integrate::exact::piece::Integral;
use crate::math::bernstein::{Cubic, restrict, trilinear_along};
use crate::math::each;
use crate::simd::{Lanes, Mask, Pairs};

/// A piece is not made shorter than this fraction of a cell; what it then costs is charged to the bound.
const SMALLEST_PIECE: f64 = 1.0 / 65536.0;

/// Attempts at the pieces between two cuts, after which a cell is left to the twin.
const MOST_ATTEMPTS: usize = 300;

/// What pieces may cost: so much of what they absorb, and by seat so much per mm, and so much per cell of what earlier ones
/// left.
#[derive(Debug, Clone)]
pub(super) struct Allowance {
    pub(super) by_absorption: f32,
    /// To be shared out along each ray by length.
    per_ray: f64,
    pub(super) per_mm: [f32; RAYS],
    pub(super) per_cell: [f32; RAYS],
    /// By seat, the variance of what a piece may miss, over what it absorbs.
    pub(super) variance: [f32; RAYS],
    /// By seat, the square of what a piece may miss at most, where it may miss as much by its share of the variance.
    pub(super) largest_square: [f32; RAYS],
}

/// What is allowed behind less light than this is as if so much were left, so that f32 holds it: of rays that do not end early.
const FAINTEST: f64 = 1e-12;

/// The share of the light that pieces may absorb before they may miss less than their share of the variance.
const LARGEST: f64 = 0.02;

impl Allowance {
    /// Of [`Budget::of_pieces`](crate::integrate::exact::budget::Budget::of_pieces).
    pub(super) fn new([by_absorption, per_ray]: [f64; 2]) -> Self {
        let by_absorption = by_absorption as f32;
        let none = [0.0; RAYS];
        Allowance { by_absorption, per_ray, per_mm: none, per_cell: none, variance: none, largest_square: none }
    }

    /// Shares out what may be spent behind this transmittance on a ray of 1 / `per_length_mm`, and what earlier pieces `left`. What is
    /// behind counts the less the less light gets there.
    #[inline(always)]
    pub(super) fn share(
        &mut self,
        seat: usize,
        transmittance: f64,
        per_length_mm: f64,
        left: f64,
        estimate: Option<Estimate>,
    ) {
        let counts = 1.0 / transmittance.max(FAINTEST);
        self.per_mm[seat] = (self.per_ray * per_length_mm * counts) as f32;
        self.per_cell[seat] = (left.max(0.0) * counts * (1.0 / STEPS as f64)) as f32;
        if let Some(estimate) = estimate {
            let variance = estimate.variance() * counts;
            self.variance[seat] = variance as f32;
            self.largest_square[seat] = (LARGEST * variance * counts) as f32;
        }
    }
}

/// What is the same for all cells of a round.
pub(super) struct Scenery<'s, 'v, V> {
    pub(super) voxels: &'s Voxels<'v, V>,
    pub(super) lighting: &'s Lighting,
    pub(super) seen: &'s Seen,
    pub(super) allowance: &'s Allowance,
    pub(super) harm_per_mm: f32,
}

/// What lanes have besides their fields.
struct Cells<L> {
    gradient: [Cubic<L>; 3],
    lights: Lights<L>,
    allowed_per_mm: L,
    allowed_per_cell: L,
}

impl<V: Voxel + Pairs> Scenery<'_, '_, V> {
    /// Reads the gradients of cells, and how their rays see the lights.
    #[inline(always)]
    fn cells<L: Lanes>(&self, way: &Way<L>, seat: L::Ints) -> Cells<L> {
        let corners = self.voxels.corners::<L>(way.base);
        let gradients = self.voxels.gradients(&self.voxels.corners_at::<L>(way.base), &corners);
        Cells {
            gradient: each(
                #[inline(always)]
                |a| trilinear_along(&gradients[a], way.from, way.to),
            ),
            lights: self.seen.lights(self.lighting, seat),
            allowed_per_mm: L::pick32(&self.allowance.per_mm, seat),
            allowed_per_cell: L::pick32(&self.allowance.per_cell, seat),
        }
    }
}

/// Integrates shaded cells.
#[inline(always)]
pub(super) fn lit<L: Lanes, V: Voxel + Pairs, const F: usize>(
    shown: &Shown<F>,
    function: &impl Function<F>,
    scenery: &Scenery<'_, '_, V>,
    results: &mut Results,
) {
    let lighting = scenery.lighting;
    for first in (0..shown.count).step_by(L::LANES) {
        let fields = load_fields::<L, F>(shown, first);
        let length_mm = L::load(&shown.length_mm[first..]);
        let harm = L::from_f64(f64::from(scenery.harm_per_mm)) * length_mm;
        let is_cell = shown.are_cells::<L>(first);
        let cells = scenery.cells::<L>(&shown.way.load(first), shown.seats::<L>(first));
        let mut runs = Runs::new(&fields, function);
        let mut sides: [Run<L>; LIGHTS] = each(
            #[inline(always)]
            |n| Run::new(along_light(&cells.gradient, &cells.lights.towards[n]), &lighting.side),
        );
        let mut sum = Sum::new();
        let (mut from, mut stuck) = (L::ZERO, is_cell.and_not(is_cell));
        loop {
            let open = is_cell.and(from.lt(L::ONE));
            if !open.any() {
                break;
            }
            let part = runs.part(function, from);
            let mut to = part.to;
            let mut turns: [Option<Next<L>>; LIGHTS] = [None; LIGHTS];
            for n in 0..lighting.lights() {
                let turn = sides[n].next(&lighting.side, from);
                to = to.min(turn.to);
                turns[n] = Some(turn);
            }
            let ends = [from, to];
            stuck = stuck.or(sum.pass(function, part.interval, &fields, &cells, scenery, length_mm, open, ends));
            runs.advance(function, &part, to, open, harm);
            for (side, turn) in sides.iter_mut().zip(&turns) {
                if let Some(turn) = turn {
                    side.advance(turn, to);
                }
            }
            from = to;
        }
        let error = L::select(stuck, L::from_f64(f64::INFINITY), sum.total.error);
        sum.total.error = runs.checked(error);
        put(results, shown, first, &sum.total, None, Some(sum.pieces));
    }
}

/// What the pieces of cells add up to.
struct Sum<L> {
    total: Integral<L>,
    transmittance: L,
    pieces: L,
}

impl<L: Lanes> Sum<L> {
    #[inline(always)]
    fn new() -> Self {
        Sum { total: Integral::nothing(), transmittance: L::ONE, pieces: L::ZERO }
    }

    /// Passes the part between two cuts, in pieces as long as their errors allow. Says which lanes do not get on.
    #[expect(clippy::too_many_arguments, reason = "a part, what is on it, and what it may cost")]
    #[inline(always)]
    fn pass<V: Voxel + Pairs, const F: usize>(
        &mut self,
        function: &impl Function<F>,
        interval: [L::Ints; F],
        fields: &[Cubic<L>; F],
        cells: &Cells<L>,
        scenery: &Scenery<'_, '_, V>,
        length_mm: L,
        open: L::Mask,
        [start, end]: [L; 2],
    ) -> L::Mask {
        let by_absorption = L::from_f64(f64::from(scenery.allowance.by_absorption));
        let (mut from, mut to) = (start, end);
        for _ in 0..MOST_ATTEMPTS {
            let under_way = open.and(from.lt(end));
            if !under_way.any() {
                return under_way;
            }
            let mut parts = *fields;
            for f in 0..F {
                parts[f] = restrict(&fields[f], from, to);
            }
            let gradient: [Cubic<L>; 3] = each(
                #[inline(always)]
                |a| restrict(&cells.gradient[a], from, to),
            );
            let shaded = scenery.lighting.shaded(&gradient, &cells.lights);
            let length = to - from;
            let piece_mm = length_mm * length;
            let piece = function.integrate(interval, &parts, piece_mm, &shaded);
            let allowed =
                by_absorption * piece.absorbed + cells.allowed_per_mm * piece_mm + cells.allowed_per_cell * length;
            let accepted = piece.error.le(allowed).or(length.le(L::from_f64(SMALLEST_PIECE)));
            let counts = under_way.and(accepted);
            let t = L::select(counts, self.transmittance, L::ZERO);
            for c in 0..3 {
                self.total.radiance[c] = t.mul_plus(piece.radiance[c], self.total.radiance[c]);
            }
            self.total.error = t.mul_plus(piece.error, self.total.error);
            self.total.absorbed = t.mul_plus(piece.absorbed, self.total.absorbed);
            self.transmittance = self.transmittance.minus_product(t, piece.absorbed);
            self.pieces += L::select(under_way, L::ONE, L::ZERO);
            from = L::select(counts, to, from);
            // The error falls with the cube of the length, what is allowed with the length. The next piece probably fares like
            // the last one, but is not left a sliver.
            let share = (allowed / piece.error).max(L::ZERO).sqrt() * L::from_f64(0.9);
            let shrunk = length * share.max(L::from_f64(0.05)).min(L::from_f64(0.5));
            let grown = L::select(accepted, length * L::from_f64(1.5), shrunk);
            to = L::select((end - from).le(grown), end, from + grown);
        }
        open.and(from.lt(end))
    }
}
