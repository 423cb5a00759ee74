//! From a scene to voxels: what a scanner would have measured.
//!
//! Each tissue covers a voxel by a share that runs smoothly from 0 to 1 across its surface, as the point-spread function
//! of a scanner makes it (partial volume), and replaces that share of what was painted before.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::noise::bell;
use super::scene::Scene;
use super::sdf::Ball;
use crate::volume::Grid;

/// Slices that one task fills.
const SLAB: usize = 8;

/// Voxels along the sides of the blocks for which the scene is cut down to what matters there.
const LEAF: usize = 4;

/// What a scanner adds of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Noise {
    pub(super) seed: u64,
    /// Standard deviation, HU.
    pub(super) deviation_hu: f32,
}

/// Voxels from `low` up to, but without, `high`.
#[derive(Debug, Clone, Copy)]
struct Block {
    low: [usize; 3],
    high: [usize; 3],
}

/// The slices of one task.
struct Slab<'a, F> {
    grid: &'a Grid,
    /// What a voxel stores, by a scene, its position in mm and its number.
    sample: &'a F,
    first_slice: usize,
    voxels: &'a mut [i16],
}

/// Fills `voxels`, x fastest, on `grid` with values in HU.
pub(super) fn scan(scene: &Scene, grid: &Grid, noise: Noise, voxels: &mut [i16]) {
    let sample = |scene: &Scene, p: Vec3, counter: u64| {
        let hu = scene.hu(p) + noise.deviation_hu * bell(noise.seed, counter);
        // CT numbers have 12 bits: -1024 to 3071.
        hu.round().clamp(-1024.0, 3071.0) as i16
    };
    rasterize(scene, grid, sample, voxels);
}

/// Fills `voxels` with the numbers of structures.
pub(super) fn structures(scene: &Scene, grid: &Grid, voxels: &mut [i16]) {
    rasterize(scene, grid, |scene: &Scene, p, _| i16::from(scene.structure(p)), voxels);
}

fn rasterize(scene: &Scene, grid: &Grid, sample: impl Fn(&Scene, Vec3, u64) -> i16 + Sync, voxels: &mut [i16]) {
    let [nx, ny, _] = grid.dims();
    voxels.par_chunks_mut(nx * ny * SLAB).enumerate().for_each(|(index, voxels)| {
        let first_slice = index * SLAB;
        let end = first_slice + voxels.len() / (nx * ny);
        let mut slab = Slab { grid, sample: &sample, first_slice, voxels };
        slab.paint(scene, Block { low: [0, 0, first_slice], high: [nx, ny, end] });
    });
}

impl<F: Fn(&Scene, Vec3, u64) -> i16> Slab<'_, F> {
    /// Cuts the scene down to the block, and the block into smaller ones, until they are small.
    fn paint(&mut self, scene: &Scene, block: Block) {
        let scene = scene.near(block.ball(self.grid));
        let [x, y, z] = std::array::from_fn(|axis| block.halves(axis));
        if x.len() * y.len() * z.len() == 1 {
            return self.fill(&scene, block);
        }
        for &[k0, k1] in &z {
            for &[j0, j1] in &y {
                for &[i0, i1] in &x {
                    self.paint(&scene, Block { low: [i0, j0, k0], high: [i1, j1, k1] });
                }
            }
        }
    }

    fn fill(&mut self, scene: &Scene, block: Block) {
        let [nx, ny, _] = self.grid.dims();
        for k in block.low[2]..block.high[2] {
            for j in block.low[1]..block.high[1] {
                for i in block.low[0]..block.high[0] {
                    let counter = ((k * ny + j) * nx + i) as u64;
                    let stored = (self.sample)(scene, position_mm(self.grid, [i, j, k]), counter);
                    self.voxels[((k - self.first_slice) * ny + j) * nx + i] = stored;
                }
            }
        }
    }
}

impl Block {
    /// Both halves along an axis, or all of it where it is short enough.
    fn halves(&self, axis: usize) -> Vec<[usize; 2]> {
        let (low, high) = (self.low[axis], self.high[axis]);
        let middle = low + (high - low).div_ceil(2);
        if high - low <= LEAF { vec![[low, high]] } else { vec![[low, middle], [middle, high]] }
    }

    /// A ball around all of the block's voxels.
    fn ball(&self, grid: &Grid) -> Ball {
        let first = position_mm(grid, self.low);
        let last = position_mm(grid, self.high.map(|end| end - 1));
        Ball { center: 0.5 * (first + last), radius_mm: 0.5 * (last - first).length() + 1e-3 }
    }
}

fn position_mm(grid: &Grid, [i, j, k]: [usize; 3]) -> Vec3 {
    grid.index_to_lps_mm().transform_point3(DVec3::new(i as f64, j as f64, k as f64)).as_vec3()
}
