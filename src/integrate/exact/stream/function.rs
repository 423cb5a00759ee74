//! Transfer functions for lanes: polynomials of the fields along a piece, and where there is nothing.

use super::axis::Axis;
use super::light::Finish;
use crate::classify::{OneD, TwoD};
use crate::integrate::exact::linear::{self, Linear};
use crate::integrate::exact::piece::{Integral, Optics};
use crate::math::bernstein::{Cubic, elevate, product};
use crate::math::each;
use crate::simd::{Ints, Lanes, Mask, Table, Tables};

/// Components of emission and extinction.
const COMPONENTS: usize = 4;

/// A transfer function of `F` fields: the value, and the gradient magnitude where `F` is 2.
pub(in crate::integrate::exact) trait Function<const F: usize>: Sync {
    /// The axis of a field.
    fn axis(&self, field: usize) -> &Axis;

    /// In which lanes nothing absorbs or emits for values in a range, whatever else there is.
    fn is_dark<L: Lanes>(&self, low: L, high: L) -> L::Mask;

    /// In which lanes nothing absorbs or emits for all fields in intervals from `first` to `last`.
    fn is_empty<L: Lanes>(&self, first: [L::Ints; F], last: [L::Ints; F]) -> L::Mask;

    /// The intervals that the fields' ranges of values reach.
    #[inline(always)]
    fn intervals<L: Lanes>(&self, ranges: &[[L; 2]; F]) -> Intervals<L, F> {
        let (mut first, mut last) = ([L::Ints::splat(0); F], [L::Ints::splat(0); F]);
        let mut knots = L::Ints::splat(0);
        for f in 0..F {
            [first[f], last[f]] = self.axis(f).intervals_of(ranges[f]);
            knots = knots + (last[f] - first[f]);
        }
        let (no, one) = (knots.eq(L::Ints::splat(0)), knots.eq(L::Ints::splat(1)));
        Intervals { first, stay: no, one_knot: one, are_empty: self.is_empty::<L>(first, last) }
    }

    /// The integral over a piece on which each field stays in one interval.
    fn integrate<L: Lanes>(
        &self,
        interval: [L::Ints; F],
        fields: &[Cubic<L>; F],
        length_mm: L,
        finish: &impl Finish<L>,
    ) -> Integral<L>;
}

/// Where ranges of fields lie on their axes.
pub(in crate::integrate::exact) struct Intervals<L: Lanes, const F: usize> {
    /// The interval of each range's lower end.
    pub(super) first: [L::Ints; F],
    /// In which lanes no range reaches beyond that, and in which one reaches beyond one knot.
    pub(super) stay: L::Mask,
    pub(super) one_knot: L::Mask,
    /// In which nothing absorbs or emits.
    pub(super) are_empty: L::Mask,
}

/// A function of the value alone.
#[derive(Debug, Clone)]
pub(in crate::integrate::exact) struct OfValue {
    axis: Axis,
    /// By interval, where its function is anchored, `α` and `β`, and of [`Linear`]'s `κ` those of the colours and the largest.
    linear: Tables<13>,
    /// Lit intervals below each.
    lit_before: Table,
    /// The first lit interval and the last, their values, and whether there are dark ones between.
    lit_intervals: [i32; 2],
    lit: [f32; 2],
    has_gaps: bool,
}

impl OfValue {
    /// For pictures within a tolerance.
    pub(in crate::integrate::exact) fn new(function: &OneD<f32>, tolerance: f64) -> Self {
        let axis = Axis::new(function.axis(), tolerance);
        let knots = function.axis().knots();
        let last = knots.len() - 2;
        // Beyond the ends the function is constant.
        let pieces: Vec<[[f32; 2]; COMPONENTS]> = (0..axis.intervals())
            .map(|i| {
                let piece = function.piece(i.saturating_sub(1).min(last));
                each(
                    #[inline(always)]
                    |c| match i {
                        0 => [piece.low[c], 0.0],
                        i if i > last + 1 => [piece.low[c] + piece.slope[c] * (knots[last + 1] - knots[last]), 0.0],
                        _ => [piece.low[c], piece.slope[c]],
                    },
                )
            })
            .collect();
        let linear = |(i, piece): (usize, &[[f32; 2]; COMPONENTS])| {
            let (low, slope): ([f32; 4], [f32; 4]) = (each(|c| piece[c][0]), each(|c| piece[c][1]));
            let ([red, green, blue], largest) = linear::drift(&low, &slope);
            let mut all = [axis.anchor_of(i); 13];
            all[1..5].copy_from_slice(&low);
            all[5..9].copy_from_slice(&slope);
            all[9..].copy_from_slice(&[red, green, blue, largest]);
            all
        };
        let linear: Vec<[f32; 13]> = pieces.iter().enumerate().map(linear).collect();
        let is_lit: Vec<bool> = pieces.iter().map(|piece| piece.iter().flatten().any(|&x| x != 0.0)).collect();
        let mut lit_before = vec![0.0];
        for &lit in &is_lit {
            lit_before.push(lit_before[lit_before.len() - 1] + f32::from(u8::from(lit)));
        }
        let ends = is_lit.iter().position(|&lit| lit).zip(is_lit.iter().rposition(|&lit| lit));
        let lit = ends.map_or([f32::INFINITY; 2], |(first, last)| [axis.lower_end(first), axis.lower_end(last + 1)]);
        let lit_intervals = ends.map_or([i32::MAX, -1], |(first, last)| [first as i32, last as i32]);
        let has_gaps = ends.is_some_and(|(first, last)| is_lit[first..last].contains(&false));
        OfValue {
            axis,
            linear: Tables::new(&linear),
            lit_before: Table::new(&lit_before),
            lit_intervals,
            lit,
            has_gaps,
        }
    }
}

impl Function<1> for OfValue {
    fn axis(&self, _: usize) -> &Axis {
        &self.axis
    }

    #[inline(always)]
    fn is_dark<L: Lanes>(&self, low: L, high: L) -> L::Mask {
        let [first, last] = self.lit;
        let dark = high.lt(L::splat(first)).or(L::splat(last).le(low));
        if self.has_gaps {
            let [first, last] = self.axis.intervals_of([low, high]);
            dark.or(self.is_empty::<L>([first], [last]))
        } else {
            dark
        }
    }

    #[inline(always)]
    fn is_empty<L: Lanes>(&self, [first]: [L::Ints; 1], [last]: [L::Ints; 1]) -> L::Mask {
        if self.has_gaps {
            let before = L::pick(&self.lit_before, first);
            L::pick(&self.lit_before, last + L::Ints::splat(1)).le(before)
        } else {
            let [first_lit, last_lit] = self.lit_intervals;
            last.lt(L::Ints::splat(first_lit)).or(L::Ints::splat(last_lit).lt(first))
        }
    }

    #[inline(always)]
    fn intervals<L: Lanes>(&self, &[[low, high]]: &[[L; 2]; 1]) -> Intervals<L, 1> {
        let first = self.axis.interval(low);
        let [next, second]: [L::Mask; 2] = each(
            #[inline(always)]
            |n| high.lt(self.axis.end(first + L::Ints::splat(1 + n as i32))),
        );
        let are_empty = if self.has_gaps {
            self.is_empty::<L>([first], [self.axis.interval(high)])
        } else {
            self.is_dark(low, high)
        };
        Intervals { first: [first], stay: next, one_knot: second.and_not(next), are_empty }
    }

    #[inline(always)]
    fn integrate<L: Lanes>(
        &self,
        [i]: [L::Ints; 1],
        [value]: &[Cubic<L>; 1],
        length_mm: L,
        finish: &impl Finish<L>,
    ) -> Integral<L> {
        let [anchor, a, b, c, d, e, f, g, h, red, green, blue, largest_drift] = self.linear.pick::<L>(i);
        let (low, slope, drift) = ([a, b, c, d], [e, f, g, h], [red, green, blue]);
        let distance: Cubic<L> = each(
            #[inline(always)]
            |k| value[k] - anchor,
        );
        finish.finish_linear(&Linear { distance, low, slope, drift, largest_drift }, length_mm)
    }
}

/// A function of value and gradient magnitude.
#[derive(Debug, Clone)]
pub(in crate::integrate::exact) struct OfValueAndMagnitude {
    values: Axis,
    magnitudes: Axis,
    /// Per component: at the lower corner, by value, by magnitude, by both.
    patches: [[Table; 4]; COMPONENTS],
    /// Summed-area table of lit patches.
    lit_below: Table,
}

impl OfValueAndMagnitude {
    /// For pictures within a tolerance.
    pub(in crate::integrate::exact) fn new(function: &TwoD<f32>, tolerance: f64) -> Self {
        let axes = [function.values(), function.gradients()];
        let [values, magnitudes] = axes.map(|axis| Axis::new(axis, tolerance));
        let (nv, ng) = (values.intervals(), magnitudes.intervals());
        // Beyond the ends of an axis the function is constant along it: how far from the inner patch's lower end it is read.
        let outside = |axis: &crate::classify::Axis<f32>, i: usize| {
            let knots = axis.knots();
            let last = knots.len() - 2;
            match i {
                0 => (0, Some(0.0)),
                i if i > last + 1 => (last, Some(knots[last + 1] - knots[last])),
                _ => (i - 1, None),
            }
        };
        let mut patches = Vec::with_capacity(nv * ng);
        for j in 0..ng {
            let (g, g_outside) = outside(function.gradients(), j);
            for i in 0..nv {
                let (v, v_outside) = outside(function.values(), i);
                let patch = function.patch(v, g);
                let component = |c: usize| {
                    let mut terms = [patch.low[c], patch.by_value[c], patch.by_gradient[c], patch.by_both[c]];
                    if let Some(dv) = v_outside {
                        terms = [terms[0] + dv * terms[1], 0.0, terms[2] + dv * terms[3], 0.0];
                    }
                    if let Some(dg) = g_outside {
                        terms = [terms[0] + dg * terms[2], terms[1] + dg * terms[3], 0.0, 0.0];
                    }
                    terms
                };
                patches.push([component(0), component(1), component(2), component(3)]);
            }
        }
        let mut lit_below = vec![0.0f32; (nv + 1) * (ng + 1)];
        let at = |i: usize, j: usize| i + j * (nv + 1);
        for j in 0..ng {
            for i in 0..nv {
                let lit = patches[i + j * nv].iter().flatten().any(|&x: &f32| x != 0.0);
                lit_below[at(i + 1, j + 1)] =
                    lit_below[at(i, j + 1)] + lit_below[at(i + 1, j)] - lit_below[at(i, j)] + f32::from(u8::from(lit));
            }
        }
        let table = |c: usize, term: usize| Table::new(&patches.iter().map(|p| p[c][term]).collect::<Vec<f32>>());
        OfValueAndMagnitude {
            values,
            magnitudes,
            patches: std::array::from_fn(|c| std::array::from_fn(|term| table(c, term))),
            lit_below: Table::new(&lit_below),
        }
    }
}

/// `i + j · width` in lanes, where `j` is small.
#[inline(always)]
fn at<L: Lanes>(i: L::Ints, j: L::Ints, width: usize) -> L::Ints {
    // Exact as f32 numbers: tables have far fewer than 2^24 entries.
    (L::from_ints(j) * L::from_f64(width as f64) + L::from_ints(i)).to_ints()
}

impl Function<2> for OfValueAndMagnitude {
    fn axis(&self, field: usize) -> &Axis {
        if field == 0 { &self.values } else { &self.magnitudes }
    }

    #[inline(always)]
    fn is_dark<L: Lanes>(&self, low: L, high: L) -> L::Mask {
        let steepest = L::Ints::splat(self.magnitudes.intervals() as i32 - 1);
        let [first, last] = self.values.intervals_of([low, high]);
        self.is_empty::<L>([first, L::Ints::splat(0)], [last, steepest])
    }

    #[inline(always)]
    fn is_empty<L: Lanes>(&self, [v0, g0]: [L::Ints; 2], [v1, g1]: [L::Ints; 2]) -> L::Mask {
        let one = L::Ints::splat(1);
        let (v1, g1) = (v1 + one, g1 + one);
        let [all, none, left, below]: [L; 4] = each(
            #[inline(always)]
            |n| {
                let (v, g) = [(v1, g1), (v0, g0), (v0, g1), (v1, g0)][n];
                L::pick(&self.lit_below, at::<L>(v, g, self.values.intervals() + 1))
            },
        );
        (all + none).le(left + below)
    }

    #[inline(always)]
    fn integrate<L: Lanes>(
        &self,
        [i, j]: [L::Ints; 2],
        [value, magnitude]: &[Cubic<L>; 2],
        length_mm: L,
        finish: &impl Finish<L>,
    ) -> Integral<L> {
        let (v_anchor, g_anchor) = (self.values.anchor::<L>(i), self.magnitudes.anchor::<L>(j));
        let dv: Cubic<L> = each(
            #[inline(always)]
            |k| value[k] - v_anchor,
        );
        let dg: Cubic<L> = each(
            #[inline(always)]
            |k| magnitude[k] - g_anchor,
        );
        let (v, m, vg) = (elevate(&dv), elevate(&dg), product(&dv, &dg));
        let patch = at::<L>(i, j, self.values.intervals());
        let [r, g, b, extinction]: [[L; 7]; 4] = each(
            #[inline(always)]
            |c| {
                let [low, by_value, by_magnitude, by_both] = &self.patches[c];
                let (low, by_value) = (L::pick(low, patch), L::pick(by_value, patch));
                let (by_magnitude, by_both) = (L::pick(by_magnitude, patch), L::pick(by_both, patch));
                each(
                    #[inline(always)]
                    |k| by_both.mul_plus(vg[k], by_magnitude.mul_plus(m[k], by_value.mul_plus(v[k], low))),
                )
            },
        );
        finish.finish::<7, 8>(&Optics { emission: [r, g, b], extinction }, length_mm)
    }
}
