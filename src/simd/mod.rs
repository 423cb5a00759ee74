//! Vector registers: the same formula for 1, 8 or 16 numbers at a time.
//!
//! An algorithm is written once, generic over `Lanes`, and run by `Level::run` with the registers of an instruction set.
//! No operation is approximate, and the same ones are fused everywhere, so that every lane of every level has the bits that the
//! scalar level has: which level runs changes how long a picture takes, never the picture.
//!
//! This is the only place for `unsafe` in the crate. Its rules: the vector types stay inside the crate, and generic code is
//! instantiated with them by `Level::run` alone, after the processor was asked; reads by index are clamped to the slice.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod joining;
mod lanes;
mod level;
mod pairs;
#[cfg(target_arch = "x86_64")]
mod register;
mod scalar;
mod table;

pub use level::Level;

pub(crate) use joining::Joining;
pub(crate) use lanes::{Doubles, Ints, Lanes, Mask};
pub(crate) use level::Kernel;
pub(crate) use pairs::{Around, Away, Pairs, Stencil};
pub(crate) use table::{Table, Tables};

/// Numbers in a register of the widest level. What is summed over neighbours is summed over so many at every level, in the
/// same order.
pub(crate) const BATCH: usize = 16;

/// Numbers in two of them.
pub(crate) const TWO_BATCHES: usize = 2 * BATCH;

#[cfg(test)]
mod tests;
