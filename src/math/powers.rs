//! Cubics by powers of their parameter, `c₀ + c₁ u + c₂ u² + c₃ u³` over `[0, 1]`: half the operations of de Casteljau's scheme.
//!
//! Their terms are up to eight times the largest coefficient in [Bernstein form](super::bernstein), and so are their roundings. A
//! constant stays exactly what it is.

use super::Number;
use super::bernstein::Cubic;

/// A cubic by powers.
pub type Powers<R> = [R; 4];

/// The powers of a cubic.
#[inline(always)]
pub fn of<R: Number>(b: &Cubic<R>) -> Powers<R> {
    let three = R::from_f64(3.0);
    let (d0, d1, d2) = (b[1] - b[0], b[2] - b[1], b[3] - b[2]);
    [b[0], three * d0, three * (d1 - d0), (d2 - d1) - (d1 - d0)]
}

/// Value at `u`.
#[inline(always)]
pub fn value<R: Number>(&[c0, c1, c2, c3]: &Powers<R>, u: R) -> R {
    c3.mul_plus(u, c2).mul_plus(u, c1).mul_plus(u, c0)
}

/// Derivative at `u`.
#[inline(always)]
pub fn slope<R: Number>(&[_, c1, c2, c3]: &Powers<R>, u: R) -> R {
    (R::from_f64(3.0) * c3).mul_plus(u, R::from_f64(2.0) * c2).mul_plus(u, c1)
}

/// Half the second derivative at `u`.
#[inline(always)]
pub fn half_bend<R: Number>(&[_, _, c2, c3]: &Powers<R>, u: R) -> R {
    (R::from_f64(3.0) * c3).mul_plus(u, c2)
}

/// The same cubic over `[from, to]`, mapped to `[0, 1]`, in Bernstein form.
#[inline(always)]
pub fn restrict<R: Number>(powers: &Powers<R>, from: R, to: R) -> Cubic<R> {
    let &[_, _, _, c3] = powers;
    let (length, third) = (to - from, R::from_f64(1.0 / 3.0));
    // Its terms in the new parameter.
    let constant = value(powers, from);
    let linear = length * slope(powers, from);
    let square = length * length * half_bend(powers, from);
    let cube = length * length * length * c3;
    let (a, b) = (third * linear, third * square);
    [constant, constant + a, constant + (a + a + b), constant + (linear + square + cube)]
}

#[cfg(test)]
mod tests {
    use super::super::bernstein;
    use super::*;

    #[test]
    fn it_is_the_cubic_in_bernstein_form() {
        for cubic in [[3.0, -1.0, 7.0, 2.0], [0.0, 0.0, 0.0, 1.0], [-5.0, 4.0, 4.0, -5.0]] {
            let powers = of(&cubic);
            for n in 0..=10 {
                let u = f64::from(n) / 10.0;
                for (what, found, expected) in [
                    ("value", value(&powers, u), bernstein::value(&cubic, u)),
                    ("slope", slope(&powers, u), bernstein::slope(&cubic, u)),
                ] {
                    assert!(
                        (found - expected).abs() < 1e-13,
                        "{what} of {cubic:?} at {u}: {found}, expected {expected}"
                    );
                }
                let to = 0.5 + 0.5 * u;
                let (found, expected) = (restrict(&powers, u, to), bernstein::restrict(&cubic, u, to));
                let apart = (0..4).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
                assert!(apart < 1e-13, "{cubic:?} from {u} to {to}: {found:?}, expected {expected:?}");
            }
        }
    }

    #[test]
    fn a_constant_stays_what_it_is() {
        for x in [0.1f32, 1999.7, -3e7] {
            let powers = of(&[x; 4]);
            assert_eq!((value(&powers, 0.3), restrict(&powers, 0.2, 0.7)), (x, [x; 4]));
        }
    }
}
