//! Offsets of the sample lattice per pixel.

use crate::plan::{Jitter, JitterKind};

/// A counter-based hash: 64 evenly distributed bits for each (seed, counter), without a state to share between threads.
/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014), once per word.
pub(in super::super) fn hash(seed: u64, counter: u64) -> u64 {
    mix(mix(seed.wrapping_add(0x9e37_79b9_7f4a_7c15)).wrapping_add(counter.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
}

fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The offset of a pixel's lattice in [0, 1), as a share of the step.
pub(super) fn offset(jitter: Option<Jitter>, column: usize, row: usize) -> f64 {
    let Some(Jitter { seed, kind }) = jitter else { return 0.0 };
    let (x, y) = (column as u64, row as u64);
    let bits = match kind {
        JitterKind::White => hash(seed, x << 32 | y),
        // Roberts' R2 sequence on the pixel grid: 1/p and 1/p² of the plastic number p, in fixed point modulo 1.
        JitterKind::LowDiscrepancy => {
            let (a, b) = (0xc13f_a9a9_02a6_328f_u64, 0x91e1_0da5_c79e_7b1d_u64);
            hash(seed, 0).wrapping_add(x.wrapping_mul(a)).wrapping_add(y.wrapping_mul(b))
        }
    };
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offsets(kind: JitterKind, seed: u64) -> Vec<f64> {
        let jitter = Some(Jitter { seed, kind });
        (0..64 * 64).map(|i| offset(jitter, i % 64, i / 64)).collect()
    }

    /// Variance of the means over blocks of 4 x 4 pixels.
    fn unevenness(offsets: &[f64]) -> f64 {
        let mean = |bx: usize, by: usize| -> f64 {
            (0..16).map(|i| offsets[(by * 4 + i / 4) * 64 + bx * 4 + i % 4]).sum::<f64>() / 16.0
        };
        (0..256).map(|b| (mean(b % 16, b / 16) - 0.5).powi(2)).sum::<f64>() / 256.0
    }

    #[test]
    fn offsets_are_uniform() {
        for kind in [JitterKind::White, JitterKind::LowDiscrepancy] {
            let mut sorted = offsets(kind, 3);
            sorted.sort_by(f64::total_cmp);
            let n = sorted.len() as f64;
            let apart = sorted.iter().enumerate().map(|(i, u)| (u - i as f64 / n).abs()).fold(0.0, f64::max);
            // Kolmogorov and Smirnov's distance; 1.95/√n is exceeded once in 1000.
            assert!(apart < 1.95 / n.sqrt(), "{kind:?}: {apart} from uniform");
        }
    }

    #[test]
    fn neighbours_share_the_interval_only_with_low_discrepancy() {
        let white = unevenness(&offsets(JitterKind::White, 5));
        let even = unevenness(&offsets(JitterKind::LowDiscrepancy, 5));
        assert!(even < 0.2 * white, "unevenness {even:e} of low discrepancy, {white:e} of white");
    }

    #[test]
    fn another_seed_gives_other_offsets() {
        for kind in [JitterKind::White, JitterKind::LowDiscrepancy] {
            assert_ne!(offsets(kind, 1), offsets(kind, 2), "{kind:?}");
        }
        assert_eq!(offset(None, 3, 4), 0.0);
    }
}
