//! Which kernel of the exact integrator renders a scene: decided here, once, for the integrator and for who asks beforehand.

use super::{Bound, Exact, VolumeInfo};
use crate::classify::narrowest;
use crate::scene::{ClassifyAt, Model, Scene, Shading};
use crate::transfer::TransferFunction;
use crate::volume::{Grid, Rescale, Volume};

/// Lights that registers have room for.
pub const MOST_LIGHTS: usize = 2;

/// The highest exponent of a highlight that registers raise to: whole ones alone, by products.
const MOST_SHININESS: f64 = 256.0;

/// What nodes miss is estimated over what is absorbed. Where something shines brighter than this over what it absorbs, and all the
/// more where it absorbs nothing, that says little, and the bound is proven.
const MOST_COLOR: f64 = 16.0;

/// f32 is used where an interval between knots is at least this many roundings wide, over the tolerance. On public scans a
/// ray's error by rounding was up to a thirtieth of a rounding over that width; this keeps it within the budget's share.
const SHARE_OF_ROUNDING: f64 = 16.0;

/// A kernel of the exact integrator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExactKernel {
    /// Many cells side by side, in f32, and what is known of the error.
    InRegisters(Bound),
    /// Cells one by one, in f32.
    Single,
    /// Cells one by one, in f64: effects of light, masks, numbers and surfaces, what is given at the voxels, and transfer
    /// functions with knots so close that rounding in f32 would show.
    Double,
}

/// What the choice of a kernel reads of a volume.
#[derive(Debug, Clone, Copy)]
pub struct Stored<'a> {
    grid: &'a Grid,
    rescale: Rescale,
    has_even_slices: bool,
    has_colors: bool,
    /// Classes of voxels, without which a mask masks nothing.
    has_classes: bool,
}

impl<'a> From<&'a Volume> for Stored<'a> {
    fn from(volume: &'a Volume) -> Self {
        Stored {
            grid: volume.grid(),
            rescale: volume.rescale(),
            has_even_slices: volume.slices().is_none(),
            has_colors: volume.samples().are_rgba(),
            has_classes: volume.classes().is_some(),
        }
    }
}

impl<'a> From<&'a VolumeInfo> for Stored<'a> {
    fn from(volume: &'a VolumeInfo) -> Self {
        Stored {
            grid: &volume.grid,
            rescale: volume.rescale,
            has_even_slices: volume.uneven_slices_mm.is_none(),
            has_colors: volume.storage.rgba_encoding().is_some(),
            // By the time a scene with a mask is rendered.
            has_classes: true,
        }
    }
}

impl ExactKernel {
    /// The kernel that renders a scene.
    pub fn of<'a>(scene: &Scene, volume: impl Into<Stored<'a>>, settings: &Exact) -> Self {
        let (volume, effects) = (volume.into(), &scene.effects);
        let of_values = !volume.has_colors && effects.classify == ClassifyAt::Samples;
        let is_masked = volume.has_classes && effects.mask.is_some();
        let plain = of_values && scene.model == Model::Light && !effects.change_light() && !is_masked;
        if !plain || is_too_narrow(&scene.transfer_function, volume.rescale, settings.tolerance) {
            return ExactKernel::Double;
        }
        let lit = scene.shading.as_ref();
        if !volume.fits_registers() || !lit.is_none_or(shades_in_registers) {
            return ExactKernel::Single;
        }
        let can_estimate = || lit.is_some() && scene.transfer_function.largest_color() <= MOST_COLOR;
        let estimates = settings.bound == Bound::Estimated && can_estimate();
        ExactKernel::InRegisters(if estimates { Bound::Estimated } else { Bound::Proven })
    }

    /// What is known of the error of its pictures.
    pub fn bound(self) -> Bound {
        match self {
            ExactKernel::InRegisters(bound) => bound,
            ExactKernel::Single | ExactKernel::Double => Bound::Proven,
        }
    }
}

impl Stored<'_> {
    /// Whether lanes can index the lattice, and cells are alike.
    fn fits_registers(&self) -> bool {
        let is_thick = self.grid.dims().iter().all(|&n| n >= 2);
        self.has_even_slices && is_thick && i32::try_from(self.grid.voxel_count()).is_ok()
    }
}

/// Whether rounding a value in f32 would cost more, across an interval between knots, than rounding may.
fn is_too_narrow(transfer_function: &TransferFunction, rescale: Rescale, tolerance: f64) -> bool {
    narrowest(transfer_function, rescale) < SHARE_OF_ROUNDING * f64::from(f32::EPSILON) / tolerance
}

/// Whether many cells can be shaded at once.
pub fn shades_in_registers(shading: &Shading) -> bool {
    let p = shading.shininess;
    let is_power = p.fract() == 0.0 && (2.0..=MOST_SHININESS).contains(&p);
    shading.lights.len() <= MOST_LIGHTS && (is_power || shading.specular == 0.0)
}
