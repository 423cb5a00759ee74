//! Noise that depends on its counter alone, never on the order in which it is drawn.

use glam::{IVec3, Vec3};

/// Mixes 64 bits so that neighbouring inputs give unrelated outputs (the finaliser of SplitMix64; Steele, Lea and Flood
/// 2014).
fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// A sample of mean 0 and standard deviation 1 for voxel `counter` of the sequence `seed`: the sum of four uniform
/// numbers, so at most 3.5 standard deviations from its mean.
pub(super) fn bell(seed: u64, counter: u64) -> f32 {
    let bits = mix(mix(seed).wrapping_add(counter.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
    let sum: u64 = (0..4).map(|word| (bits >> (16 * word)) & 0xffff).sum();
    // Each 16-bit word has mean 65535/2 and variance (65536² - 1)/12.
    (sum as f32 - 2.0 * 65535.0) * (1.0 / (65536.0 * 0.577_350_27))
}

/// Smooth noise in [-1, 1]: random values at the points of a unit lattice, blended by Perlin's quintic.
pub(super) fn value_noise(stream: u32, p: Vec3) -> f32 {
    let floor = p.floor();
    let cell = floor.as_ivec3();
    let t = p - floor;
    let w = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let along_x = |y: i32, z: i32| {
        let a = lattice(stream, cell + IVec3::new(0, y, z));
        a + w.x * (lattice(stream, cell + IVec3::new(1, y, z)) - a)
    };
    let along_y = |z: i32| {
        let a = along_x(0, z);
        a + w.y * (along_x(1, z) - a)
    };
    let a = along_y(0);
    a + w.z * (along_y(1) - a)
}

fn lattice(stream: u32, cell: IVec3) -> f32 {
    let [x, y, z] = cell.to_array().map(|c| u64::from(c as u32 & 0xffff));
    let bits = mix(u64::from(stream) << 48 ^ x << 32 ^ y << 16 ^ z);
    (bits >> 40) as f32 * (2.0 / 16_777_215.0) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bell_has_mean_0_and_deviation_1() {
        let n = 100_000;
        let samples: Vec<f64> = (0..n).map(|i| f64::from(bell(7, i))).collect();
        let mean = samples.iter().sum::<f64>() / n as f64;
        let variance = samples.iter().map(|s| (s - mean) * (s - mean)).sum::<f64>() / n as f64;
        assert!(mean.abs() < 0.01, "mean: found {mean}, expected 0");
        assert!((variance - 1.0).abs() < 0.02, "variance: found {variance}, expected 1");
    }

    #[test]
    fn value_noise_is_continuous_across_cells() {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            let p = Vec3::new(3.3, -1.6, 0.4);
            let wall = p - p * axis + 2.0 * axis;
            let (below, above) = (value_noise(1, wall - 1e-4 * axis), value_noise(1, wall + 1e-4 * axis));
            assert!((below - above).abs() < 1e-3, "jump along {axis}: {below} against {above}");
        }
    }
}
