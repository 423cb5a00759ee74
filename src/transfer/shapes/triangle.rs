//! The wedge: opacity along a boundary of even thickness, at any contrast.

use super::{Expansion, Optics, Term, Weight, curve_of, limit_rows};
use crate::error::Result;

/// A wedge over `|v − apex| ≤ opening · g` for gradient magnitudes `g` in a range.
///
/// With `x = |v − apex| / (opening · g)`, the distance in mm from the isosurface over the opening where the field is
/// linear, it is `min(1, (1 − x) / edge)`, and 0 from `x = 1` on. `edge = 1` is the isovalue contour of Levoy 1988,
/// equation 3; a smaller edge is the triangle widget of Kniss, Kindlmann and Hansen 2002.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Value of the apex, HU.
    pub apex: f64,
    /// Half width per gradient magnitude, mm, above 0.
    pub opening_mm: f64,
    /// Share of the half width over which it falls from 1 to 0, above 0 and at most 1.
    pub edge: f64,
    /// Lowest and highest gradient magnitude, HU/mm, the lowest above 0: at 0 the wedge is a point.
    pub gradient_per_mm: [f64; 2],
}

impl Triangle {
    pub(super) fn ideal(&self, value: f64, gradient_per_mm: f64) -> f64 {
        let [low, high] = self.gradient_per_mm;
        if gradient_per_mm < low || gradient_per_mm >= high {
            return 0.0;
        }
        let x = (value - self.apex).abs() / (self.opening_mm * gradient_per_mm);
        ((1.0 - x) / self.edge).clamp(0.0, 1.0)
    }

    /// Rows of gradient magnitudes in a geometric series of ratio ρ, exact on each row and linear in between.
    ///
    /// At a fixed value the shape rises with `g`, nowhere steeper than `L = 1 / (edge · g)`. A rising function with slopes
    /// in `[0, L]` is at most `L Δ / 4` from its chord over `Δ`: here `(ρ − 1) / (4 edge)` in every interval.
    pub(super) fn expand(&self, optics: Optics, max_deviation: f64) -> Result<Expansion> {
        let [low, high] = self.gradient_per_mm;
        let intervals = ((high / low).ln() / (4.0 * self.edge * max_deviation).ln_1p()).ceil().max(1.0);
        let intervals = limit_rows(intervals)?;
        let ratio = (high / low).powf(1.0 / intervals as f64);
        let row = |j: usize| if j == intervals { high } else { low * ratio.powi(j as i32) };
        let terms = (0..=intervals).map(|j| {
            // The first and last row end with a jump; the neighbours' hats end where this row is.
            let before = if j == 0 { low } else { row(j - 1) };
            let after = if j == intervals { high } else { row(j + 1) };
            let weight = Weight::new(vec![[before, 0.0], [row(j), 1.0], [after, 0.0]])?;
            Ok(Term { curve: curve_of(self.profile(row(j)), optics)?, weight: Some(weight) })
        });
        let terms = terms.collect::<Result<_>>()?;
        Ok(Expansion { terms, max_deviation: (ratio - 1.0) / (4.0 * self.edge) })
    }

    /// The shape on one row, as knots.
    fn profile(&self, gradient_per_mm: f64) -> Vec<(f64, f64)> {
        let outer = self.opening_mm * gradient_per_mm;
        let inner = outer * (1.0 - self.edge);
        if inner == 0.0 {
            return vec![(self.apex - outer, 0.0), (self.apex, 1.0), (self.apex + outer, 0.0)];
        }
        let [a, b, c, d] = [-outer, -inner, inner, outer].map(|offset| self.apex + offset);
        vec![(a, 0.0), (b, 1.0), (c, 1.0), (d, 0.0)]
    }
}
