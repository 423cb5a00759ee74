//! How the values of a volume are stored, and what becomes of padding.
//!
//! Padding pixels (PS3.3 §C.7.5.1.1.2) hold no value; they are outside the scanner's field of view. Each is replaced by the
//! smallest value of the volume's other pixels, which in CT is that of air, so that it neither makes an edge of thousands of
//! HU nor widens the range of values. How many were replaced is a warning of the scan.

use rayon::prelude::*;

use super::frame::{Decoded, padding_slots};
use super::series::Slice;
use crate::volume::{Rescale, Samples};

/// A decoded slice and its map from slots to values.
pub(super) struct Plane<'a> {
    pub(super) slice: &'a Slice,
    pub(super) decoded: Decoded,
    pub(super) rescale: Rescale,
}

impl Plane<'_> {
    /// Smallest and largest value of the pixels that are not padding.
    fn value_range(&self) -> Option<[f64; 2]> {
        let [a, b] = self.decoded.range?.map(|slot| self.rescale.value(f64::from(slot)));
        Some([a.min(b), a.max(b)])
    }

    /// Tells padding from values, slot by slot.
    fn padding_test(&self) -> impl Fn(i16) -> bool {
        let padding = padding_slots(self.slice.file(), self.decoded.offset);
        move |slot| padding.as_ref().is_some_and(|range| range.contains(&i32::from(slot)))
    }
}

/// The smallest value of the volume that is not padding; `None` if all is padding.
pub(super) fn lowest_value(planes: &[Plane]) -> Option<f64> {
    planes.iter().filter_map(Plane::value_range).map(|[low, _]| low).reduce(f64::min)
}

/// Samples and rescale of a volume whose slots are in `slots`, `frame_len` to a slice.
///
/// One rescale for all slices: the slots, and that rescale. Differing ones: values in i16 if all are whole and fit, else in
/// f32, rounded to nearest.
pub(super) fn store(mut slots: Vec<i16>, frame_len: usize, planes: &[Plane], lowest: f64) -> (Samples, Rescale) {
    let first = planes[0].rescale;
    if planes.iter().all(|plane| plane.rescale == first) {
        // Exact: `lowest` is the value of a slot under this very rescale.
        let fill = first.stored(lowest).round() as i16;
        let padded = slots.par_chunks_exact_mut(frame_len).zip(planes).filter(|(_, plane)| plane.decoded.padding > 0);
        padded.for_each(|(slots, plane)| {
            let is_padding = plane.padding_test();
            for slot in slots.iter_mut().filter(|slot| is_padding(**slot)) {
                *slot = fill;
            }
        });
        (Samples::I16(slots), first)
    } else if planes.iter().all(holds_whole_i16_values) {
        slots.par_chunks_exact_mut(frame_len).zip(planes).for_each(|(slots, plane)| {
            let is_padding = plane.padding_test();
            for slot in slots {
                *slot = if is_padding(*slot) { lowest } else { plane.rescale.value(f64::from(*slot)) } as i16;
            }
        });
        (Samples::I16(slots), Rescale::IDENTITY)
    } else {
        let mut values = vec![0.0_f32; slots.len()];
        let targets = values.par_chunks_exact_mut(frame_len);
        targets.zip(slots.par_chunks_exact(frame_len)).zip(planes).for_each(|((values, slots), plane)| {
            let is_padding = plane.padding_test();
            for (value, &slot) in values.iter_mut().zip(slots) {
                *value = if is_padding(slot) { lowest } else { plane.rescale.value(f64::from(slot)) } as f32;
            }
        });
        (Samples::F32(values), Rescale::IDENTITY)
    }
}

/// True if slope and intercept are whole and the values fit i16.
fn holds_whole_i16_values(plane: &Plane) -> bool {
    let Rescale { slope, intercept } = plane.rescale;
    let fits = |value: f64| (f64::from(i16::MIN)..=f64::from(i16::MAX)).contains(&value);
    slope.fract() == 0.0
        && intercept.fract() == 0.0
        && plane.value_range().is_none_or(|[low, high]| fits(low) && fits(high))
}
