//! The pixels of one file, decoded into 16-bit slots.

use std::panic::{AssertUnwindSafe, catch_unwind};

use dicom_core::value::PrimitiveValue;
use dicom_dictionary_std::tags;
use dicom_encoding::TransferSyntaxIndex as _;
use dicom_encoding::adapters::PixelDataObject as _;
use dicom_encoding::transfer_syntax::Codec;
use dicom_object::{DefaultDicomObject, OpenFileOptions};
use dicom_transfer_syntax_registry::TransferSyntaxRegistry;

use super::codestream::{Codestream, Coding};
use super::header::ImageFile;
use super::pixels::StoredBits;
use super::transfer_syntax;
use crate::error::{Error, Fault, Result};

/// The index of a frame in its file, and the part of the volume that it fills.
pub(super) type FrameSlots<'a> = (usize, &'a mut [i16]);

/// What was decoded into one frame's slots.
#[derive(Debug, Clone, Default)]
pub(super) struct Decoded {
    /// Stored value minus slot.
    pub(super) offset: i32,
    /// Smallest and largest slot that is not padding; `None` if all are.
    pub(super) range: Option<[i16; 2]>,
    /// Pixels that are padding.
    pub(super) padding: usize,
    /// What the data set and the compressed data disagree in.
    pub(super) warning: Option<String>,
}

/// Decodes frames of a file, each into the slots given for it.
///
/// # Errors
/// `Fault::Input` for pixel data that is missing, of the wrong length, or damaged; `Fault::Unsupported` for coding that
/// this build would get wrong.
pub(super) fn decode_frames(file: &ImageFile, frames: Vec<FrameSlots>) -> Result<Vec<Decoded>> {
    let object = OpenFileOptions::new().read_to(tags::PIXEL_DATA).open_file(&file.path).map_err(|error| {
        Error::new(Fault::Input, "the pixels cannot be read")
            .at(&file.path)
            .found(format!("a file of {} bytes: {}", file.bytes, super::deepest(&error)))
            .remedy("copy the file again; it may be cut short")
    })?;
    frames
        .into_iter()
        .map(|(index, slots)| {
            let mut decoded = decode_frame(file, &object, index, slots)?;
            measure(file, slots, &mut decoded);
            Ok(decoded)
        })
        .collect()
}

fn decode_frame(file: &ImageFile, object: &DefaultDicomObject, index: usize, slots: &mut [i16]) -> Result<Decoded> {
    if transfer_syntax::is_native(&file.transfer_syntax_uid) {
        native_frame(file, object, index, slots)
    } else {
        compressed_frame(file, object, index, slots)
    }
}

fn native_frame(file: &ImageFile, object: &DefaultDicomObject, index: usize, slots: &mut [i16]) -> Result<Decoded> {
    let Some(cells) = object.get(tags::PIXEL_DATA).and_then(|element| element.value().primitive()) else {
        return Err(Error::new(Fault::Input, "there is no uncompressed Pixel Data")
            .at(&file.path)
            .found(format!("the transfer syntax {}", transfer_syntax::name(&file.transfer_syntax_uid)))
            .remedy("export the file again"));
    };
    let found = cells.calculate_byte_len();
    let expected = file.format.frame_bytes().and_then(|bytes| bytes.checked_mul(file.frames.len()));
    // Values have an even length (PS3.5 §7.1.1), so an odd one is followed by a byte of padding.
    if expected.is_none_or(|expected| found != expected && found != expected + expected % 2) {
        return Err(wrong_length(file, found, expected));
    }
    let bits = file.format.stored_bits();
    let frame = index * slots.len()..(index + 1) * slots.len();
    match (cells, file.format.bits_allocated) {
        (PrimitiveValue::U16(words), 16) => fill(slots, &words[frame], bits),
        (PrimitiveValue::U16(words), _) => {
            // 8-bit cells in words: the first one is the low byte (PS3.5 §8.1.1).
            for (slot, cell) in slots.iter_mut().zip(frame) {
                *slot = bits.slot(words[cell / 2] >> (8 * (cell % 2)) & 0xFF);
            }
        }
        (PrimitiveValue::U8(bytes), 8) => fill_bytes(slots, &bytes[frame], bits),
        (PrimitiveValue::U8(bytes), _) => fill_words(slots, &bytes[2 * frame.start..2 * frame.end], bits),
        _ => return Err(wrong_length(file, found, expected)),
    }
    Ok(Decoded { offset: bits.offset(), ..Decoded::default() })
}

fn wrong_length(file: &ImageFile, found: usize, expected: Option<usize>) -> Error {
    let format = &file.format;
    let expected = expected.map_or_else(|| "fewer".to_owned(), |bytes| bytes.to_string());
    Error::new(Fault::Input, "the Pixel Data has the wrong length")
        .at(&file.path)
        .found(format!("{found} bytes"))
        .expected(format!(
            "{expected} for {} frames of {} x {} pixels of {} bits",
            file.frames.len(),
            format.columns,
            format.rows,
            format.bits_allocated
        ))
        .remedy("copy or export the file again; it may be cut short")
}

fn compressed_frame(file: &ImageFile, object: &DefaultDicomObject, index: usize, slots: &mut [i16]) -> Result<Decoded> {
    let fault = |fault, what: String| {
        Error::new(fault, what)
            .at(&file.path)
            .element(format!("frame {}", index + 1))
            .remedy("convert the series to Explicit VR Little Endian, or export it again")
    };
    let is_encapsulated = object.number_of_fragments().is_some();
    let encoded = object.frame_pixel_data(index as u32).filter(|bytes| is_encapsulated && !bytes.is_empty());
    let Some(encoded) = encoded else {
        return Err(fault(Fault::Input, "there is no compressed Pixel Data of this frame".to_owned()));
    };
    // RLE has no header that says as much.
    let codestream = Codestream::of_jpeg(&encoded).or_else(|| Codestream::of_jpeg2000(&encoded));
    if let Some(stream) = codestream {
        if let Some(reason) = stream.refusal() {
            return Err(fault(Fault::Unsupported, reason));
        }
        if (stream.columns, stream.rows, stream.components) != (file.format.columns, file.format.rows, 1) {
            return Err(fault(
                Fault::Input,
                "the compressed image is not the one that the header describes".to_owned(),
            )
            .found(format!("{} x {} pixels of {} components", stream.columns, stream.rows, stream.components))
            .expected(format!("{} x {} of 1", file.format.columns, file.format.rows)));
        }
    }
    let bytes = decompress(file, object, index).map_err(|reason| {
        fault(Fault::Input, format!("the compressed pixels cannot be decoded: {reason}"))
            .found(transfer_syntax::name(&file.transfer_syntax_uid))
    })?;
    let sample_bytes = codestream.map_or((file.format.bits_allocated / 8) as usize, |stream| {
        stream.decoded_sample_bytes(file.format.bits_allocated)
    });
    let needed = slots.len() * sample_bytes;
    if bytes.len() < needed {
        return Err(fault(Fault::Input, "the compressed pixels end too soon".to_owned())
            .found(format!("{} bytes", bytes.len()))
            .expected(needed.to_string()));
    }
    let (bits, warning) = decoded_bits(file, codestream);
    match sample_bytes {
        1 => fill_bytes(slots, &bytes[..needed], bits),
        _ => fill_words(slots, &bytes[..needed], bits),
    }
    Ok(Decoded { offset: bits.offset(), warning, ..Decoded::default() })
}

/// Runs the decoder of the transfer syntax; it gives little-endian samples.
///
/// Some decoders panic on damaged data where an error is due. They own all that they work on, so nothing is left in doubt
/// when that is caught here.
fn decompress(file: &ImageFile, object: &DefaultDicomObject, index: usize) -> Result<Vec<u8>, String> {
    let syntax = TransferSyntaxRegistry.get(&file.transfer_syntax_uid);
    let Some(Codec::EncapsulatedPixelData(Some(reader), _)) = syntax.map(|syntax| syntax.codec()) else {
        return Err("no decoder for it in this build".to_owned());
    };
    let mut bytes = Vec::new();
    catch_unwind(AssertUnwindSafe(|| reader.decode_frame(object, index as u32, &mut bytes)))
        .map_err(|_| "the data is damaged".to_owned())?
        .map_err(|error| super::deepest(&error))?;
    Ok(bytes)
}

/// The stored bits of decoded samples, which lie at the bottom of their cells.
///
/// JPEG 2000 samples have a precision and sign of their own, and decoders give them by these. The precision is taken from
/// the codestream, the sign from Pixel Representation, as pydicom does: where the two disagree the bits are right and
/// only their reading was wrong.
fn decoded_bits(file: &ImageFile, codestream: Option<Codestream>) -> (StoredBits, Option<String>) {
    let mut bits = StoredBits { low_bit: 0, ..file.format.stored_bits() };
    match codestream {
        Some(Codestream { coding: Coding::Jpeg2000 { signed }, precision, .. }) => {
            bits.bits = precision.clamp(1, 16);
            let sign = |signed| if signed { "signed" } else { "unsigned" };
            let warning = (signed != bits.signed || i64::from(precision) != file.format.bits_stored).then(|| {
                format!(
                    "the JPEG 2000 data is {} of {precision} bits, its header says {} of {} bits: \
                     read as {} of {precision} bits",
                    sign(signed),
                    sign(bits.signed),
                    file.format.bits_stored,
                    sign(bits.signed)
                )
            });
            (bits, warning)
        }
        Some(_) => (bits, None),
        // RLE keeps whole cells.
        None => (file.format.stored_bits(), None),
    }
}

fn fill(slots: &mut [i16], cells: &[u16], bits: StoredBits) {
    for (slot, &cell) in slots.iter_mut().zip(cells) {
        *slot = bits.slot(cell);
    }
}

fn fill_bytes(slots: &mut [i16], cells: &[u8], bits: StoredBits) {
    for (slot, &cell) in slots.iter_mut().zip(cells) {
        *slot = bits.slot(u16::from(cell));
    }
}

fn fill_words(slots: &mut [i16], cells: &[u8], bits: StoredBits) {
    for (slot, cell) in slots.iter_mut().zip(cells.as_chunks::<2>().0) {
        *slot = bits.slot(u16::from_le_bytes(*cell));
    }
}

/// Counts the padding and finds the range of the rest.
fn measure(file: &ImageFile, slots: &[i16], decoded: &mut Decoded) {
    let padding = padding_slots(file, decoded.offset);
    let is_padding = |slot: i16| padding.as_ref().is_some_and(|range| range.contains(&i32::from(slot)));
    let (mut low, mut high) = (i16::MAX, i16::MIN);
    for &slot in slots {
        if is_padding(slot) {
            decoded.padding += 1;
        } else {
            low = low.min(slot);
            high = high.max(slot);
        }
    }
    decoded.range = (low <= high).then_some([low, high]);
}

/// The slots that padding lies in.
pub(super) fn padding_slots(file: &ImageFile, offset: i32) -> Option<std::ops::RangeInclusive<i32>> {
    file.format.padding.as_ref().map(|range| range.start() - offset..=range.end() - offset)
}
