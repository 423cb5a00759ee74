//! From a scene to voxels: what a scanner would have measured.
//!
//! Each tissue covers a voxel by a share that runs smoothly from 0 to 1 across its surface, as the point-spread function
//! of a scanner makes it (partial volume), and replaces that share of what was painted before. Work is done in blocks:
//! tissues that cannot reach a block, and tissues that are painted over in all of it, are dropped for the whole block.

use glam::Vec3;
use rayon::prelude::*;

use super::noise::bell;
use super::sdf::Solid;
use super::tissue::{AIR_HU, Tissue, mix, smooth_step};
use crate::volume::Grid;

/// Voxels along each side of a block.
const BLOCK: usize = 8;

/// How much farther than the true distance a solid's own may be, inside.
const DISTANCE_SLACK: f32 = 1.3;

/// Tissues in the order in which they are painted.
pub(super) struct Scene {
    /// The outer surface of the body; tissues may be cut off some way beneath it.
    pub(super) skin: Solid,
    pub(super) tissues: Vec<Tissue>,
}

/// The values a scanner adds of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noise {
    pub(super) seed: u64,
    /// Standard deviation, HU.
    pub(super) deviation_hu: f32,
}

/// A block's part of the scene: the tissues that its voxels need.
struct BlockScene<'a> {
    skin: &'a Solid,
    tissues: Vec<&'a Tissue>,
    ramp_mm: f32,
}

/// Fills `voxels`, x fastest, on `grid`.
pub(super) fn rasterize(scene: &Scene, grid: &Grid, noise: Noise, voxels: &mut [i16]) {
    let [nx, ny, _] = grid.dims();
    let map = grid.index_to_lps_mm();
    let position =
        |i: usize, j: usize, k: usize| map.transform_point3(glam::DVec3::new(i as f64, j as f64, k as f64)).as_vec3();
    let spacing_mm = grid.spacing_mm().as_vec3();
    // Half the width of the edges: about 1.2 voxels between 10 % and 90 %.
    let ramp_mm = 1.25 * spacing_mm.element_sum() / 3.0;
    voxels.par_chunks_mut(nx * ny * BLOCK).enumerate().for_each(|(slab, slices)| {
        let k0 = slab * BLOCK;
        let k1 = k0 + slices.len() / (nx * ny);
        for j0 in (0..ny).step_by(BLOCK) {
            for i0 in (0..nx).step_by(BLOCK) {
                let (i1, j1) = ((i0 + BLOCK).min(nx), (j0 + BLOCK).min(ny));
                let (first, last) = (position(i0, j0, k0), position(i1 - 1, j1 - 1, k1 - 1));
                let part = BlockScene::new(scene, 0.5 * (first + last), 0.5 * (last - first).length(), ramp_mm);
                for k in k0..k1 {
                    for j in j0..j1 {
                        for i in i0..i1 {
                            let voxel = (k * ny + j) * nx + i;
                            let noise_hu = noise.deviation_hu * bell(noise.seed, voxel as u64);
                            let hu = part.hu(position(i, j, k)) + noise_hu;
                            // CT numbers have 12 bits: -1024 to 3071.
                            slices[((k - k0) * ny + j) * nx + i] = hu.round().clamp(-1024.0, 3071.0) as i16;
                        }
                    }
                }
            }
        }
    });
}

impl<'a> BlockScene<'a> {
    /// What is needed within `radius_mm` of `center`.
    fn new(scene: &'a Scene, center: Vec3, radius_mm: f32, ramp_mm: f32) -> Self {
        let reach_mm = DISTANCE_SLACK * radius_mm + 2.0 * ramp_mm;
        let skin_mm = scene.skin.distance(center);
        let mut tissues: Vec<&Tissue> = Vec::new();
        if skin_mm < reach_mm {
            for tissue in &scene.tissues {
                if tissue.solid.bounds().distance(center) > reach_mm {
                    continue;
                }
                let d = tissue.solid.distance(center);
                if d > reach_mm {
                    continue;
                }
                let uncut = tissue.beneath_skin_mm.is_none_or(|mm| skin_mm + mm < -reach_mm);
                if d < -reach_mm && uncut {
                    tissues.clear();
                }
                tissues.push(tissue);
            }
        }
        BlockScene { skin: &scene.skin, tissues, ramp_mm }
    }

    /// Value at `p`, without noise.
    fn hu(&self, p: Vec3) -> f32 {
        let coverage = |d: f32| smooth_step(-self.ramp_mm, self.ramp_mm, -d);
        let mut skin_mm = None;
        let mut hu = AIR_HU;
        for tissue in &self.tissues {
            if tissue.solid.bounds().distance(p) > self.ramp_mm {
                continue;
            }
            let mut d = tissue.solid.distance(p);
            if let Some(mm) = tissue.beneath_skin_mm {
                d = d.max(*skin_mm.get_or_insert_with(|| self.skin.distance(p)) + mm);
            }
            for (depth_mm, material) in &tissue.coats {
                let share = coverage(d + depth_mm);
                if share > 0.0 {
                    hu = mix(hu, material.hu(p, -d), share);
                }
            }
        }
        hu
    }
}
