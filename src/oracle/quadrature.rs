//! Gauss-Legendre nodes on [0, 1], and the collocation matrix on them.

/// Nodes and weights of the `N`-point Gauss-Legendre rule on [0, 1]; exact to degree `2N - 1`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gauss<const N: usize> {
    /// Nodes, ascending.
    pub(super) nodes: [f64; N],
    /// Weights; their sum is 1.
    pub(super) weights: [f64; N],
}

impl<const N: usize> Gauss<N> {
    /// The rule, its nodes by Newton's method from Tricomi's estimate.
    pub(super) fn new() -> Self {
        let mut rule = Gauss { nodes: [0.5; N], weights: [0.0; N] };
        for i in 0..N {
            let estimate = -(std::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
            let mut x = estimate;
            for _ in 0..8 {
                let (p, slope) = legendre(N, x);
                x -= p / slope;
            }
            let (_, slope) = legendre(N, x);
            rule.nodes[i] = 0.5 + 0.5 * x;
            rule.weights[i] = 1.0 / ((1.0 - x * x) * slope * slope);
        }
        rule
    }

    /// `a[i][j] = ∫₀^{node i} ℓ_j`, with `ℓ_j` the Lagrange polynomial of node `j`: running integrals at the nodes from
    /// values at the nodes (Gauss collocation, of order `2N` at the end of the step).
    pub(super) fn running(&self) -> [[f64; N]; N] {
        std::array::from_fn(|i| {
            let end = self.nodes[i];
            std::array::from_fn(|j| {
                // The rule itself integrates a Lagrange polynomial exactly over the shortened interval.
                (0..N).map(|k| end * self.weights[k] * self.lagrange(j, end * self.nodes[k])).sum()
            })
        })
    }

    fn lagrange(&self, j: usize, t: f64) -> f64 {
        let others = (0..N).filter(|&m| m != j);
        others.map(|m| (t - self.nodes[m]) / (self.nodes[j] - self.nodes[m])).product()
    }
}

/// Legendre polynomial of degree `n` on [-1, 1], and its derivative.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (x * p - before) / (x * x - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_integrated_exactly_up_to_twice_the_nodes() {
        let rule = Gauss::<16>::new();
        for power in 0..32 {
            let found: f64 = rule.nodes.iter().zip(rule.weights).map(|(x, w)| w * x.powi(power)).sum();
            let error = (found - 1.0 / f64::from(power + 1)).abs();
            assert!(error < 1e-15, "power {power}: error {error:e}");
        }
        let two = Gauss::<2>::new();
        let fourth: f64 = two.nodes.iter().zip(two.weights).map(|(x, w)| w * x.powi(4)).sum();
        assert!((fourth - 0.2).abs() > 1e-3, "two nodes cannot integrate a fourth power: found {fourth}");
    }

    #[test]
    fn running_integrals_of_powers_are_exact() {
        let rule = Gauss::<5>::new();
        let running = rule.running();
        for power in 0..5 {
            for (end, row) in rule.nodes.iter().zip(&running) {
                let found: f64 = row.iter().zip(rule.nodes).map(|(a, x)| a * x.powi(power)).sum();
                let expected = end.powi(power + 1) / f64::from(power + 1);
                assert!((found - expected).abs() < 1e-15, "power {power}: found {found}, expected {expected}");
            }
        }
    }
}
