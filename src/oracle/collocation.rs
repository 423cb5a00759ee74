//! Method B: adaptive Gauss collocation of anything that can be evaluated.
//!
//! Five nodes per step (order 10 at its end), each step held against its two halves. Adaptive quadrature alone is no
//! truth, since it never knows what it did not sample: the caller cuts the ray at every knot and kink beforehand, and
//! the integrand says of each step whether something narrow may hide in it.

use super::light::{Light, Segment};
use super::patches::Channels;
use super::quadrature::Gauss;

const NODES: usize = 5;

/// A smooth step and its halves may differ by this much, in light and in optical depth. The halves, which are kept, are
/// then better by three orders of magnitude.
const AGREEMENT: f64 = 1e-14;

/// Deep enough to resolve a passage to the last bit and an extinction of 1e300 per mm.
const MAX_HALVINGS: usize = 1100;

/// Narrower parts of a passage are not halved to look for what may hide in them: it could not be seen.
const NARROWEST: f64 = 1.0 / (1_u64 << 50) as f64;

/// What can be integrated along a passage.
pub(super) trait Integrand {
    /// σ and q at a position in the passage.
    fn optics(&self, t: f64) -> Channels;

    /// False if a feature much narrower than the step may lie between its nodes.
    fn resolved_by(&self, step: &Stretch) -> bool;
}

/// Collocation on five nodes.
#[derive(Debug, Clone)]
pub(super) struct Collocation {
    gauss: Gauss<NODES>,
    running: [[f64; NODES]; NODES],
    agreement: f64,
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
        Collocation::within(AGREEMENT)
    }

    /// The rule for integrands that are bent between cuts: a step and its halves may differ by `agreement`.
    pub(super) fn within(agreement: f64) -> Self {
        let gauss = Gauss::new();
        Collocation { running: gauss.running(), gauss, agreement }
    }

    /// Adds a stretch to the light of a ray.
    pub(super) fn integrate(&self, integrand: &impl Integrand, stretch: Stretch, light: &mut Light) {
        self.refine(integrand, stretch, self.step(integrand, stretch), MAX_HALVINGS, light);
    }

    fn refine(
        &self,
        integrand: &impl Integrand,
        stretch: Stretch,
        whole: Segment,
        halvings_left: usize,
        light: &mut Light,
    ) {
        if light.is_opaque() {
            return;
        }
        let halves = stretch.halves();
        let [near, far] = halves.map(|h| self.step(integrand, h));
        let joined = near.then(&far);
        // A deep step sees none of what it should: its nodes agree with anything.
        let shallow = joined.optical_depth.max(whole.optical_depth) <= 1.0;
        let resolved = stretch.width <= NARROWEST || integrand.resolved_by(&stretch);
        let agreed = difference(&whole, &joined, light.transmittance()) <= self.agreement;
        if shallow && resolved && agreed || halvings_left == 0 {
            light.add(&joined);
        } else {
            self.refine(integrand, halves[0], near, halvings_left - 1, light);
            self.refine(integrand, halves[1], far, halvings_left - 1, light);
        }
    }

    fn step(&self, integrand: &impl Integrand, stretch: Stretch) -> Segment {
        let at: [Channels; NODES] = self.gauss.nodes.map(|x| integrand.optics(stretch.from + stretch.width * x));
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

    impl<F: Fn(f64) -> Channels> Integrand for F {
        fn optics(&self, t: f64) -> Channels {
            self(t)
        }

        fn resolved_by(&self, _: &Stretch) -> bool {
            true
        }
    }

    fn light_of(optics: impl Integrand, length_mm: f64) -> Segment {
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

    /// A bump of width 1e-6 at 0.3, which knows of itself.
    struct Bump {
        says_so: bool,
    }

    const WIDTH: f64 = 1e-6;

    impl Integrand for Bump {
        fn optics(&self, t: f64) -> Channels {
            let x = (t - 0.3) / WIDTH;
            [0.0, (-x * x).exp(), 0.0, 0.0]
        }

        fn resolved_by(&self, step: &Stretch) -> bool {
            let meets = step.from < 0.3 + WIDTH && step.from + step.width > 0.3 - WIDTH;
            !self.says_so || !meets || step.width < WIDTH
        }
    }

    #[test]
    fn a_narrow_bump_is_found_only_if_the_integrand_tells_of_it() {
        let expected = WIDTH * std::f64::consts::PI.sqrt();
        let found = light_of(Bump { says_so: true }, 1.0).rgb[0];
        assert!((found - expected).abs() < 1e-15, "found {found}, expected {expected}");
        let missed = light_of(Bump { says_so: false }, 1.0).rgb[0];
        assert!((missed - expected).abs() > 0.9 * expected, "adaptive quadrature alone cannot see it: found {missed}");
    }
}
