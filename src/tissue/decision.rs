//! Which tissue a voxel belongs to, from its memberships.

use crate::plan::Tissue;
use crate::transfer::{Side, TransferFunction, Weight};

/// Least membership of a voxel in the tissue it belongs to.
pub const THRESHOLD: f64 = 0.5;

/// Memberships that differ by less are equal: a ramp of whole numbers has its middle at a voxel's value, and rounding must
/// not decide there.
const EQUAL: f64 = 1e-9;

/// The tissue of a voxel with these memberships, counted from 1; 0 for none. The definition is in the [module](super).
pub(super) fn decide(memberships: &[f64], peaks_per_mm: &[f64]) -> u8 {
    let mut best: Option<usize> = None;
    for (t, &m) in memberships.iter().enumerate().filter(|(_, m)| **m >= THRESHOLD - EQUAL) {
        let wins = best.is_none_or(|b| {
            let ahead = m - memberships[b];
            ahead > EQUAL || (ahead >= -EQUAL && peaks_per_mm[t] > peaks_per_mm[b])
        });
        if wins {
            best = Some(t);
        }
    }
    // A classification has at most 255 tissues.
    best.map_or(0, |t| (t + 1) as u8)
}

/// What is known of a voxel from its value alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByValue {
    /// The tissue, whatever the gradient; 0 for none.
    Settled(u8),
    /// The gradient decides.
    Open,
}

/// Memberships as `Σ curve(v) · weight(g)`, flat, so that the curves can be tabulated by value.
pub(super) struct Functions<'a> {
    /// For each term: its tissue, its membership function and its place there.
    terms: Vec<(usize, &'a TransferFunction, usize)>,
    peaks_per_mm: Vec<f64>,
}

impl<'a> Functions<'a> {
    pub(super) fn new(tissues: &'a [Tissue]) -> Self {
        let terms = tissues.iter().enumerate().flat_map(|(t, tissue)| {
            let function = tissue.membership_function();
            (0..function.terms().len()).map(move |n| (t, function, n))
        });
        Functions { terms: terms.collect(), peaks_per_mm: tissues.iter().map(|t| t.peak_extinction_per_mm).collect() }
    }

    /// Number of terms of all tissues.
    pub(super) fn len(&self) -> usize {
        self.terms.len()
    }

    /// Number of tissues.
    pub(super) fn tissues(&self) -> usize {
        self.peaks_per_mm.len()
    }

    /// The curves of all terms at a value.
    pub(super) fn curves_at(&self, value: f64, curves: &mut [f64]) {
        for ((_, function, n), curve) in self.terms.iter().zip(curves) {
            let [low, high] = function.window();
            let side = if value >= high { Side::Left } else { Side::Right };
            *curve = function.terms()[*n].curve.at(value.clamp(low, high), side).extinction_per_mm;
        }
    }

    /// What these curves settle.
    pub(super) fn by_value(&self, curves: &[f64]) -> ByValue {
        let mut most = vec![0.0; self.peaks_per_mm.len()];
        let mut open = false;
        for ((t, function, n), curve) in self.terms.iter().zip(curves) {
            let weight = function.terms()[*n].weight.as_ref();
            most[*t] += curve * weight.map_or(1.0, largest);
            open |= *curve > 0.0 && weight.is_some();
        }
        if most.iter().all(|m| *m < THRESHOLD - EQUAL) {
            return ByValue::Settled(0);
        }
        if open { ByValue::Open } else { ByValue::Settled(decide(&most, &self.peaks_per_mm)) }
    }

    /// The tissue for these curves at a gradient magnitude; `memberships` has one place for each tissue.
    pub(super) fn decide(&self, curves: &[f64], gradient_per_mm: f64, memberships: &mut [f64]) -> u8 {
        memberships.fill(0.0);
        for ((t, function, n), curve) in self.terms.iter().zip(curves).filter(|(_, curve)| **curve > 0.0) {
            let range = function.gradient_range_per_mm();
            let side = if gradient_per_mm >= range { Side::Left } else { Side::Right };
            let weight = function.terms()[*n].weight.as_ref();
            memberships[*t] += curve * weight.map_or(1.0, |w| w.at(gradient_per_mm.clamp(0.0, range), side));
        }
        decide(memberships, &self.peaks_per_mm)
    }
}

fn largest(weight: &Weight) -> f64 {
    weight.knots().iter().map(|[_, w]| *w).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_membership_has_it_then_the_denser_then_the_first() {
        for (memberships, peaks, expected, why) in [
            ([0.9, 0.6], [0.1, 9.0], 1, "membership comes before density"),
            ([1.0, 1.0], [0.1, 9.0], 2, "the denser of equals"),
            ([1.0, 1.0], [0.3, 0.3], 1, "the first of those still equal"),
            ([0.5, 0.2], [0.3, 0.3], 1, "half is enough"),
            ([0.5 - 1e-12, 0.0], [0.3, 0.3], 1, "half within rounding is enough"),
            ([0.49, 0.49], [0.3, 0.3], 0, "two halves that are none do not add up"),
        ] {
            assert_eq!(decide(&memberships, &peaks), expected, "{why}: {memberships:?} of peaks {peaks:?}");
        }
    }
}
