//! A ring: the depth beneath a torus.

use glam::DVec3;

use super::ScalarField;

/// A ring about the z axis. The value rises by the same amount per mm of depth beneath its surface,
/// `surface_value + value_per_mm · (minor_radius_mm − √((√(x² + y²) − major_radius_mm)² + z²))`, so that level surfaces
/// near the ring are tori about the same circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Torus {
    /// Radius of the circle in the middle of the tube, mm.
    pub major_radius_mm: f64,
    /// Radius of the tube, mm.
    pub minor_radius_mm: f64,
    /// Value on the surface.
    pub surface_value: f64,
    /// Rise of the value per mm of depth.
    pub value_per_mm: f64,
}

impl ScalarField for Torus {
    fn value(&self, at_mm: DVec3) -> f64 {
        let from_circle_mm = (at_mm.x.hypot(at_mm.y) - self.major_radius_mm).hypot(at_mm.z);
        self.surface_value + self.value_per_mm * (self.minor_radius_mm - from_circle_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_is_that_of_the_depth() {
        let torus = Torus { major_radius_mm: 25.0, minor_radius_mm: 10.0, surface_value: 0.0, value_per_mm: 4.0 };
        for (at, expected) in [
            ([15.0, 20.0, 0.0], 40.0),
            ([-15.0, 20.0, 10.0], 0.0),
            ([35.0, 0.0, 0.0], 0.0),
            ([0.0, 0.0, 0.0], -60.0),
            ([0.0, -31.0, 8.0], 0.0),
        ] {
            assert_eq!(torus.value(at.into()), expected, "at {at:?}");
        }
    }
}
