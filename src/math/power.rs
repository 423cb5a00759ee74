//! Powers of cosines, for highlights.

use super::Number;

/// An exponent that is a number of sixteenths: `x^y` is then a product of squares and square roots, the same bits in a lane as
/// alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Power {
    whole: u32,
    sixteenths: u32,
}

impl Power {
    /// Exponents beyond this are none of ours.
    const MOST: f32 = 65536.0;

    /// The exponent, if it is a number of sixteenths from 0 to 65536.
    pub fn new(exponent: f32) -> Option<Self> {
        let sixteenths = 16.0 * exponent;
        let fits = (0.0..=Power::MOST).contains(&exponent) && sixteenths.fract() == 0.0;
        fits.then_some(Power { whole: exponent as u32, sixteenths: sixteenths as u32 % 16 })
    }

    /// `x^y` for x from 0 to 1. Relative error at most `(y + 4) 2⁻²⁴` (asserted below) where the result is a normal number.
    #[inline(always)]
    pub fn of<N: Number>(self, x: N) -> N {
        let mut power = N::ONE;
        let (mut square, mut bits) = (x, self.whole);
        while bits > 0 {
            if bits & 1 == 1 {
                power = power * square;
            }
            square = square * square;
            bits >>= 1;
        }
        let (mut root, mut bits) = (x, self.sixteenths);
        while bits > 0 {
            root = root.sqrt();
            if bits & 8 == 8 {
                power = power * root;
            }
            bits = bits << 1 & 15;
        }
        power
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_within_their_stated_relative_error() {
        for exponent in [0.0f32, 0.0625, 1.0, 1.5, 2.0, 10.0, 12.4375, 17.5, 63.9375, 128.0, 1000.0] {
            let power = Power::new(exponent).unwrap();
            let allowed = (f64::from(exponent) + 4.0) * 2f64.powi(-24);
            for i in 0..=100_000 {
                let x = i as f32 / 1e5;
                let (found, truth) = (f64::from(power.of(x)), f64::from(x).powf(f64::from(exponent)));
                if truth > 1.2e-38 {
                    let apart = (found / truth - 1.0).abs();
                    assert!(apart <= allowed, "{x}^{exponent}: found {found:e}, expected {truth:e}, {apart:e} off");
                } else {
                    assert!(found < 1.3e-38, "{x}^{exponent}: found {found:e}");
                }
            }
        }
    }

    #[test]
    fn other_exponents_are_left_to_others() {
        for exponent in [0.1, -1.0, 1e9, f32::NAN, f32::INFINITY] {
            assert_eq!(Power::new(exponent), None, "{exponent}");
        }
    }
}
