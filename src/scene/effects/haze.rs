//! Fog as a medium.

/// A homogeneous medium that fills space from each ray's origin to a distance behind the volume.
///
/// **Definition.** It adds `σ_h` to the extinction and `σ_h C` to the emission, unshaded, from the ray's origin to `end_mm`,
/// inside the volume and outside of it. So a ray that meets nothing else shows `I₀T + C(1 − T)` with `T = e^{−σ_h end}`, the
/// closed form of a homogeneous medium, and what is seen through a length `z` of it is dimmed by `e^{−σ_h z}`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Haze {
    /// σ_h, 1/mm, above 0.
    pub extinction_per_mm: f64,
    /// C, the colour it has where nothing is seen through it, linear RGB.
    pub color: [f64; 3],
    /// Where it ends along each ray, mm; no point of the volume lies beyond.
    pub end_mm: f64,
}

impl Haze {
    /// What a stretch of haze alone does to light: what it sends towards the eye, linear RGB, and its opacity.
    pub fn slab(&self, length_mm: f64) -> ([f64; 3], f64) {
        let opacity = -(-self.extinction_per_mm * length_mm).exp_m1();
        (self.color.map(|c| c * opacity), opacity)
    }

    /// σ_h C, 1/mm.
    pub fn emission_per_mm(&self) -> [f64; 3] {
        self.color.map(|c| c * self.extinction_per_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slabs_in_a_row_are_one_slab() {
        let haze = Haze { extinction_per_mm: 0.01, color: [1.0, 0.5, 0.0], end_mm: 1e3 };
        let (near, far, both) = (haze.slab(30.0), haze.slab(70.0), haze.slab(100.0));
        let joined = near.0[1] + (1.0 - near.1) * far.0[1];
        assert!((joined - both.0[1]).abs() < 1e-15, "found {joined}, expected {}", both.0[1]);
        assert!((both.1 - (1.0 - (-1.0f64).exp())).abs() < 1e-15, "found {}", both.1);
    }
}
