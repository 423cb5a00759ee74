//! One source for kernels in f32 and their twins in f64.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::absorb::{absorbed_f32, mean_transmittance_f32};

/// A real number: f32 in kernels, f64 in their twins.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// Difference between 1 and the next larger number.
    const EPSILON: Self;

    /// Nearest number to an f64.
    fn from_f64(x: f64) -> Self;
    /// Nearest number to an f32.
    fn from_f32(x: f32) -> Self;
    /// As f64, exactly.
    fn to_f64(self) -> f64;
    /// `self · a + b`. Rounded twice: a fused operation is only fast where the machine has one, and the result must not
    /// depend on that.
    #[inline(always)]
    fn mul_plus(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    /// Absolute value.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// `self` to the power of `exponent`.
    fn powf(self, exponent: Self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// The larger one.
    fn max(self, other: Self) -> Self;
    /// `1 − e^{−τ}` for an optical depth τ ≥ 0: what is absorbed; accurate for small τ too.
    fn absorbed(self) -> Self;
    /// `(1 − e^{−τ}) / τ`, which is 1 at τ = 0: the mean transmittance over a piece of optical depth τ ≥ 0.
    fn mean_transmittance(self) -> Self;
}

macro_rules! forward {
    ($t:ty) => {
        const ZERO: Self = 0.0;
        const ONE: Self = 1.0;
        const EPSILON: Self = <$t>::EPSILON;

        #[inline(always)]
        fn abs(self) -> Self {
            self.abs()
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            self.sqrt()
        }
        #[inline(always)]
        fn powf(self, exponent: Self) -> Self {
            self.powf(exponent)
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

impl Real for f32 {
    forward!(f32);

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x as f32
    }
    #[inline(always)]
    fn from_f32(x: f32) -> Self {
        x
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
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

impl Real for f64 {
    forward!(f64);

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn from_f32(x: f32) -> Self {
        f64::from(x)
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
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
