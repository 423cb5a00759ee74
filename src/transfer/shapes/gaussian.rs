//! The Gaussian: a tissue by its mean and spread.

use super::{Expansion, Optics, Term, Weight, curve_of};
use crate::error::Result;

/// `exp(−(v − mean)²/2σ²)`, times the same along the gradient magnitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian {
    /// Mean and standard deviation of the value, HU; the deviation above 0.
    pub value: [f64; 2],
    /// Mean and standard deviation of the gradient magnitude, HU/mm; `None` for any.
    pub gradient_per_mm: Option<[f64; 2]>,
}

impl Gaussian {
    pub(super) fn ideal(&self, value: f64, gradient_per_mm: f64) -> f64 {
        bell(value, self.value) * self.gradient_per_mm.map_or(1.0, |g| bell(gradient_per_mm, g))
    }

    /// One product of two piecewise linear bells, each with its share of the deviation: both are at most 1, so the
    /// deviations add.
    pub(super) fn expand(&self, optics: Optics, max_deviation: f64) -> Result<Expansion> {
        let factors = if self.gradient_per_mm.is_some() { 2.0 } else { 1.0 };
        let share = max_deviation / factors;
        let curve = curve_of(bell_knots(self.value, share), optics)?;
        let weight = self.gradient_per_mm.map(|g| Weight::new(bell_knots(g, share).map(|(x, w)| [x, w]).collect()));
        Ok(Expansion { terms: vec![Term { curve, weight: weight.transpose()? }], max_deviation })
    }
}

fn bell(x: f64, [mean, deviation]: [f64; 2]) -> f64 {
    let z = (x - mean) / deviation;
    (-0.5 * z * z).exp()
}

/// Knots of a bell to within `share`: half of it for the tail that is cut off, half for the chords. The second derivative
/// is within ±1 in units of the deviation, so a chord over `h` is within `h²/8`.
fn bell_knots([mean, deviation]: [f64; 2], share: f64) -> impl Iterator<Item = (f64, f64)> {
    let cut = (2.0 * (2.0 / share).ln()).sqrt();
    let half = (cut / (2.0 * share.sqrt())).ceil();
    let count = 2 * half as usize;
    (0..=count).map(move |i| {
        let z = cut * (i as f64 / half - 1.0);
        let height = if i == 0 || i == count { 0.0 } else { (-0.5 * z * z).exp() };
        (mean + z * deviation, height)
    })
}
