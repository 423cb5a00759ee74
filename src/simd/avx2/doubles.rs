//! Eight f64, in two registers.
#![expect(unsafe_code, reason = "intrinsics; the module's rules say why they are safe")]

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

use super::super::Doubles;
use super::super::register::operators;
use super::{F64x8, I32x8, Mask8};

// SAFETY, for every block below: as for all registers, see the module.
operators!(F64x8, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd);

impl F64x8 {
    /// The truths of two registers of four.
    #[inline(always)]
    fn joined(low: __m256d, high: __m256d) -> Mask8 {
        Mask8(unsafe {
            // The lower half of each truth, in an order that the next instruction mends.
            let mixed = _mm256_shuffle_ps::<0b10_00_10_00>(_mm256_castpd_ps(low), _mm256_castpd_ps(high));
            _mm256_castpd_ps(_mm256_permute4x64_pd::<0b11_01_10_00>(_mm256_castps_pd(mixed)))
        })
    }

    /// Truths for two registers of four.
    #[inline(always)]
    fn split(mask: Mask8) -> [__m256d; 2] {
        unsafe {
            let ints = _mm256_castps_si256(mask.0);
            let (low, high) = (_mm256_castsi256_si128(ints), _mm256_extracti128_si256::<1>(ints));
            [_mm256_castsi256_pd(_mm256_cvtepi32_epi64(low)), _mm256_castsi256_pd(_mm256_cvtepi32_epi64(high))]
        }
    }
}

impl Doubles for F64x8 {
    type Ints = I32x8;
    type Mask = Mask8;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        F64x8(unsafe { [_mm256_set1_pd(x), _mm256_set1_pd(x)] })
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let (low, high) = from[..8].split_at(4);
        F64x8(unsafe { [_mm256_loadu_pd(low.as_ptr()), _mm256_loadu_pd(high.as_ptr())] })
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let (low, high) = to[..8].split_at_mut(4);
        unsafe {
            _mm256_storeu_pd(low.as_mut_ptr(), self.0[0]);
            _mm256_storeu_pd(high.as_mut_ptr(), self.0[1]);
        }
    }
    #[inline(always)]
    fn from_ints(ints: I32x8) -> Self {
        F64x8(unsafe {
            let (low, high) = (_mm256_castsi256_si128(ints.0), _mm256_extracti128_si256::<1>(ints.0));
            [_mm256_cvtepi32_pd(low), _mm256_cvtepi32_pd(high)]
        })
    }
    #[inline(always)]
    fn to_ints(self) -> I32x8 {
        let [low, high] = self.0;
        I32x8(unsafe { _mm256_set_m128i(_mm256_cvttpd_epi32(high), _mm256_cvttpd_epi32(low)) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        let [low, high] = self.0;
        F64x8(unsafe { [_mm256_floor_pd(low), _mm256_floor_pd(high)] })
    }
    #[inline(always)]
    fn mul_plus(self, a: Self, b: Self) -> Self {
        let ([p, q], [a, c], [b, d]) = (self.0, a.0, b.0);
        F64x8(unsafe { [_mm256_fmadd_pd(p, a, b), _mm256_fmadd_pd(q, c, d)] })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.0, other.0);
        F64x8(unsafe { [_mm256_min_pd(c, a), _mm256_min_pd(d, b)] })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        let ([a, b], [c, d]) = (self.0, other.0);
        let (low, high) = unsafe { (_mm256_cmp_pd::<_CMP_LT_OQ>(a, c), _mm256_cmp_pd::<_CMP_LT_OQ>(b, d)) };
        F64x8::joined(low, high)
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask8 {
        let ([a, b], [c, d]) = (self.0, other.0);
        let (low, high) = unsafe { (_mm256_cmp_pd::<_CMP_LE_OQ>(a, c), _mm256_cmp_pd::<_CMP_LE_OQ>(b, d)) };
        F64x8::joined(low, high)
    }
    #[inline(always)]
    fn select(mask: Mask8, yes: Self, no: Self) -> Self {
        let ([a, b], [c, d], [low, high]) = (yes.0, no.0, F64x8::split(mask));
        F64x8(unsafe { [_mm256_blendv_pd(c, a, low), _mm256_blendv_pd(d, b, high)] })
    }
}
