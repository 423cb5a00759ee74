//! Numbers that lie apart in memory, and what is stored lane by lane.
#![expect(unsafe_code, reason = "intrinsics; the module's rules say why they are safe")]

use std::arch::x86_64::*;

use super::{F32x16, I32x16};
use crate::simd::BATCH;
use crate::simd::lanes::last;

/// Four lanes each.
#[inline(always)]
pub(super) fn quarters(all: __m512i) -> [__m128i; 4] {
    // SAFETY: as for all registers, see the module.
    unsafe {
        [
            _mm512_castsi512_si128(all),
            _mm512_extracti32x4_epi32::<1>(all),
            _mm512_extracti32x4_epi32::<2>(all),
            _mm512_extracti32x4_epi32::<3>(all),
        ]
    }
}

/// Indices, which leave a register two at a time.
#[inline(always)]
pub(super) fn indices(four: __m128i) -> [usize; 4] {
    // SAFETY: as for all registers, see the module.
    let (low, high) = unsafe { (_mm_cvtsi128_si64(four) as u64, _mm_extract_epi64::<1>(four) as u64) };
    [(low & 0xffff_ffff) as usize, (low >> 32) as usize, (high & 0xffff_ffff) as usize, (high >> 32) as usize]
}

/// Two neighbours each, in one read of 32 bits: so many reads take less time than a gather.
///
/// # Safety
/// Both must be there.
#[inline(always)]
pub(super) unsafe fn four_pairs(from: *const i16, places: [usize; 4]) -> __m128i {
    // SAFETY: the caller's.
    unsafe {
        let read = |k: usize| from.add(places[k]).cast::<i32>().read_unaligned();
        let first = _mm_cvtsi32_si128(read(0));
        let second = _mm_insert_epi32::<1>(first, read(1));
        let third = _mm_insert_epi32::<2>(second, read(2));
        _mm_insert_epi32::<3>(third, read(3))
    }
}

/// Four neighbours each, in one read of 64 bits: likewise.
///
/// # Safety
/// All four must be there.
#[inline(always)]
pub(super) unsafe fn four_quads(from: *const i16, places: [usize; 4]) -> __m256i {
    // SAFETY: the caller's.
    unsafe {
        let read = |k: usize| from.add(places[k]).cast::<f64>();
        let first = _mm_loadh_pd(_mm_load_sd(read(0)), read(1));
        let second = _mm_loadh_pd(_mm_load_sd(read(2)), read(3));
        _mm256_castpd_si256(_mm256_set_m128d(second, first))
    }
}

// SAFETY, for both blocks below: as for all registers, see the module.
/// As [`Lanes::vectors`](crate::simd::Lanes::vectors).
#[inline(always)]
pub(super) fn vectors(from: &[[f32; 4]], at: I32x16) -> [F32x16; 3] {
    unsafe {
        let quarters = quarters(_mm512_min_epu32(at.0, _mm512_set1_epi32(last(from) as i32)));
        let places = [indices(quarters[0]), indices(quarters[1]), indices(quarters[2]), indices(quarters[3])];
        let vector = |quarter: usize, k: usize| _mm_loadu_ps(from.as_ptr().add(places[quarter][k]).cast());
        // The k-th of each quarter.
        let row = |k: usize| {
            let row = _mm512_insertf32x4::<1>(_mm512_castps128_ps512(vector(0, k)), vector(1, k));
            _mm512_insertf32x4::<3>(_mm512_insertf32x4::<2>(row, vector(2, k)), vector(3, k))
        };
        let (a, b, c, d) = (row(0), row(1), row(2), row(3));
        let (xy, zw) = (_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b));
        let (xy_next, zw_next) = (_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d));
        [
            F32x16(_mm512_shuffle_ps::<0b01_00_01_00>(xy, xy_next)),
            F32x16(_mm512_shuffle_ps::<0b11_10_11_10>(xy, xy_next)),
            F32x16(_mm512_shuffle_ps::<0b01_00_01_00>(zw, zw_next)),
        ]
    }
}
/// As [`Lanes::store_vectors`](crate::simd::Lanes::store_vectors).
#[inline(always)]
pub(super) fn store_vectors([x, y, z, w]: [F32x16; 4], to: &mut [[f32; 4]; BATCH]) {
    unsafe {
        let (xy, xy_next) = (_mm512_unpacklo_ps(x.0, y.0), _mm512_unpackhi_ps(x.0, y.0));
        let (zw, zw_next) = (_mm512_unpacklo_ps(z.0, w.0), _mm512_unpackhi_ps(z.0, w.0));
        // The k-th vector of each quarter.
        let first = _mm512_shuffle_ps::<0b01_00_01_00>(xy, zw);
        let second = _mm512_shuffle_ps::<0b11_10_11_10>(xy, zw);
        let third = _mm512_shuffle_ps::<0b01_00_01_00>(xy_next, zw_next);
        let fourth = _mm512_shuffle_ps::<0b11_10_11_10>(xy_next, zw_next);
        // Quarters 0 and 1 of two, quarters 2 and 3 of two, then a quarter of all four.
        let (low, high) = (_mm512_shuffle_f32x4::<0x44>(first, second), _mm512_shuffle_f32x4::<0x44>(third, fourth));
        let to = to.as_mut_ptr().cast::<f32>();
        _mm512_storeu_ps(to, _mm512_shuffle_f32x4::<0x88>(low, high));
        _mm512_storeu_ps(to.add(16), _mm512_shuffle_f32x4::<0xdd>(low, high));
        let (low, high) = (_mm512_shuffle_f32x4::<0xee>(first, second), _mm512_shuffle_f32x4::<0xee>(third, fourth));
        _mm512_storeu_ps(to.add(32), _mm512_shuffle_f32x4::<0x88>(low, high));
        _mm512_storeu_ps(to.add(48), _mm512_shuffle_f32x4::<0xdd>(low, high));
    }
}

/// As [`Lanes::load_vectors`](crate::simd::Lanes::load_vectors).
#[inline(always)]
pub(super) fn load_vectors(from: &[[f32; 4]]) -> [F32x16; 4] {
    let from = from[..BATCH].as_flattened();
    // SAFETY: as for all registers, see the module.
    unsafe {
        let four = |k: usize| _mm512_loadu_ps(from[k * BATCH..][..BATCH].as_ptr());
        let (a, b, c, d) = (four(0), four(1), four(2), four(3));
        let first = _mm512_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28, 1, 5, 9, 13, 17, 21, 25, 29);
        let last = _mm512_setr_epi32(2, 6, 10, 14, 18, 22, 26, 30, 3, 7, 11, 15, 19, 23, 27, 31);
        let (xy, xy_next) = (_mm512_permutex2var_ps(a, first, b), _mm512_permutex2var_ps(c, first, d));
        let (zw, zw_next) = (_mm512_permutex2var_ps(a, last, b), _mm512_permutex2var_ps(c, last, d));
        [
            F32x16(_mm512_shuffle_f32x4::<0x44>(xy, xy_next)),
            F32x16(_mm512_shuffle_f32x4::<0xee>(xy, xy_next)),
            F32x16(_mm512_shuffle_f32x4::<0x44>(zw, zw_next)),
            F32x16(_mm512_shuffle_f32x4::<0xee>(zw, zw_next)),
        ]
    }
}
