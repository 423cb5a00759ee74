//! The volume: samples on a lattice, and one affine map from voxel index to the patient.
//!
//! **Definitions.** Patient coordinates are LPS (x to the patient's left, y to the back, z to the head), in millimetres.
//! The voxel with index `(i, j, k)` is a point, at `A · (i, j, k)`; spacing, orientation, handedness and shear are all in
//! `A`, and nothing is resampled. The domain is the hull of the lattice points; an axis with one voxel is constant across
//! its own spacing, from index -1/2 to +1/2. Between lattice points the value is interpolated trilinearly.
//!
//! A lattice may be rectilinear: its slices at uneven distances, in a table `p` of places along k ([`Slices`]). The voxel
//! `(i, j, k)` is then the point `A · (i, j, p_k)`, a cell is the box between neighbouring lattice points, and inside it the
//! value is trilinear as in any other. Nothing is resampled: a ray is straight in `(i, j, p)` as it is in space.
//!
//! The value of a voxel is `slope · stored + intercept`, in HU for CT ([`Rescale`]). Samples stay at 16 bits in memory
//! wherever the source has no more ([`Samples`]).
//!
//! An RGBA volume has a colour and an opacity at each voxel in place of a value, and absorbs and emits by itself, without a
//! transfer function ([`RgbaEncoding`]).

mod classes;
mod digest;
mod grid;
mod label_map;
mod rgba;
mod samples;
mod slices;

pub use classes::Classes;
pub use grid::Grid;
pub use label_map::{Concept, LabelMap, MOST_SEGMENTS, Segment};
pub use rgba::{ColorEncoding, RgbaEncoding};
pub use samples::{Rescale, Samples};
pub use slices::Slices;

use glam::DVec3;

use crate::error::{Error, Fault, Result};

/// What the values of a volume measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Hounsfield units: air -1000, water 0.
    Hu,
    /// Numbers of unknown meaning, such as the 8-bit test volumes; presets in HU do not apply to them.
    Arbitrary,
}

/// A scan in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Volume {
    grid: Grid,
    slices: Option<Slices>,
    samples: Samples,
    rescale: Rescale,
    quantity: Quantity,
    classes: Option<Classes>,
    /// There for RGBA samples.
    rgba: Option<RgbaEncoding>,
}

impl Volume {
    /// A volume of `samples` (x fastest, then y, then z) on `grid`.
    ///
    /// # Errors
    /// `Fault::Input` if the number of samples is not that of the grid, or a sample or the rescale is not finite:
    /// readers replace NaN and infinity, by a stated policy, before they come here.
    pub fn new(grid: Grid, samples: Samples, rescale: Rescale, quantity: Quantity) -> Result<Self> {
        if samples.len() != grid.voxel_count() {
            return Err(Error::new(Fault::Input, "the number of samples does not match the grid")
                .found(format!("{} samples", samples.len()))
                .expected(format!("{} for {:?} voxels", grid.voxel_count(), grid.dims())));
        }
        if !(rescale.slope.is_finite() && rescale.intercept.is_finite() && rescale.slope != 0.0) {
            return Err(Error::new(Fault::Input, "the rescale is not usable")
                .found(format!("slope {}, intercept {}", rescale.slope, rescale.intercept))
                .expected("finite numbers and a slope other than 0"));
        }
        if let Samples::F32(values) = &samples
            && let Some(index) = values.iter().position(|v| !v.is_finite())
        {
            let [i, j, k] = grid.unflatten(index);
            return Err(Error::new(Fault::Input, "a voxel is not a finite number")
                .element(format!("voxel ({i}, {j}, {k})"))
                .found(values[index].to_string()));
        }
        let default =
            RgbaEncoding { opacity_length_mm: grid.spacing_mm().min_element(), color: ColorEncoding::default() };
        let rgba = samples.are_rgba().then_some(default);
        Ok(Volume { grid, slices: None, samples, rescale, quantity, classes: None, rgba })
    }

    /// The same samples on a rectilinear lattice: the grid's first and last slice stay, the others move to their places.
    ///
    /// # Errors
    /// `Fault::Geometry` if there are more or fewer places than slices.
    pub fn with_slices(mut self, slices: Slices) -> Result<Self> {
        let ([.., expected], found) = (self.grid.dims(), slices.positions().len());
        if found != expected {
            return Err(Error::new(Fault::Geometry, "the number of places does not match the slices")
                .found(found.to_string())
                .expected(expected.to_string()));
        }
        self.slices = Some(slices);
        Ok(self)
    }

    /// Where the slices lie, for a rectilinear lattice; `None` where they are one step apart.
    pub fn slices(&self) -> Option<&Slices> {
        self.slices.as_ref()
    }

    /// Place of a voxel, LPS mm. Panics outside a rectilinear lattice.
    pub fn voxel_mm(&self, [i, j, k]: [usize; 3]) -> DVec3 {
        let p = self.slices.as_ref().map_or(k as f64, |slices| slices.positions()[k]);
        self.grid.index_to_lps_mm().transform_point3(DVec3::new(i as f64, j as f64, p))
    }

    /// Distance of each slice from the first along k, mm, for a rectilinear lattice.
    pub fn slice_positions_mm(&self) -> Option<Vec<f64>> {
        let step_mm = self.grid.spacing_mm().z;
        self.slices.as_ref().map(|slices| slices.positions().iter().map(|p| p * step_mm).collect())
    }

    /// Smallest and largest distance between neighbouring slices along k, mm; the spacing of the grid if they are even.
    pub fn slice_step_range_mm(&self) -> [f64; 2] {
        let step_mm = self.grid.spacing_mm().z;
        self.slices.as_ref().map_or([1.0; 2], Slices::step_range).map(|steps| steps * step_mm)
    }

    /// Lattice and affine.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Stored samples, x fastest.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// Stored samples as a 3D array in the order (z, y, x), for programs that use ndarray; 16-bit storage only.
    pub fn view_i16(&self) -> Option<ndarray::ArrayView3<'_, i16>> {
        let [nx, ny, nz] = self.grid.dims();
        match &self.samples {
            Samples::I16(data) => ndarray::ArrayView3::from_shape((nz, ny, nx), data).ok(),
            _ => None,
        }
    }

    /// Map from stored samples to values.
    pub fn rescale(&self) -> Rescale {
        self.rescale
    }

    /// What the values measure.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// The same volume with its values declared to be something else.
    #[must_use]
    pub fn with_quantity(mut self, quantity: Quantity) -> Self {
        self.quantity = quantity;
        self
    }

    /// The same volume with another map from stored samples to values, for scans whose values are shifted.
    #[must_use]
    pub fn with_rescale(mut self, rescale: Rescale) -> Self {
        self.rescale = rescale;
        self
    }

    /// Value (HU for CT, alpha for an RGBA volume) at a lattice point, exact in f64. Panics outside the grid.
    pub fn value(&self, index: [usize; 3]) -> f64 {
        self.rescale.value(self.samples.stored(self.grid.flatten(index)))
    }

    /// Smallest and largest value of the volume.
    pub fn value_range(&self) -> [f64; 2] {
        let [low, high] = self.samples.range();
        let (a, b) = (self.rescale.value(low), self.rescale.value(high));
        [a.min(b), a.max(b)]
    }
}
