//! From the elements of a file to the samples of a volume: 16-bit integers wherever they hold every value.

use super::elements::Elements;
use crate::error::{Error, Fault, Result};
use crate::volume::{Rescale, Samples};

/// Values that 16-bit integers hold.
const I16: std::ops::RangeInclusive<i128> = -32768..=32767;
/// Largest number up to which f64 holds every integer.
const F64_INTEGERS: i128 = 1 << 53;

/// Samples and their map to values, with what had to be replaced or rounded.
///
/// # Errors
/// `Fault::Input` if no element is a finite number, `Fault::Unsupported` for numbers beyond 32-bit floats. The caller
/// names the file.
pub(in crate::io) fn samples(elements: Elements, warnings: &mut Vec<String>) -> Result<(Samples, Rescale)> {
    let exact = |data| Ok((Samples::I16(data), Rescale::IDENTITY));
    match elements {
        Elements::I16(values) => exact(values),
        Elements::I8(values) => exact(values.into_iter().map(i16::from).collect()),
        Elements::U8(values) => exact(values.into_iter().map(i16::from).collect()),
        // Flipping the highest bit subtracts 32768.
        Elements::U16(values) => {
            Ok((Samples::I16(values.into_iter().map(|v| (v ^ 0x8000) as i16).collect()), offset(32768)))
        }
        Elements::I32(values) => Ok(integers(values, warnings)),
        Elements::U32(values) => Ok(integers(values, warnings)),
        Elements::I64(values) => Ok(integers(values, warnings)),
        Elements::U64(values) => Ok(integers(values, warnings)),
        Elements::F32(values) => floats(values, |v| v, warnings),
        Elements::F64(values) => floats(values, |v| v as f32, warnings),
    }
}

fn offset(intercept: i128) -> Rescale {
    Rescale { slope: 1.0, intercept: intercept as f64 }
}

/// What to subtract from values of this range so that 16 bits hold them; `None` if nothing does.
fn offset_to_i16(low: i128, high: i128) -> Option<i128> {
    if I16.contains(&low) && I16.contains(&high) {
        return Some(0);
    }
    let offset = low - I16.start();
    (I16.contains(&(high - offset)) && low.abs() < F64_INTEGERS && high.abs() < F64_INTEGERS).then_some(offset)
}

fn integers<T: Copy + Ord + Into<i128>>(values: Vec<T>, warnings: &mut Vec<String>) -> (Samples, Rescale) {
    let low = values.iter().min().map_or(0, |&v| v.into());
    let high = values.iter().max().map_or(0, |&v| v.into());
    if let Some(subtract) = offset_to_i16(low, high) {
        // In range by the choice of the offset.
        let stored = values.into_iter().map(|v| (v.into() - subtract) as i16).collect();
        return (Samples::I16(stored), offset(subtract));
    }
    let mut rounding = 0;
    let stored = values.into_iter().map(|v| {
        let value: i128 = v.into();
        let rounded = value as f32;
        rounding = rounding.max((rounded as i128 - value).abs());
        rounded
    });
    let stored = stored.collect();
    if rounding > 0 {
        warnings.push(format!("values from {low} to {high} were rounded to 32-bit floats, by up to {rounding}"));
    }
    (Samples::F32(stored), Rescale::IDENTITY)
}

/// What a pass over all values finds.
struct Survey {
    low: f64,
    high: f64,
    not_finite: usize,
    integers: bool,
    largest_rounding: f64,
}

fn survey<T: Copy + Into<f64>>(values: &[T], to_f32: impl Fn(T) -> f32) -> Survey {
    let mut seen =
        Survey { low: f64::INFINITY, high: f64::NEG_INFINITY, not_finite: 0, integers: true, largest_rounding: 0.0 };
    for &v in values {
        let value: f64 = v.into();
        if !value.is_finite() {
            seen.not_finite += 1;
            continue;
        }
        seen.low = seen.low.min(value);
        seen.high = seen.high.max(value);
        seen.integers &= value.fract() == 0.0;
        seen.largest_rounding = seen.largest_rounding.max((f64::from(to_f32(v)) - value).abs());
    }
    seen
}

fn floats<T: Copy + Into<f64>>(
    values: Vec<T>,
    to_f32: impl Fn(T) -> f32,
    warnings: &mut Vec<String>,
) -> Result<(Samples, Rescale)> {
    let seen = survey(&values, &to_f32);
    if seen.not_finite == values.len() {
        return Err(Error::new(Fault::Input, "no voxel is a finite number").found(format!("{} voxels", values.len())));
    }
    if seen.not_finite > 0 {
        warnings.push(format!(
            "{} of {} voxels are NaN or infinite: the smallest value, {}, was put in their place",
            seen.not_finite,
            values.len(),
            seen.low
        ));
    }
    let finite = |v: T| Some(v.into()).filter(|v: &f64| v.is_finite()).unwrap_or(seen.low);
    if seen.integers
        && seen.low.abs().max(seen.high.abs()) < F64_INTEGERS as f64
        && let Some(subtract) = offset_to_i16(seen.low as i128, seen.high as i128)
    {
        // In range by the choice of the offset.
        let stored = values.into_iter().map(|v| (finite(v) - subtract as f64) as i16).collect();
        return Ok((Samples::I16(stored), offset(subtract)));
    }
    if !seen.largest_rounding.is_finite() {
        return Err(Error::new(Fault::Unsupported, "the values are too large for 32-bit floats")
            .found(format!("values from {:e} to {:e}", seen.low, seen.high)));
    }
    if seen.largest_rounding > 0.0 {
        warnings.push(format!("values were rounded to 32-bit floats, by up to {:.1e}", seen.largest_rounding));
    }
    let low = seen.low as f32;
    let stored = values.into_iter().map(|v| Some(to_f32(v)).filter(|v| v.is_finite()).unwrap_or(low)).collect();
    Ok((Samples::F32(stored), Rescale::IDENTITY))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Storage, values and number of warnings.
    fn stored(elements: Elements) -> (&'static str, Vec<f64>, usize) {
        let mut warnings = Vec::new();
        let (samples, rescale) = samples(elements, &mut warnings).unwrap();
        let storage = if matches!(samples, Samples::I16(_)) { "i16" } else { "f32" };
        (storage, (0..samples.len()).map(|i| rescale.value(samples.stored(i))).collect(), warnings.len())
    }

    #[test]
    fn integers_take_16_bits_wherever_these_hold_them() {
        for (elements, storage, values, warnings) in [
            (Elements::I8(vec![-128, 127]), "i16", vec![-128.0, 127.0], 0),
            (Elements::U16(vec![0, 32768, 65535]), "i16", vec![0.0, 32768.0, 65535.0], 0),
            (Elements::I32(vec![-32768, 32767]), "i16", vec![-32768.0, 32767.0], 0),
            (Elements::U32(vec![100_000, 165_535]), "i16", vec![100_000.0, 165_535.0], 0),
            (Elements::I32(vec![100_000, 165_536]), "f32", vec![100_000.0, 165_536.0], 0),
            (Elements::I64(vec![-5_000_000_000, -4_999_934_465]), "i16", vec![-5e9, -4_999_934_465.0], 0),
            (Elements::I32(vec![0, 16_777_217]), "f32", vec![0.0, 16_777_216.0], 1),
            (Elements::U64(vec![u64::MAX, u64::MAX]), "f32", vec![18_446_744_073_709_551_616.0; 2], 1),
        ] {
            let text = format!("{elements:?}");
            assert_eq!(stored(elements), (storage, values, warnings), "{text}");
        }
    }

    #[test]
    fn floats_take_16_bits_only_if_all_are_integers() {
        for (elements, storage, values, warnings) in [
            (Elements::F32(vec![-1024.0, -0.0, 3071.0]), "i16", vec![-1024.0, 0.0, 3071.0], 0),
            (Elements::F64(vec![40_000.0, 105_535.0]), "i16", vec![40_000.0, 105_535.0], 0),
            (Elements::F32(vec![0.5, 2.0]), "f32", vec![0.5, 2.0], 0),
            (Elements::F32(vec![0.0, 65_536.0]), "f32", vec![0.0, 65_536.0], 0),
            (Elements::F64(vec![0.1, 2.0]), "f32", vec![f64::from(0.1_f32), 2.0], 1),
            (
                Elements::F32(vec![f32::NAN, -1000.0, f32::INFINITY, 7.0]),
                "i16",
                vec![-1000.0, -1000.0, -1000.0, 7.0],
                1,
            ),
            (Elements::F64(vec![f64::NEG_INFINITY, 0.5, -0.5]), "f32", vec![-0.5, 0.5, -0.5], 1),
        ] {
            let text = format!("{elements:?}");
            assert_eq!(stored(elements), (storage, values, warnings), "{text}");
        }
    }

    #[test]
    fn values_that_no_storage_holds_are_refused() {
        let error = |elements| samples(elements, &mut Vec::new()).unwrap_err().to_string();
        assert_eq!(error(Elements::F32(vec![f32::NAN; 3])), "no voxel is a finite number: found 3 voxels");
        assert_eq!(
            error(Elements::F64(vec![1e300, -1.5])),
            "the values are too large for 32-bit floats: found values from -1.5e0 to 1e300"
        );
    }
}
