//! NIfTI-1, read and written: `.nii` and `.nii.gz` (nifti.nimh.nih.gov/nifti-1).
//!
//! Read by the crate `nifti`, which knows headers, byte orders and number types. What it leaves open is decided here: where
//! the voxels are, with x and y turned from NIfTI's RAS to LPS, and what a value is, with the same rules as for NRRD.
//!
//! The *sform* is taken if there is one, the *qform* if not; if both are there and contradict each other, a warning says so.

mod placement;
mod write;

pub use write::write_label_map;

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;
use nifti::volume::inmem::InMemNiftiVolume;
use nifti::{DataElement, NiftiHeader, NiftiType};

use super::nrrd::{Elements, samples_of};
use super::{FileFate, Scan};
use crate::error::{Error, Fault, Result};
use crate::volume::{Quantity, Rescale, Samples, Volume};

/// Bytes of a header, with the four that say whether extensions follow.
const HEADER_BYTES: u64 = 352;
/// Deflate makes at most 1032 bytes of one, so a smaller file cannot hold more.
const MOST_BYTES_FROM_ONE: u64 = 1032;

/// Reads a volume of scalars.
///
/// # Errors
/// `Fault::Input` for a file that is missing, damaged or too short, `Fault::Unsupported` for what is no volume of scalars, for
/// a header whose data lie in another file, and for NIfTI-2, `Fault::Geometry` for voxels whose place cannot be known,
/// `Fault::Limit` if reading takes more than `max_bytes`.
pub fn read(path: &Path, max_bytes: Option<u64>) -> Result<Scan> {
    read_scan(path, max_bytes).map_err(|error| error.at(path))
}

fn read_scan(path: &Path, max_bytes: Option<u64>) -> Result<Scan> {
    let (mut source, is_gzip, file_bytes) = open(path)?;
    let header = header(&mut source)?;
    let dims = dims(&header)?;
    let mut warnings = Vec::new();
    let grid = placement::grid(&header, dims, &mut warnings)?;
    let start = data_start(&header)?;
    let most = if is_gzip { file_bytes.saturating_mul(MOST_BYTES_FROM_ONE) } else { file_bytes };
    let bytes = u64::try_from(header.bitpix / 8).unwrap_or(0) * grid.voxel_count() as u64;
    if start.saturating_add(bytes) > most {
        return Err(Error::new(Fault::Input, "the data ends too early")
            .found(format!("a file of {file_bytes} bytes"))
            .expected(format!("{bytes} bytes of voxels")));
    }
    // The elements as they are, and the samples made of them.
    let reading_bytes = bytes.saturating_mul(2);
    if let Some(limit) = max_bytes.filter(|&limit| reading_bytes > limit) {
        return Err(Error::new(Fault::Limit, "the volume does not fit into memory")
            .found(format!("{reading_bytes} bytes"))
            .expected(format!("at most {limit} bytes"))
            .remedy("crop the volume, or raise the limit on memory with --max-memory"));
    }
    skip(&mut source, start - HEADER_BYTES)?;
    let volume = InMemNiftiVolume::from_reader(source, &header).map_err(damaged)?;
    let (samples, stored) = samples_of(elements(volume, &header)?, &mut warnings)?;
    let rescale = rescale(&header, stored);
    let volume = Volume::new(grid, samples, rescale, quantity(&header))?;
    let files = vec![FileFate { path: path.to_path_buf(), used: true, reason: "header and data".to_owned() }];
    Ok(Scan { labels: None, facts: facts(&header, &volume), volume, warnings, files, reading_bytes })
}

/// The file, unpacked if it is packed; and whether it is, and its size.
fn open(path: &Path) -> Result<(Box<dyn Read>, bool, u64)> {
    let unreadable = |cause: std::io::Error| Error::new(Fault::Input, "the file cannot be read").caused_by(cause);
    let file = File::open(path).map_err(unreadable)?;
    let bytes = file.metadata().map_err(unreadable)?.len();
    let mut reader = BufReader::new(file);
    let is_gzip = std::io::BufRead::fill_buf(&mut reader).map_err(unreadable)?.starts_with(&[0x1f, 0x8b]);
    Ok(match is_gzip {
        true => (Box::new(MultiGzDecoder::new(reader)), true, bytes),
        false => (Box::new(reader), false, bytes),
    })
}

fn header(source: &mut impl Read) -> Result<NiftiHeader> {
    let mut bytes = [0; HEADER_BYTES as usize];
    source
        .read_exact(&mut bytes)
        .map_err(|cause| Error::new(Fault::Input, "the header is cut off or cannot be unpacked").caused_by(cause))?;
    // A NIfTI-2 header begins with its size, 540, in either byte order.
    if matches!(bytes[..4], [0x1c, 0x02, 0, 0] | [0, 0, 0x02, 0x1c]) {
        return Err(Error::new(Fault::Unsupported, "NIfTI-2 is not read here").expected("NIfTI-1"));
    }
    let header = NiftiHeader::from_reader(&bytes[..]).map_err(damaged)?;
    match &header.magic {
        b"n+1\0" => Ok(header),
        b"ni1\0" => Err(Error::new(Fault::Unsupported, "the voxels lie in another file")
            .found("a header for a pair of .hdr and .img")
            .remedy("convert it to one .nii file")),
        other => Err(Error::new(Fault::Input, "this is not NIfTI-1")
            .element("magic")
            .found(String::from_utf8_lossy(other).into_owned())),
    }
}

fn damaged(cause: nifti::NiftiError) -> Error {
    Error::new(Fault::Input, "the file is damaged or not NIfTI-1").caused_by(cause)
}

/// Voxels along i, j and k; further axes may have one entry each.
fn dims(header: &NiftiHeader) -> Result<[usize; 3]> {
    let dim = header.dim().map_err(damaged)?;
    let at = |axis: usize| usize::from(dim.get(axis).copied().unwrap_or(1));
    if dim.len() < 3 || dim[3..].iter().any(|n| *n != 1) {
        return Err(Error::new(Fault::Unsupported, "the array is not one volume of scalars")
            .element("dim")
            .found(format!("{dim:?}"))
            .expected("three axes"));
    }
    let dims = [at(0), at(1), at(2)];
    match dims.iter().try_fold(1_usize, |product, n| product.checked_mul(*n)) {
        Some(_) => Ok(dims),
        None => Err(Error::new(Fault::Limit, "the volume has too many voxels").found(format!("{dims:?}"))),
    }
}

/// Where the voxels begin in the file.
fn data_start(header: &NiftiHeader) -> Result<u64> {
    let start = header.vox_offset;
    // Some writers leave 0, which means right after the header.
    if start == 0.0 {
        return Ok(HEADER_BYTES);
    }
    let possible = start.is_finite() && start.fract() == 0.0 && start >= HEADER_BYTES as f32;
    if possible {
        return Ok(start as u64);
    }
    Err(Error::new(Fault::Input, "the voxels begin at no possible place")
        .element("vox_offset")
        .found(start.to_string())
        .expected("a whole number of at least 352"))
}

fn skip(source: &mut impl Read, bytes: u64) -> Result<()> {
    let skipped = std::io::copy(&mut source.by_ref().take(bytes), &mut std::io::sink());
    match skipped {
        Ok(found) if found == bytes => Ok(()),
        Ok(_) => Err(Error::new(Fault::Input, "the file ends before its voxels")),
        Err(cause) => Err(Error::new(Fault::Input, "the file cannot be unpacked").caused_by(cause)),
    }
}

/// The voxels in their type.
fn elements(volume: InMemNiftiVolume, header: &NiftiHeader) -> Result<Elements> {
    fn typed<T: DataElement>(volume: InMemNiftiVolume) -> Result<Vec<T>> {
        volume.into_nifti_typed_data().map_err(damaged)
    }
    let data_type = header.data_type().map_err(damaged)?;
    if usize::try_from(header.bitpix).ok() != Some(8 * data_type.size_of()) {
        return Err(Error::new(Fault::Input, "type and size of the voxels contradict each other")
            .element("bitpix")
            .found(header.bitpix.to_string())
            .expected((8 * data_type.size_of()).to_string()));
    }
    Ok(match data_type {
        NiftiType::Int8 => Elements::I8(typed(volume)?),
        NiftiType::Uint8 => Elements::U8(typed(volume)?),
        NiftiType::Int16 => Elements::I16(typed(volume)?),
        NiftiType::Uint16 => Elements::U16(typed(volume)?),
        NiftiType::Int32 => Elements::I32(typed(volume)?),
        NiftiType::Uint32 => Elements::U32(typed(volume)?),
        NiftiType::Int64 => Elements::I64(typed(volume)?),
        NiftiType::Uint64 => Elements::U64(typed(volume)?),
        NiftiType::Float32 => Elements::F32(typed(volume)?),
        NiftiType::Float64 => Elements::F64(typed(volume)?),
        other => {
            return Err(Error::new(Fault::Unsupported, "voxels of this type are not read here")
                .element("datatype")
                .found(format!("{other:?}"))
                .expected("integers or floats"));
        }
    })
}

/// The map of the file, after that of how samples are stored here. A slope of 0 means that there is none.
fn rescale(header: &NiftiHeader, stored: Rescale) -> Rescale {
    let (slope, intercept) = (f64::from(header.scl_slope), f64::from(header.scl_inter));
    if slope == 0.0 || !slope.is_finite() || !intercept.is_finite() {
        return stored;
    }
    Rescale { slope: slope * stored.slope, intercept: slope * stored.intercept + intercept }
}

/// As for NRRD: signed numbers of 16 bits and more are taken for HU.
fn quantity(header: &NiftiHeader) -> Quantity {
    match header.data_type() {
        Ok(NiftiType::Int16 | NiftiType::Int32 | NiftiType::Int64 | NiftiType::Float32 | NiftiType::Float64) => {
            Quantity::Hu
        }
        _ => Quantity::Arbitrary,
    }
}

/// What was read, for people. `descrip` and `aux_file` are left out: they may name the patient.
fn facts(header: &NiftiHeader, volume: &Volume) -> Vec<(String, String)> {
    let [nx, ny, nz] = volume.grid().dims();
    let spacing = volume.grid().spacing_mm();
    let round = |x: f64| (x * 1e6).round() / 1e6;
    let samples = match volume.samples() {
        Samples::I16(_) => "16-bit integers",
        Samples::F32(_) => "32-bit floats",
        Samples::Rgba8(_) | Samples::Rgba16(_) => "colours",
    };
    [
        ("format", "NIfTI-1".to_owned()),
        ("type", header.data_type().map_or(String::new(), |t| format!("{t:?}").to_lowercase())),
        ("in memory", samples.to_owned()),
        ("dimensions", format!("{nx} x {ny} x {nz}")),
        ("spacing", format!("{} x {} x {} mm", round(spacing.x), round(spacing.y), round(spacing.z))),
    ]
    .map(|(label, text)| (label.to_owned(), text))
    .to_vec()
}
