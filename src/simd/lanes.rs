//! What a vector register can do.

use std::ops::{Add, Mul, Sub};

use super::{Away, BATCH, TWO_BATCHES, Table};
use crate::math::Number;
#[cfg(target_arch = "x86_64")]
use crate::math::{THIN, mean_transmittance_of_thin};

/// f32 numbers side by side, each computed for itself.
pub(crate) trait Lanes: Number {
    /// How many.
    const LANES: usize;
    /// As many integers.
    type Ints: Ints<Mask = Self::Mask>;
    /// As many f64.
    type Doubles: Doubles<Ints = Self::Ints, Mask = Self::Mask>;
    /// As many truths.
    type Mask: Mask;

    /// The nearest f32 to each f64.
    fn from_doubles(doubles: Self::Doubles) -> Self;
    /// Each number, exactly.
    fn to_doubles(self) -> Self::Doubles;
    /// Numbers of a slice of at least one; indices beyond its end give its last one.
    fn gather(from: &[f32], at: Self::Ints) -> Self;
    /// Vectors of a slice of at least one, each the first three of four numbers; indices beyond its end give some other of its
    /// numbers.
    #[inline(always)]
    fn vectors(from: &[[f32; 4]], at: Self::Ints) -> [Self; 3] {
        let (numbers, first) = (from.as_flattened(), at * Self::Ints::splat(4));
        let (second, third) = (first + Self::Ints::splat(1), first + Self::Ints::splat(2));
        [Self::gather(numbers, first), Self::gather(numbers, second), Self::gather(numbers, third)]
    }
    /// Vectors of four numbers, lane by lane.
    #[inline(always)]
    fn store_vectors(numbers: [Self; 4], to: &mut [[f32; 4]; BATCH]) {
        let mut rows = [[0.0; BATCH]; 4];
        for c in 0..4 {
            numbers[c].store(&mut rows[c]);
        }
        for (k, to) in to[..Self::LANES].iter_mut().enumerate() {
            *to = [rows[0][k], rows[1][k], rows[2][k], rows[3][k]];
        }
    }
    /// Vectors of four numbers, as many as there are lanes; the slice has at least as many.
    #[inline(always)]
    fn load_vectors(from: &[[f32; 4]]) -> [Self; 4] {
        let mut rows = [[0.0; BATCH]; 4];
        for (k, from) in from[..Self::LANES].iter().enumerate() {
            for c in 0..4 {
                rows[c][k] = from[c];
            }
        }
        rows.map(
            #[inline(always)]
            |row| Self::load(&row),
        )
    }
    /// The same number in every lane.
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self::from_f64(f64::from(x))
    }
    /// The first numbers of a slice, which has at least as many.
    fn load(from: &[f32]) -> Self;
    /// Overwrites the first numbers of a slice, which has at least as many.
    fn store(self, to: &mut [f32]);
    /// `self < other`, false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self ≤ other`, false for NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The nearest whole number, ties to even.
    fn round(self) -> Self;
    /// Towards 0; numbers that fit.
    fn to_ints(self) -> Self::Ints;
    /// The nearest number to each integer.
    fn from_ints(ints: Self::Ints) -> Self;
    /// 2 to the power of integers from -126 to 127.
    fn power_of_two(exponent: Self::Ints) -> Self;
    /// Entries of a table; indices beyond its end give its last entry.
    fn pick(table: &Table, at: Self::Ints) -> Self;
    /// Entries of a table of one register of the widest level; indices beyond its end give its last entry.
    fn pick16(table: &[f32; BATCH], at: Self::Ints) -> Self;
    /// Entries of a table of two of these; likewise.
    fn pick32(table: &[f32; TWO_BATCHES], at: Self::Ints) -> Self;
    /// The samples at these distances from `at`, each with the next one in one number: see [`Ints::low_half`] and [`Pairs`].
    fn pairs_i16<const N: usize>(samples: &[i16], at: Self::Ints, away: &Away<N>) -> [Self::Ints; N];
    /// Likewise four samples in two numbers.
    fn quads_i16<const N: usize>(samples: &[i16], at: Self::Ints, away: &Away<N>) -> [[Self::Ints; 2]; N];
    /// The samples at `at` and at `at + 1`: see [`Pairs`].
    fn pairs_f32(samples: &[f32], at: Self::Ints) -> [Self; 2];
    /// The samples from `at` to `at + 3`: see [`Pairs`].
    fn quads_f32(samples: &[f32], at: Self::Ints) -> [Self; 4];
    /// The lanes for which the mask is true, in order, at the front; the others are unspecified.
    fn compress(self, mask: Self::Mask) -> Self;
    /// The first lanes, in order, where the mask is true; the others are unspecified.
    fn expand(self, mask: Self::Mask) -> Self;
    /// Lanes by their numbers, those of `other` behind those of `self`; other numbers give any lane.
    fn among(self, other: Self, at: Self::Ints) -> Self;

    /// Opacities in the order in which light meets them, combined: of all before each, and of all of them. `a ∘ b = a + b − a b`
    /// is accurate however small they are; in a tree of four levels, the same at every level of instructions.
    #[inline(always)]
    fn accumulated(opacities: &[f32; BATCH]) -> ([f32; BATCH], f32) {
        let mut all = *opacities;
        for distance in [1, 2, 4, 8] {
            let before = all;
            for k in distance..BATCH {
                all[k] = before[k] + before[k - distance] * (1.0 - before[k]);
            }
        }
        let mut before = [0.0; BATCH];
        before[1..].copy_from_slice(&all[..BATCH - 1]);
        (before, all[BATCH - 1])
    }

    /// The sum of numbers, in a tree: halves, quarters, eighths, pairs.
    #[inline(always)]
    fn sum(numbers: &[f32; BATCH]) -> f32 {
        let mut sums = *numbers;
        for half in [8, 4, 2, 1] {
            for k in 0..half {
                sums[k] += sums[k + half];
            }
        }
        sums[0]
    }
}

/// f64 numbers side by side.
pub(crate) trait Doubles: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + 'static {
    /// As many integers.
    type Ints: Ints;
    /// As many truths.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(x: f64) -> Self;
    /// The first numbers of a slice, which has at least as many.
    fn load(from: &[f64]) -> Self;
    /// Overwrites the first numbers of a slice, which has at least as many.
    fn store(self, to: &mut [f64]);
    /// Each integer, exactly.
    fn from_ints(ints: Self::Ints) -> Self;
    /// Towards 0; numbers that fit.
    fn to_ints(self) -> Self::Ints;
    /// The largest whole number that is not larger.
    fn floor(self) -> Self;
    /// `self · a + b`, rounded once.
    fn mul_plus(self, a: Self, b: Self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// `self < other`, false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self ≤ other`, false for NaN.
    fn le(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
}

/// i32 numbers side by side; arithmetic wraps.
pub(crate) trait Ints:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + 'static
{
    /// As many truths.
    type Mask: Mask;

    /// The same number in every lane.
    fn splat(x: i32) -> Self;
    /// 0, 1, 2, …
    fn count() -> Self;
    /// The first numbers of a slice, which has at least as many.
    fn load(from: &[i32]) -> Self;
    /// Overwrites the first numbers of a slice, which has at least as many.
    fn store(self, to: &mut [i32]);
    /// Halved so many times, towards -∞.
    fn shifted_right(self, bits: u32) -> Self;
    /// The lower 16 bits, signed.
    fn low_half(self) -> Self;
    /// The upper 16 bits, signed.
    #[inline(always)]
    fn high_half(self) -> Self {
        self.shifted_right(16)
    }
    /// `high_half − low_half`.
    fn rise(self) -> Self;
    /// The bits that both have.
    fn and(self, bits: Self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// The larger one.
    fn max(self, other: Self) -> Self;
    /// Each without its `by` lowest bits: rounded down to a multiple of 2^`by`, `by` from 0 to 31.
    fn without_low_bits(self, by: Self) -> Self;
    /// 2^`self`, for numbers from 0 to 30.
    fn power_of_two(self) -> Self;
    /// Numbers of a slice of at least one; indices beyond its end give its last one.
    fn gather(from: &[i32], at: Self) -> Self;
    /// Bytes of a slice; indices beyond its end give another byte of it. It has at least four.
    fn bytes(from: &[u8], at: Self) -> Self;
    /// `self = other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The lanes for which the mask is true, in order, at the front; the others are unspecified.
    fn compress(self, mask: Self::Mask) -> Self;
    /// The first lanes, in order, where the mask is true; the others are unspecified.
    fn expand(self, mask: Self::Mask) -> Self;
    /// Lanes by their numbers, those of `other` behind those of `self`; other numbers give any lane.
    fn among(self, other: Self, at: Self) -> Self;
}

/// Truths side by side.
pub(crate) trait Mask: Copy + 'static {
    /// All of them.
    const ALL: Self;

    /// Both.
    fn and(self, other: Self) -> Self;
    /// Either.
    fn or(self, other: Self) -> Self;
    /// `self`, and not `other`.
    fn and_not(self, other: Self) -> Self;
    /// Bit `k` is lane `k`.
    fn bits(self) -> u32;
    /// Whether any is true.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
}

/// The last index at which a pair of samples begins.
#[inline(always)]
pub(super) fn last_pair<T>(samples: &[T]) -> u32 {
    assert!(samples.len() >= 2, "a pair has two samples");
    (samples.len() - 2).min(i32::MAX as usize) as u32
}

/// The last index of a slice.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn last<T>(numbers: &[T]) -> u32 {
    assert!(!numbers.is_empty(), "a number to read");
    (numbers.len() - 1).min(i32::MAX as usize) as u32
}

/// The last index at which four bytes can be read.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn last_word(bytes: &[u8]) -> u32 {
    assert!(bytes.len() >= 4, "a word has four bytes");
    (bytes.len() - 4).min(i32::MAX as usize) as u32
}

/// The last index at which four samples begin.
#[inline(always)]
pub(super) fn last_quad<T>(samples: &[T]) -> u32 {
    assert!(samples.len() >= 4, "four samples");
    (samples.len() - 4).min(i32::MAX as usize) as u32
}

/// `1 − e^{−τ}` and `(1 − e^{−τ})/τ` as [`absorbed_f32`](crate::math::absorbed_f32) and
/// [`mean_transmittance_f32`](crate::math::mean_transmittance_f32) have them, operation by operation.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(super) fn attenuation<L: Lanes>(optical_depth: L) -> (L, L) {
    let mean = mean_transmittance_of_thin(optical_depth);
    let absorbed = optical_depth * mean;
    let thin = optical_depth.le(L::splat(THIN));
    if !<L::Mask as Mask>::ALL.and_not(thin).any() {
        return (absorbed, mean);
    }
    let of_dense = absorbed_by_dense(optical_depth);
    (L::select(thin, absorbed, of_dense), L::select(thin, mean, of_dense / optical_depth))
}

#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn absorbed_by_dense<L: Lanes>(optical_depth: L) -> L {
    let constant = L::from_f64;
    let x = -(constant(87.0).min(optical_depth));
    let k = (x * constant(f64::from(std::f32::consts::LOG2_E))).round();
    let f = x.minus_product(k, constant(f64::from(0.693_359_4_f32)));
    let f = f.minus_product(k, constant(f64::from(-2.121_944_4e-4_f32)));
    let p = constant(f64::from(1.0_f32 / 5040.0)).mul_plus(f, constant(f64::from(1.0_f32 / 720.0)));
    let p = p.mul_plus(f, constant(f64::from(1.0_f32 / 120.0)));
    let p = p.mul_plus(f, constant(f64::from(1.0_f32 / 24.0)));
    let p = p.mul_plus(f, constant(f64::from(1.0_f32 / 6.0)));
    let p = p.mul_plus(f, constant(0.5));
    let expm1 = (p * f).mul_plus(f, f);
    let scale = L::power_of_two(k.to_ints());
    (L::ONE - scale).minus_product(scale, expm1)
}
