//! From cubics to light: cuts cells at the knots, and integrates.

use super::axis::Axis;
use super::crossing::{Beginnings, Crossing, Taken};
use super::function::Function;
use super::known::Find;
use super::levels::{Between, critical_points, crossing};
use super::light::AsItIs;
use super::look::ROUNDINGS;
use super::queue::{Results, Shown};
use crate::integrate::exact::piece::Integral;
use crate::math::bernstein::{Cubic, range};
use crate::math::each;
use crate::math::powers::{self, Powers};
use crate::simd::{Ints, Lanes, Mask, Table};

/// A piece is not made shorter than this fraction of a cell; what it then costs the ray's budget may refuse.
const SMALLEST_PIECE: f64 = 1.0 / 256.0;

/// What a piece may cost is its share of the ray's account times this. Most pieces leave nearly all of theirs unspent, so the account,
/// which `front` keeps, hardly ever refuses a piece that takes more.
const OVERDRAFT: f64 = 1.4;

/// What the error of a piece may be: a share of what it absorbs, and one of its length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Allowed {
    by_absorption: f64,
    per_mm: f64,
}

impl Allowed {
    /// For rays of at most `longest_mm`; `by_absorption` and `by_length` are shares of a tolerance.
    pub(super) fn new([by_absorption, by_length]: [f64; 2], longest_mm: f64) -> Self {
        Allowed { by_absorption: OVERDRAFT * by_absorption, per_mm: by_length / longest_mm }
    }

    /// What a piece may cost.
    #[inline(always)]
    fn of<L: Lanes>(&self, piece: &Integral<L>, length_mm: L) -> L {
        L::from_f64(self.by_absorption).mul_plus(piece.absorbed, L::from_f64(self.per_mm) * length_mm)
    }
}

/// Integrates cells of which the pieces are known. Those of which these are not enough go to `cut`.
#[inline(always)]
pub(super) fn known<L: Lanes, P: Find<F, N>, const F: usize, const N: usize>(
    shown: &Shown<F>,
    function: &impl Function<F>,
    allowed: &Allowed,
    cut: &mut Shown<F>,
    results: &mut Results,
) {
    for first in (0..shown.count).step_by(L::LANES) {
        let (is_cell, fields) = (shown.are_cells::<L>(first), load_fields::<L, F>(shown, first));
        let length_mm = L::load(&shown.length_mm[first..]);
        let known = P::find(function, fields, load_intervals::<L, F>(shown, first), is_cell);
        let mut fits = known.are_known;
        let mut total = Integral::nothing();
        for n in 0..N {
            let [from, to] = known.ends[n];
            let piece_mm = length_mm * (to - from);
            let piece = function.integrate(known.interval[n], &known.fields[n], piece_mm, &AsItIs);
            fits = fits.and(piece.error.le(allowed.of(&piece, piece_mm)));
            total = if n == 0 { piece } else { total.followed_by(&piece) };
        }
        put(results, shown, first, &total, None, None);
        cut.append(is_cell.and_not(fits), L::Ints::load(&shown.slot[first..]), &fields, None, length_mm, None);
    }
}

/// Cuts cells where a field crosses a knot, and integrates the pieces, in parts where one would miss too much. A cut across a jump
/// that is misplaced by `u` of a cell's length does `harm_per_mm` times that length of what may be tolerated; where rounding may do
/// so, the error is infinite.
#[inline(always)]
pub(super) fn cut<L: Lanes, const F: usize>(
    shown: &Shown<F>,
    function: &impl Function<F>,
    harm_per_mm: f32,
    allowed: &Allowed,
    beginnings: &mut Beginnings<F>,
    results: &mut Results,
) {
    beginnings.prepare::<L>(shown, function);
    let harm_per_mm = L::from_f64(f64::from(harm_per_mm));
    let mut cells = Crossing::<L, F>::new();
    // How far the next piece may reach.
    let mut reach = L::ONE;
    loop {
        let open = cells.attend(
            shown,
            beginnings,
            false,
            results,
            #[inline(always)]
            |taken| reach = taken.all(L::ONE, reach),
        );
        if !open.any() {
            break;
        }
        let from = cells.from;
        let part = cells.runs.part(function, from);
        let mut to = part.to.min(reach);
        let along = cells.runs.fields(from, to);
        let mut length = to - from;
        let piece_mm = cells.length_mm * length;
        let mut piece = function.integrate(part.interval, &along, piece_mm, &AsItIs);
        let most = allowed.of(&piece, piece_mm);
        let refused = open.and_not(piece.error.le(most).or(length.le(L::from_f64(SMALLEST_PIECE))));
        reach = L::ONE;
        if refused.any() {
            // The error falls with the cube of the length, what is allowed with the length.
            let share = (most / piece.error).max(L::ZERO).sqrt() * L::from_f64(0.9);
            length = length * share.max(L::from_f64(0.05)).min(L::from_f64(0.5));
            reach = L::select(refused, from + length, reach);
            to = L::select(refused, from, to);
            piece.forget(refused);
        }
        cells.add(&piece, cells.transmittance);
        cells.pass(&piece, open, to);
        cells.runs.advance(function, &part, to, open, harm_per_mm * cells.length_mm);
    }
}

#[inline(always)]
pub(super) fn load_fields<L: Lanes, const F: usize>(shown: &Shown<F>, first: usize) -> [Cubic<L>; F] {
    each(
        #[inline(always)]
        |f| {
            each(
                #[inline(always)]
                |k| L::load(&shown.fields[f][k][first..]),
            )
        },
    )
}

#[inline(always)]
pub(super) fn load_intervals<L: Lanes, const F: usize>(shown: &Shown<F>, first: usize) -> [L::Ints; F] {
    each(
        #[inline(always)]
        |f| L::Ints::load(&shown.interval[f][first..]),
    )
}

#[inline(always)]
pub(super) fn put<L: Lanes, const F: usize>(
    results: &mut Results,
    shown: &Shown<F>,
    first: usize,
    integral: &Integral<L>,
    variance: Option<L>,
    pieces: Option<L>,
) {
    results.put(shown.are_cells::<L>(first), &shown.slot[first..], integral, variance, pieces);
}

/// A field on its way through a cell: from one critical point to the next it is monotone, and passes its intervals in order.
#[derive(Clone, Copy)]
pub(super) struct Run<L: Lanes> {
    powers: Powers<L>,
    /// Critical points, ascending; 1 where there is none.
    critical: [L; 2],
    /// The value where the cell has been passed to.
    at: L,
    pub(super) interval: L::Ints,
    rounding: L,
}

/// Where a field's interval, or its direction, next changes.
#[derive(Clone, Copy)]
pub(super) struct Next<L: Lanes> {
    pub(super) to: L,
    /// The value there.
    value: L,
    crosses: L::Mask,
    rises: L::Mask,
    /// The end of the interval that it makes for.
    end: L::Ints,
}

/// The fields of cells on their way.
pub(super) struct Runs<L: Lanes, const F: usize> {
    runs: [Run<L>; F],
    /// Cells in which rounding may have misplaced a cut.
    misplaced: L::Mask,
}

/// A part of cells in which every field stays in an interval, and rises or falls.
pub(super) struct Part<L: Lanes, const F: usize> {
    next: [Next<L>; F],
    /// Where it ends.
    pub(super) to: L,
    pub(super) interval: [L::Ints; F],
}

impl<L: Lanes, const F: usize> Runs<L, F> {
    /// Of no cells.
    #[inline(always)]
    pub(super) fn nowhere() -> Self {
        let run = Run {
            powers: [L::ZERO; 4],
            critical: [L::ONE; 2],
            at: L::ZERO,
            interval: L::Ints::splat(0),
            rounding: L::ZERO,
        };
        Runs { runs: [run; F], misplaced: L::ONE.lt(L::ZERO) }
    }

    /// Those of cells that have taken a lane, at their beginnings.
    #[inline(always)]
    pub(super) fn seat(&mut self, rows: &Beginnings<F>, taken: &Taken<L>) {
        for (f, run) in self.runs.iter_mut().enumerate() {
            taken.powers(&rows.powers[f], &mut run.powers);
            for k in 0..2 {
                run.critical[k] = taken.numbers(&rows.critical[f][k], run.critical[k]);
            }
            run.at = taken.numbers(&rows.powers[f][0], run.at);
            run.interval = taken.ints(&rows.interval[f], run.interval);
            run.rounding = taken.numbers(&rows.rounding[f], run.rounding);
        }
        self.misplaced = taken.none(self.misplaced);
    }

    /// At their beginnings, from cell number `first` on.
    #[inline(always)]
    pub(super) fn store(&self, rows: &mut Beginnings<F>, first: usize) {
        for (f, run) in self.runs.iter().enumerate() {
            for k in 0..4 {
                run.powers[k].store(&mut rows.powers[f][k][first..]);
            }
            for k in 0..2 {
                run.critical[k].store(&mut rows.critical[f][k][first..]);
            }
            run.interval.store(&mut rows.interval[f][first..]);
            run.rounding.store(&mut rows.rounding[f][first..]);
        }
    }

    #[inline(always)]
    pub(super) fn new(fields: &[Cubic<L>; F], function: &impl Function<F>) -> Self {
        let runs = each(
            #[inline(always)]
            |f| Run::new(fields[f], function.axis(f)),
        );
        Runs { runs, misplaced: L::ONE.lt(L::ZERO) }
    }

    /// The fields, by powers.
    #[inline(always)]
    pub(super) fn powers(&self) -> [Powers<L>; F] {
        each(
            #[inline(always)]
            |f| self.runs[f].powers,
        )
    }

    /// The fields from one place to another.
    #[inline(always)]
    pub(super) fn fields(&self, from: L, to: L) -> [Cubic<L>; F] {
        each(
            #[inline(always)]
            |f| powers::restrict(&self.runs[f].powers, from, to),
        )
    }

    /// The part that begins at `from`.
    #[inline(always)]
    pub(super) fn part(&self, function: &impl Function<F>, from: L) -> Part<L, F> {
        let next: [Next<L>; F] = each(
            #[inline(always)]
            |f| self.runs[f].next(function.axis(f), from),
        );
        let mut part = Part { next, to: next[0].to, interval: [L::Ints::splat(0); F] };
        for f in 0..F {
            part.to = part.to.min(next[f].to);
            part.interval[f] = self.runs[f].interval;
        }
        part
    }

    /// Goes on to `to`, which is no further than the end of the part.
    #[inline(always)]
    pub(super) fn advance(&mut self, function: &impl Function<F>, part: &Part<L, F>, to: L, open: L::Mask, harm: L) {
        for f in 0..F {
            let misplaced = self.runs[f].is_misplaced(function.axis(f), &part.next[f], to, harm);
            self.misplaced = self.misplaced.or(open.and(misplaced));
            self.runs[f].advance(&part.next[f], to);
        }
    }

    /// An error that is infinite where cuts may be misplaced.
    #[inline(always)]
    pub(super) fn checked(&self, error: L) -> L {
        L::select(self.misplaced, L::from_f64(f64::INFINITY), error)
    }
}

impl<L: Lanes> Run<L> {
    #[inline(always)]
    pub(super) fn new(cubic: Cubic<L>, axis: &Axis) -> Self {
        let critical = critical_points(&cubic);
        let powers = powers::of(&cubic);
        let first_end = powers::value(&powers, critical[0]);
        let rises = cubic[0].le(first_end);
        let interval = L::Ints::select(rises, axis.interval(cubic[0]), axis.interval_below(cubic[0]));
        let [low, high] = range(&cubic);
        let rounding = L::from_f64(ROUNDINGS * f64::from(f32::EPSILON)) * low.abs().max(high.abs());
        Run { powers, critical, at: cubic[0], interval, rounding }
    }

    #[inline(always)]
    pub(super) fn next(&self, axis: &Axis, from: L) -> Next<L> {
        let [first, second] = self.critical;
        let turn = L::select(from.lt(first), first, L::select(from.lt(second), second, L::ONE));
        let there = powers::value(&self.powers, turn);
        let rises = self.at.le(there);
        let end = L::Ints::select(rises, self.interval + L::Ints::splat(1), self.interval);
        let level = axis.end::<L>(end);
        let crosses = L::Mask::or(rises.and(level.lt(there)), there.lt(level).and_not(rises));
        let crosses = crosses.and(from.lt(L::ONE));
        let mut to = turn;
        if crosses.any() {
            let between = Between { from, to: turn, at_from: self.at - level, at_to: there - level };
            let found = crossing(&self.powers, level, rises, crosses, &between, axis.precision());
            to = L::select(crosses, found, turn);
        }
        Next { to, value: L::select(crosses, level, there), crosses, rises, end }
    }

    /// Whether a cut at `to` is where a steep knot is crossed, or all but crossed, at an angle so flat that rounding matters.
    #[inline(always)]
    pub(super) fn is_misplaced(&self, axis: &Axis, next: &Next<L>, to: L, harm: L) -> L::Mask {
        let Some(steep) = axis.steep() else { return L::ONE.lt(L::ZERO) };
        let here = next.to.le(to);
        let flat = powers::slope(&self.powers, to).abs().lt(harm * self.rounding);
        let grazes = next.crosses.and(flat).and(is_steep::<L>(steep, next.end));
        // At a turn, either end of the interval may be touched.
        let turns = to.lt(L::ONE).and_not(next.crosses);
        let mut touches = here.and_not(here);
        for end in [self.interval, self.interval + L::Ints::splat(1)] {
            let near = (next.value - axis.end::<L>(end)).abs().le(self.rounding);
            touches = touches.or(turns.and(near).and(is_steep::<L>(steep, end)));
        }
        here.and(grazes.or(touches))
    }

    #[inline(always)]
    pub(super) fn advance(&mut self, next: &Next<L>, to: L) {
        let here = next.to.le(to);
        let crossed = here.and(next.crosses);
        let (up, down) = (self.interval + L::Ints::splat(1), self.interval - L::Ints::splat(1));
        self.interval = L::Ints::select(crossed, L::Ints::select(next.rises, up, down), self.interval);
        self.at = next.value;
        // Where another field ends the part.
        if <L::Mask as Mask>::ALL.and_not(here).any() {
            self.at = L::select(here, next.value, powers::value(&self.powers, to));
        }
    }
}

#[inline(always)]
fn is_steep<L: Lanes>(steep: &Table, end: L::Ints) -> L::Mask {
    L::ZERO.lt(L::pick(steep, end))
}
