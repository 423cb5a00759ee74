//! The test signal of Marschner and Lobb.

use std::f64::consts::PI;

use glam::DVec3;

use super::ScalarField;

/// The test signal of Marschner and Lobb, "An evaluation of reconstruction filters for volume rendering", Proc. IEEE
/// Visualization 1994: ripples across a plane whose frequency is modulated, from 0 to 1, hard to reconstruct.
///
/// With `(x, y, z)` in units of `unit_mm`:
/// `ρ = (1 − sin(πz/2) + α (1 + cos(2π f cos(πr/2)))) / (2 (1 + α))` and `r = √(x² + y²)`.
/// It is meant to be sampled on [-1, 1]³ at 40 × 40 × 40 points, where nearly all of its spectrum lies below the Nyquist
/// frequency, some of it just so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MarschnerLobb {
    /// Length of one unit of the formula, mm.
    pub unit_mm: f64,
    /// Frequency of the ripples `f`, per unit.
    pub frequency: f64,
    /// Weight of the ripples `α`.
    pub alpha: f64,
}

impl Default for MarschnerLobb {
    /// `f = 6`, `α = 1/4`, as published, at 1 mm per unit.
    fn default() -> Self {
        MarschnerLobb { unit_mm: 1.0, frequency: 6.0, alpha: 0.25 }
    }
}

impl ScalarField for MarschnerLobb {
    fn value(&self, at_mm: DVec3) -> f64 {
        let at = at_mm / self.unit_mm;
        let r = at.x.hypot(at.y);
        let ripples = (2.0 * PI * self.frequency * (0.5 * PI * r).cos()).cos();
        (1.0 - (0.5 * PI * at.z).sin() + self.alpha * (1.0 + ripples)) / (2.0 * (1.0 + self.alpha))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_has_the_published_values() {
        let field = MarschnerLobb { unit_mm: 10.0, ..MarschnerLobb::default() };
        // At the origin cos(2π · 6 · 1) = 1; at r = 1, cos(2π · 6 · 0) = 1; at r = 2/3, cos(2π · 6 · 1/2) = 1;
        // where cos(πr/2) = 1/24, cos(π/2) = 0; where it is 1/12, cos(π) = -1.
        let r = |cosine: f64| 10.0 * cosine.acos() / (0.5 * PI);
        for (at, expected) in [
            ([0.0, 0.0, 0.0], 1.5 / 2.5),
            ([10.0, 0.0, 0.0], 1.5 / 2.5),
            ([0.0, -20.0 / 3.0, 0.0], 1.5 / 2.5),
            ([r(1.0 / 24.0), 0.0, 0.0], 1.25 / 2.5),
            ([0.0, r(1.0 / 12.0), 0.0], 1.0 / 2.5),
            ([0.0, r(1.0 / 12.0), 10.0], 0.0),
            ([0.0, 0.0, -10.0], 1.0),
            ([0.0, 0.0, 10.0 / 3.0], 1.0 / 2.5),
        ] {
            let found = field.value(at.into());
            assert!((found - expected).abs() < 1e-13, "at {at:?}: found {found}, expected {expected}");
        }
    }
}
