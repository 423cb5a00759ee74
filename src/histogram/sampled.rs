//! A volume's samples as a field of a known type, whatever they are stored in and however slices follow each other.

use crate::error::{Error, Fault, Result};
use crate::field::{GradientUnits, SliceTable, Spacing, Trilinear, Voxel, gradient_magnitude_row};
use crate::volume::{Grid, Rescale, Samples, Volume};

/// A volume of values.
pub(super) struct Sampled<'v, V, K> {
    pub(super) field: Trilinear<'v, V, K>,
    pub(super) units: GradientUnits,
    pub(super) rescale: Rescale,
    pub(super) grid: &'v Grid,
    /// Place of each slice along k, in steps of the grid's affine.
    pub(super) slices: &'v [f64],
}

/// What is to be done with a volume of values, for any type that it is stored in.
pub(super) trait Task {
    /// What comes of it.
    type Output;

    /// Does it.
    fn on<V: Voxel, K: Spacing>(&self, sampled: &Sampled<'_, V, K>) -> Self::Output;
}

impl<V: Voxel, K: Spacing> Sampled<'_, V, K> {
    /// The value of a voxel.
    pub(super) fn value(&self, voxel: [usize; 3]) -> f64 {
        self.rescale.value(f64::from(self.field.voxel(voxel)))
    }

    /// The gradient magnitudes of row `(j, k)`, per mm, into `row`.
    pub(super) fn gradients(&self, at: [usize; 2], row: &mut [f32]) {
        gradient_magnitude_row(&self.field, &self.units, at, row);
    }
}

/// Does a task on a volume.
///
/// # Errors
/// `Fault::Unsupported` for a volume of colours; as [`Trilinear::new`].
pub(super) fn on_values<T: Task>(volume: &Volume, task: &T) -> Result<T::Output> {
    match volume.samples() {
        Samples::I16(data) => on_voxels(volume, data, task),
        Samples::F32(data) => on_voxels(volume, data, task),
        Samples::Rgba8(_) | Samples::Rgba16(_) => {
            Err(Error::new(Fault::Unsupported, "a volume of colours has no values to count"))
        }
    }
}

fn on_voxels<V: Voxel, T: Task>(volume: &Volume, data: &[V], task: &T) -> Result<T::Output> {
    let (grid, rescale) = (volume.grid(), volume.rescale());
    let field = Trilinear::new(data, grid.dims())?;
    let units = GradientUnits::new(grid, rescale);
    Ok(match volume.slices() {
        None => {
            let even: Vec<f64> = (0..grid.dims()[2]).map(|k| k as f64).collect();
            task.on(&Sampled { field, units, rescale, grid, slices: &even })
        }
        Some(slices) => {
            let table = SliceTable::new(slices);
            let field = field.with_spacing(table.spacing());
            task.on(&Sampled { field, units, rescale, grid, slices: slices.positions() })
        }
    })
}
