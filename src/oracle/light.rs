//! What a ray has gathered so far: optical depth and colour, both summed without losing small terms.

use crate::scene::Haze;

/// A stretch of a ray: the light that leaves its near end, and its optical depth.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Segment {
    /// `∫ q e^{-τ} ds` over the stretch, linear RGB.
    pub rgb: [f64; 3],
    /// `τ = ∫ σ ds` over the stretch, at least 0; no longer counted once it exceeds 60.
    pub optical_depth: f64,
}

impl Segment {
    /// A stretch of haze alone.
    pub(super) fn of_haze(haze: &Haze, length_mm: f64) -> Segment {
        let (rgb, _) = haze.slab(length_mm);
        Segment { rgb, optical_depth: haze.extinction_per_mm * length_mm }
    }

    /// `T = e^{-τ}`.
    pub fn transmittance(&self) -> f64 {
        (-self.optical_depth).exp()
    }

    /// Premultiplied linear RGBA, with `1 - T` for alpha.
    pub fn rgba(&self) -> [f64; 4] {
        let [r, g, b] = self.rgb;
        [r, g, b, -(-self.optical_depth).exp_m1()]
    }

    /// This stretch and, behind it, `other`.
    #[must_use]
    pub fn then(&self, other: &Segment) -> Segment {
        let t = self.transmittance();
        Segment {
            rgb: std::array::from_fn(|c| self.rgb[c] + t * other.rgb[c]),
            optical_depth: self.optical_depth + other.optical_depth,
        }
    }
}

/// Beyond this optical depth nothing is seen: `e^{-60} < 1e-26`.
const OPAQUE_DEPTH: f64 = 60.0;

/// Sums segments from the eye on.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Light {
    rgb: [Sum; 3],
    depth: Sum,
}

impl Light {
    /// Adds what lies behind all that was added before.
    pub(super) fn add(&mut self, behind: &Segment) {
        let t = self.transmittance();
        for (sum, c) in self.rgb.iter_mut().zip(behind.rgb) {
            sum.add(t * c);
        }
        self.depth.add(behind.optical_depth);
    }

    /// Share of the light behind that reaches the eye.
    pub(super) fn transmittance(&self) -> f64 {
        (-self.depth.total()).exp()
    }

    /// True if nothing behind can be seen.
    pub(super) fn is_opaque(&self) -> bool {
        self.depth.total() > OPAQUE_DEPTH
    }

    /// The sums.
    pub(super) fn segment(&self) -> Segment {
        Segment { rgb: self.rgb.map(|c| c.total()), optical_depth: self.depth.total() }
    }
}

/// A compensated sum (Neumaier 1974): its error does not grow with the number of terms.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        let next = self.sum + term;
        self.lost += if self.sum.abs() >= term.abs() { (self.sum - next) + term } else { (term - next) + self.sum };
        self.sum = next;
    }

    fn total(&self) -> f64 {
        self.sum + self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hundred_thousand_thin_slabs_are_one_slab() {
        let slab = Segment { rgb: [1e-8; 3], optical_depth: 1e-8 };
        let mut light = Light::default();
        for _ in 0..100_000 {
            light.add(&slab);
        }
        let found = light.segment();
        // The first slab's own light is taken as unattenuated, which adds half a slab's depth.
        let expected = -(-1e-3_f64).exp_m1() * (1e-8 / -(-1e-8_f64).exp_m1());
        assert!((found.optical_depth - 1e-3).abs() < 1e-18, "found {}", found.optical_depth);
        assert!((found.rgb[0] - expected).abs() < 1e-17, "found {}, expected {expected}", found.rgb[0]);
    }

    #[test]
    fn joining_attenuates_what_is_behind() {
        let front = Segment { rgb: [0.25, 0.0, 0.0], optical_depth: 2.0_f64.ln() };
        let behind = Segment { rgb: [0.5, 1.0, 0.0], optical_depth: 0.0 };
        let joined = front.then(&behind);
        assert!((joined.rgb[0] - 0.5).abs() < 1e-15 && (joined.rgb[1] - 0.5).abs() < 1e-15, "found {joined:?}");
        assert!((joined.rgba()[3] - 0.5).abs() < 1e-15, "found {joined:?}");
    }
}
