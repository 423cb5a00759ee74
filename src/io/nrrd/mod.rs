//! NRRD: the whole format, read and written (teem.sourceforge.net/nrrd/format.html).
//!
//! All five encodings, all ten number types in either byte order, attached and detached headers, data in one file or
//! in many, every named space. [`read`] gives a volume; [`read_array`] gives what is in the file, whatever its shape.
//!
//! What a file does not say is not guessed. Where a sensible reading exists (no origin, no space), it is taken and a
//! warning says so; where there is none (no spacing), the file is refused.
//!
//! A float that is NaN or infinite is replaced by the smallest finite value of the volume, with a warning that says how
//! many there were.

mod data_file;
mod elements;
mod encoding;
mod field;
mod header;
mod kind;
mod lines;
mod orientation;
mod parse;
mod read;
mod rgba;
pub mod segmentation;
mod source;
mod space;
mod storage;
mod values;
mod write;

use std::path::Path;

pub use data_file::{DataFile, NumberedName};
pub use elements::Elements;
pub use encoding::{ElementType, Encoding, Endian};
pub use header::{Axis, ByteSkip, Center, Header};
pub use kind::Kind;
pub use space::{Frame, Space};
pub(in crate::io) use storage::samples as samples_of;
pub use write::write;

use crate::error::Result;
use crate::io::{FileFate, Scan};
use crate::volume::{Quantity, Rescale, Volume};

/// What a file holds, as it stands there.
#[derive(Debug, Clone)]
pub struct Array {
    /// The header.
    pub header: Header,
    /// The elements, fastest axis first.
    pub elements: Elements,
    /// What a careful user should know about the header.
    pub warnings: Vec<String>,
    /// The header's file, then those of the data.
    pub files: Vec<FileFate>,
}

/// Reads the header alone; the strings are warnings.
///
/// # Errors
/// `Fault::Input` for a file that is missing or no valid header, `Fault::Unsupported` for elements or an encoding that
/// this reader does not know.
pub fn read_header(path: &Path) -> Result<(Header, Vec<String>)> {
    read::header(path).map(|(header, warnings, _)| (header, warnings))
}

/// Reads header and elements of an array of any shape: volumes of colours, label maps with layers.
///
/// # Errors
/// As [`read_header`]; also `Fault::Input` for data that is missing, damaged, too short or too long, and
/// `Fault::Limit` if there is not enough memory.
pub fn read_array(path: &Path) -> Result<Array> {
    read::array(path, None)
}

/// Reads a volume of scalars or of colours with an opacity: three spatial axes, perhaps one of kind `RGBA-color`, and others
/// only if they have one sample.
///
/// Values of signed and floating-point types of 16 bits and more are taken for HU, those of 8-bit and unsigned types
/// are not; [`Volume::with_quantity`] overrides that.
///
/// # Errors
/// As [`read_array`]; also `Fault::Unsupported` for an array that is no such volume, and `Fault::Geometry` for one
/// whose place in the patient cannot be known.
pub fn read(path: &Path) -> Result<Scan> {
    read_within(path, None)
}

/// The same, if reading takes at most `max_bytes` of memory.
///
/// # Errors
/// As [`read`]; also `Fault::Limit` for more than `max_bytes`, before anything is allocated for elements.
pub fn read_within(path: &Path, max_bytes: Option<u64>) -> Result<Scan> {
    // The header comes first by itself: whatever it rules out need not be read.
    let (header, _) = read_header(path)?;
    let mut assumptions = Vec::new();
    let grid = orientation::grid(&header, &mut assumptions).map_err(|error| error.at(path))?;
    let Array { header, elements, mut warnings, files } = read::array(path, max_bytes)?;
    let reading_bytes = read::most_bytes(&header);
    warnings.append(&mut assumptions);
    let (samples, rescale) = match rgba::samples(&header, &elements) {
        Some(samples) => samples.map(|samples| (samples, Rescale::IDENTITY)),
        None => storage::samples(elements, &mut warnings),
    }
    .map_err(|error| error.at(path))?;
    let volume = Volume::new(grid, samples, rescale, quantity(header.element_type)).map_err(|error| error.at(path))?;
    let facts = facts(&header, &volume, files.len());
    Ok(Scan { labels: None, facts, volume, warnings, files, reading_bytes })
}

fn quantity(element_type: ElementType) -> Quantity {
    match element_type {
        ElementType::I16 | ElementType::I32 | ElementType::I64 | ElementType::F32 | ElementType::F64 => Quantity::Hu,
        ElementType::I8 | ElementType::U8 | ElementType::U16 | ElementType::U32 | ElementType::U64 => {
            Quantity::Arbitrary
        }
    }
}

/// What was read, for people. `content` and the key/value pairs are left out: they may name the patient.
fn facts(header: &Header, volume: &Volume, files: usize) -> Vec<(String, String)> {
    let [nx, ny, nz] = volume.grid().dims();
    let spacing = volume.grid().spacing_mm();
    let data = match (&header.data_file, files) {
        (DataFile::Attached, _) => "data in the same file".to_owned(),
        (_, 2) => "data in one other file".to_owned(),
        _ => format!("data in {} other files", files - 1),
    };
    let round = |x: f64| (x * 1e6).round() / 1e6;
    [
        ("format", format!("NRRD {}, {data}", header.version)),
        ("encoding", header.encoding.name().to_owned()),
        ("type", header.element_type.name().to_owned()),
        ("dimensions", format!("{nx} x {ny} x {nz}")),
        ("spacing", format!("{} x {} x {} mm", round(spacing.x), round(spacing.y), round(spacing.z))),
        ("space", header.space.map_or("not given".to_owned(), Space::name)),
    ]
    .map(|(label, text)| (label.to_owned(), text))
    .to_vec()
}
