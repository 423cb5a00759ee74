//! A ball: the depth beneath a sphere.

use glam::DVec3;

use super::ScalarField;

/// A ball about the origin. The value rises by the same amount per mm of depth beneath its surface,
/// `surface_value + value_per_mm · (radius_mm − |r|)`, so that level surfaces are spheres and the gradient points to the
/// centre with the magnitude `|value_per_mm|` everywhere but there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Radius, mm.
    pub radius_mm: f64,
    /// Value on the surface.
    pub surface_value: f64,
    /// Rise of the value per mm of depth.
    pub value_per_mm: f64,
}

impl ScalarField for Sphere {
    fn value(&self, at_mm: DVec3) -> f64 {
        self.surface_value + self.value_per_mm * (self.radius_mm - at_mm.length())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_is_that_of_the_depth() {
        let sphere = Sphere { radius_mm: 13.0, surface_value: 300.0, value_per_mm: 2.0 };
        for (at, expected) in
            [([3.0, -4.0, 12.0], 300.0), ([0.0, 0.0, 0.0], 326.0), ([0.0, 0.0, 20.0], 286.0), ([0.0, 3.0, 4.0], 316.0)]
        {
            assert_eq!(sphere.value(at.into()), expected, "at {at:?}");
        }
    }
}
