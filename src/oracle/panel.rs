//! Method A: where extinction and emission are polynomials, the optical depth is one too, and the rest is quadrature.

use super::bernstein::Bernstein;
use super::light::{Light, Segment};
use super::quadrature::Gauss;

const NODES: usize = 16;

/// Quadrature of a panel on which σ and q are polynomials of degree `N - 1`.
///
/// `rgb = Σ_j q_j Σ_i w_i B_j(x_i) e^{-τ(x_i)}`, with `τ(x) = Σ_j σ_j ∫₀ˣ B_j` exact.
#[derive(Debug, Clone)]
pub(super) struct PanelRule<const N: usize> {
    /// `∫₀^{x_i} B_j`, by `[j][i]`.
    integrated_basis: [[f64; NODES]; N],
    /// `w_i B_j(x_i)`, by `[j][i]`.
    weighted_basis: [[f64; NODES]; N],
    /// A panel with a greater optical depth is halved.
    depth_limit: f64,
}

/// σ and q as polynomials of degree `N - 1` over a stretch of the ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel<const N: usize> {
    /// σ, then q in red, green and blue, 1/mm.
    pub(super) channels: [Bernstein<N>; 4],
    /// Length of the stretch, mm.
    pub(super) length_mm: f64,
}

impl<const N: usize> Panel<N> {
    fn optical_depth(&self) -> f64 {
        self.length_mm * self.channels[0].mean()
    }

    fn halves(&self) -> (Self, Self) {
        let halves = self.channels.map(|c| c.halves());
        let length_mm = 0.5 * self.length_mm;
        (Panel { channels: halves.map(|h| h.0), length_mm }, Panel { channels: halves.map(|h| h.1), length_mm })
    }
}

impl<const N: usize> PanelRule<N> {
    /// The rule for panels of degree `N - 1`, to 1e-14 for optical depths up to `depth_limit`.
    pub(super) fn new(depth_limit: f64) -> Self {
        let gauss = Gauss::<NODES>::new();
        let mut rule =
            PanelRule { integrated_basis: [[0.0; NODES]; N], weighted_basis: [[0.0; NODES]; N], depth_limit };
        for (i, (x, w)) in gauss.nodes.into_iter().zip(gauss.weights).enumerate() {
            let basis = bernstein_basis(N, x);
            let raised = bernstein_basis(N + 1, x);
            for j in 0..N {
                rule.weighted_basis[j][i] = w * basis[j];
                rule.integrated_basis[j][i] = raised[j + 1..].iter().sum::<f64>() / N as f64;
            }
        }
        rule
    }

    /// Adds a panel to the light of a ray.
    pub(super) fn integrate(&self, panel: &Panel<N>, light: &mut Light) {
        if light.is_opaque() {
            return;
        }
        if panel.optical_depth() > self.depth_limit {
            let (left, right) = panel.halves();
            self.integrate(&left, light);
            self.integrate(&right, light);
            return;
        }
        light.add(&self.segment(panel));
    }

    fn segment(&self, panel: &Panel<N>) -> Segment {
        let [extinction, emission @ ..] = &panel.channels;
        let mut segment = Segment { rgb: [0.0; 3], optical_depth: panel.optical_depth() };
        if emission.iter().all(|q| q.0 == [0.0; N]) {
            return segment;
        }
        let mut seen = [0.0; NODES];
        for (row, s) in self.integrated_basis.iter().zip(extinction.0) {
            for (tau, b) in seen.iter_mut().zip(row) {
                *tau += panel.length_mm * s * b;
            }
        }
        seen = seen.map(|tau| (-tau).exp());
        for (j, row) in self.weighted_basis.iter().enumerate() {
            let moment: f64 = row.iter().zip(seen).map(|(b, t)| b * t).sum();
            for (rgb, q) in segment.rgb.iter_mut().zip(emission) {
                *rgb += panel.length_mm * q.0[j] * moment;
            }
        }
        segment
    }
}

/// The `n` Bernstein polynomials of degree `n - 1` at `t`.
fn bernstein_basis(n: usize, t: f64) -> Vec<f64> {
    let mut basis = vec![1.0];
    while basis.len() < n {
        let below = &basis;
        basis = (0..=below.len())
            .map(|j| {
                let left = if j > 0 { t * below[j - 1] } else { 0.0 };
                let same = below.get(j).map_or(0.0, |b| (1.0 - t) * b);
                left + same
            })
            .collect();
    }
    basis
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light_of<const N: usize>(limit: f64, panel: &Panel<N>) -> Segment {
        let mut light = Light::default();
        PanelRule::new(limit).integrate(panel, &mut light);
        light.segment()
    }

    #[test]
    fn a_constant_panel_of_any_depth_is_closed_form() {
        for depth in [0.0, 1e-12, 1e-3, 0.9, 5.0, 50.0, 1e4, 1e30, 1e300] {
            let channels = [depth / 2.0, depth, 0.0, 0.25 * depth].map(|c| Bernstein([c; 4]));
            let found = light_of(1.0, &Panel { channels, length_mm: 2.0 });
            let expected = -(-depth).exp_m1();
            for (rgb, color) in found.rgb.into_iter().zip([2.0, 0.0, 0.5]) {
                let error = (rgb - color * expected).abs();
                assert!(error <= 4e-15 * expected, "depth {depth:e}: found {rgb}, error {error:e}");
            }
            assert!((found.rgba()[3] - expected).abs() <= 1e-15, "depth {depth:e}: found {:?}", found.rgba());
        }
    }

    #[test]
    fn emission_alone_is_its_integral() {
        let channels = [[0.0; 7], [1.0, 0.0, 5.0, 3.0, 0.0, 0.0, 5.0], [0.0; 7], [1e-9; 7]].map(Bernstein);
        let found = light_of(0.25, &Panel { channels, length_mm: 3.0 });
        assert!((found.rgb[0] - 6.0).abs() < 4e-15, "found {}, expected 3 · 14/7", found.rgb[0]);
        assert!((found.rgb[2] - 3e-9).abs() < 1e-23, "found {}", found.rgb[2]);
        assert_eq!(found.optical_depth, 0.0);
    }

    /// Error of the rule at its limit for extinction and emission that wave as much as their degree allows.
    fn error_at<const N: usize>(limit: f64, extinction: [f64; N], emission: [f64; N]) -> f64 {
        let depth_per_mm = limit / Bernstein(extinction).mean();
        let none = Bernstein([0.0; N]);
        let channels = [Bernstein(extinction.map(|s| s * depth_per_mm)), Bernstein(emission), none, none];
        let panel = Panel { channels, length_mm: 1.0 };
        (light_of(limit, &panel).rgb[0] - light_of(limit / 100.0, &panel).rgb[0]).abs()
    }

    #[test]
    fn panels_within_the_limits_need_no_halving() {
        // 1 + T₃ and 1 - T₃, Chebyshev polynomials on [0, 1]; 1 + T₆ and 1 - T₆.
        let (cubic, mirrored) = ([0.0, 6.0, -4.0, 2.0], [2.0, -4.0, 6.0, 0.0]);
        let sextic = [2.0, -10.0, 34.0, -45.2, 34.0, -10.0, 2.0];
        let falling = sextic.map(|c| 2.0 - c);
        for (name, error, bound) in
            [("cubic", error_at(1.0, cubic, mirrored), 1e-14), ("sextic", error_at(0.25, sextic, falling), 1e-14)]
        {
            assert!(error < bound, "{name}: error {error:e}");
        }
        let error = error_at(4.0, sextic, falling);
        assert!(error > 1e-12, "beyond its limit the rule is seen to be wrong: error {error:e}");
    }

    #[test]
    fn a_panel_without_halving_is_seen_to_be_wrong_when_deep() {
        let channels = [[30.0; 4], [30.0; 4], [0.0; 4], [0.0; 4]].map(Bernstein);
        let panel = Panel { channels, length_mm: 4.0 };
        let error = light_of(1e9, &panel).rgb[0] - light_of(1.0, &panel).rgb[0];
        assert!(error.abs() > 1e-9, "the limit on the depth is what makes the rule exact: error {error:e}");
    }
}
