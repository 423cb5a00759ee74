//! Sixteen lanes: AVX-512 F, BW, DQ and VL.
#![expect(unsafe_code, reason = "intrinsics; the module's rules say why they are safe")]

mod doubles;
mod memory;

use std::arch::x86_64::*;
use std::mem::transmute;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::sync::atomic::{Ordering, compiler_fence};

use super::lanes::{attenuation, last, last_pair, last_quad, last_word};
use super::register::arithmetic;
use super::{Away, BATCH, Ints, Kernel, Lanes, Mask, TWO_BATCHES, Table};
use crate::math::{Number, each};
use memory::{four_pairs, four_quads, indices, load_vectors, quarters, store_vectors, vectors};

/// Runs a kernel compiled for these instructions.
///
/// # Safety
/// The processor must have them.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) unsafe fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<F32x16>()
}

/// Sixteen f32.
#[derive(Clone, Copy)]
pub(crate) struct F32x16(__m512);

/// Sixteen i32.
#[derive(Clone, Copy)]
pub(crate) struct I32x16(__m512i);

/// Sixteen f64, in two registers.
#[derive(Clone, Copy)]
pub(crate) struct F64x16([__m512d; 2]);

/// Sixteen truths.
#[derive(Clone, Copy)]
pub(crate) struct Mask16(__mmask16);

arithmetic!(
    F32x16,
    16,
    __m512,
    _mm512_add_ps,
    _mm512_sub_ps,
    _mm512_mul_ps,
    _mm512_div_ps,
    _mm512_fmadd_ps,
    _mm512_fnmadd_ps,
    _mm512_min_ps,
    _mm512_max_ps,
    _mm512_sqrt_ps,
    _mm512_xor_ps,
    _mm512_andnot_ps,
    _mm512_set1_ps
);

/// In lane k what lane k - distance has, and 0 where there is none.
#[inline(always)]
fn moved(all: __m512, distance: i32) -> __m512 {
    // SAFETY: as below.
    unsafe {
        let from = _mm512_sub_epi32(I32x16::count().0, _mm512_set1_epi32(distance));
        _mm512_maskz_permutexvar_ps(u16::MAX << distance, from, all)
    }
}

/// Keeps compilers from putting reads before and behind this into another order, in which they need more indices at a time than there are
/// registers. No instruction.
#[inline(always)]
fn in_this_order() {
    compiler_fence(Ordering::SeqCst);
}

// SAFETY, for every block below: values of these types exist only in kernels that `Level::run` has started, so the processor
// has the instructions; slices are checked to be as long as what is read or written, and indices are clamped to them.
impl Lanes for F32x16 {
    const LANES: usize = 16;
    type Ints = I32x16;
    type Doubles = F64x16;
    type Mask = Mask16;

    #[inline(always)]
    fn from_doubles(doubles: F64x16) -> Self {
        let [low, high] = doubles.0;
        F32x16(unsafe {
            let low = _mm512_castps256_ps512(_mm512_cvtpd_ps(low));
            _mm512_insertf32x8::<1>(low, _mm512_cvtpd_ps(high))
        })
    }
    #[inline(always)]
    fn to_doubles(self) -> F64x16 {
        F64x16(unsafe {
            [_mm512_cvtps_pd(_mm512_castps512_ps256(self.0)), _mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(self.0))]
        })
    }
    #[inline(always)]
    fn gather(from: &[f32], at: I32x16) -> Self {
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(last(from) as i32));
            F32x16(_mm512_i32gather_ps::<4>(at, from.as_ptr()))
        }
    }
    #[inline(always)]
    fn vectors(from: &[[f32; 4]], at: I32x16) -> [Self; 3] {
        vectors(from, at)
    }
    #[inline(always)]
    fn store_vectors(numbers: [Self; 4], to: &mut [[f32; 4]; BATCH]) {
        store_vectors(numbers, to);
    }
    #[inline(always)]
    fn load_vectors(from: &[[f32; 4]]) -> [Self; 4] {
        load_vectors(&from[..BATCH])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        F32x16(unsafe { _mm512_loadu_ps(from[..16].as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        unsafe { _mm512_storeu_ps(to[..16].as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Mask16, yes: Self, no: Self) -> Self {
        F32x16(unsafe { _mm512_mask_blend_ps(mask.0, no.0, yes.0) })
    }
    #[inline(always)]
    fn round(self) -> Self {
        F32x16(unsafe { _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0) })
    }
    #[inline(always)]
    fn to_ints(self) -> I32x16 {
        I32x16(unsafe { _mm512_cvttps_epi32(self.0) })
    }
    #[inline(always)]
    fn from_ints(ints: I32x16) -> Self {
        F32x16(unsafe { _mm512_cvtepi32_ps(ints.0) })
    }
    #[inline(always)]
    fn power_of_two(exponent: I32x16) -> Self {
        F32x16(unsafe {
            _mm512_castsi512_ps(_mm512_slli_epi32::<23>(_mm512_add_epi32(exponent.0, _mm512_set1_epi32(127))))
        })
    }
    #[inline(always)]
    fn pick(table: &Table, at: I32x16) -> Self {
        let entries = table.entries();
        let last = (entries.len() - 1) as i32;
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(last));
            F32x16(match entries.len() {
                16 => _mm512_permutexvar_ps(at, _mm512_loadu_ps(entries.as_ptr())),
                32 => {
                    let (low, high) = entries.split_at(16);
                    _mm512_permutex2var_ps(_mm512_loadu_ps(low.as_ptr()), at, _mm512_loadu_ps(high.as_ptr()))
                }
                _ => _mm512_i32gather_ps::<4>(at, entries.as_ptr()),
            })
        }
    }
    #[inline(always)]
    fn pick32(table: &[f32; TWO_BATCHES], at: I32x16) -> Self {
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(TWO_BATCHES as i32 - 1));
            let (low, high) = table.split_at(BATCH);
            F32x16(_mm512_permutex2var_ps(_mm512_loadu_ps(low.as_ptr()), at, _mm512_loadu_ps(high.as_ptr())))
        }
    }
    #[inline(always)]
    fn pick16(table: &[f32; BATCH], at: I32x16) -> Self {
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(BATCH as i32 - 1));
            F32x16(_mm512_permutexvar_ps(at, _mm512_loadu_ps(table.as_ptr())))
        }
    }
    #[inline(always)]
    fn pairs_i16<const N: usize>(samples: &[i16], at: I32x16, away: &Away<N>) -> [I32x16; N] {
        let Some(last) = last_pair(samples).checked_sub(away.reach()) else {
            return each(
                #[inline(always)]
                |n| Self::pairs_i16(samples, at + I32x16::splat(away.distance(n)), &Away::HERE)[0],
            );
        };
        unsafe {
            let at = _mm512_add_epi32(at.0, _mm512_set1_epi32(away.least()));
            let quarters = quarters(_mm512_min_epu32(at, _mm512_set1_epi32(last as i32)));
            // Indices leave their register once for all pairs.
            let mut both = [_mm512_setzero_si512(); N];
            let from = |n: usize| samples.as_ptr().add(away.beyond(n));
            let places = indices(quarters[0]);
            for n in 0..N {
                both[n] = _mm512_castsi128_si512(four_pairs(from(n), places));
            }
            in_this_order();
            let places = indices(quarters[1]);
            for n in 0..N {
                both[n] = _mm512_inserti32x4::<1>(both[n], four_pairs(from(n), places));
            }
            in_this_order();
            let places = indices(quarters[2]);
            for n in 0..N {
                both[n] = _mm512_inserti32x4::<2>(both[n], four_pairs(from(n), places));
            }
            in_this_order();
            let places = indices(quarters[3]);
            for n in 0..N {
                both[n] = _mm512_inserti32x4::<3>(both[n], four_pairs(from(n), places));
            }
            each(
                #[inline(always)]
                |n| I32x16(both[n]),
            )
        }
    }
    #[inline(always)]
    fn pairs_f32(samples: &[f32], at: I32x16) -> [Self; 2] {
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(last_pair(samples) as i32));
            let next = samples[1..].as_ptr();
            [F32x16(_mm512_i32gather_ps::<4>(at, samples.as_ptr())), F32x16(_mm512_i32gather_ps::<4>(at, next))]
        }
    }
    #[inline(always)]
    fn quads_i16<const N: usize>(samples: &[i16], at: I32x16, away: &Away<N>) -> [[I32x16; 2]; N] {
        let Some(last) = last_quad(samples).checked_sub(away.reach()) else {
            return each(
                #[inline(always)]
                |n| Self::quads_i16(samples, at + I32x16::splat(away.distance(n)), &Away::HERE)[0],
            );
        };
        let mut quads = [[I32x16::splat(0); 2]; N];
        unsafe {
            let at = _mm512_add_epi32(at.0, _mm512_set1_epi32(away.least()));
            let quarters = quarters(_mm512_min_epu32(at, _mm512_set1_epi32(last as i32)));
            // Indices leave their register once for all quads.
            let from = |n: usize| samples.as_ptr().add(away.beyond(n));
            let (mut low, mut high) = ([_mm512_setzero_si512(); N], [_mm512_setzero_si512(); N]);
            let places = indices(quarters[0]);
            for n in 0..N {
                low[n] = _mm512_castsi256_si512(four_quads(from(n), places));
            }
            in_this_order();
            let places = indices(quarters[1]);
            for n in 0..N {
                low[n] = _mm512_inserti64x4::<1>(low[n], four_quads(from(n), places));
            }
            in_this_order();
            let places = indices(quarters[2]);
            for n in 0..N {
                high[n] = _mm512_castsi256_si512(four_quads(from(n), places));
            }
            in_this_order();
            let places = indices(quarters[3]);
            let even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
            let odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
            for n in 0..N {
                let high = _mm512_inserti64x4::<1>(high[n], four_quads(from(n), places));
                quads[n] = [
                    I32x16(_mm512_permutex2var_epi32(low[n], even, high)),
                    I32x16(_mm512_permutex2var_epi32(low[n], odd, high)),
                ];
            }
        }
        quads
    }
    #[inline(always)]
    fn quads_f32(samples: &[f32], at: I32x16) -> [Self; 4] {
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(last_quad(samples) as i32));
            let mut quads = [F32x16::ZERO; 4];
            for (k, quad) in quads.iter_mut().enumerate() {
                *quad = F32x16(_mm512_i32gather_ps::<4>(at, samples[k..].as_ptr()));
            }
            quads
        }
    }
    #[inline(always)]
    fn accumulated(opacities: &[f32; BATCH]) -> ([f32; BATCH], f32) {
        unsafe {
            let mut all = _mm512_loadu_ps(opacities.as_ptr());
            for distance in [1, 2, 4, 8] {
                let left = _mm512_sub_ps(_mm512_set1_ps(1.0), all);
                all = _mm512_add_ps(all, _mm512_mul_ps(moved(all, distance), left));
            }
            let mut before = [0.0; BATCH];
            _mm512_storeu_ps(before.as_mut_ptr(), moved(all, 1));
            let last = _mm512_permutexvar_ps(_mm512_set1_epi32(BATCH as i32 - 1), all);
            (before, _mm512_cvtss_f32(last))
        }
    }
    #[inline(always)]
    fn sum(numbers: &[f32; BATCH]) -> f32 {
        unsafe {
            let all = _mm512_loadu_ps(numbers.as_ptr());
            let halves = _mm256_add_ps(_mm512_castps512_ps256(all), _mm512_extractf32x8_ps::<1>(all));
            let quarters = _mm_add_ps(_mm256_castps256_ps128(halves), _mm256_extractf128_ps::<1>(halves));
            let eighths = _mm_add_ps(quarters, _mm_movehl_ps(quarters, quarters));
            _mm_cvtss_f32(_mm_add_ss(eighths, _mm_shuffle_ps::<1>(eighths, eighths)))
        }
    }
    #[inline(always)]
    fn compress(self, mask: Mask16) -> Self {
        F32x16(unsafe { _mm512_maskz_compress_ps(mask.0, self.0) })
    }
    #[inline(always)]
    fn expand(self, mask: Mask16) -> Self {
        F32x16(unsafe { _mm512_maskz_expand_ps(mask.0, self.0) })
    }
    #[inline(always)]
    fn among(self, other: Self, at: I32x16) -> Self {
        F32x16(unsafe { _mm512_permutex2var_ps(self.0, at.0, other.0) })
    }
}

impl Default for I32x16 {
    #[inline(always)]
    fn default() -> Self {
        I32x16::splat(0)
    }
}

impl Add for I32x16 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        I32x16(unsafe { _mm512_add_epi32(self.0, other.0) })
    }
}

impl Sub for I32x16 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        I32x16(unsafe { _mm512_sub_epi32(self.0, other.0) })
    }
}

impl Mul for I32x16 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        I32x16(unsafe { _mm512_mullo_epi32(self.0, other.0) })
    }
}

impl Ints for I32x16 {
    type Mask = Mask16;

    #[inline(always)]
    fn splat(x: i32) -> Self {
        I32x16(unsafe { _mm512_set1_epi32(x) })
    }
    #[inline(always)]
    fn count() -> Self {
        I32x16(unsafe { _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) })
    }
    #[inline(always)]
    fn load(from: &[i32]) -> Self {
        I32x16(unsafe { _mm512_loadu_si512(from[..16].as_ptr().cast()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [i32]) {
        unsafe { _mm512_storeu_si512(to[..16].as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn shifted_right(self, bits: u32) -> Self {
        I32x16(unsafe { _mm512_srav_epi32(self.0, _mm512_set1_epi32(bits as i32)) })
    }
    #[inline(always)]
    fn low_half(self) -> Self {
        I32x16(unsafe { _mm512_madd_epi16(self.0, _mm512_set1_epi32(1)) })
    }
    #[inline(always)]
    fn rise(self) -> Self {
        // 1 times the second half, -1 times the first.
        I32x16(unsafe { _mm512_madd_epi16(self.0, _mm512_set1_epi32(0x1_ffff)) })
    }
    #[inline(always)]
    fn and(self, bits: Self) -> Self {
        I32x16(unsafe { _mm512_and_si512(self.0, bits.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        I32x16(unsafe { _mm512_min_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        I32x16(unsafe { _mm512_max_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn without_low_bits(self, by: Self) -> Self {
        I32x16(unsafe { _mm512_sllv_epi32(_mm512_srav_epi32(self.0, by.0), by.0) })
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        I32x16(unsafe { _mm512_sllv_epi32(_mm512_set1_epi32(1), self.0) })
    }
    #[inline(always)]
    fn gather(from: &[i32], at: Self) -> Self {
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(last(from) as i32));
            I32x16(_mm512_i32gather_epi32::<4>(at, from.as_ptr()))
        }
    }
    #[inline(always)]
    fn bytes(from: &[u8], at: Self) -> Self {
        unsafe {
            let at = _mm512_min_epu32(at.0, _mm512_set1_epi32(last_word(from) as i32));
            // Sixteen reads take less time than a gather, and words less than bytes put into a register one after the other.
            let word = |four: __m128i| {
                let [a, b, c, d] = indices(four).map(
                    #[inline(always)]
                    |place| u64::from(*from.as_ptr().add(place)),
                );
                (a | b << 8) | (c | d << 8) << 16
            };
            let [first, second, third, fourth] = quarters(at);
            let low = (word(first) | word(second) << 32) as i64;
            let high = (word(third) | word(fourth) << 32) as i64;
            I32x16(_mm512_cvtepu8_epi32(_mm_set_epi64x(high, low)))
        }
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmpeq_epi32_mask(self.0, other.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask16 {
        Mask16(unsafe { _mm512_cmplt_epi32_mask(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Mask16, yes: Self, no: Self) -> Self {
        I32x16(unsafe { _mm512_mask_blend_epi32(mask.0, no.0, yes.0) })
    }
    #[inline(always)]
    fn compress(self, mask: Mask16) -> Self {
        I32x16(unsafe { _mm512_maskz_compress_epi32(mask.0, self.0) })
    }
    #[inline(always)]
    fn expand(self, mask: Mask16) -> Self {
        I32x16(unsafe { _mm512_maskz_expand_epi32(mask.0, self.0) })
    }
    #[inline(always)]
    fn among(self, other: Self, at: Self) -> Self {
        I32x16(unsafe { _mm512_permutex2var_epi32(self.0, at.0, other.0) })
    }
}

impl Mask for Mask16 {
    const ALL: Self = Mask16(u16::MAX);

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Mask16(self.0 & other.0)
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Mask16(self.0 | other.0)
    }
    #[inline(always)]
    fn and_not(self, other: Self) -> Self {
        Mask16(self.0 & !other.0)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self.0)
    }
}
