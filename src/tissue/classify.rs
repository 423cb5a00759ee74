//! Labels and memberships of all voxels, a row at a time.

use rayon::prelude::*;

use super::decision::{ByValue, Functions};
use crate::error::{Error, Fault, Result};
use crate::field::{GradientUnits, Trilinear, Voxel, gradient_magnitude_row};
use crate::plan::{Classification, Tissue};
use crate::volume::{LabelMap, Rescale, Samples, Volume};

/// The tissue of every voxel, by the definition in the [module](super); without [cleaning](super::clean).
///
/// Beyond the volume it takes a byte per voxel: gradient magnitudes are computed row by row, and only in rows with a voxel
/// whose value leaves the tissue open.
///
/// # Errors
/// `Fault::Limit` if there is not enough memory, or an axis has more voxels than the field can address.
pub fn classify(volume: &Volume, classification: &Classification) -> Result<LabelMap> {
    let functions = Functions::new(&classification.tissues);
    let mut voxels = reserved(volume.grid().voxel_count(), 0_u8)?;
    match volume.samples() {
        Samples::I16(data) => {
            let table = Table::new(&functions, data, volume.rescale());
            label(volume, data, |stored| table.look_up(stored), &functions, &mut voxels)?;
        }
        Samples::F32(data) => {
            let rescale = volume.rescale();
            let look_up = |stored: f32| Known::at(&functions, rescale.value(f64::from(stored)));
            label(volume, data, look_up, &functions, &mut voxels)?;
        }
        Samples::Rgba8(_) | Samples::Rgba16(_) => return Err(no_values()),
    }
    let segments = classification.tissues.iter().map(|tissue| tissue.segment.clone()).collect();
    LabelMap::new(*volume.grid(), segments, voxels)
}

/// The membership of every voxel in a tissue, from 0 to 1, x fastest.
///
/// # Errors
/// As [`classify`].
pub fn membership(volume: &Volume, tissue: &Tissue) -> Result<Vec<f32>> {
    let mut memberships = reserved(volume.grid().voxel_count(), 0.0_f32)?;
    match volume.samples() {
        Samples::I16(data) => fill_membership(volume, data, tissue, &mut memberships)?,
        Samples::F32(data) => fill_membership(volume, data, tissue, &mut memberships)?,
        Samples::Rgba8(_) | Samples::Rgba16(_) => return Err(no_values()),
    }
    Ok(memberships)
}

/// Colours belong to no tissue.
pub(super) fn no_values() -> Error {
    Error::new(Fault::Unsupported, "a volume of colours has no values to classify by")
}

fn reserved<T: Clone>(count: usize, value: T) -> Result<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|cause| {
        Error::new(Fault::Limit, "there is not enough memory for the labels")
            .found(format!("{count} voxels of {} bytes", size_of::<T>()))
            .caused_by(cause)
    })?;
    values.resize(count, value);
    Ok(values)
}

/// What is known of a value: the curves of all terms there, and what they settle.
struct Known<C> {
    curves: C,
    by_value: ByValue,
}

impl Known<Vec<f64>> {
    fn at(functions: &Functions<'_>, value: f64) -> Self {
        let mut curves = vec![0.0; functions.len()];
        functions.curves_at(value, &mut curves);
        let by_value = functions.by_value(&curves);
        Known { curves, by_value }
    }
}

/// What is known of each stored 16-bit number that the volume holds.
struct Table {
    lowest: i16,
    terms: usize,
    curves: Vec<f64>,
    by_value: Vec<ByValue>,
}

impl Table {
    fn new(functions: &Functions<'_>, data: &[i16], rescale: Rescale) -> Self {
        let lowest = data.iter().copied().min().unwrap_or(0);
        let highest = data.iter().copied().max().unwrap_or(0);
        let known = |stored: i16| Known::at(functions, rescale.value(f64::from(stored)));
        let (curves, by_value): (Vec<Vec<f64>>, Vec<ByValue>) =
            (lowest..=highest).map(known).map(|known| (known.curves, known.by_value)).unzip();
        Table { lowest, terms: functions.len(), curves: curves.concat(), by_value }
    }

    fn look_up(&self, stored: i16) -> Known<&[f64]> {
        // At least 0 and below the table's length, since the table spans all stored numbers.
        let row = (i32::from(stored) - i32::from(self.lowest)) as usize;
        Known { curves: &self.curves[row * self.terms..][..self.terms], by_value: self.by_value[row] }
    }
}

fn label<V: Voxel, C: AsRef<[f64]>>(
    volume: &Volume,
    data: &[V],
    look_up: impl Fn(V) -> Known<C> + Sync,
    functions: &Functions<'_>,
    labels: &mut [u8],
) -> Result<()> {
    let [nx, ny, _] = volume.grid().dims();
    let field = Trilinear::new(data, volume.grid().dims())?;
    let units = GradientUnits::new(volume.grid(), volume.rescale());
    let scratch = || (vec![0.0_f32; nx], vec![0.0; functions.tissues()]);
    labels.par_chunks_mut(nx).enumerate().for_each_init(scratch, |(gradients, memberships), (row, line)| {
        let stored = &data[row * nx..][..nx];
        let mut gradients_known = false;
        for (i, label) in line.iter_mut().enumerate() {
            let known = look_up(stored[i]);
            *label = match known.by_value {
                ByValue::Settled(label) => label,
                ByValue::Open => {
                    if !gradients_known {
                        gradient_magnitude_row(&field, &units, [row % ny, row / ny], gradients);
                        gradients_known = true;
                    }
                    functions.decide(known.curves.as_ref(), f64::from(gradients[i]), memberships)
                }
            };
        }
    });
    Ok(())
}

fn fill_membership<V: Voxel>(volume: &Volume, data: &[V], tissue: &Tissue, memberships: &mut [f32]) -> Result<()> {
    let [nx, ny, _] = volume.grid().dims();
    let field = Trilinear::new(data, volume.grid().dims())?;
    let units = GradientUnits::new(volume.grid(), volume.rescale());
    let rescale = volume.rescale();
    memberships.par_chunks_mut(nx).enumerate().for_each_init(
        || vec![0.0_f32; nx],
        |gradients, (row, line)| {
            if tissue.membership_function().reads_gradient() {
                gradient_magnitude_row(&field, &units, [row % ny, row / ny], gradients);
            }
            for ((membership, stored), gradient) in line.iter_mut().zip(&data[row * nx..]).zip(gradients) {
                let value = rescale.value(f64::from(stored.to_f32()));
                *membership = tissue.membership(value, f64::from(*gradient)) as f32;
            }
        },
    );
    Ok(())
}
