//! One source for kernels in f32 and their twins in f64.

use std::fmt::Debug;

use super::Number;
use super::absorb::{absorbed_f32, mean_transmittance_f32};

/// A real number: f32 in kernels, f64 in their twins.
pub trait Real: Number + Debug + PartialOrd {
    /// Difference between 1 and the next larger number.
    const EPSILON: Self;

    /// Nearest number to an f32.
    fn from_f32(x: f32) -> Self;
    /// As f64, exactly.
    fn to_f64(self) -> f64;
    /// `self` to the power of `exponent`.
    fn powf(self, exponent: Self) -> Self;
}

macro_rules! forward {
    ($t:ty) => {
        const ZERO: Self = 0.0;
        const ONE: Self = 1.0;

        #[inline(always)]
        fn abs(self) -> Self {
            self.abs()
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            self.sqrt()
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            if other < self { other } else { self }
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            if other > self { other } else { self }
        }
    };
}

impl Number for f32 {
    forward!(f32);

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x as f32
    }
    #[inline(always)]
    fn mul_plus(self, a: Self, b: Self) -> Self {
        self.mul_add(a, b)
    }
    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        (-a).mul_add(b, self)
    }
    #[inline(always)]
    fn absorbed(self) -> Self {
        absorbed_f32(self)
    }
    #[inline(always)]
    fn mean_transmittance(self) -> Self {
        mean_transmittance_f32(self)
    }
}

impl Number for f64 {
    forward!(f64);

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn mul_plus(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    #[inline(always)]
    fn minus_product(self, a: Self, b: Self) -> Self {
        self - a * b
    }
    #[inline]
    fn absorbed(self) -> Self {
        -(-self).exp_m1()
    }
    #[inline]
    fn mean_transmittance(self) -> Self {
        if self < 1e-9 { 1.0 - 0.5 * self } else { self.absorbed() / self }
    }
}

impl Real for f32 {
    const EPSILON: Self = f32::EPSILON;

    #[inline(always)]
    fn from_f32(x: f32) -> Self {
        x
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        self.powf(exponent)
    }
}

impl Real for f64 {
    const EPSILON: Self = f64::EPSILON;

    #[inline(always)]
    fn from_f32(x: f32) -> Self {
        f64::from(x)
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        self.powf(exponent)
    }
}
