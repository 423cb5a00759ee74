//! Levoy's depth cue.

/// Dims the lit terms of shading with distance.
///
/// **Definition** (Levoy 1988, equation 4). The diffuse and the specular term, not the ambient one, are multiplied by
/// `1/(k₁ + k₂ d)`, where `d` is the distance in mm of a point from the picture plane: the plane through the camera across
/// its line of sight. A surface is dimmed like a point of the volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthCue {
    /// k₁, above 0; 1 leaves light at the camera as it is.
    pub constant: f64,
    /// k₂, 1/mm, at least 0.
    pub per_mm: f64,
}

impl DepthCue {
    /// The factor at this distance from the picture plane, mm, at least 0.
    pub fn factor(&self, depth_mm: f64) -> f64 {
        1.0 / (self.constant + self.per_mm * depth_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_halves_where_the_denominator_doubles() {
        let cue = DepthCue { constant: 1.0, per_mm: 0.01 };
        assert_eq!([0.0, 100.0, 300.0].map(|d| cue.factor(d)), [1.0, 0.5, 0.25]);
    }
}
