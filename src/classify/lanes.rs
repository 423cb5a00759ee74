//! Baked transfer functions as tables that many samples are looked up in at a time.

use super::{Axis, Bilinear, Linear, OneD, Rgbs, TwoD};
use crate::math::each;
use crate::simd::{BATCH, Ints, Lanes, Mask, Table};

/// Looks up a transfer function for many samples at a time; each as [`Classifier::classify`](super::Classifier::classify) does
/// for one.
pub(crate) trait LaneClassifier: Sync {
    /// Emission and extinction for stored values and gradient magnitudes in HU/mm, which are computed where they matter;
    /// `None` if nothing absorbs or emits in any lane.
    fn classify_lanes<L: Lanes>(&self, stored: L, gradients_per_mm: impl FnOnce() -> L) -> Option<Rgbs<L>>;
}

/// A number for each interval or patch.
#[derive(Debug, Clone)]
struct Column {
    /// The first ones, in a register.
    few: [f32; BATCH],
    all: Table,
}

impl Column {
    fn new(numbers: impl Iterator<Item = f32>) -> Self {
        let numbers: Vec<f32> = numbers.collect();
        let last = numbers[numbers.len() - 1];
        Column { few: each(|k| *numbers.get(k).unwrap_or(&last)), all: Table::new(&numbers) }
    }

    /// The numbers of these intervals; if they are few, of the first ones.
    #[inline(always)]
    fn pick<L: Lanes, const FEW: bool>(&self, at: L::Ints) -> L {
        if FEW { L::pick16(&self.few, at) } else { L::pick(&self.all, at) }
    }
}

/// One column per component.
fn columns<'t, T: 't>(all: &'t [T], part: impl Fn(&'t T) -> &'t Rgbs<f32>) -> [Column; 4] {
    [0, 1, 2, 3].map(|c| Column::new(all.iter().map(|one| part(one)[c])))
}

/// An [`Axis`].
#[derive(Debug, Clone)]
struct Knots {
    ends: [f32; 2],
    /// All but the first and the last.
    inner: Vec<f32>,
    /// The lower knot of each interval, and infinity behind.
    lower: Column,
    /// The largest power of two of at most the number of intervals.
    halves: i32,
}

impl Knots {
    fn new(axis: &Axis<f32>) -> Self {
        let (knots, intervals) = (axis.knots(), axis.intervals());
        Knots {
            ends: [knots[0], knots[intervals]],
            inner: knots[1..intervals].to_vec(),
            lower: Column::new(knots[..intervals].iter().copied().chain([f32::INFINITY])),
            halves: 1 << intervals.ilog2(),
        }
    }

    fn are_few(&self) -> bool {
        self.inner.len() < BATCH
    }

    /// Numbers moved into the domain, the intervals that they are in, and their distances from the lower knots.
    #[inline(always)]
    fn locate<L: Lanes, const FEW: bool>(&self, x: L) -> (L::Ints, L) {
        let x = x.max(L::splat(self.ends[0])).min(L::splat(self.ends[1]));
        let mut at = L::Ints::splat(0);
        if FEW {
            for &knot in &self.inner {
                let beyond = L::splat(knot).le(x);
                at = L::Ints::select(beyond, at + L::Ints::splat(1), at);
            }
        } else {
            let mut half = self.halves;
            while half > 0 {
                let further = at + L::Ints::splat(half);
                at = L::Ints::select(self.lower.pick::<L, false>(further).le(x), further, at);
                half >>= 1;
            }
        }
        (at, x - self.lower.pick::<L, FEW>(at))
    }
}

/// [`OneD`] as columns.
#[derive(Debug, Clone)]
pub(crate) struct OneDColumns {
    knots: Knots,
    low: [Column; 4],
    slope: [Column; 4],
    /// 1 where something absorbs or emits.
    lit: Column,
}

impl OneDColumns {
    pub(crate) fn new(function: &OneD<f32>) -> Self {
        let intervals = function.axis().intervals();
        let pieces: Vec<Linear<f32>> = (0..intervals).map(|i| *function.piece(i)).collect();
        OneDColumns {
            knots: Knots::new(function.axis()),
            low: columns(&pieces, |piece| &piece.low),
            slope: columns(&pieces, |piece| &piece.slope),
            lit: Column::new((0..intervals).map(|i| f32::from(u8::from(!function.are_empty(i, i))))),
        }
    }

    #[inline(always)]
    fn classify<L: Lanes, const FEW: bool>(&self, stored: L) -> Option<Rgbs<L>> {
        let (at, dx) = self.knots.locate::<L, FEW>(stored);
        if !L::ZERO.lt(self.lit.pick::<L, FEW>(at)).any() {
            return None;
        }
        let mut optics = [L::ZERO; 4];
        for c in 0..4 {
            optics[c] = self.slope[c].pick::<L, FEW>(at).mul_plus(dx, self.low[c].pick::<L, FEW>(at));
        }
        Some(optics)
    }
}

impl LaneClassifier for OneDColumns {
    #[inline(always)]
    fn classify_lanes<L: Lanes>(&self, stored: L, _: impl FnOnce() -> L) -> Option<Rgbs<L>> {
        if self.knots.are_few() { self.classify::<L, true>(stored) } else { self.classify::<L, false>(stored) }
    }
}

/// [`TwoD`] as columns.
#[derive(Debug, Clone)]
pub(crate) struct TwoDColumns {
    values: Knots,
    gradients: Knots,
    low: [Column; 4],
    by_value: [Column; 4],
    by_gradient: [Column; 4],
    by_both: [Column; 4],
    /// By interval of values: 1 where something absorbs or emits at some gradient magnitude.
    lit: Column,
}

impl TwoDColumns {
    pub(crate) fn new(function: &TwoD<f32>) -> Self {
        let (values, gradients) = (function.values().intervals(), function.gradients().intervals());
        let at = |j: usize| (0..values).map(move |i| *function.patch(i, j));
        let patches: Vec<Bilinear<f32>> = (0..gradients).flat_map(at).collect();
        let is_lit = |i: usize| !function.are_empty([i, i], [0, gradients - 1]);
        TwoDColumns {
            values: Knots::new(function.values()),
            gradients: Knots::new(function.gradients()),
            low: columns(&patches, |patch| &patch.low),
            by_value: columns(&patches, |patch| &patch.by_value),
            by_gradient: columns(&patches, |patch| &patch.by_gradient),
            by_both: columns(&patches, |patch| &patch.by_both),
            lit: Column::new((0..values).map(|i| f32::from(u8::from(is_lit(i))))),
        }
    }

    #[inline(always)]
    fn classify<L: Lanes, const FEW: bool>(&self, stored: L, gradients_per_mm: impl FnOnce() -> L) -> Option<Rgbs<L>> {
        let (i, dv) = self.values.locate::<L, FEW>(stored);
        if !L::ZERO.lt(self.lit.pick::<L, FEW>(i)).any() {
            return None;
        }
        let (j, dg) = self.gradients.locate::<L, FEW>(gradients_per_mm());
        let at = i + j * L::Ints::splat(self.values.inner.len() as i32 + 1);
        let mut optics = [L::ZERO; 4];
        for c in 0..4 {
            let (low, by_value) = (self.low[c].pick::<L, false>(at), self.by_value[c].pick::<L, false>(at));
            let (by_gradient, by_both) =
                (self.by_gradient[c].pick::<L, false>(at), self.by_both[c].pick::<L, false>(at));
            let across = by_value.mul_plus(dv, low);
            optics[c] = by_both.mul_plus(dv, by_gradient).mul_plus(dg, across);
        }
        Some(optics)
    }
}

impl LaneClassifier for TwoDColumns {
    #[inline(always)]
    fn classify_lanes<L: Lanes>(&self, stored: L, gradients_per_mm: impl FnOnce() -> L) -> Option<Rgbs<L>> {
        if self.values.are_few() && self.gradients.are_few() {
            self.classify::<L, true>(stored, gradients_per_mm)
        } else {
            self.classify::<L, false>(stored, gradients_per_mm)
        }
    }
}
