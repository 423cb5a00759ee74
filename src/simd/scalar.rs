//! One lane: the twin of every register, on any processor.

#[cfg(target_arch = "x86_64")]
use super::Kernel;
use super::lanes::{last_pair, last_quad};
use super::{Away, BATCH, Doubles, Ints, Lanes, Mask, TWO_BATCHES, Table};
use crate::math::each;

/// Runs a kernel compiled for fused operations, which are calls of a function elsewhere.
///
/// # Safety
/// The processor must have them.
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "compiled for instructions that the caller asked the processor for")]
#[target_feature(enable = "fma")]
pub(super) unsafe fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<f32>()
}

impl Lanes for f32 {
    const LANES: usize = 1;
    type Ints = i32;
    type Doubles = f64;
    type Mask = bool;

    #[inline(always)]
    fn from_doubles(doubles: f64) -> Self {
        doubles as f32
    }
    #[inline(always)]
    fn to_doubles(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn gather(from: &[f32], at: i32) -> Self {
        from[(at as u32 as usize).min(from.len() - 1)]
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[0] = self;
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn round(self) -> Self {
        self.round_ties_even()
    }
    #[inline(always)]
    fn to_ints(self) -> i32 {
        self as i32
    }
    #[inline(always)]
    fn from_ints(ints: i32) -> Self {
        ints as f32
    }
    #[inline(always)]
    fn power_of_two(exponent: i32) -> Self {
        f32::from_bits(((exponent + 127) as u32) << 23)
    }
    #[inline(always)]
    fn pick(table: &Table, at: i32) -> Self {
        let entries = table.entries();
        entries[(at as u32 as usize).min(entries.len() - 1)]
    }
    #[inline(always)]
    fn pick32(table: &[f32; TWO_BATCHES], at: i32) -> Self {
        table[(at as u32 as usize).min(TWO_BATCHES - 1)]
    }
    #[inline(always)]
    fn pick16(table: &[f32; BATCH], at: i32) -> Self {
        table[(at as u32 as usize).min(BATCH - 1)]
    }
    #[inline(always)]
    fn pairs_i16<const N: usize>(samples: &[i16], at: i32, away: &Away<N>) -> [i32; N] {
        each(
            #[inline(always)]
            |n| {
                let at = ((at + away.distance(n)) as u32).min(last_pair(samples)) as usize;
                packed(samples[at], samples[at + 1])
            },
        )
    }
    #[inline(always)]
    fn quads_i16<const N: usize>(samples: &[i16], at: i32, away: &Away<N>) -> [[i32; 2]; N] {
        each(
            #[inline(always)]
            |n| {
                let four = &samples[((at + away.distance(n)) as u32).min(last_quad(samples)) as usize..][..4];
                [packed(four[0], four[1]), packed(four[2], four[3])]
            },
        )
    }
    #[inline(always)]
    fn pairs_f32(samples: &[f32], at: i32) -> [Self; 2] {
        let at = (at as u32).min(last_pair(samples)) as usize;
        [samples[at], samples[at + 1]]
    }
    #[inline(always)]
    fn quads_f32(samples: &[f32], at: i32) -> [Self; 4] {
        let four = &samples[(at as u32).min(last_quad(samples)) as usize..][..4];
        [four[0], four[1], four[2], four[3]]
    }
    #[inline(always)]
    fn compress(self, _: bool) -> Self {
        self
    }
    #[inline(always)]
    fn expand(self, _: bool) -> Self {
        self
    }
    #[inline(always)]
    fn among(self, other: Self, at: i32) -> Self {
        if at == 0 { self } else { other }
    }
}

/// Two samples in one number, the first one in the lower half.
#[inline(always)]
fn packed(first: i16, second: i16) -> i32 {
    i32::from(first as u16) | i32::from(second) << 16
}

impl Doubles for f64 {
    type Ints = i32;
    type Mask = bool;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        to[0] = self;
    }
    #[inline(always)]
    fn from_ints(ints: i32) -> Self {
        f64::from(ints)
    }
    #[inline(always)]
    fn to_ints(self) -> i32 {
        self as i32
    }
    #[inline(always)]
    fn floor(self) -> Self {
        self.floor()
    }
    #[inline(always)]
    fn mul_plus(self, a: Self, b: Self) -> Self {
        f64::mul_add(self, a, b)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
}

impl Ints for i32 {
    type Mask = bool;

    #[inline(always)]
    fn splat(x: i32) -> Self {
        x
    }
    #[inline(always)]
    fn count() -> Self {
        0
    }
    #[inline(always)]
    fn load(from: &[i32]) -> Self {
        from[0]
    }
    #[inline(always)]
    fn store(self, to: &mut [i32]) {
        to[0] = self;
    }
    #[inline(always)]
    fn shifted_right(self, bits: u32) -> Self {
        self >> bits
    }
    #[inline(always)]
    fn low_half(self) -> Self {
        i32::from(self as i16)
    }
    #[inline(always)]
    fn rise(self) -> Self {
        self.high_half() - self.low_half()
    }
    #[inline(always)]
    fn and(self, bits: Self) -> Self {
        self & bits
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
    #[inline(always)]
    fn without_low_bits(self, by: Self) -> Self {
        self >> by << by
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        1 << self
    }
    #[inline(always)]
    fn gather(from: &[i32], at: Self) -> Self {
        from[(at as u32 as usize).min(from.len() - 1)]
    }
    #[inline(always)]
    fn bytes(from: &[u8], at: Self) -> Self {
        i32::from(from[(at as u32 as usize).min(from.len() - 4)])
    }
    #[inline(always)]
    fn eq(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn compress(self, _: bool) -> Self {
        self
    }
    #[inline(always)]
    fn expand(self, _: bool) -> Self {
        self
    }
    #[inline(always)]
    fn among(self, other: Self, at: i32) -> Self {
        if at == 0 { self } else { other }
    }
}

impl Mask for bool {
    const ALL: Self = true;

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
    #[inline(always)]
    fn and_not(self, other: Self) -> Self {
        self & !other
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self)
    }
}
