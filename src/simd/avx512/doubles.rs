//! Sixteen f64, in two registers.
#![expect(unsafe_code, reason = "intrinsics; the module's rules say why they are safe")]

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

use super::super::Doubles;
use super::super::register::operators;
use super::{F64x16, I32x16, Mask16};

// SAFETY, for every block below: as for all registers, see the module.
operators!(F64x16, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd);

impl Doubles for F64x16 {
    type Ints = I32x16;
    type Mask = Mask16;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        F64x16(unsafe { [_mm512_set1_pd(x), _mm512_set1_pd(x)] })
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        let (low, high) = from[..16].split_at(8);
        F64x16(unsafe { [_mm512_loadu_pd(low.as_ptr()), _mm512_loadu_pd(high.as_ptr())] })
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let (low, high) = to[..16].split_at_mut(8);
        unsafe {
            _mm512_storeu_pd(low.as_mut_ptr(), self.0[0]);
            _mm512_storeu_pd(high.as_mut_ptr(), self.0[1]);
        }
    }
    #[inline(always)]
    fn from_ints(ints: I32x16) -> Self {
        F64x16(unsafe {
            let (low, high) = (_mm512_castsi512_si256(ints.0), _mm512_extracti64x4_epi64::<1>(ints.0));
            [_mm512_cvtepi32_pd(low), _mm512_cvtepi32_pd(high)]
        })
    }
    #[inline(always)]
    fn to_ints(self) -> I32x16 {
        let [low, high] = self.0;
        I32x16(unsafe {
            let low = _mm512_castsi256_si512(_mm512_cvttpd_epi32(low));
            _mm512_inserti64x4::<1>(low, _mm512_cvttpd_epi32(high))
        })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        let [low, high] = self.0;
        const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
        F64x16(unsafe { [_mm512_roundscale_pd::<DOWN>(low), _mm512_roundscale_pd::<DOWN>(high)] })
    }
    #[inline(always)]
    fn mul_plus(self, a: Self, b: Self) -> Self {
        let ([p, q], [a, c], [b, d]) = (self.0, a.0, b.0);
        F64x16(unsafe { [_mm512_fmadd_pd(p, a, b), _mm512_fmadd_pd(q, c, d)] })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.0, other.0);
        F64x16(unsafe { [_mm512_min_pd(c, a), _mm512_min_pd(d, b)] })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask16 {
        let ([a, b], [c, d]) = (self.0, other.0);
        let (low, high) = unsafe { (_mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, c), _mm512_cmp_pd_mask::<_CMP_LT_OQ>(b, d)) };
        Mask16(u16::from(low) | u16::from(high) << 8)
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask16 {
        let ([a, b], [c, d]) = (self.0, other.0);
        let (low, high) = unsafe { (_mm512_cmp_pd_mask::<_CMP_LE_OQ>(a, c), _mm512_cmp_pd_mask::<_CMP_LE_OQ>(b, d)) };
        Mask16(u16::from(low) | u16::from(high) << 8)
    }
    #[inline(always)]
    fn select(mask: Mask16, yes: Self, no: Self) -> Self {
        let ([a, b], [c, d]) = (yes.0, no.0);
        F64x16(unsafe { [_mm512_mask_blend_pd(mask.0 as u8, c, a), _mm512_mask_blend_pd((mask.0 >> 8) as u8, d, b)] })
    }
}
