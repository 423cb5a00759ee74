//! Method B: adaptive Gauss collocation of anything that can be evaluated.
//!
//! Five nodes per step (order 10 at its end), each step held against its two halves. Adaptive quadrature alone is no
//! truth, since it cannot miss what it never samples: the caller cuts the ray at every knot and kink beforehand.

use super::light::{Light, Segment};
use super::patches::Channels;
use super::quadrature::Gauss;

const NODES: usize = 5;

/// A step and its halves may differ by this much, in light and in optical depth. The halves, which are kept, are then
/// better by three orders of magnitude.
const AGREEMENT: f64 = 1e-14;

/// Deep enough to resolve a passage to the last bit and an extinction of 1e300 per mm.
const MAX_HALVINGS: usize = 1100;

/// Collocation on five nodes.
#[derive(Debug, Clone)]
pub(super) struct Collocation {
    gauss: Gauss<NODES>,
    running: [[f64; NODES]; NODES],
}

/// Part of a passage: position and width in units of the passage, and length in mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) from: f64,
    pub(super) width: f64,
    pub(super) length_mm: f64,
}

impl Stretch {
    fn halves(self) -> [Stretch; 2] {
        let half = Stretch { width: 0.5 * self.width, length_mm: 0.5 * self.length_mm, ..self };
        [half, Stretch { from: self.from + half.width, ..half }]
    }
}

impl Collocation {
    /// The rule.
    pub(super) fn new() -> Self {
        let gauss = Gauss::new();
        Collocation { running: gauss.running(), gauss }
    }

    /// Adds a stretch to the light of a ray; `optics` gives σ and q at a position in the passage.
    pub(super) fn integrate(&self, optics: &impl Fn(f64) -> Channels, stretch: Stretch, light: &mut Light) {
        self.refine(optics, stretch, self.step(optics, stretch), MAX_HALVINGS, light);
    }

    fn refine(
        &self,
        optics: &impl Fn(f64) -> Channels,
        stretch: Stretch,
        whole: Segment,
        halvings_left: usize,
        light: &mut Light,
    ) {
        if light.is_opaque() {
            return;
        }
        let halves = stretch.halves();
        let [near, far] = halves.map(|h| self.step(optics, h));
        let joined = near.then(&far);
        // A deep step sees none of what it should: its nodes agree with anything.
        let shallow = joined.optical_depth.max(whole.optical_depth) <= 1.0;
        if shallow && difference(&whole, &joined, light.transmittance()) <= AGREEMENT || halvings_left == 0 {
            light.add(&joined);
        } else {
            self.refine(optics, halves[0], near, halvings_left - 1, light);
            self.refine(optics, halves[1], far, halvings_left - 1, light);
        }
    }

    fn step(&self, optics: &impl Fn(f64) -> Channels, stretch: Stretch) -> Segment {
        let at: [Channels; NODES] = self.gauss.nodes.map(|x| optics(stretch.from + stretch.width * x));
        let mut segment = Segment::default();
        for ((row, w), [extinction, emission @ ..]) in self.running.iter().zip(self.gauss.weights).zip(at) {
            let depth: f64 = row.iter().zip(at).map(|(a, [s, ..])| a * s).sum::<f64>() * stretch.length_mm;
            let seen = stretch.length_mm * w * (-depth).exp();
            for (rgb, q) in segment.rgb.iter_mut().zip(emission) {
                *rgb += seen * q;
            }
            segment.optical_depth += stretch.length_mm * w * extinction;
        }
        segment
    }
}

/// Largest difference in light, as the eye sees it, and in optical depth.
fn difference(a: &Segment, b: &Segment, transmittance: f64) -> f64 {
    let light = a.rgb.into_iter().zip(b.rgb).map(|(x, y)| transmittance * (x - y).abs());
    light.fold((a.optical_depth - b.optical_depth).abs(), f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light_of(optics: impl Fn(f64) -> Channels, length_mm: f64) -> Segment {
        let mut light = Light::default();
        Collocation::new().integrate(&optics, Stretch { from: 0.0, width: 1.0, length_mm }, &mut light);
        light.segment()
    }

    #[test]
    fn a_constant_of_any_depth_is_closed_form() {
        for depth in [0.0, 1e-12, 0.9, 5.0, 1e4, 1e30, 1e300] {
            let found = light_of(|_| [depth, 0.5 * depth, 0.0, 0.0], 1.0);
            let expected = -0.5 * (-depth).exp_m1();
            let error = (found.rgb[0] - expected).abs();
            assert!(error <= 2e-15, "depth {depth:e}: found {}, error {error:e}", found.rgb[0]);
        }
    }

    #[test]
    fn a_sharp_peak_at_a_seeded_end_is_resolved() {
        // ∫₀¹ ε/(x² + ε²) dx = atan(1/ε); the peak is 1e-9 wide, and lies at an end as a seed makes it lie.
        let width = 1e-9;
        let found = light_of(|x| [0.0, width / (x * x + width * width), 0.0, 0.0], 1.0);
        let expected = (1.0_f64 / width).atan();
        assert!((found.rgb[0] - expected).abs() < 1e-12, "found {}, expected {expected}", found.rgb[0]);
    }

    #[test]
    fn an_unseeded_sliver_is_missed() {
        // Why the caller must cut at knots: an interior sliver between the nodes is not seen at all.
        let found = light_of(|x| [0.0, if (x - 0.3).abs() < 1e-4 { 1.0 } else { 0.0 }, 0.0, 0.0], 1.0);
        assert!((found.rgb[0] - 2e-4).abs() > 1e-5, "found {}", found.rgb[0]);
    }
}
