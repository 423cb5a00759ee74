//! Volumes made by formula: the CT head phantom.

mod anatomy;
mod bounds;
mod noise;
mod raster;
mod sdf;
mod tissue;

use glam::{DAffine3, DMat3, DVec3};

use crate::error::{Error, Fault, Result};
use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// A CT scan of a head.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadPhantom {
    /// Voxels along x and along y, 2 to 1024.
    pub size: usize,
    /// Chooses the noise; the anatomy is always the same.
    pub seed: u64,
    /// Standard deviation of the noise, HU, 0 to 1000.
    pub noise_hu: f64,
}

impl Default for HeadPhantom {
    fn default() -> Self {
        HeadPhantom { size: 256, seed: 1, noise_hu: 4.0 }
    }
}

/// Makes it.
pub fn head(phantom: &HeadPhantom) -> Result<Volume> {
    let size = phantom.size;
    if !(2..=1024).contains(&size) {
        return Err(Error::new(Fault::Spec, "size"));
    }
    let s = 240.0 / size as f64;
    let nz = ((280.0 / (1.25 * s)).round() as usize).max(2);
    let sp = DVec3::new(s, s, 280.0 / nz as f64);
    let origin = DVec3::new(-120.0, -131.0, -142.0) + 0.5 * sp;
    let grid = Grid::new([size, size, nz], DAffine3::from_mat3_translation(DMat3::from_diagonal(sp), origin))?;
    let mut voxels = vec![0i16; grid.voxel_count()];
    let scene = anatomy::head();
    raster::rasterize(
        &scene,
        &grid,
        raster::Noise { seed: phantom.seed, deviation_hu: phantom.noise_hu as f32 },
        &mut voxels,
    );
    Volume::new(grid, Samples::I16(voxels), Rescale::IDENTITY, Quantity::Hu)
}
