//! From a series to a volume: every slice decoded into its place.
//!
//! Slices are decoded in parallel, each into its own part of the one buffer that becomes the volume, so the peak of memory
//! is the volume and a slice per thread.

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;

use super::frame::{Decoded, FrameSlots, decode_frames};
use super::series::{Series, Slice};
use super::storage::{Plane, lowest_value, store};
use super::transfer_syntax;
use crate::error::{Error, Fault, Result};
use crate::volume::{Rescale, Samples};

/// Samples of a series with all that was noticed on the way.
pub(super) struct Assembled {
    pub(super) samples: Samples,
    pub(super) rescale: Rescale,
    /// Slope and intercept as the files give them, for people.
    pub(super) rescale_text: String,
    pub(super) warnings: Vec<String>,
    /// Most bytes held while the pixels were read, estimated.
    pub(super) reading_bytes: u64,
}

/// Bytes per pixel that a thread holds while it reads a slice: the file, and what a decoder makes of it; as measured.
const PLAIN_BYTES_PER_PIXEL: usize = 2;
const DECODER_BYTES_PER_PIXEL: usize = 7;

/// Reads the pixels of a series, whose slices are given in order along k.
///
/// # Errors
/// `Fault::Limit` if the volume would exceed `max_bytes` or memory; else as the pixels of the first bad slice say.
pub(super) fn assemble(series: &Series, slices: &[Slice], max_bytes: Option<u64>) -> Result<Assembled> {
    let (frame_len, reading_bytes) = check_sizes(series, slices, max_bytes)?;
    let mut buffer = zeroed(series, frame_len * slices.len())?;
    let decoded = decode_all(slices, buffer.chunks_exact_mut(frame_len))?;
    let planes: Vec<Plane> = slices
        .iter()
        .zip(decoded)
        .map(|(slice, decoded)| {
            let Rescale { slope, intercept } =
                slice.frame().rescale.as_ref().ok().copied().flatten().unwrap_or(Rescale::IDENTITY);
            let rescale = Rescale { slope, intercept: intercept + slope * f64::from(decoded.offset) };
            Plane { slice, decoded, rescale }
        })
        .collect();
    let Some(lowest) = lowest_value(&planes) else {
        return Err(Error::new(Fault::Input, "every pixel of the series is padding")
            .element(series.label())
            .remedy("choose another series"));
    };
    let warnings = warnings(&planes, lowest);
    let (samples, rescale) = store(buffer, frame_len, &planes, lowest);
    Ok(Assembled { samples, rescale, rescale_text: rescale_text(slices), warnings, reading_bytes })
}

/// Samples of one slice, if those of all can be held, and the most bytes that are held on the way.
fn check_sizes(series: &Series, slices: &[Slice], max_bytes: Option<u64>) -> Result<(usize, u64)> {
    let [columns, rows, count] = series.dims;
    let varies = slices.iter().any(|slice| slice.frame().rescale != slices[0].frame().rescale);
    // Values of slices whose rescale differs may need f32 beside the 16-bit slots they come from.
    let bytes_per_sample = if varies { size_of::<i16>() + size_of::<f32>() } else { size_of::<i16>() };
    let frame_len = columns.checked_mul(rows);
    let bytes = frame_len.and_then(|n| n.checked_mul(count)).and_then(|n| n.checked_mul(bytes_per_sample));
    let (Some(frame_len), Some(bytes)) = (frame_len, bytes) else {
        return Err(too_large(series, "more bytes than there are addresses".to_owned(), max_bytes));
    };
    let plain = slices.iter().all(|slice| transfer_syntax::is_plain(&slice.file().transfer_syntax_uid));
    let per_pixel = if plain { PLAIN_BYTES_PER_PIXEL } else { DECODER_BYTES_PER_PIXEL };
    let bytes = bytes as u64 + (rayon::current_num_threads() * per_pixel * frame_len) as u64;
    if max_bytes.is_some_and(|most| bytes > most) {
        return Err(too_large(series, format!("{bytes} bytes"), max_bytes));
    }
    for slice in slices {
        let file = slice.file();
        // A small file must not make us set aside memory for the pixels it claims.
        let pixels = file.format.frame_bytes().and_then(|bytes| bytes.checked_mul(file.frames.len()));
        if transfer_syntax::is_plain(&file.transfer_syntax_uid) && pixels.is_none_or(|n| n as u64 > file.bytes) {
            return Err(Error::new(Fault::Input, "the file is too short for its pixels")
                .at(&file.path)
                .found(format!("{} bytes", file.bytes))
                .expected(format!(
                    "more than {} bytes",
                    pixels.map_or_else(|| "any number of".to_owned(), |n| n.to_string())
                ))
                .remedy("copy the file again; it was cut short"));
        }
    }
    Ok((frame_len, bytes))
}

fn too_large(series: &Series, found: String, max_bytes: Option<u64>) -> Error {
    let [columns, rows, count] = series.dims;
    let error = Error::new(Fault::Limit, "the volume does not fit into memory")
        .element(format!("{columns} x {rows} x {count} voxels"))
        .found(found)
        .remedy("choose a smaller series, or raise the limit on memory");
    match max_bytes {
        Some(most) => error.expected(format!("at most {most} bytes")),
        None => error,
    }
}

fn zeroed(series: &Series, len: usize) -> Result<Vec<i16>> {
    let mut buffer = Vec::new();
    buffer.try_reserve_exact(len).map_err(|_| too_large(series, format!("{} bytes", 2 * len), None))?;
    buffer.resize(len, 0);
    Ok(buffer)
}

/// Decodes every slice into its part of the volume, one task per file.
fn decode_all<'a>(slices: &[Slice], parts: impl Iterator<Item = &'a mut [i16]>) -> Result<Vec<Decoded>> {
    let mut by_file: BTreeMap<&Path, (Vec<usize>, Vec<FrameSlots>)> = BTreeMap::new();
    for (k, (slice, part)) in slices.iter().zip(parts).enumerate() {
        let (places, frames) = by_file.entry(slice.path()).or_default();
        places.push(k);
        frames.push((slice.frame_index(), part));
    }
    let files: Vec<_> = by_file.into_values().collect();
    let done: Vec<Result<Vec<(usize, Decoded)>>> = files
        .into_par_iter()
        .map(|(places, frames)| {
            let decoded = decode_frames(slices[places[0]].file(), frames)?;
            Ok(places.into_iter().zip(decoded).collect())
        })
        .collect();
    let mut decoded = vec![Decoded::default(); slices.len()];
    // In the order of the paths, so that the same error is reported whichever thread was first.
    for file in done {
        for (k, frame) in file? {
            decoded[k] = frame;
        }
    }
    Ok(decoded)
}

fn warnings(planes: &[Plane], lowest: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    let padding: usize = planes.iter().map(|plane| plane.decoded.padding).sum();
    if padding > 0 {
        let slices = planes.iter().filter(|plane| plane.decoded.padding > 0).count();
        warnings.push(format!(
            "{padding} pixels of {slices} slices are padding: replaced by the smallest value of the others, {lowest}"
        ));
    }
    if let Some(plane) = planes.iter().find(|plane| plane.decoded.warning.is_some()) {
        let count = planes.iter().filter(|plane| plane.decoded.warning.is_some()).count();
        let warning = plane.decoded.warning.as_deref().unwrap_or_default();
        warnings.push(format!("{warning} (in {count} slices, the first {})", plane.slice.name()));
    }
    warnings
}

fn rescale_text(slices: &[Slice]) -> String {
    let mut given: Vec<String> = slices
        .iter()
        .map(|slice| match &slice.frame().rescale {
            Ok(Some(Rescale { slope, intercept })) => format!("slope {slope}, intercept {intercept}"),
            _ => "none".to_owned(),
        })
        .collect();
    given.sort();
    given.dedup();
    match &given[..] {
        [one] => one.clone(),
        many => format!("varies by slice: {} pairs, from {} to {}", many.len(), many[0], many[many.len() - 1]),
    }
}
