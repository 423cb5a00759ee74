//! From pixel cells to stored values: PS3.5 §8.1.1.
//!
//! A pixel cell of `BitsAllocated` bits holds the stored value in the `BitsStored` bits that end at `HighBit`. What lies
//! above or below them (old overlays, sign bits of another width) is not part of the value, so it is cut off here, and the
//! sign is extended from the top stored bit.

use std::ops::RangeInclusive;

use dicom_dictionary_std::tags;
use dicom_object::InMemDicomObject;

use super::attributes::{Malformed, integer, required, text};

/// How the pixels of one file are laid out; the Image Pixel Module (PS3.3 §C.7.6.3).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PixelFormat {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) samples_per_pixel: i64,
    /// Such as MONOCHROME2; MONOCHROME1 differs in display only, not in its values.
    pub(super) photometric: String,
    pub(super) bits_allocated: i64,
    pub(super) bits_stored: i64,
    pub(super) high_bit: i64,
    pub(super) signed: bool,
    /// Stored values that stand for "no pixel here" (PS3.3 §C.7.5.1.1.2).
    pub(super) padding: Option<RangeInclusive<i32>>,
}

/// The widest offset of [`StoredBits::slot`].
const UNSIGNED_16_OFFSET: i32 = 32768;

impl PixelFormat {
    pub(super) fn of(object: &InMemDicomObject) -> Result<Self, Malformed> {
        let count = |tag| required(integer(object, tag), tag);
        let size = |tag| {
            count(tag).and_then(|n| match usize::try_from(n) {
                Ok(n) if n > 0 => Ok(n),
                _ => Err(Malformed(format!("{} is {n}", super::attributes::name_of(tag)))),
            })
        };
        let bits_stored = count(tags::BITS_STORED)?;
        let signed = count(tags::PIXEL_REPRESENTATION)? == 1;
        Ok(PixelFormat {
            rows: size(tags::ROWS)?,
            columns: size(tags::COLUMNS)?,
            samples_per_pixel: integer(object, tags::SAMPLES_PER_PIXEL)?.unwrap_or(1),
            photometric: text(object, tags::PHOTOMETRIC_INTERPRETATION).unwrap_or_default(),
            bits_allocated: count(tags::BITS_ALLOCATED)?,
            bits_stored,
            high_bit: integer(object, tags::HIGH_BIT)?.unwrap_or(bits_stored - 1),
            signed,
            padding: padding(object, signed)?,
        })
    }

    /// The clause that says why these pixels cannot be read, if so.
    pub(super) fn refusal(&self) -> Option<String> {
        if self.samples_per_pixel != 1 {
            return Some(format!("colour images ({}) are not CT slices", self.photometric));
        }
        if !matches!(self.photometric.as_str(), "MONOCHROME1" | "MONOCHROME2") {
            return Some(format!("the photometric interpretation '{}' is not read", self.photometric));
        }
        if !matches!(self.bits_allocated, 8 | 16) {
            return Some(format!("pixels of {} bits allocated are not read; 8 and 16 are", self.bits_allocated));
        }
        let fits = (1..=self.bits_allocated).contains(&self.bits_stored)
            && (self.bits_stored - 1..self.bits_allocated).contains(&self.high_bit);
        (!fits).then(|| {
            format!(
                "{} bits stored with high bit {} do not fit {} bits allocated",
                self.bits_stored, self.high_bit, self.bits_allocated
            )
        })
    }

    /// Bytes of one uncompressed frame.
    pub(super) fn frame_bytes(&self) -> Option<usize> {
        let cell = usize::try_from(self.bits_allocated / 8).ok()?;
        self.rows.checked_mul(self.columns)?.checked_mul(cell)
    }

    /// Where the stored bits lie in a cell.
    pub(super) fn stored_bits(&self) -> StoredBits {
        StoredBits {
            bits: self.bits_stored as u32,
            low_bit: (self.high_bit + 1 - self.bits_stored) as u32,
            signed: self.signed,
        }
    }
}

/// Pixel Padding Value and Range Limit. Their VR follows Pixel Representation, and readers of implicit VR cannot know it,
/// so the sign is taken from the 16 bits here.
fn padding(object: &InMemDicomObject, signed: bool) -> Result<Option<RangeInclusive<i32>>, Malformed> {
    let value =
        |tag| integer(object, tag).map(|n| n.map(|n| if signed { i32::from(n as i16) } else { i32::from(n as u16) }));
    let Some(first) = value(tags::PIXEL_PADDING_VALUE)? else { return Ok(None) };
    let last = value(tags::PIXEL_PADDING_RANGE_LIMIT)?.unwrap_or(first);
    Ok(Some(first.min(last)..=first.max(last)))
}

/// The stored bits of a 16-bit word and their sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct StoredBits {
    /// 1 to 16.
    pub(super) bits: u32,
    /// Position of the lowest stored bit.
    pub(super) low_bit: u32,
    pub(super) signed: bool,
}

impl StoredBits {
    /// Stored value minus slot: 32768 for unsigned 16-bit values, which an i16 slot holds only when shifted; else 0.
    pub(super) fn offset(self) -> i32 {
        if !self.signed && self.bits == 16 { UNSIGNED_16_OFFSET } else { 0 }
    }

    /// The 16-bit slot that holds a cell's stored value, less [`StoredBits::offset`].
    pub(super) fn slot(self, cell: u16) -> i16 {
        let top_aligned = cell << (16 - self.bits - self.low_bit);
        if self.signed {
            (top_aligned as i16) >> (16 - self.bits)
        } else {
            let value = top_aligned >> (16 - self.bits);
            if self.bits == 16 { (value ^ 0x8000) as i16 } else { value as i16 }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_gives_the_value_of_its_stored_bits() {
        for (bits, low_bit, signed) in
            [(12, 0, false), (12, 0, true), (12, 4, true), (13, 2, false), (16, 0, true), (16, 0, false), (1, 0, false)]
        {
            let stored = StoredBits { bits, low_bit, signed };
            for cell in 0..=u16::MAX {
                let field = (i32::from(cell) >> low_bit) & ((1 << bits) - 1);
                let expected = if signed && field >= 1 << (bits - 1) { field - (1 << bits) } else { field };
                let found = i32::from(stored.slot(cell)) + stored.offset();
                assert_eq!(found, expected, "cell {cell:#06x}, {bits} bits from bit {low_bit}, signed {signed}");
            }
        }
    }

    #[test]
    fn padding_takes_its_sign_from_the_pixel_representation() {
        use dicom_core::{DataElement, PrimitiveValue, VR};
        let object = InMemDicomObject::from_element_iter([DataElement::new(
            tags::PIXEL_PADDING_VALUE,
            VR::US,
            PrimitiveValue::from(63536_u16),
        )]);
        assert_eq!(padding(&object, true), Ok(Some(-2000..=-2000)), "signed pixels");
        assert_eq!(padding(&object, false), Ok(Some(63536..=63536)), "unsigned pixels");
    }
}
