//! Method A: where extinction and emission are polynomials, the optical depth is one too, and the rest is quadrature.

use super::bernstein::Bernstein;
use super::light::{Light, Segment};
use super::quadrature::Gauss;

const NODES: usize = 16;

/// What a panel may be at most; beyond that it is halved.
#[derive(Debug, Clone, Copy)]
struct Limits {
    /// Optical depth.
    depth: f64,
    /// Length times the largest second difference of the extinction's coefficients: how far the optical depth is from
    /// what its first three terms make it.
    bend: f64,
}

/// Within these the quadrature is exact to 2e-15 of the emission, whatever shape the polynomials have. The depth alone
/// does not make it so: extinction of degree 6 that turns at every chance would cost 6e-10 at a depth of 1.
const EXACT: Limits = Limits { depth: 1.0, bend: 2.0 };

/// Quadrature of a panel on which σ and q are polynomials of degree `N - 1`.
///
/// `rgb = Σ_j q_j Σ_i w_i B_j(x_i) e^{-τ(x_i)}`, with `τ(x) = Σ_j σ_j ∫₀ˣ B_j` exact.
#[derive(Debug, Clone)]
pub(super) struct PanelRule<const N: usize> {
    /// `∫₀^{x_i} B_j`, by `[j][i]`.
    integrated_basis: [[f64; NODES]; N],
    /// `w_i B_j(x_i)`, by `[j][i]`.
    weighted_basis: [[f64; NODES]; N],
    limits: Limits,
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

    fn exceeds(&self, limits: Limits) -> bool {
        let second_differences = self.channels[0].0.windows(3).map(|c| ((c[0] - c[1]) + (c[2] - c[1])).abs());
        let bend = self.length_mm * second_differences.fold(0.0, f64::max);
        self.optical_depth() > limits.depth || bend > limits.bend
    }

    fn halves(&self) -> (Self, Self) {
        let halves = self.channels.map(|c| c.halves());
        let length_mm = 0.5 * self.length_mm;
        (Panel { channels: halves.map(|h| h.0), length_mm }, Panel { channels: halves.map(|h| h.1), length_mm })
    }
}

impl<const N: usize> PanelRule<N> {
    /// The rule for panels of degree `N - 1`.
    pub(super) fn new() -> Self {
        PanelRule::with_limits(EXACT)
    }

    fn with_limits(limits: Limits) -> Self {
        let gauss = Gauss::<NODES>::new();
        let mut rule = PanelRule { integrated_basis: [[0.0; NODES]; N], weighted_basis: [[0.0; NODES]; N], limits };
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
        if panel.exceeds(self.limits) {
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

    fn light_of<const N: usize>(rule: &PanelRule<N>, panel: &Panel<N>) -> Segment {
        let mut light = Light::default();
        rule.integrate(panel, &mut light);
        light.segment()
    }

    #[test]
    fn a_constant_panel_of_any_depth_is_closed_form() {
        for depth in [0.0, 1e-12, 1e-3, 0.9, 5.0, 50.0, 1e4, 1e30, 1e300] {
            let channels = [depth / 2.0, depth, 0.0, 0.25 * depth].map(|c| Bernstein([c; 4]));
            let found = light_of(&PanelRule::new(), &Panel { channels, length_mm: 2.0 });
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
        let found = light_of(&PanelRule::new(), &Panel { channels, length_mm: 3.0 });
        assert!((found.rgb[0] - 6.0).abs() < 4e-15, "found {}, expected 3 · 14/7", found.rgb[0]);
        assert!((found.rgb[2] - 3e-9).abs() < 1e-23, "found {}", found.rgb[2]);
        assert_eq!(found.optical_depth, 0.0);
    }

    /// Error on a panel as large as these limits allow, whose extinction and emission wave as `shape` and `2 - shape`.
    fn error_at<const N: usize>(limits: Limits, shape: [f64; N]) -> f64 {
        let [none, emission] = [[0.0; N], shape.map(|s| 2.0 - s)].map(Bernstein);
        let scaled = |scale: f64| Panel {
            channels: [Bernstein(shape.map(|s| scale * s)), emission, none, none],
            length_mm: 1.0,
        };
        let mut scale = 64.0;
        while scaled(scale).exceeds(limits) {
            scale *= 0.99;
        }
        let panel = scaled(scale);
        let finer = PanelRule::with_limits(Limits { depth: 0.01 * limits.depth, bend: 0.01 * limits.bend });
        (light_of(&PanelRule::with_limits(limits), &panel).rgb[0] - light_of(&finer, &panel).rgb[0]).abs()
    }

    /// 1 + T₃ and 1 + T₆, the Chebyshev polynomials on [0, 1]: as many turns as the degree allows.
    const CUBIC: [f64; 4] = [0.0, 6.0, -4.0, 2.0];
    const SEXTIC: [f64; 7] = [2.0, -10.0, 34.0, -45.2, 34.0, -10.0, 2.0];

    #[test]
    fn panels_at_the_limits_are_exact() {
        for (name, error) in [
            ("constant", error_at(EXACT, [1.0; 4])),
            ("linear", error_at(EXACT, [0.0, 1.0, 2.0, 3.0])),
            ("cubic", error_at(EXACT, CUBIC)),
            ("sextic", error_at(EXACT, SEXTIC)),
        ] {
            assert!(error < 4e-15, "{name}: error {error:e}");
        }
    }

    #[test]
    fn without_either_limit_the_rule_is_seen_to_be_wrong() {
        let any = f64::INFINITY;
        for (name, error) in [
            ("no limit of depth", error_at(Limits { depth: 60.0, bend: any }, [1.0; 4])),
            ("no limit of bend, cubic", error_at(Limits { depth: 8.0, bend: any }, CUBIC)),
            ("no limit of bend, sextic", error_at(Limits { bend: any, ..EXACT }, SEXTIC)),
        ] {
            assert!(error > 1e-12, "{name}: error {error:e}");
        }
    }
}
