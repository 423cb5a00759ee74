//! Eight lanes: AVX2.
#![expect(unsafe_code, reason = "intrinsics; the module's rules say why they are safe")]

mod doubles;
mod memory;

use std::arch::x86_64::*;
use std::mem::transmute;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use super::lanes::{attenuation, last, last_pair, last_quad, last_word};
use super::register::arithmetic;
use super::{Away, BATCH, Ints, Kernel, Lanes, Mask, TWO_BATCHES, Table};
use crate::math::{Number, each};
use memory::{load_vectors, store_vectors};

/// Runs a kernel compiled for these instructions.
///
/// # Safety
/// The processor must have them.
#[target_feature(enable = "avx2,fma")]
pub(super) unsafe fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<F32x8>()
}

/// Eight f32.
#[derive(Clone, Copy)]
pub(crate) struct F32x8(__m256);

/// Eight i32.
#[derive(Clone, Copy)]
pub(crate) struct I32x8(__m256i);

/// Eight f64, in two registers.
#[derive(Clone, Copy)]
pub(crate) struct F64x8([__m256d; 2]);

/// Eight truths: all bits of a lane, or none.
#[derive(Clone, Copy)]
pub(crate) struct Mask8(__m256);

arithmetic!(
    F32x8,
    8,
    __m256,
    _mm256_add_ps,
    _mm256_sub_ps,
    _mm256_mul_ps,
    _mm256_div_ps,
    _mm256_fmadd_ps,
    _mm256_fnmadd_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    _mm256_sqrt_ps,
    _mm256_xor_ps,
    _mm256_andnot_ps,
    _mm256_set1_ps
);

/// For each set of lanes, their numbers in order.
const COMPRESSED: [[i32; 8]; 256] = {
    let mut all = [[0; 8]; 256];
    let mut bits = 0;
    while bits < 256 {
        let (mut lane, mut at) = (0, 0);
        while lane < 8 {
            if bits >> lane & 1 == 1 {
                all[bits][at] = lane;
                at += 1;
            }
            lane += 1;
        }
        bits += 1;
    }
    all
};

/// For each set of lanes and each lane, how many of the set are before it.
const RANKS: [[i32; 8]; 256] = {
    let mut all = [[0; 8]; 256];
    let mut bits: usize = 0;
    while bits < 256 {
        let mut lane = 1;
        while lane < 8 {
            all[bits][lane] = all[bits][lane - 1] + (bits >> (lane - 1) & 1) as i32;
            lane += 1;
        }
        bits += 1;
    }
    all
};

// SAFETY, for every block below: values of these types exist only in kernels that `Level::run` has started, so the processor
// has the instructions; slices are checked to be as long as what is read or written, and indices are clamped to them.
#[inline(always)]
fn order(mask: Mask8) -> __m256i {
    unsafe { _mm256_loadu_si256(COMPRESSED[mask.bits() as usize & 255].as_ptr().cast()) }
}

#[inline(always)]
fn ranks(mask: Mask8) -> __m256i {
    unsafe { _mm256_loadu_si256(RANKS[mask.bits() as usize & 255].as_ptr().cast()) }
}

#[inline(always)]
fn clamped(at: I32x8, last: u32) -> __m256i {
    unsafe { _mm256_min_epu32(at.0, _mm256_set1_epi32(last as i32)) }
}

/// Entries of a table of two registers, by indices below 16.
#[inline(always)]
fn halves_by(table: &[f32; BATCH], at: __m256i) -> F32x8 {
    let (low, high) = table.split_at(8);
    unsafe {
        let low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(low.as_ptr()), at);
        let high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(high.as_ptr()), at);
        // Bit 3 of the index, moved to the sign, chooses the half.
        F32x8(_mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32::<28>(at))))
    }
}

impl Lanes for F32x8 {
    const LANES: usize = 8;
    type Ints = I32x8;
    type Doubles = F64x8;
    type Mask = Mask8;

    #[inline(always)]
    fn from_doubles(doubles: F64x8) -> Self {
        let [low, high] = doubles.0;
        F32x8(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low)) })
    }
    #[inline(always)]
    fn to_doubles(self) -> F64x8 {
        F64x8(unsafe {
            [_mm256_cvtps_pd(_mm256_castps256_ps128(self.0)), _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(self.0))]
        })
    }
    #[inline(always)]
    fn gather(from: &[f32], at: I32x8) -> Self {
        F32x8(unsafe { _mm256_i32gather_ps::<4>(from.as_ptr(), clamped(at, last(from))) })
    }
    #[inline(always)]
    fn store_vectors(numbers: [Self; 4], to: &mut [[f32; 4]; BATCH]) {
        store_vectors(numbers, to);
    }
    #[inline(always)]
    fn load_vectors(from: &[[f32; 4]]) -> [Self; 4] {
        load_vectors(from)
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        F32x8(unsafe { _mm256_loadu_ps(from[..8].as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        unsafe { _mm256_storeu_ps(to[..8].as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Mask8, yes: Self, no: Self) -> Self {
        F32x8(unsafe { _mm256_blendv_ps(no.0, yes.0, mask.0) })
    }
    #[inline(always)]
    fn round(self) -> Self {
        F32x8(unsafe { _mm256_round_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0) })
    }
    #[inline(always)]
    fn to_ints(self) -> I32x8 {
        I32x8(unsafe { _mm256_cvttps_epi32(self.0) })
    }
    #[inline(always)]
    fn from_ints(ints: I32x8) -> Self {
        F32x8(unsafe { _mm256_cvtepi32_ps(ints.0) })
    }
    #[inline(always)]
    fn power_of_two(exponent: I32x8) -> Self {
        F32x8(unsafe {
            _mm256_castsi256_ps(_mm256_slli_epi32::<23>(_mm256_add_epi32(exponent.0, _mm256_set1_epi32(127))))
        })
    }
    #[inline(always)]
    fn pick(table: &Table, at: I32x8) -> Self {
        let entries = table.entries();
        let at = clamped(at, (entries.len() - 1) as u32);
        unsafe {
            match entries.try_into() {
                Ok(entries) => halves_by(entries, at),
                Err(_) => F32x8(_mm256_i32gather_ps::<4>(entries.as_ptr(), at)),
            }
        }
    }
    #[inline(always)]
    fn pick32(table: &[f32; TWO_BATCHES], at: I32x8) -> Self {
        unsafe { F32x8(_mm256_i32gather_ps::<4>(table.as_ptr(), clamped(at, TWO_BATCHES as u32 - 1))) }
    }
    #[inline(always)]
    fn pick16(table: &[f32; BATCH], at: I32x8) -> Self {
        halves_by(table, clamped(at, BATCH as u32 - 1))
    }
    #[inline(always)]
    fn pairs_i16<const N: usize>(samples: &[i16], at: I32x8, away: &Away<N>) -> [I32x8; N] {
        each(
            #[inline(always)]
            |n| {
                let at = clamped(at + I32x8::splat(away.distance(n)), last_pair(samples));
                // Two neighbours in one read of 32 bits.
                I32x8(unsafe { _mm256_i32gather_epi32::<2>(samples.as_ptr().cast(), at) })
            },
        )
    }
    #[inline(always)]
    fn pairs_f32(samples: &[f32], at: I32x8) -> [Self; 2] {
        let at = clamped(at, last_pair(samples));
        let next = samples[1..].as_ptr();
        unsafe { [F32x8(_mm256_i32gather_ps::<4>(samples.as_ptr(), at)), F32x8(_mm256_i32gather_ps::<4>(next, at))] }
    }
    #[inline(always)]
    fn quads_i16<const N: usize>(samples: &[i16], at: I32x8, away: &Away<N>) -> [[I32x8; 2]; N] {
        each(
            #[inline(always)]
            |n| unsafe {
                let at = clamped(at + I32x8::splat(away.distance(n)), last_quad(samples));
                let from = samples.as_ptr().cast();
                // Four neighbours in one read of 64 bits, for half of the lanes at a time.
                let low = _mm256_i32gather_epi64::<2>(from, _mm256_castsi256_si128(at));
                let high = _mm256_i32gather_epi64::<2>(from, _mm256_extracti128_si256::<1>(at));
                let (low, high) = (_mm256_castsi256_ps(low), _mm256_castsi256_ps(high));
                // The pairs of lanes 0 1 4 5 2 3 6 7, then put in order.
                let first = _mm256_castps_si256(_mm256_shuffle_ps::<0b10_00_10_00>(low, high));
                let last = _mm256_castps_si256(_mm256_shuffle_ps::<0b11_01_11_01>(low, high));
                [
                    I32x8(_mm256_permute4x64_epi64::<0b11_01_10_00>(first)),
                    I32x8(_mm256_permute4x64_epi64::<0b11_01_10_00>(last)),
                ]
            },
        )
    }
    #[inline(always)]
    fn quads_f32(samples: &[f32], at: I32x8) -> [Self; 4] {
        let at = clamped(at, last_quad(samples));
        let mut quads = [F32x8::ZERO; 4];
        for (k, quad) in quads.iter_mut().enumerate() {
            *quad = F32x8(unsafe { _mm256_i32gather_ps::<4>(samples[k..].as_ptr(), at) });
        }
        quads
    }
    #[inline(always)]
    fn compress(self, mask: Mask8) -> Self {
        F32x8(unsafe { _mm256_permutevar8x32_ps(self.0, order(mask)) })
    }
    #[inline(always)]
    fn expand(self, mask: Mask8) -> Self {
        F32x8(unsafe { _mm256_permutevar8x32_ps(self.0, ranks(mask)) })
    }
    #[inline(always)]
    fn among(self, other: Self, at: I32x8) -> Self {
        unsafe {
            let (low, high) = (_mm256_permutevar8x32_ps(self.0, at.0), _mm256_permutevar8x32_ps(other.0, at.0));
            // Bit 3 of the number, moved to the sign, chooses the register.
            F32x8(_mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32::<28>(at.0))))
        }
    }
}

impl Default for I32x8 {
    #[inline(always)]
    fn default() -> Self {
        I32x8::splat(0)
    }
}

impl Add for I32x8 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        I32x8(unsafe { _mm256_add_epi32(self.0, other.0) })
    }
}

impl Sub for I32x8 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        I32x8(unsafe { _mm256_sub_epi32(self.0, other.0) })
    }
}

impl Mul for I32x8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        I32x8(unsafe { _mm256_mullo_epi32(self.0, other.0) })
    }
}

impl Ints for I32x8 {
    type Mask = Mask8;

    #[inline(always)]
    fn splat(x: i32) -> Self {
        I32x8(unsafe { _mm256_set1_epi32(x) })
    }
    #[inline(always)]
    fn count() -> Self {
        I32x8(unsafe { _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7) })
    }
    #[inline(always)]
    fn load(from: &[i32]) -> Self {
        I32x8(unsafe { _mm256_loadu_si256(from[..8].as_ptr().cast()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [i32]) {
        unsafe { _mm256_storeu_si256(to[..8].as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn shifted_right(self, bits: u32) -> Self {
        I32x8(unsafe { _mm256_srav_epi32(self.0, _mm256_set1_epi32(bits as i32)) })
    }
    #[inline(always)]
    fn low_half(self) -> Self {
        I32x8(unsafe { _mm256_madd_epi16(self.0, _mm256_set1_epi32(1)) })
    }
    #[inline(always)]
    fn rise(self) -> Self {
        // 1 times the second half, -1 times the first.
        I32x8(unsafe { _mm256_madd_epi16(self.0, _mm256_set1_epi32(0x1_ffff)) })
    }
    #[inline(always)]
    fn and(self, bits: Self) -> Self {
        I32x8(unsafe { _mm256_and_si256(self.0, bits.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        I32x8(unsafe { _mm256_min_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        I32x8(unsafe { _mm256_max_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn without_low_bits(self, by: Self) -> Self {
        I32x8(unsafe { _mm256_sllv_epi32(_mm256_srav_epi32(self.0, by.0), by.0) })
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        I32x8(unsafe { _mm256_sllv_epi32(_mm256_set1_epi32(1), self.0) })
    }
    #[inline(always)]
    fn gather(from: &[i32], at: Self) -> Self {
        I32x8(unsafe { _mm256_i32gather_epi32::<4>(from.as_ptr(), clamped(at, last(from))) })
    }
    #[inline(always)]
    fn bytes(from: &[u8], at: Self) -> Self {
        unsafe {
            let words = _mm256_i32gather_epi32::<1>(from.as_ptr().cast(), clamped(at, last_word(from)));
            I32x8(_mm256_and_si256(words, _mm256_set1_epi32(0xff)))
        }
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_castsi256_ps(_mm256_cmpeq_epi32(self.0, other.0)) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        Mask8(unsafe { _mm256_castsi256_ps(_mm256_cmpgt_epi32(other.0, self.0)) })
    }
    #[inline(always)]
    fn select(mask: Mask8, yes: Self, no: Self) -> Self {
        let (no, yes) = unsafe { (_mm256_castsi256_ps(no.0), _mm256_castsi256_ps(yes.0)) };
        I32x8(unsafe { _mm256_castps_si256(_mm256_blendv_ps(no, yes, mask.0)) })
    }
    #[inline(always)]
    fn compress(self, mask: Mask8) -> Self {
        I32x8(unsafe { _mm256_permutevar8x32_epi32(self.0, order(mask)) })
    }
    #[inline(always)]
    fn expand(self, mask: Mask8) -> Self {
        I32x8(unsafe { _mm256_permutevar8x32_epi32(self.0, ranks(mask)) })
    }
    #[inline(always)]
    fn among(self, other: Self, at: Self) -> Self {
        let (low, high) = unsafe { (_mm256_castsi256_ps(self.0), _mm256_castsi256_ps(other.0)) };
        I32x8(unsafe { _mm256_castps_si256(F32x8(low).among(F32x8(high), at).0) })
    }
}

impl Mask for Mask8 {
    const ALL: Self = Mask8(unsafe { transmute::<[i32; 8], __m256>([-1; 8]) });

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Mask8(unsafe { _mm256_and_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Mask8(unsafe { _mm256_or_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn and_not(self, other: Self) -> Self {
        Mask8(unsafe { _mm256_andnot_ps(other.0, self.0) })
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        unsafe { _mm256_movemask_ps(self.0) as u32 }
    }
}
