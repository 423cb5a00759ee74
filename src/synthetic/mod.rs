//! Volumes made by formula: the CT head phantom, [analytic] fields, and rings in colours ([`rings`]).
//!
//! The phantom is a head as a CT scanner would see it, for pictures and tests without a patient: skin, fat, muscle,
//! skull, teeth, brain, airways and vessels filled with contrast medium, in HU. It is defined in patient coordinates
//! (see [`head`]) and sampled at any size; nothing in it comes from a scan.
//!
//! ```text
//! anatomy ──► scene ──► raster ──► volume
//! (solids)    (tissues,  (voxels,
//!              one over   partial volume,
//!              the other) noise)
//! ```
//!
//! `sdf` holds the solids, `tissue` what they are made of, `noise` the counter-based hash behind sponge, folds and
//! scanner noise.

pub mod analytic;
mod anatomy;
mod noise;
mod raster;
mod rings;
mod scene;
mod sdf;
mod tissue;

pub use rings::rings;

use glam::{DAffine3, DMat3, DVec3};

use crate::error::{Error, Fault, Result};
use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// Width of the field of view along x and y, mm.
const FIELD_OF_VIEW_MM: f64 = 240.0;

/// Extent along z, mm: from the seventh cervical vertebra to above the crown.
const HEIGHT_MM: f64 = 280.0;

/// Lower corner of the field of view, LPS mm. The nose takes more room than the back of the head.
const CORNER_MM: DVec3 = DVec3::new(-120.0, -131.0, -142.0);

/// Slices are farther apart than voxels in them, as in most scans.
const SLICE_SPACING_RATIO: f64 = 1.25;

/// Most voxels along x and y; 2 GB.
const MAX_SIZE: usize = 1024;

/// Strongest noise, HU.
const MAX_NOISE_HU: f64 = 1000.0;

/// What to make of the head phantom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadPhantom {
    /// Voxels along x and along y, 2 to 1024, over 240 mm.
    pub size: usize,
    /// Chooses the noise; the anatomy is always the same.
    pub seed: u64,
    /// Standard deviation of the noise in each voxel, HU, 0 to 1000.
    pub noise_hu: f64,
}

impl Default for HeadPhantom {
    /// 256 × 256 × 239 voxels of 0.94 × 0.94 × 1.17 mm, with the noise of a good diagnostic scan.
    fn default() -> Self {
        HeadPhantom { size: 256, seed: 1, noise_hu: 4.0 }
    }
}

impl HeadPhantom {
    /// Most bytes held while it is made: its voxels, and the shapes of its anatomy.
    ///
    /// # Errors
    /// As [`head`].
    pub fn making_bytes(&self) -> Result<u64> {
        Ok(2 * head_grid(self.size)?.voxel_count() as u64 + 1_450_000)
    }
}

/// A CT angiogram of a head, 240 × 240 × 280 mm, in HU.
///
/// The origin lies between the ear canals, with z = 0 through them and the lower rims of the orbits (Frankfort plane);
/// the face looks to -y and the crown is at z = 130 mm. Not all is symmetric: a metal filling, a larger frontal sinus,
/// an aneurysm of the middle cerebral artery and a bowed nasal septum are on the patient's left, a burr hole in the
/// skull on the right.
///
/// The same bytes on every machine and any number of threads.
///
/// # Errors
/// `Fault::Spec` for a size or a noise out of range, `Fault::Limit` where memory for the voxels cannot be had.
pub fn head(phantom: &HeadPhantom) -> Result<Volume> {
    let HeadPhantom { size, seed, noise_hu } = *phantom;
    let grid = head_grid(size)?;
    if !(0.0..=MAX_NOISE_HU).contains(&noise_hu) {
        return Err(Error::new(Fault::Spec, "the head phantom cannot have this noise")
            .element("noise_hu")
            .found(noise_hu.to_string())
            .expected(format!("0 to {MAX_NOISE_HU} HU")));
    }
    let mut voxels = room(&grid)?;
    let scene = anatomy::head(edge_mm(&grid));
    raster::scan(&scene, &grid, raster::Noise { seed, deviation_hu: noise_hu as f32 }, &mut voxels);
    Volume::new(grid, Samples::I16(voxels), Rescale::IDENTITY, Quantity::Hu)
}

/// The label map of [`head`] at a size: in each voxel the number of the structure at its centre, from 1, or 0 outside the
/// body; [`head_structures`] has their names.
///
/// # Errors
/// As [`head`].
pub fn head_labels(size: usize) -> Result<Volume> {
    let grid = head_grid(size)?;
    let mut voxels = room(&grid)?;
    raster::structures(&anatomy::head(edge_mm(&grid)), &grid, &mut voxels);
    Volume::new(grid, Samples::I16(voxels), Rescale::IDENTITY, Quantity::Arbitrary)
}

/// The structures of the head phantom, by number in its label map.
pub fn head_structures() -> impl Iterator<Item = (u16, &'static str)> {
    (1..).zip(anatomy::STRUCTURES)
}

/// A voxel of 0 for each of the grid's.
fn room(grid: &Grid) -> Result<Vec<i16>> {
    let mut voxels = Vec::new();
    voxels.try_reserve_exact(grid.voxel_count()).map_err(|error| {
        Error::new(Fault::Limit, "there is no memory for the head phantom")
            .found(format!("{:?} voxels of 2 bytes", grid.dims()))
            .remedy("ask for a smaller size")
            .caused_by(error)
    })?;
    voxels.resize(grid.voxel_count(), 0);
    Ok(voxels)
}

/// The lattice: voxels at the centres of equal parts of the field of view.
fn head_grid(size: usize) -> Result<Grid> {
    if !(2..=MAX_SIZE).contains(&size) {
        return Err(Error::new(Fault::Spec, "the head phantom cannot have this size")
            .element("size")
            .found(size.to_string())
            .expected(format!("2 to {MAX_SIZE} voxels along x and y")));
    }
    let in_slice_mm = FIELD_OF_VIEW_MM / size as f64;
    let slices = ((HEIGHT_MM / (SLICE_SPACING_RATIO * in_slice_mm)).round() as usize).max(2);
    let spacing_mm = DVec3::new(in_slice_mm, in_slice_mm, HEIGHT_MM / slices as f64);
    let first_voxel_mm = CORNER_MM + 0.5 * spacing_mm;
    let index_to_lps_mm = DAffine3::from_mat3_translation(DMat3::from_diagonal(spacing_mm), first_voxel_mm);
    Grid::new([size, size, slices], index_to_lps_mm)
}

/// Half the width of edges between tissues: 10 % to 90 % within about 1.4 voxels.
fn edge_mm(grid: &Grid) -> f32 {
    1.25 * grid.spacing_mm().as_vec3().element_sum() / 3.0
}
