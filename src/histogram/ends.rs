//! Where axes end unless someone says so.

use rayon::prelude::*;

use super::sampled::{Sampled, Task, on_values};
use super::{Axis, MOST_BINS};
use crate::error::Result;
use crate::field::{Spacing, Voxel};
use crate::volume::{Samples, Volume};

/// Beyond each end of an axis lies at most one voxel in so many: a clip of metal must not squeeze all tissues into a corner.
const ONE_IN: u64 = 10_000;
/// Bins in which the ends of the values are looked for.
const FINE: usize = 1 << 16;

/// An axis of about so many bins over all values, but for at most one voxel in 10 000 at either end, which are round numbers.
///
/// Where values are whole multiples of a unit, each bin is as wide as a whole number of them: bins that hold now nine
/// numbers and now ten make stripes that are not of the scan.
///
/// # Errors
/// As [`Axis::new`] and [`joint`](super::joint).
pub fn value_axis(volume: &Volume, bins: usize) -> Result<Axis> {
    let ends = value_ends(volume)?;
    if let (Samples::I16(_), 1..=MOST_BINS) = (volume.samples(), bins) {
        let [low, high] = ends;
        let unit = volume.rescale().slope.abs();
        let width = unit * ((high - low) / (bins as f64 * unit)).round().max(1.0);
        let count = ((high - low) / width).ceil() as usize;
        if count <= MOST_BINS {
            return Axis::new([low, low + count as f64 * width], count);
        }
    }
    Axis::new(ends, bins)
}

/// Round values between which all voxels lie, but for at most one in 10 000 at either end.
fn value_ends(volume: &Volume) -> Result<[f64; 2]> {
    let [low, high] = volume.value_range();
    let per_bin = (high - low) / FINE as f64;
    let bin = |value: f64| if per_bin > 0.0 { (((value - low) / per_bin) as usize).min(FINE - 1) } else { 0 };
    let counts = on_values(volume, &Fine { of: Of::Value(&bin) })?;
    let from = low + per_bin * beyond(counts.iter()) as f64;
    let to = high - per_bin * beyond(counts.iter().rev()) as f64;
    let step = round_step(to - from, to.abs().max(from.abs()));
    let (from, to) = ((from / step).floor() * step, (to / step).ceil() * step);
    // Values that are all one round number.
    Ok(if from < to { [from, to] } else { [from, from + step] })
}

/// A round gradient magnitude, per mm, that at most one voxel in 10 000 is above.
///
/// # Errors
/// As [`joint`](super::joint).
pub fn gradient_end_per_mm(volume: &Volume) -> Result<f64> {
    let counts = on_values(volume, &Fine { of: Of::Gradient })?;
    // The upper end of a bin of magnitudes is the lower end of the next.
    let end = f64::from(f32::from_bits((FINE - beyond(counts.iter().rev())) as u32 * (1 << 16)));
    let end = if end.is_finite() { end } else { f64::from(f32::MAX) };
    let step = round_step(end, end);
    Ok(((end / step).ceil() * step).max(step))
}

/// How many bins from one end on hold no more than the few that may be left out.
fn beyond<'c>(counts: impl ExactSizeIterator<Item = &'c u64> + Clone) -> usize {
    let most = counts.clone().sum::<u64>() / ONE_IN;
    let mut sum = 0;
    let within = |count: &&u64| {
        sum += **count;
        sum <= most
    };
    counts.take_while(within).count()
}

/// A round number of which about twenty make up the span; for a span of nothing, one that is round beside `size`.
fn round_step(span: f64, size: f64) -> f64 {
    let about = if span > 0.0 { span / 20.0 } else { (size / 20.0).max(1.0) };
    let power = 10f64.powf(about.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|step| *step >= about).unwrap_or(10.0 * power)
}

/// Counts in many narrow bins.
struct Fine<'f> {
    of: Of<'f>,
}

enum Of<'f> {
    /// The value, by its bin.
    Value(&'f (dyn Fn(f64) -> usize + Sync)),
    /// The gradient magnitude, by the upper half of its bits: they are in the order of the numbers, and 1/128 apart.
    Gradient,
}

impl Task for Fine<'_> {
    type Output = Vec<u64>;

    fn on<V: Voxel, K: Spacing>(&self, sampled: &Sampled<'_, V, K>) -> Vec<u64> {
        let [nx, ny, nz] = sampled.field.dims();
        let slice = |(mut counts, mut row): (Vec<u64>, Vec<f32>), k: usize| {
            for j in 0..ny {
                match self.of {
                    Of::Value(bin) => (0..nx).for_each(|i| counts[bin(sampled.value([i, j, k]))] += 1),
                    Of::Gradient => {
                        sampled.gradients([j, k], &mut row);
                        row.iter().for_each(|gradient| counts[(gradient.to_bits() >> 16) as usize] += 1);
                    }
                }
            }
            (counts, row)
        };
        let longest = nz.div_ceil(4 * rayon::current_num_threads());
        let slices = (0..nz).into_par_iter().with_min_len(longest);
        let counts = slices.fold(|| (vec![0; FINE], vec![0.0; nx]), slice).map(|(counts, _)| counts);
        counts.reduce(
            || vec![0; FINE],
            |mut sum, more| {
                sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
                sum
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Quantity, Rescale, Samples};
    use glam::DVec3;

    fn volume(values: Vec<f32>) -> Volume {
        let grid = Grid::axis_aligned([values.len(), 1, 1], DVec3::ONE).unwrap();
        Volume::new(grid, Samples::F32(values), Rescale::IDENTITY, Quantity::Hu).unwrap()
    }

    #[test]
    fn ends_are_round_and_hold_all_but_a_few() {
        let ramp: Vec<f32> = (0..30_000).map(|i| -1003.0 + i as f32 * 0.05).collect();
        let [low, high] = value_ends(&volume(ramp.clone())).unwrap();
        assert_eq!([low, high], [-1100.0, 500.0]);
        let gradient = gradient_end_per_mm(&volume(ramp.clone())).unwrap();
        assert!((0.05..0.06).contains(&gradient), "found {gradient}");

        let mut with_metal = ramp;
        with_metal[15_000] = 30_000.0;
        assert_eq!(value_ends(&volume(with_metal)).unwrap(), [-1100.0, 500.0], "one voxel of metal is left out");
    }

    #[test]
    fn bins_of_whole_numbers_hold_equally_many() {
        let grid = Grid::axis_aligned([2601, 1, 1], DVec3::ONE).unwrap();
        let samples = Samples::I16((0..2601).map(|i| i - 1000).collect());
        let volume = Volume::new(grid, samples, Rescale { slope: 0.5, intercept: 3.0 }, Quantity::Hu).unwrap();
        let axis = value_axis(&volume, 256).unwrap();
        let width = (axis.high() - axis.low()) / axis.bins() as f64;
        assert_eq!((width, axis.low()), (5.5, -500.0), "eleven numbers to a bin, found {axis:?}");
        assert!(axis.high() >= 803.0, "found {axis:?}");
        assert!(value_axis(&volume, 0).is_err() && value_axis(&volume, MOST_BINS + 1).is_err());
    }

    #[test]
    fn a_volume_of_one_value_has_an_axis_all_the_same() {
        for value in [0.0, 7.0, -1024.0] {
            let constant = volume(vec![value; 9]);
            let [low, high] = value_ends(&constant).unwrap();
            assert!(low <= f64::from(value) && f64::from(value) <= high && low < high, "{value}: {low} to {high}");
            assert!(gradient_end_per_mm(&constant).unwrap() > 0.0);
        }
    }
}
