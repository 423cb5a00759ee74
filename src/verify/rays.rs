//! Random rays, the same for every run.

use glam::DVec3;

use crate::scene::Ray;
use crate::volume::Grid;

/// `count` rays from a sphere around the grid to points inside it.
pub(super) fn through(grid: &Grid, count: usize, seed: u64) -> Vec<Ray> {
    let mut state = seed;
    let center = grid.center_mm();
    let radius = 1.5 * grid.corners_mm()[0].distance(center);
    let (low, high) = grid.index_bounds();
    (0..count)
        .map(|_| {
            let (z, angle) = (2.0 * unit(&mut state) - 1.0, std::f64::consts::TAU * unit(&mut state));
            let across = (1.0 - z * z).sqrt();
            let origin_mm = center + radius * DVec3::new(across * angle.cos(), across * angle.sin(), z);
            let share = DVec3::new(unit(&mut state), unit(&mut state), unit(&mut state));
            let target = grid.index_to_lps_mm().transform_point3(low + share * (high - low));
            Ray { origin_mm, direction: (target - origin_mm).normalize() }
        })
        .collect()
}

/// Evenly distributed in [0, 1): SplitMix64 (Steele, Lea and Flood 2014).
fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
