//! A volume as a CT series.

use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::Path;

use tempfile::Builder;

use super::ct_image::SeriesAttributes;
use super::decimal_string::exact;
use super::uid::Seed;
use crate::error::{Error, Fault, Result};
use crate::io::whole_file::folder_of;
use crate::volume::{Quantity, Rescale, Samples, Slices, Volume};

/// Cosine of the angle between rows and columns above which a lattice is sheared in the plane of its slices.
const IN_PLANE_SHEAR: f64 = 1e-6;

/// Characters of a Series Description (VR LO, PS3.5 §6.2).
const MAX_DESCRIPTION: usize = 64;

/// What is written about a series besides its volume.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SeriesDescription {
    /// Series Description, at most 64 characters.
    pub description: String,
    /// Tells apart series whose content is the same: the identifiers are derived from the content and this number.
    pub seed: u64,
}

/// Writes a volume as a CT Image Storage series into a new folder, one file per slice, and gives the number of files.
///
/// Values are written as signed 16-bit numbers with the volume's rescale, so that reading gives the same values; the
/// affine as position, orientation and spacing, to the 16 characters of a DS; slices at uneven distances each at its
/// place, without Spacing Between Slices. Slices of a left-handed lattice come back in
/// the reverse order, each at its place. The folder appears whole or not at all. Patient name and ID are `PHANTOM`; the
/// identifiers are those of the content, the same each time.
///
/// # Errors
/// `Fault::Unsupported` for what a CT series cannot hold: shear in the plane of the slices, more than 65535 rows or columns,
/// values that are not 16-bit integers under one rescale, a description of more than 64 characters. `Fault::Output` if the
/// folder exists and is not empty, or cannot be written.
pub fn write_series(dir: &Path, volume: &Volume, description: &SeriesDescription) -> Result<usize> {
    let (stored, rescale) = stored_values(volume).map_err(|error| error.at(dir))?;
    let attributes = attributes(volume, &stored, rescale, description).map_err(|error| error.at(dir))?;
    let [columns, rows, slices] = volume.grid().dims();
    let width = slices.to_string().len().max(4);
    whole_folder(dir, |folder| {
        for k in 0..slices {
            let position = volume.voxel_mm([0, 0, k]);
            let plane = &stored[k * columns * rows..(k + 1) * columns * rows];
            let pixels = plane.iter().map(|&value| value.cast_unsigned()).collect();
            let path = folder.join(format!("{:0width$}.dcm", k + 1));
            let failed = |error: Box<dyn std::error::Error + Send + Sync>| {
                Error::new(Fault::Output, "the slice cannot be written").at(&path).caused_by(error)
            };
            let image = attributes.image(k, position.to_array(), pixels).map_err(|error| failed(error.into()))?;
            let mut file = BufWriter::new(File::create(&path).map_err(|error| failed(error.into()))?);
            image.write_all(&mut file).map_err(|error| failed(error.into()))?;
            file.flush().map_err(|error| failed(error.into()))?;
        }
        Ok(slices)
    })
}

/// The 16-bit numbers to write, and their rescale.
fn stored_values(volume: &Volume) -> Result<(Vec<i16>, Rescale)> {
    match volume.samples() {
        Samples::I16(stored) => Ok((stored.clone(), volume.rescale())),
        Samples::F32(values) => {
            let whole =
                |value: f64| (f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(&value) && value.fract() == 0.0;
            let value_of = |&value: &f32| volume.rescale().value(f64::from(value));
            if let Some(index) = values.iter().position(|value| !whole(value_of(value))) {
                let [i, j, k] = volume.grid().unflatten(index);
                return Err(Error::new(Fault::Unsupported, "the values are not all whole numbers of 16 bits")
                    .element(format!("voxel ({i}, {j}, {k})"))
                    .found(value_of(&values[index]).to_string())
                    .expected("whole numbers from -32768 to 32767")
                    .remedy("write NRRD, which holds any value"));
            }
            Ok((values.iter().map(|value| value_of(value) as i16).collect(), Rescale::IDENTITY))
        }
        Samples::Rgba8(_) | Samples::Rgba16(_) => Err(Error::new(Fault::Unsupported, "a CT series holds values")
            .found("colours with an opacity")
            .remedy("write NRRD, which holds them")),
    }
}

fn attributes(
    volume: &Volume,
    stored: &[i16],
    rescale: Rescale,
    description: &SeriesDescription,
) -> Result<SeriesAttributes> {
    let SeriesDescription { description: text, seed } = description;
    if text.chars().count() > MAX_DESCRIPTION || text.chars().any(|c| c.is_control() || c == '\\') {
        return Err(Error::new(Fault::Unsupported, "the series description cannot be written")
            .found(format!("{text:?}"))
            .expected("at most 64 characters, none of them a backslash or a control character")
            .remedy("shorten the description"));
    }
    let grid = volume.grid();
    let [columns, rows, _] = grid.dims();
    let too_many = |_| {
        Error::new(Fault::Unsupported, "a slice has too many rows or columns for DICOM")
            .found(format!("{columns} x {rows}"))
            .expected("at most 65535 each")
            .remedy("write NRRD")
    };
    let matrix = grid.index_to_lps_mm().matrix3;
    let (row, column) = (matrix.x_axis.normalize(), matrix.y_axis.normalize());
    if row.dot(column).abs() > IN_PLANE_SHEAR {
        return Err(Error::new(Fault::Unsupported, "the lattice is sheared in the plane of its slices")
            .found(format!("{:.4} degrees between rows and columns", row.angle_between(column).to_degrees()))
            .expected("90, as Image Orientation (Patient) demands (PS3.3 C.7.6.2.1.1)")
            .remedy("write NRRD, which holds any affine"));
    }
    let decimal = |name: &str, value: f64| {
        exact(value).ok_or_else(|| {
            Error::new(Fault::Unsupported, format!("the rescale {name} cannot be written in the 16 characters of a DS"))
                .found(value.to_string())
                .remedy("write NRRD")
        })
    };
    let quantity = match volume.quantity() {
        Quantity::Hu => "HU",
        Quantity::Arbitrary => "US",
    };
    Ok(SeriesAttributes {
        seed: content_seed(volume, stored, rescale, quantity, description, *seed),
        description: text.clone(),
        rows: u16::try_from(rows).map_err(too_many)?,
        columns: u16::try_from(columns).map_err(too_many)?,
        cosines: [row.x, row.y, row.z, column.x, column.y, column.z],
        pixel_spacing_mm: [matrix.y_axis.length(), matrix.x_axis.length()],
        slice_spacing_mm: volume.slices().is_none().then(|| matrix.z_axis.dot(row.cross(column)).abs()),
        rescale: [decimal("slope", rescale.slope)?, decimal("intercept", rescale.intercept)?],
        rescale_type: quantity,
    })
}

/// The hash of all that is written.
fn content_seed(
    volume: &Volume,
    stored: &[i16],
    rescale: Rescale,
    quantity: &str,
    description: &SeriesDescription,
    seed: u64,
) -> Seed {
    let dims = volume.grid().dims().map(|n| n as u64).map(u64::to_le_bytes).concat();
    let affine = volume.grid().index_to_lps_mm().to_cols_array();
    let places = volume.slices().map(Slices::positions).unwrap_or_default();
    let lattice: Vec<u8> = affine.iter().chain(places).flat_map(|number| number.to_le_bytes()).collect();
    let rescale = [rescale.slope, rescale.intercept].map(f64::to_le_bytes).concat();
    let samples: Vec<u8> = stored.iter().flat_map(|value| value.to_le_bytes()).collect();
    let description = description.description.as_bytes();
    Seed::of(&[&dims, &lattice, &rescale, quantity.as_bytes(), description, &seed.to_le_bytes(), &samples])
}

/// Makes a folder under another name beside `dir`, lets `write` fill it, and gives it its name; nothing is left on failure.
fn whole_folder<T>(dir: &Path, write: impl FnOnce(&Path) -> Result<T>) -> Result<T> {
    let failed = |error: std::io::Error| {
        Error::new(Fault::Output, "the folder cannot be written")
            .at(dir)
            .caused_by(error)
            .remedy("check that the path can be written to")
    };
    if dir.exists() && (!dir.is_dir() || fs::read_dir(dir).map_err(failed)?.next().is_some()) {
        return Err(Error::new(Fault::Output, "the folder exists and is not empty")
            .at(dir)
            .remedy("choose another folder: slices of two series must not mix"));
    }
    let parent = folder_of(dir);
    fs::create_dir_all(&parent).map_err(failed)?;
    let name = dir.file_name().unwrap_or_default().to_string_lossy();
    // In the same folder, so that the renaming stays on one file system; dropped, it is removed.
    let part = Builder::new().prefix(&format!(".{name}.")).suffix(".partial").tempdir_in(parent).map_err(failed)?;
    let result = write(part.path())?;
    if dir.exists() {
        fs::remove_dir(dir).map_err(failed)?; // Empty, as was seen above; anything else is an error here.
    }
    fs::rename(part.path(), dir).map_err(failed)?;
    let _ = part.keep();
    Ok(result)
}
