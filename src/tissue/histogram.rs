//! The joint histogram of value and gradient magnitude, with what of each bin is of a tissue.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::Mask;
use crate::error::{Error, Fault, Result};
use crate::field::{GradientUnits, Trilinear, Voxel, gradient_magnitude_row};
use crate::volume::{Samples, Volume};

/// Width of a bin along the value axis, HU.
pub const BIN_VALUE: f64 = 10.0;
/// Width of a bin along the gradient axis, HU/mm.
pub const BIN_GRADIENT_PER_MM: f64 = 5.0;
/// The last bin along the gradient axis holds everything above.
const LAST_GRADIENT_BIN: u16 = 199;

/// Voxels in a bin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Bin {
    /// All of them.
    pub(super) voxels: u64,
    /// Those of the tissue.
    pub(super) of_tissue: u64,
}

/// A joint histogram. Bin `n` of the value axis begins at `n` times its width, and so along the gradient axis.
#[derive(Debug, Clone)]
pub(super) struct Histogram {
    bins: BTreeMap<(i32, u16), Bin>,
}

impl Histogram {
    /// The histogram of a volume and a mask.
    ///
    /// # Errors
    /// `Fault::Geometry` if the two differ in their number of voxels, and as [`Trilinear::new`].
    pub(super) fn new(volume: &Volume, mask: &Mask) -> Result<Self> {
        if mask.dims != volume.grid().dims() {
            return Err(Error::new(Fault::Geometry, "labels and scan differ in their number of voxels")
                .found(format!("{:?} and {:?}", mask.dims, volume.grid().dims())));
        }
        match volume.samples() {
            Samples::I16(data) => Self::of(volume, data, mask),
            Samples::F32(data) => Self::of(volume, data, mask),
            Samples::Rgba8(_) | Samples::Rgba16(_) => Err(super::classify::no_values()),
        }
    }

    fn of<V: Voxel>(volume: &Volume, data: &[V], mask: &Mask) -> Result<Self> {
        let [nx, ny, nz] = volume.grid().dims();
        let field = Trilinear::new(data, volume.grid().dims())?;
        let units = GradientUnits::new(volume.grid(), volume.rescale());
        let of_slice = |k: usize| {
            let mut gradients = vec![0.0_f32; nx];
            let mut bins: BTreeMap<(i32, u16), Bin> = BTreeMap::new();
            for j in 0..ny {
                gradient_magnitude_row(&field, &units, [j, k], &mut gradients);
                let start = nx * (j + ny * k);
                let row = data[start..].iter().zip(&mask.inside[start..]).zip(&gradients);
                for ((stored, inside), gradient) in row {
                    let value = volume.rescale().value(f64::from(stored.to_f32()));
                    // Saturates: values beyond 2e10 share the last bins.
                    let value_bin = (value / BIN_VALUE).floor() as i32;
                    let gradient_bin = (f64::from(*gradient) / BIN_GRADIENT_PER_MM) as u16;
                    let bin = bins.entry((value_bin, gradient_bin.min(LAST_GRADIENT_BIN))).or_default();
                    bin.voxels += 1;
                    bin.of_tissue += u64::from(*inside);
                }
            }
            bins
        };
        let bins = (0..nz).into_par_iter().map(of_slice).reduce(BTreeMap::new, |mut sum, more| {
            for (key, bin) in more {
                let of_both = sum.entry(key).or_default();
                of_both.voxels += bin.voxels;
                of_both.of_tissue += bin.of_tissue;
            }
            sum
        });
        Ok(Histogram { bins })
    }

    /// The bins that are not empty, by value and gradient, in their order.
    pub(super) fn bins(&self) -> impl Iterator<Item = ((i32, u16), Bin)> {
        self.bins.iter().map(|(key, bin)| (*key, *bin))
    }

    /// The bins by value alone.
    pub(super) fn by_value(&self) -> Vec<Bin> {
        let mut bins: BTreeMap<i32, Bin> = BTreeMap::new();
        for ((value, _), bin) in &self.bins {
            let of_value = bins.entry(*value).or_default();
            of_value.voxels += bin.voxels;
            of_value.of_tissue += bin.of_tissue;
        }
        bins.into_values().collect()
    }

    /// All voxels of the tissue.
    pub(super) fn of_tissue(&self) -> u64 {
        self.bins.values().map(|bin| bin.of_tissue).sum()
    }
}
