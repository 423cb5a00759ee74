//! Vectors of four numbers, to and from memory lane by lane.
#![expect(unsafe_code, reason = "intrinsics; the module's rules say why they are safe")]

use std::arch::x86_64::*;

use super::F32x8;
use crate::simd::BATCH;

// SAFETY, for both blocks below: as for all registers, see the module; rows of four numbers are as long as what is read or written.
/// As [`Lanes::store_vectors`](crate::simd::Lanes::store_vectors).
#[inline(always)]
pub(super) fn store_vectors([x, y, z, w]: [F32x8; 4], to: &mut [[f32; 4]; BATCH]) {
    unsafe {
        let (xy, xy_next) = (_mm256_unpacklo_ps(x.0, y.0), _mm256_unpackhi_ps(x.0, y.0));
        let (zw, zw_next) = (_mm256_unpacklo_ps(z.0, w.0), _mm256_unpackhi_ps(z.0, w.0));
        // The k-th vector of each half.
        let vectors = [
            _mm256_shuffle_ps::<0b01_00_01_00>(xy, zw),
            _mm256_shuffle_ps::<0b11_10_11_10>(xy, zw),
            _mm256_shuffle_ps::<0b01_00_01_00>(xy_next, zw_next),
            _mm256_shuffle_ps::<0b11_10_11_10>(xy_next, zw_next),
        ];
        for (k, both) in vectors.into_iter().enumerate() {
            _mm_storeu_ps(to[k].as_mut_ptr(), _mm256_castps256_ps128(both));
            _mm_storeu_ps(to[k + 4].as_mut_ptr(), _mm256_extractf128_ps::<1>(both));
        }
    }
}

/// As [`Lanes::load_vectors`](crate::simd::Lanes::load_vectors).
#[inline(always)]
pub(super) fn load_vectors(from: &[[f32; 4]]) -> [F32x8; 4] {
    let from = &from[..8];
    unsafe {
        // The k-th vector of each half.
        let both = |k: usize| _mm256_set_m128(_mm_loadu_ps(from[k + 4].as_ptr()), _mm_loadu_ps(from[k].as_ptr()));
        let (a, b, c, d) = (both(0), both(1), both(2), both(3));
        let (xy, zw) = (_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b));
        let (xy_next, zw_next) = (_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d));
        [
            F32x8(_mm256_shuffle_ps::<0b01_00_01_00>(xy, xy_next)),
            F32x8(_mm256_shuffle_ps::<0b11_10_11_10>(xy, xy_next)),
            F32x8(_mm256_shuffle_ps::<0b01_00_01_00>(zw, zw_next)),
            F32x8(_mm256_shuffle_ps::<0b11_10_11_10>(zw, zw_next)),
        ]
    }
}
