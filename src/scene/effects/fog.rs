//! Fog as OpenGL defines it.

/// Fog that replaces colours with its own as they are farther away.
///
/// **Definition** (OpenGL 2.1 specification, section 3.10). With `z` the distance along the ray in mm, from the eye, or from
/// the camera's plane where rays are parallel, a colour becomes `f C + (1 − f) C_fog`, `f` clamped to [0, 1] ([`FogLaw`]). Opacity
/// is left alone: so emission becomes `q′ = f q + (1 − f) σ C_fog`, a level surface's colour `f C + (1 − f) C_fog`, and the
/// background stays as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fog {
    /// How much of a colour is left.
    pub law: FogLaw,
    /// The fog's colour, linear RGB.
    pub color: [f64; 3],
}

/// The share `f` of a colour that fog leaves, by distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FogLaw {
    /// `(end − z)/(end − start)`.
    Linear {
        /// Fog begins, mm.
        start_mm: f64,
        /// Nothing but fog is left, mm; beyond `start_mm`.
        end_mm: f64,
    },
    /// `e^{−dz}`.
    Exp {
        /// d, 1/mm, at least 0.
        density_per_mm: f64,
    },
    /// `e^{−(dz)²}`.
    Exp2 {
        /// d, 1/mm, at least 0.
        density_per_mm: f64,
    },
}

impl FogLaw {
    /// `f` at a distance in mm.
    pub fn clearness(&self, distance_mm: f64) -> f64 {
        let f = match *self {
            FogLaw::Linear { start_mm, end_mm } => (end_mm - distance_mm) / (end_mm - start_mm),
            FogLaw::Exp { density_per_mm } => (-density_per_mm * distance_mm).exp(),
            FogLaw::Exp2 { density_per_mm } => (-(density_per_mm * distance_mm).powi(2)).exp(),
        };
        f.clamp(0.0, 1.0)
    }

    /// True if nothing within a distance in mm is fogged.
    pub fn is_clear_until(&self, distance_mm: f64) -> bool {
        match *self {
            FogLaw::Linear { start_mm, .. } => start_mm >= distance_mm,
            FogLaw::Exp { density_per_mm } | FogLaw::Exp2 { density_per_mm } => density_per_mm == 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_three_laws_at_known_distances() {
        let linear = FogLaw::Linear { start_mm: 100.0, end_mm: 300.0 };
        assert_eq!([50.0, 100.0, 250.0, 300.0, 900.0].map(|z| linear.clearness(z)), [1.0, 1.0, 0.25, 0.0, 0.0]);
        let half = 2.0_f64.ln();
        assert!((FogLaw::Exp { density_per_mm: half / 10.0 }.clearness(20.0) - 0.25).abs() < 1e-15);
        assert!((FogLaw::Exp2 { density_per_mm: half.sqrt() / 10.0 }.clearness(20.0) - 0.0625).abs() < 1e-15);
    }

    #[test]
    fn fog_of_no_density_and_fog_behind_everything_are_clear() {
        assert!(FogLaw::Exp { density_per_mm: 0.0 }.is_clear_until(1e9));
        assert!(FogLaw::Linear { start_mm: 100.0, end_mm: 300.0 }.is_clear_until(100.0));
        assert!(!FogLaw::Linear { start_mm: 100.0, end_mm: 300.0 }.is_clear_until(100.1));
        assert!(!FogLaw::Exp2 { density_per_mm: 1e-9 }.is_clear_until(1.0));
    }
}
