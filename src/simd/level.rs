//! Instruction sets, and which one runs.

use std::fmt;
use std::str::FromStr;

/// An instruction set whose registers kernels are instantiated for. The pictures are the same to the bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// One number at a time, on any processor; slow on one that cannot multiply and add at once.
    Scalar,
    /// Eight at a time: x86-64 with AVX2 and FMA.
    Avx2,
    /// Sixteen at a time: x86-64 with AVX-512 F, BW, DQ and VL.
    Avx512,
}

/// What is run with the registers of a level.
pub(crate) trait Kernel {
    /// What it returns.
    type Output;

    /// Runs it. Must be `#[inline(always)]`, as must be all that it calls for each number: only then is it compiled for the
    /// level's instructions.
    fn run<L: super::Lanes>(self) -> Self::Output;
}

impl Level {
    /// All levels, narrowest first.
    pub const ALL: [Level; 3] = [Level::Scalar, Level::Avx2, Level::Avx512];

    /// The widest level of this processor.
    pub fn widest() -> Level {
        Level::ALL.into_iter().rfind(|level| level.is_available()).unwrap_or(Level::Scalar)
    }

    /// Whether this processor has the level's instructions.
    pub fn is_available(self) -> bool {
        match self {
            Level::Scalar => true,
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => std::arch::is_x86_feature_detected!("avx2") && has_fma(),
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => {
                has_fma()
                    && std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512bw")
                    && std::arch::is_x86_feature_detected!("avx512dq")
                    && std::arch::is_x86_feature_detected!("avx512vl")
            }
            #[cfg(not(target_arch = "x86_64"))]
            _ => false,
        }
    }

    /// Numbers per register.
    pub fn lanes(self) -> usize {
        match self {
            Level::Scalar => 1,
            Level::Avx2 => 8,
            Level::Avx512 => 16,
        }
    }

    /// Runs a kernel with the registers of this level, or of the scalar level where the processor lacks it.
    #[expect(unsafe_code, reason = "calls functions compiled for instructions that the processor was asked for")]
    pub(crate) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            // SAFETY: the processor has the instructions that the function is compiled for.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 if self.is_available() => unsafe { super::avx2::run(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 if self.is_available() => unsafe { super::avx512::run(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            _ if has_fma() => unsafe { super::scalar::run(kernel) },
            _ => kernel.run::<f32>(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn has_fma() -> bool {
    std::arch::is_x86_feature_detected!("fma")
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Level::Scalar => "scalar",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
        })
    }
}

impl FromStr for Level {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let level = Level::ALL.into_iter().find(|level| level.to_string() == name);
        let level = level.ok_or_else(|| "expected one of scalar, avx2, avx512".to_owned())?;
        if level.is_available() { Ok(level) } else { Err(format!("this processor has no {level}")) }
    }
}
