//! The ellipse: a smooth hill around a point of the histogram.

use super::{Expansion, Optics, Term, Weight, curve_of, limit_rows};
use crate::error::Result;

/// A hill `(1 − ρ²)²` with `ρ² = ((v − center)/radius)² + ((g − center)/radius)²`, 0 outside the ellipse.
///
/// It and its slope vanish at the ellipse, so that it can be met by piecewise linear terms; a disc of even height with a
/// sharp oblique edge cannot be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// Value of the centre, HU.
    pub value: f64,
    /// Half axis along the value, HU, above 0.
    pub value_radius: f64,
    /// Gradient magnitude of the centre, HU/mm.
    pub gradient_per_mm: f64,
    /// Half axis along the gradient magnitude, HU/mm, above 0.
    pub gradient_radius_per_mm: f64,
}

impl Ellipse {
    pub(super) fn ideal(&self, value: f64, gradient_per_mm: f64) -> f64 {
        let x = (value - self.value) / self.value_radius;
        let y = (gradient_per_mm - self.gradient_per_mm) / self.gradient_radius_per_mm;
        hill(x, y)
    }

    /// The bilinear interpolant on a square lattice of step `h` in units of the radii.
    ///
    /// The second derivatives along the axes are within ±8, also across the edge of the ellipse, so linear interpolation
    /// is within `8 h² / 8` along each axis: `2 h²` in all.
    pub(super) fn expand(&self, optics: Optics, max_deviation: f64) -> Result<Expansion> {
        // Even, so that the centre is a knot and the hill has its full height.
        let half = limit_rows((1.0 / (0.5 * max_deviation).sqrt()).ceil())?;
        let step = 1.0 / half as f64;
        let lattice = |i: usize| i as f64 * step - 1.0;
        let gradient = |y: f64| self.gradient_per_mm + y * self.gradient_radius_per_mm;
        let terms = (1..2 * half).map(|j| {
            let y = lattice(j);
            let profile = (0..=2 * half).map(|i| (self.value + lattice(i) * self.value_radius, hill(lattice(i), y)));
            let weight = Weight::new(vec![[gradient(y - step), 0.0], [gradient(y), 1.0], [gradient(y + step), 0.0]])?;
            Ok(Term { curve: curve_of(profile, optics)?, weight: Some(weight) })
        });
        let terms = terms.collect::<Result<_>>()?;
        Ok(Expansion { terms, max_deviation: 2.0 * step * step })
    }
}

fn hill(x: f64, y: f64) -> f64 {
    let inside = (1.0 - x * x - y * y).max(0.0);
    inside * inside
}
