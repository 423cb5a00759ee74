//! A ramp: a linear field.

use glam::DVec3;

use super::ScalarField;

/// A linear field, `origin_value + gradient_per_mm · r`. Trilinear interpolation and central differences are exact for it
/// on any lattice, so that whatever is rendered of it has a closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp {
    /// Value at the origin.
    pub origin_value: f64,
    /// Gradient, values per mm along x, y and z.
    pub gradient_per_mm: DVec3,
}

impl ScalarField for Ramp {
    fn value(&self, at_mm: DVec3) -> f64 {
        self.origin_value + self.gradient_per_mm.dot(at_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_is_linear() {
        let ramp = Ramp { origin_value: 7.0, gradient_per_mm: DVec3::new(1.0, -2.0, 0.5) };
        assert_eq!(ramp.value(DVec3::new(4.0, 3.0, -8.0)), 7.0 + 4.0 - 6.0 - 4.0);
    }
}
