//! Numbers that arithmetic is written for once: one real number, or many side by side.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// What formulas without a branch need: a [`Real`](super::Real), or the lanes of a vector register, each for itself.
///
/// Every operation rounds as IEEE 754 says, and none is fused but where the formula says so, so that it gives the same bits in a
/// lane as alone.
pub trait Number:
    Copy
    + Default
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

    /// Nearest number to an f64, in every lane.
    fn from_f64(x: f64) -> Self;
    /// `self · a + b`: in f32 rounded once, in f64, in which only slow twins compute, twice.
    fn mul_plus(self, a: Self, b: Self) -> Self;
    /// `self − a · b`, likewise.
    fn minus_product(self, a: Self, b: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// The larger one.
    fn max(self, other: Self) -> Self;
    /// `1 − e^{−τ}` for an optical depth τ ≥ 0: what is absorbed; accurate for small τ too.
    fn absorbed(self) -> Self;
    /// `(1 − e^{−τ}) / τ`, which is 1 at τ = 0: the mean transmittance over a piece of optical depth τ ≥ 0.
    fn mean_transmittance(self) -> Self;
    /// Both.
    #[inline(always)]
    fn absorbed_and_mean_transmittance(self) -> (Self, Self) {
        (self.absorbed(), self.mean_transmittance())
    }
}
