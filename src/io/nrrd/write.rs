//! Writes a volume as a file with an attached header, in LPS.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use bzip2::write::BzEncoder;
use flate2::write::GzEncoder;

use super::encoding::{ElementType, Encoding};
use super::field::Field;
use crate::error::{Error, Fault, Result};
use crate::io::whole_file;
use crate::volume::{Grid, LabelMap, Quantity, Samples, Volume};

/// Values that are converted before they are written, to keep the number of writes small.
const CHUNK_VALUES: usize = 1 << 14;

/// Writes a volume, its values exactly; little-endian, LPS, in mm, with key/value pairs of the caller's.
///
/// The type is the smallest that holds every value and that [`read`](super::read) takes for the same quantity: int16,
/// int32, float or double for HU, and uint8 or uint16 before these for others. Colours are written as they are stored, with
/// their components along the first axis.
///
/// # Errors
/// `Fault::Unsupported` for slices at uneven distances, which a NRRD cannot say. `Fault::Output` if the file cannot be
/// written, or a key or value cannot stand in a header.
pub fn write(path: &Path, volume: &Volume, encoding: Encoding, key_values: &[(String, String)]) -> Result<()> {
    refuse_uneven(volume).map_err(|error| error.at(path))?;
    let element_type = element_type(volume);
    let header = header(volume.grid(), volume.samples().are_rgba(), element_type, encoding, key_values)
        .map_err(|error| error.at(path))?;
    whole_file::write(path, |file| {
        file.write_all(header.as_bytes())?;
        match encoding {
            Encoding::Raw => binary(volume, element_type, file),
            Encoding::Gzip => {
                let mut file = GzEncoder::new(file, flate2::Compression::default());
                binary(volume, element_type, &mut file)?;
                file.finish().map(drop)
            }
            Encoding::Bzip2 => {
                let mut file = BzEncoder::new(file, bzip2::Compression::default());
                binary(volume, element_type, &mut file)?;
                file.finish().map(drop)
            }
            Encoding::Text => text(volume, file),
            Encoding::Hex => binary(volume, element_type, &mut HexDigits(file)),
        }
    })
}

/// Writes the labels of a map, packed, as uint8 if they fit, as uint16 if not.
///
/// # Errors
/// As [`write`].
pub(super) fn write_labels(path: &Path, labels: &LabelMap, key_values: &[(String, String)]) -> Result<()> {
    let wide = labels.segments().iter().any(|segment| segment.label > 255);
    let element_type = if wide { ElementType::U16 } else { ElementType::U8 };
    let header =
        header(labels.grid(), false, element_type, Encoding::Gzip, key_values).map_err(|error| error.at(path))?;
    // A label map has at most 255 segments.
    let numbers: Vec<u16> = (0..=labels.segments().len()).map(|voxel| labels.label_of(voxel as u8)).collect();
    whole_file::write(path, |file| {
        file.write_all(header.as_bytes())?;
        let mut file = GzEncoder::new(file, flate2::Compression::default());
        for chunk in labels.voxels().chunks(CHUNK_VALUES) {
            let numbers = chunk.iter().map(|voxel| numbers[usize::from(*voxel)]);
            let bytes: Vec<u8> = match wide {
                true => numbers.flat_map(u16::to_le_bytes).collect(),
                false => numbers.map(|label| label as u8).collect(),
            };
            file.write_all(&bytes)?;
        }
        file.finish().map(drop)
    })
}

/// The format has one `space directions` vector per axis, and no place for a table.
fn refuse_uneven(volume: &Volume) -> Result<()> {
    if volume.slices().is_none() {
        return Ok(());
    }
    let [least, most] = volume.slice_step_range_mm();
    Err(Error::new(Fault::Unsupported, "a NRRD cannot hold slices at uneven distances")
        .found(format!("slices {least:.4} to {most:.4} mm apart"))
        .expected("one distance")
        .remedy("write a DICOM series, or resample to even slices first"))
}

/// The smallest type that holds every value exactly.
fn element_type(volume: &Volume) -> ElementType {
    match volume.samples() {
        Samples::Rgba8(_) => return ElementType::U8,
        Samples::Rgba16(_) => return ElementType::U16,
        Samples::I16(_) | Samples::F32(_) => {}
    }
    let rescale = volume.rescale();
    let values = || (0..volume.samples().len()).map(|index| rescale.value(volume.samples().stored(index)));
    let [low, high] = volume.value_range();
    let fits = |from: f64, to: f64| from <= low && high <= to;
    let integers = match volume.samples() {
        Samples::I16(_) => rescale.slope.fract() == 0.0 && rescale.intercept.fract() == 0.0,
        _ => false,
    };
    let unsigned = integers && volume.quantity() == Quantity::Arbitrary;
    match integers {
        true if unsigned && fits(0.0, 255.0) => ElementType::U8,
        true if unsigned && fits(0.0, 65535.0) => ElementType::U16,
        true if fits(-32768.0, 32767.0) => ElementType::I16,
        true if fits(f64::from(i32::MIN), f64::from(i32::MAX)) => ElementType::I32,
        _ if values().all(|value| f64::from(value as f32) == value) => ElementType::F32,
        _ => ElementType::F64,
    }
}

fn header(
    grid: &Grid,
    are_rgba: bool,
    element_type: ElementType,
    encoding: Encoding,
    key_values: &[(String, String)],
) -> Result<String> {
    let [nx, ny, nz] = grid.dims();
    let affine = grid.index_to_lps_mm();
    let vector = |v: glam::DVec3| format!("({},{},{})", v.x, v.y, v.z);
    let steps = affine.matrix3;
    // Dimension, and what stands before the three axes of space in sizes, directions and kinds.
    let [dimension, size, direction, kind] =
        if are_rgba { ["4", "4 ", "none ", "RGBA-color "] } else { ["3", "", "", ""] };
    let mut header = format!(
        "NRRD0004\n\
         type: {}\n\
         dimension: {dimension}\n\
         space: left-posterior-superior\n\
         sizes: {size}{nx} {ny} {nz}\n\
         space directions: {direction}{} {} {}\n\
         kinds: {kind}domain domain domain\n\
         endian: little\n\
         encoding: {}\n\
         space origin: {}\n",
        element_type.name(),
        vector(steps.x_axis),
        vector(steps.y_axis),
        vector(steps.z_axis),
        encoding.name(),
        vector(affine.translation),
    );
    for (key, value) in key_values {
        refuse_key(key, value)?;
        header.push_str(&format!("{}:={}\n", with_escapes(key), with_escapes(value)));
    }
    header.push('\n');
    Ok(header)
}

/// A pair must come back from a reader as it was given.
fn refuse_key(key: &str, value: &str) -> Result<()> {
    let reason = if key.is_empty() {
        "a key without a name"
    } else if key.starts_with('#') {
        "a key that reads as a comment"
    } else if key.contains(":=") || key.ends_with(':') {
        "a key with the mark that ends it"
    } else if key.split_once(':').is_some_and(|(name, _)| Field::from_name(name).is_some()) {
        "a key that reads as a field"
    } else if key.chars().chain(value.chars()).any(|c| c.is_control() && c != '\n' && c != '\t') {
        "a control character"
    } else {
        return Ok(());
    };
    Err(Error::new(Fault::Output, "a key/value pair cannot stand in a header").element(key).found(reason))
}

fn with_escapes(text: &str) -> String {
    text.replace('\\', "\\\\").replace('\n', "\\n")
}

/// Runs over the values in chunks, each turned into bytes.
fn binary(volume: &Volume, element_type: ElementType, file: &mut impl Write) -> io::Result<()> {
    let rescale = volume.rescale();
    let samples = volume.samples();
    match samples {
        Samples::Rgba8(texels) => return file.write_all(texels.as_flattened()),
        Samples::Rgba16(texels) => {
            return texels.chunks(CHUNK_VALUES).try_for_each(|chunk| {
                file.write_all(&chunk.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>())
            });
        }
        Samples::I16(_) | Samples::F32(_) => {}
    }
    let mut bytes = Vec::with_capacity(CHUNK_VALUES * element_type.bytes());
    for start in (0..samples.len()).step_by(CHUNK_VALUES) {
        bytes.clear();
        for index in start..samples.len().min(start + CHUNK_VALUES) {
            let value = rescale.value(samples.stored(index));
            // Every value fits the type, by its choice.
            match element_type {
                ElementType::U8 => bytes.push(value as u8),
                ElementType::I16 => bytes.extend((value as i16).to_le_bytes()),
                ElementType::U16 => bytes.extend((value as u16).to_le_bytes()),
                ElementType::I32 => bytes.extend((value as i32).to_le_bytes()),
                ElementType::F32 => bytes.extend((value as f32).to_le_bytes()),
                _ => bytes.extend(value.to_le_bytes()),
            }
        }
        file.write_all(&bytes)?;
    }
    Ok(())
}

/// One row of voxels in a line.
fn text(volume: &Volume, file: &mut BufWriter<File>) -> io::Result<()> {
    let row = volume.grid().dims()[0];
    for index in 0..volume.samples().len() {
        let end = if (index + 1).is_multiple_of(row) { '\n' } else { ' ' };
        match volume.samples() {
            Samples::Rgba8(texels) => components(texels[index], end, file)?,
            Samples::Rgba16(texels) => components(texels[index], end, file)?,
            samples => write!(file, "{}{end}", volume.rescale().value(samples.stored(index)))?,
        }
    }
    Ok(())
}

fn components<T: std::fmt::Display>([r, g, b, alpha]: [T; 4], end: char, file: &mut impl Write) -> io::Result<()> {
    write!(file, "{r} {g} {b} {alpha}{end}")
}

/// Writes each byte as two hexadecimal digits, 40 bytes in a line.
struct HexDigits<W>(W);

impl<W: Write> Write for HexDigits<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for line in bytes.chunks(40) {
            for byte in line {
                write!(self.0, "{byte:02x}")?;
            }
            self.0.write_all(b"\n")?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
