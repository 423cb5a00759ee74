//! Shadows towards directional lights.

/// Lets the volume cast shadows on itself.
///
/// **Definition.** The lit terms of a directional light are multiplied by `V = 1 − strength · (1 − T)`, where `T` is the
/// transmittance of the scene's extinction, clipped and masked but without haze, from a point towards that light until the
/// volume ends. `T` is exact at the lattice points and interpolated trilinearly between them, as the value is; how far
/// that is from tracing every point's own ray towards the light is the model's error, which the oracle can tell. A headlight
/// casts no shadow that its own eye could see.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shadows {
    /// 0 for none to 1 for all of it.
    pub strength: f64,
}

impl Shadows {
    /// V for a transmittance T towards a light.
    pub fn visibility(&self, transmittance: f64) -> f64 {
        1.0 - self.strength * (1.0 - transmittance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strength_goes_from_no_shadow_to_all_of_it() {
        assert_eq!([0.0, 0.5, 1.0].map(|strength| Shadows { strength }.visibility(0.25)), [1.0, 0.625, 0.25]);
    }
}
