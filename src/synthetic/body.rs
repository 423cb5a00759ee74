//! CT phantoms of regions of the body: where they lie, and how they are sampled.

use glam::{DAffine3, DMat3, DVec3};

use super::scene::Scene;
use super::{anatomy, raster};
use crate::error::{Error, Fault, Result};
use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// Slices are farther apart than voxels in them, as in most scans.
const SLICE_SPACING_RATIO: f64 = 1.25;

/// Most voxels along x and y; 2 GB.
const MAX_SIZE: usize = 1024;

/// Strongest noise, HU.
const MAX_NOISE_HU: f64 = 1000.0;

/// A part of the body that has a phantom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// An angiogram of a head, 240 × 240 × 280 mm.
    ///
    /// The origin lies between the ear canals, with z = 0 through them and the lower rims of the orbits (Frankfort plane);
    /// the face looks to -y and the crown is at z = 130 mm. Not all is symmetric: a metal filling, a larger frontal sinus,
    /// an aneurysm of the middle cerebral artery and a bowed nasal septum are on the patient's left, a burr hole in the
    /// skull on the right.
    Head,
    /// A chest in the arterial phase with the arms raised, 360 × 360 × 300 mm.
    ///
    /// The origin lies in the midline before the eighth thoracic vertebra, in the middle of the heart; the breast bone is at
    /// -y, the first rib at z = 150 mm, and the scan ends in the liver. The heart's apex, the aorta's way down, the stomach and the
    /// spleen are on the patient's left, the liver and the caval veins on the right. Blood has 350 HU in left heart and aorta, 300 in the
    /// pulmonary arteries, 270 in the right heart and 90 in veins from below; the heart's muscle has 115.
    Chest,
}

/// What to make of a phantom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyPhantom {
    /// Which part of the body.
    pub region: Region,
    /// Voxels along x and along y, 2 to 1024, over the width of the region.
    pub size: usize,
    /// Chooses the noise; the anatomy is always the same.
    pub seed: u64,
    /// Standard deviation of the noise in each voxel, HU, 0 to 1000.
    pub noise_hu: f64,
}

impl BodyPhantom {
    /// Of 256 × 256 voxels, so of 0.94 × 0.94 × 1.17 mm in the head and 1.41 × 1.41 × 1.76 mm in the chest, with the noise of a
    /// good diagnostic scan.
    #[must_use]
    pub fn of(region: Region) -> Self {
        BodyPhantom { region, size: 256, seed: 1, noise_hu: 4.0 }
    }

    /// Most bytes held while it is made: its voxels, and the shapes of its anatomy.
    ///
    /// # Errors
    /// As [`body`].
    pub fn making_bytes(&self) -> Result<u64> {
        Ok(2 * self.region.grid(self.size)?.voxel_count() as u64 + self.region.shape_bytes())
    }
}

impl Region {
    /// As pipelines and the command line call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Region::Head => "head",
            Region::Chest => "chest",
        }
    }

    /// The structures by their numbers in the label map, from 1.
    pub fn structures(self) -> impl Iterator<Item = (u16, &'static str)> {
        let names: &[&str] = match self {
            Region::Head => &anatomy::head::STRUCTURES,
            Region::Chest => &anatomy::chest::STRUCTURES,
        };
        (1..).zip(names.iter().copied())
    }

    fn scene(self, edge_mm: f32) -> Scene {
        match self {
            Region::Head => anatomy::head::head(edge_mm),
            Region::Chest => anatomy::chest::chest(edge_mm),
        }
    }

    /// Width of the field of view along x and y, extent along z, and lower corner in LPS; mm.
    fn field_of_view_mm(self) -> (f64, f64, DVec3) {
        match self {
            // From the seventh cervical vertebra to above the crown. The nose takes more room than the back of the head.
            Region::Head => (240.0, 280.0, DVec3::new(-120.0, -131.0, -142.0)),
            // From the first lumbar vertebra to the first rib.
            Region::Chest => (360.0, 300.0, DVec3::new(-180.0, -178.0, -130.0)),
        }
    }

    /// Most bytes of the shapes with a few threads, each of which holds shapes cut down to its block.
    fn shape_bytes(self) -> u64 {
        match self {
            Region::Head => 1_450_000,
            Region::Chest => 4_000_000,
        }
    }

    /// The lattice: voxels at the centres of equal parts of the field of view.
    fn grid(self, size: usize) -> Result<Grid> {
        if !(2..=MAX_SIZE).contains(&size) {
            return Err(Error::new(Fault::Spec, format!("the {} phantom cannot have this size", self.name()))
                .element("size")
                .found(size.to_string())
                .expected(format!("2 to {MAX_SIZE} voxels along x and y")));
        }
        let (width_mm, height_mm, corner_mm) = self.field_of_view_mm();
        let in_slice_mm = width_mm / size as f64;
        let slices = ((height_mm / (SLICE_SPACING_RATIO * in_slice_mm)).round() as usize).max(2);
        let spacing_mm = DVec3::new(in_slice_mm, in_slice_mm, height_mm / slices as f64);
        let first_voxel_mm = corner_mm + 0.5 * spacing_mm;
        let index_to_lps_mm = DAffine3::from_mat3_translation(DMat3::from_diagonal(spacing_mm), first_voxel_mm);
        Grid::new([size, size, slices], index_to_lps_mm)
    }
}

/// A CT scan of a region, in HU: the same bytes on every machine and any number of threads.
///
/// # Errors
/// `Fault::Spec` for a size or a noise out of range, `Fault::Limit` where memory for the voxels cannot be had.
pub fn body(phantom: &BodyPhantom) -> Result<Volume> {
    let BodyPhantom { region, size, seed, noise_hu } = *phantom;
    let grid = region.grid(size)?;
    if !(0.0..=MAX_NOISE_HU).contains(&noise_hu) {
        return Err(Error::new(Fault::Spec, format!("the {} phantom cannot have this noise", region.name()))
            .element("noise_hu")
            .found(noise_hu.to_string())
            .expected(format!("0 to {MAX_NOISE_HU} HU")));
    }
    let mut voxels = room(&grid)?;
    let scene = region.scene(edge_mm(&grid));
    raster::scan(&scene, &grid, raster::Noise { seed, deviation_hu: noise_hu as f32 }, &mut voxels);
    Volume::new(grid, Samples::I16(voxels), Rescale::IDENTITY, Quantity::Hu)
}

/// The label map of a [`body`] of a size: in each voxel the number of the structure at its centre, from 1, or 0 outside the
/// body; [`Region::structures`] has their names.
///
/// # Errors
/// As [`body`].
pub fn body_labels(region: Region, size: usize) -> Result<Volume> {
    let grid = region.grid(size)?;
    let mut voxels = room(&grid)?;
    raster::structures(&region.scene(edge_mm(&grid)), &grid, &mut voxels);
    Volume::new(grid, Samples::I16(voxels), Rescale::IDENTITY, Quantity::Arbitrary)
}

/// A voxel of 0 for each of the grid's.
fn room(grid: &Grid) -> Result<Vec<i16>> {
    let mut voxels = Vec::new();
    voxels.try_reserve_exact(grid.voxel_count()).map_err(|error| {
        Error::new(Fault::Limit, "there is no memory for the phantom")
            .found(format!("{:?} voxels of 2 bytes", grid.dims()))
            .remedy("ask for a smaller size")
            .caused_by(error)
    })?;
    voxels.resize(grid.voxel_count(), 0);
    Ok(voxels)
}

/// Half the width of edges between tissues: 10 % to 90 % within about 1.4 voxels.
fn edge_mm(grid: &Grid) -> f32 {
    1.25 * grid.spacing_mm().as_vec3().element_sum() / 3.0
}
