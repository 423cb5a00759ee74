//! Registers, and reads by lanes.
//!
//! Eight lanes, AVX2. With sixteen, AVX-512, means were the same within a tenth, but for two: value and gradient from bricks with an apron
//! of all axes took 0.83 to 0.96 of lines, nearly half of the gain because a compiler knows the strides in a brick; and bricks with one
//! along x alone 1.2 to 1.4.
#![allow(unsafe_code, reason = "intrinsics")]

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

/// Lanes of a register, and how many of them are side by side in the picture.
pub(crate) const LANES: usize = 8;
pub(crate) const ASIDE: usize = 4;

#[derive(Clone, Copy)]
pub(crate) struct Floats(__m256);

#[derive(Clone, Copy)]
pub(crate) struct Ints(__m256i);

macro_rules! operator {
    ($type:ident, $operator:ident, $name:ident, $intrinsic:ident) => {
        impl $operator for $type {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                // SAFETY: registers exist only in `walked`, which is called where the processor has AVX2.
                $type(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
operator!(Floats, Add, add, _mm256_add_ps);
operator!(Floats, Sub, sub, _mm256_sub_ps);
operator!(Floats, Mul, mul, _mm256_mul_ps);
operator!(Ints, Add, add, _mm256_add_epi32);
operator!(Ints, Mul, mul, _mm256_mullo_epi32);

impl Floats {
    #[inline(always)]
    pub(crate) fn splat(x: f32) -> Self {
        // SAFETY: as for all registers, see the operators.
        Floats(unsafe { _mm256_set1_ps(x) })
    }
    #[inline(always)]
    pub(crate) fn from_ints(ints: Ints) -> Self {
        // SAFETY: likewise.
        Floats(unsafe { _mm256_cvtepi32_ps(ints.0) })
    }
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        // SAFETY: likewise.
        Floats(unsafe { _mm256_sqrt_ps(self.0) })
    }
    #[inline(always)]
    pub(crate) fn lerp(self, other: Self, t: Self) -> Self {
        // SAFETY: likewise.
        Floats(unsafe { _mm256_fmadd_ps(t.0, (other - self).0, self.0) })
    }
    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        let mut lanes = [0.0f32; LANES];
        // SAFETY: likewise; there is room for eight.
        unsafe { _mm256_storeu_ps(lanes.as_mut_ptr(), self.0) };
        lanes.iter().map(|&x| f64::from(x)).sum()
    }
}

impl Ints {
    #[inline(always)]
    pub(crate) fn splat(x: i32) -> Self {
        // SAFETY: as for all registers, see the operators.
        Ints(unsafe { _mm256_set1_epi32(x) })
    }
    #[inline(always)]
    pub(crate) fn load(from: &[i32; LANES]) -> Self {
        // SAFETY: likewise; there are eight.
        Ints(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }
    #[inline(always)]
    pub(crate) fn shifted_right(self, bits: i32) -> Self {
        // SAFETY: likewise.
        Ints(unsafe { _mm256_srav_epi32(self.0, _mm256_set1_epi32(bits)) })
    }
    #[inline(always)]
    pub(crate) fn and(self, bits: i32) -> Self {
        // SAFETY: likewise.
        Ints(unsafe { _mm256_and_si256(self.0, _mm256_set1_epi32(bits)) })
    }
    /// The lower and the upper 16 bits, signed.
    #[inline(always)]
    fn halves(self) -> [Floats; 2] {
        // SAFETY: likewise.
        let low = Ints(unsafe { _mm256_slli_epi32::<16>(self.0) });
        [Floats::from_ints(low.shifted_right(16)), Floats::from_ints(self.shifted_right(16))]
    }
    /// Four lanes' indices, which leave a register two at a time.
    #[inline(always)]
    fn indices<const UPPER: i32>(self) -> [usize; 4] {
        // SAFETY: likewise.
        let (low, high) = unsafe {
            let four = _mm256_extracti128_si256::<UPPER>(self.0);
            (_mm_cvtsi128_si64(four) as u64, _mm_extract_epi64::<1>(four) as u64)
        };
        [(low & 0xffff_ffff) as usize, (low >> 32) as usize, (high & 0xffff_ffff) as usize, (high >> 32) as usize]
    }
}

/// Two neighbours each, in one read of 32 bits.
///
/// # Safety
/// Both must be there.
#[inline(always)]
unsafe fn four_pairs(from: *const i16, places: [usize; 4]) -> __m128i {
    // SAFETY: the caller's.
    unsafe {
        let read = |k: usize| from.add(places[k]).cast::<i32>().read_unaligned();
        let first = _mm_cvtsi32_si128(read(0));
        let second = _mm_insert_epi32::<1>(first, read(1));
        _mm_insert_epi32::<3>(_mm_insert_epi32::<2>(second, read(2)), read(3))
    }
}

/// Four neighbours each, in one read of 64 bits.
///
/// # Safety
/// All four must be there.
#[inline(always)]
unsafe fn four_quads(from: *const i16, places: [usize; 4]) -> __m256 {
    // SAFETY: the caller's.
    unsafe {
        let read = |k: usize| from.add(places[k]).cast::<f64>();
        let first = _mm_loadh_pd(_mm_load_sd(read(0)), read(1));
        let second = _mm_loadh_pd(_mm_load_sd(read(2)), read(3));
        _mm256_castpd_ps(_mm256_set_m128d(second, first))
    }
}

/// Pairs at several distances from `at`, for which indices leave their register once.
///
/// # Safety
/// They must be there.
#[inline(always)]
pub(crate) unsafe fn pairs_around<const N: usize>(from: *const i16, at: Ints, away: [isize; N]) -> [[Floats; 2]; N] {
    let (low, high) = (at.indices::<0>(), at.indices::<1>());
    let mut pairs = [[Floats::splat(0.0); 2]; N];
    for n in 0..N {
        // SAFETY: the caller's.
        let both = unsafe {
            let from = from.offset(away[n]);
            _mm256_set_m128i(four_pairs(from, high), four_pairs(from, low))
        };
        pairs[n] = Ints(both).halves();
    }
    pairs
}

/// Likewise four neighbours each.
///
/// # Safety
/// They must be there.
#[inline(always)]
pub(crate) unsafe fn quads_around<const N: usize>(from: *const i16, at: Ints, away: [isize; N]) -> [[Floats; 4]; N] {
    let (low, high) = (at.indices::<0>(), at.indices::<1>());
    let mut quads = [[Floats::splat(0.0); 4]; N];
    for n in 0..N {
        // SAFETY: the caller's.
        let [first, second] = unsafe {
            let from = from.offset(away[n]);
            let (low, high) = (four_quads(from, low), four_quads(from, high));
            // Of lanes 0 1 4 5 2 3 6 7, then put in order.
            let first = _mm256_castps_pd(_mm256_shuffle_ps::<0b10_00_10_00>(low, high));
            let second = _mm256_castps_pd(_mm256_shuffle_ps::<0b11_01_11_01>(low, high));
            let first = _mm256_castpd_si256(_mm256_permute4x64_pd::<0b11_01_10_00>(first));
            let second = _mm256_castpd_si256(_mm256_permute4x64_pd::<0b11_01_10_00>(second));
            [Ints(first), Ints(second)]
        };
        let ([a, b], [c, d]) = (first.halves(), second.halves());
        quads[n] = [a, b, c, d];
    }
    quads
}
