//! Polynomials on [0, 1] by their Bernstein coefficients: every operation is a sequence of linear interpolations, so
//! constants stay constants to the last bit and nothing cancels (Farouki and Rajan 1987).

/// A polynomial of degree `N - 1` on [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bernstein<const N: usize>(pub(super) [f64; N]);

/// A cubic: a trilinear field along a straight line through one cell.
pub(super) type Cubic = Bernstein<4>;

impl<const N: usize> Bernstein<N> {
    /// Value at `t` (de Casteljau).
    pub(super) fn at(&self, t: f64) -> f64 {
        let mut c = self.0;
        for last in (1..N).rev() {
            for i in 0..last {
                c[i] += t * (c[i + 1] - c[i]);
            }
        }
        c[0]
    }

    /// The same polynomial over `[a, b]`, as a polynomial on [0, 1]: the blossom with arguments `a` and `b`.
    pub(super) fn restrict(&self, a: f64, b: f64) -> Self {
        Bernstein(std::array::from_fn(|k| {
            let mut c = self.0;
            for last in (1..N).rev() {
                let t = if last > k { a } else { b };
                for i in 0..last {
                    c[i] += t * (c[i + 1] - c[i]);
                }
            }
            c[0]
        }))
    }

    /// Left and right half, each as a polynomial on [0, 1].
    pub(super) fn halves(&self) -> (Self, Self) {
        let mut c = self.0;
        let (mut left, mut right) = (c, c);
        for r in 0..N {
            left[r] = c[0];
            right[N - 1 - r] = c[N - 1 - r];
            for i in 0..N - 1 - r {
                c[i] += 0.5 * (c[i + 1] - c[i]);
            }
        }
        (Bernstein(left), Bernstein(right))
    }

    /// Mean over [0, 1], which is the mean of the coefficients.
    pub(super) fn mean(&self) -> f64 {
        self.0.iter().map(|c| c / N as f64).sum()
    }

    /// `f` of each coefficient; the polynomial `f(p)` where `f` is affine.
    pub(super) fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        Bernstein(self.0.map(f))
    }
}

impl Cubic {
    /// The product, of degree 6.
    pub(super) fn times(&self, other: &Cubic) -> Bernstein<7> {
        const BINOMIAL_3: [f64; 4] = [1.0, 3.0, 3.0, 1.0];
        const BINOMIAL_6: [f64; 7] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];
        let mut product = [0.0; 7];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += BINOMIAL_3[i] * BINOMIAL_3[j] / BINOMIAL_6[i + j] * a * b;
            }
        }
        Bernstein(product)
    }

    /// The same polynomial with its degree raised from 3 to 6.
    pub(super) fn elevated(&self) -> Bernstein<7> {
        let [a, b, c, d] = self.0;
        // Interpolated between neighbours, so that a constant stays exactly that.
        let four = [a, a + 0.75 * (b - a), b + 0.5 * (c - b), c + 0.25 * (d - c), d];
        let five: [f64; 6] = std::array::from_fn(|i| if i == 5 { d } else { lerp_down(&four, i, i as f64 / 5.0) });
        Bernstein(std::array::from_fn(|i| if i == 6 { d } else { lerp_down(&five, i, i as f64 / 6.0) }))
    }
}

/// `c[i]` moved towards `c[i - 1]` by `share`: one step of degree elevation.
fn lerp_down(c: &[f64], i: usize, share: f64) -> f64 {
    if i == 0 { c[0] } else { c[i] + share * (c[i - 1] - c[i]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: Cubic = Bernstein([1.0, -2.0, 5.0, 0.5]);

    /// 1 - 9 t + 30 t² - 21.5 t³, the power form of `P`.
    fn power(t: f64) -> f64 {
        1.0 + t * (-9.0 + t * (30.0 - 21.5 * t))
    }

    #[test]
    fn value_restriction_and_halves_agree_with_the_power_form() {
        let part = P.restrict(0.3, 0.8);
        let (left, right) = P.halves();
        for t in [0.0, 0.1, 0.5, 0.9, 1.0] {
            for (found, expected) in [
                (P.at(t), power(t)),
                (part.at(t), power(0.3 + 0.5 * t)),
                (left.at(t), power(0.5 * t)),
                (right.at(t), power(0.5 + 0.5 * t)),
                (P.elevated().at(t), power(t)),
                (P.times(&part).at(t), power(t) * power(0.3 + 0.5 * t)),
            ] {
                assert!((found - expected).abs() < 4e-15, "at {t}: found {found}, expected {expected}");
            }
        }
        let mean = 1.0 - 4.5 + 10.0 - 21.5 / 4.0;
        assert!((P.mean() - mean).abs() < 1e-15, "found {}, expected {mean}", P.mean());
    }

    #[test]
    fn constants_survive_to_the_last_bit() {
        let c = Bernstein([0.1 + 0.2; 4]);
        assert_eq!(c.at(0.37), 0.1 + 0.2);
        assert_eq!(c.restrict(0.1, 0.77), c);
        assert_eq!(c.elevated(), Bernstein([0.1 + 0.2; 7]));
    }
}
