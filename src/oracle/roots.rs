//! Real zeros in (0, 1): critical points first, then one bracketed zero per monotone stretch.
//!
//! Nothing is divided by a leading coefficient, so degenerate polynomials need no case of their own, and a zero that is
//! also an extremum, which no change of sign betrays, is found among the critical points instead.

/// Largest degree: the square of a gradient along a cell is of degree 6.
const MAX_DEGREE: usize = 6;

/// Half the distance of neighbouring numbers just below 1. Finer zeros near 0 would move nothing that is integrated.
const HALF_LAST_BIT: f64 = 0.25 * f64::EPSILON;

/// Ascending points inside (0, 1).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Points {
    at: [f64; MAX_DEGREE],
    count: usize,
}

impl Points {
    fn push(&mut self, t: f64) {
        if t > 0.0 && t < 1.0 && self.count < MAX_DEGREE {
            self.at[self.count] = t;
            self.count += 1;
        }
    }

    /// The points.
    pub(super) fn as_slice(&self) -> &[f64] {
        &self.at[..self.count]
    }

    /// The stretches into which the points cut [0, 1].
    pub(super) fn stretches(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        (0..=self.count).map(|i| {
            let from = if i == 0 { 0.0 } else { self.at[i - 1] };
            let to = if i == self.count { 1.0 } else { self.at[i] };
            [from, to]
        })
    }
}

/// Zeros of the derivative of the polynomial with these Bernstein coefficients.
pub(super) fn critical_points(coefficients: &[f64]) -> Points {
    let mut derivative = [0.0; MAX_DEGREE];
    let degree = coefficients.len() - 1;
    for (d, pair) in derivative.iter_mut().zip(coefficients.windows(2)) {
        // Without the factor of the degree, which moves no zero.
        *d = pair[1] - pair[0];
    }
    zeros(&derivative[..degree])
}

/// Zeros where the sign changes, and those of even order as far as rounding shows them.
pub(super) fn zeros(coefficients: &[f64]) -> Points {
    let mut found = Points::default();
    match *coefficients {
        [] | [_] => {}
        [a, b] => found.push(a / (a - b)),
        [a, b, c] => quadratic(a, b, c, &mut found),
        _ => {
            for [from, to] in critical_points(coefficients).stretches() {
                if let Some(t) = crossing(|t| value(coefficients, t), from, to) {
                    found.push(t);
                }
            }
        }
    }
    found
}

/// Zeros of `a (1-t)² + 2 b t (1-t) + c t²`, without cancellation.
fn quadratic(a: f64, b: f64, c: f64, found: &mut Points) {
    let half_slope = b - a;
    let curvature = (a - b) + (c - b);
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return;
    }
    let q = -(half_slope + discriminant.sqrt().copysign(half_slope));
    // A zero curvature makes the first infinite and a zero polynomial makes both NaN: `push` takes neither.
    let (first, second) = (q / curvature, a / q);
    found.push(first.min(second));
    if first != second {
        found.push(first.max(second));
    }
}

/// Value of a polynomial of any degree up to 6 (de Casteljau).
fn value(coefficients: &[f64], t: f64) -> f64 {
    let mut c = [0.0; MAX_DEGREE + 1];
    c[..coefficients.len()].copy_from_slice(coefficients);
    for last in (1..coefficients.len()).rev() {
        for i in 0..last {
            c[i] += t * (c[i + 1] - c[i]);
        }
    }
    c[0]
}

/// Where the monotone `f` changes sign in `[from, to]`, to the last bit of [0, 1]; `None` if it does not.
///
/// Chandrupatla's method (1997): inverse quadratic interpolation where it is safe, bisection elsewhere, the bracket
/// kept throughout.
pub(super) fn crossing(f: impl Fn(f64) -> f64, from: f64, to: f64) -> Option<f64> {
    let (mut a, mut b) = (to, from);
    let (mut at_a, mut at_b) = (f(a), f(b));
    if !(at_a < 0.0 && at_b > 0.0 || at_a > 0.0 && at_b < 0.0) {
        return None;
    }
    let mut fraction = 0.5;
    // Bisection alone needs 54 steps; the interpolation never needs more than three times as many.
    for _ in 0..160 {
        let t = a + fraction * (b - a);
        let at_t = f(t);
        let (c, at_c);
        if (at_t < 0.0) == (at_a < 0.0) {
            (c, at_c) = (a, at_a);
        } else {
            (c, at_c) = (b, at_b);
            (b, at_b) = (a, at_a);
        }
        (a, at_a) = (t, at_t);
        let best = if at_a.abs() < at_b.abs() { a } else { b };
        let share = HALF_LAST_BIT / (b - a).abs();
        if share >= 0.5 || at_t == 0.0 {
            return Some(best);
        }
        let xi = (a - b) / (c - b);
        let phi = (at_a - at_b) / (at_c - at_b);
        fraction = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            at_a / (at_b - at_a) * (at_c / (at_b - at_c))
                + (c - a) / (b - a) * (at_a / (at_c - at_a)) * (at_b / (at_c - at_b))
        } else {
            0.5
        }
        .clamp(share, 1.0 - share);
    }
    Some(if at_a.abs() < at_b.abs() { a } else { b })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bernstein coefficients of a product of `(t - r)`, by multiplying in one factor after another.
    fn with_zeros(zeros: &[f64]) -> Vec<f64> {
        zeros.iter().fold(vec![1.0], |p, r| {
            let n = p.len() as f64;
            let factor = [-r, 1.0 - r];
            (0..=p.len())
                .map(|k| {
                    let low = if k < p.len() { (n - k as f64) / n * p[k] * factor[0] } else { 0.0 };
                    let high = if k > 0 { k as f64 / n * p[k - 1] * factor[1] } else { 0.0 };
                    low + high
                })
                .collect()
        })
    }

    #[test]
    fn simple_zeros_of_every_degree_are_found_to_rounding() {
        let all = [0.11, 0.29, 0.5, 0.61, 0.83];
        for n in 1..=5 {
            let found = zeros(&with_zeros(&all[..n]));
            assert_eq!(found.as_slice().len(), n, "degree {n}: found {found:?}");
            for (t, expected) in found.as_slice().iter().zip(all) {
                assert!((t - expected).abs() < 1e-13, "degree {n}: found {t}, expected {expected}");
            }
        }
    }

    #[test]
    fn zeros_outside_are_left_out() {
        assert!(zeros(&with_zeros(&[-0.2, 1.3, 2.0])).as_slice().is_empty());
        assert_eq!(zeros(&with_zeros(&[-0.2, 0.75, 2.0])).as_slice().len(), 1);
    }

    #[test]
    fn a_double_zero_is_a_critical_point() {
        let turns = critical_points(&with_zeros(&[0.4, 0.4, 1.5]));
        assert!(turns.as_slice().iter().any(|t| (t - 0.4).abs() < 1e-12), "found {turns:?}");
    }

    #[test]
    fn degenerate_polynomials_have_no_case_of_their_own() {
        for constant in [0.0, 1.0, -7.0] {
            assert!(zeros(&[constant; 4]).as_slice().is_empty(), "constant {constant}");
            assert!(critical_points(&[constant; 4]).as_slice().is_empty(), "constant {constant}");
        }
        // A line, a parabola and a nearly straight cubic, all written as cubics.
        for c in [[-1.0, 0.0, 1.0, 2.0], [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0], [-1.0, 0.0, 1.0, 2.0 + 1e-14]] {
            let found = zeros(&c);
            let expected = if c[1] == 0.0 { 1.0 / 3.0 } else { 0.5 };
            assert_eq!(found.as_slice().len(), 1, "{c:?}: found {found:?}");
            assert!((found.as_slice()[0] - expected).abs() < 1e-14, "{c:?}: found {found:?}");
        }
        assert!(critical_points(&[0.0, 1.0, 2.0, 3.0]).as_slice().is_empty(), "a line has no extremum");
    }

    #[test]
    fn a_bracket_closes_on_steep_flat_and_jumping_functions() {
        for (found, expected) in [
            (crossing(|t| t - 0.7, 0.0, 1.0), 0.7),
            (crossing(|t| (t - 0.7).powi(9), 0.0, 1.0), 0.7),
            (crossing(|t| if t < 0.3 { -1e-300 } else { 1e300 }, 0.0, 1.0), 0.3),
            (crossing(|t| 1e-200 * (t * t - 0.01), 0.0, 1.0), 0.1),
            (crossing(|t| t - 1e-17, 0.0, 1.0), 0.0),
        ] {
            assert!(found.is_some_and(|t| (t - expected).abs() < 1e-15), "found {found:?}, expected {expected}");
        }
        assert_eq!(crossing(|t| t + 1.0, 0.0, 1.0), None);
        assert_eq!(crossing(|t| t, 0.0, 1.0), None, "a zero at an end is no change of sign");
    }
}
