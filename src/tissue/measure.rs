//! How much of each tissue there is, where, and what its values are.

use rayon::prelude::*;
use serde::Serialize;

use super::parts::{Joined, Parts};
use super::surface;
use crate::error::{Error, Fault, Result};
use crate::volume::{LabelMap, Samples, Volume};

/// What is known of a tissue's voxels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TissueMeasure {
    /// Its name.
    pub name: String,
    /// Its number in files.
    pub label: u16,
    /// Number of voxels.
    pub voxels: u64,
    /// Volume, ml.
    pub ml: f64,
    /// Mean value, HU for CT; `None` without voxels.
    pub mean_hu: Option<f64>,
    /// Standard deviation of the values over the voxels, HU for CT; `None` without voxels.
    pub sd_hu: Option<f64>,
    /// Lowest and highest voxel index along i, j and k; `None` without voxels.
    pub bounds: Option<[[usize; 2]; 3]>,
    /// Area of the surface inside the volume, mm², by Crofton's formula in 13 directions.
    pub surface_mm2: f64,
    /// Number of parts, voxels being joined through faces.
    pub parts: u64,
}

/// Measures every tissue of `labels`, with the values of `volume`.
///
/// # Errors
/// `Fault::Geometry` if the two are not on the same number of voxels.
pub fn measure(labels: &LabelMap, volume: &Volume) -> Result<Vec<TissueMeasure>> {
    if labels.grid().dims() != volume.grid().dims() {
        return Err(Error::new(Fault::Geometry, "labels and volume differ in their number of voxels")
            .found(format!("{:?}", labels.grid().dims()))
            .expected(format!("{:?}", volume.grid().dims())));
    }
    let moments = moments(labels, volume);
    let bounds = labels.bounds();
    let areas = surface::areas_mm2(labels);
    let mut parts = vec![0_u64; labels.segments().len() + 1];
    for part in Parts::new(labels.grid().dims(), Joined::InVolume, |index| labels.voxels()[index]).parts() {
        parts[usize::from(part.class)] += 1;
    }
    let rescale = volume.rescale();
    let measure = |(n, segment): (usize, &crate::volume::Segment)| {
        let Moments { count, mean, squares } = moments[n + 1];
        let any = count > 0;
        TissueMeasure {
            name: segment.name.clone(),
            label: segment.label,
            voxels: count,
            ml: count as f64 * labels.grid().voxel_mm3() / 1000.0,
            mean_hu: any.then(|| rescale.value(mean)),
            sd_hu: any.then(|| (squares / count as f64).max(0.0).sqrt() * rescale.slope.abs()),
            bounds: bounds[n],
            surface_mm2: areas[n],
            parts: parts[n + 1],
        }
    };
    Ok(labels.segments().iter().enumerate().map(measure).collect())
}

/// Number, mean and sum of squared differences from the mean, of stored numbers.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    count: u64,
    mean: f64,
    squares: f64,
}

impl Moments {
    /// One number more (Welford 1962): no sum of large squares whose difference would be all rounding.
    fn add(&mut self, number: f64) {
        self.count += 1;
        let before = number - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (number - self.mean);
    }

    /// Those of whole numbers, from their sums, without rounding until the end.
    fn of_sums(Sums { count, sum, squares }: Sums) -> Self {
        if count == 0 {
            return Moments::default();
        }
        let (n, sum) = (i128::from(count), i128::from(sum));
        let apart = i128::from(squares) * n - sum * sum;
        Moments { count, mean: sum as f64 / n as f64, squares: apart as f64 / n as f64 }
    }

    /// All numbers of both (Chan, Golub and LeVeque 1983).
    fn and(self, other: Moments) -> Moments {
        let count = self.count + other.count;
        if count == 0 {
            return self;
        }
        let apart = other.mean - self.mean;
        let share = other.count as f64 / count as f64;
        Moments {
            count,
            mean: self.mean + apart * share,
            squares: self.squares + other.squares + apart * apart * share * self.count as f64,
        }
    }
}

/// Number, sum and sum of squares of the 16-bit numbers of a slice: of 2³² of them, the squares are less than 2⁶².
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    count: u64,
    sum: i64,
    squares: i64,
}

/// Moments of none and of each segment. Slices are summed in their order, so that threads do not matter.
fn moments(labels: &LabelMap, volume: &Volume) -> Vec<Moments> {
    let classes = labels.segments().len() + 1;
    let [nx, ny, _] = labels.grid().dims();
    let of_slice = |(k, slice): (usize, &[u8])| {
        let first = k * nx * ny;
        if let Samples::I16(data) = volume.samples() {
            let mut sums = vec![Sums::default(); classes];
            for (label, stored) in slice.iter().zip(&data[first..]).filter(|(label, _)| **label != 0) {
                let of = &mut sums[usize::from(*label)];
                let stored = i64::from(*stored);
                *of = Sums { count: of.count + 1, sum: of.sum + stored, squares: of.squares + stored * stored };
            }
            return sums.into_iter().map(Moments::of_sums).collect();
        }
        let mut moments = vec![Moments::default(); classes];
        for (offset, label) in slice.iter().enumerate().filter(|(_, label)| **label != 0) {
            moments[usize::from(*label)].add(volume.samples().stored(first + offset));
        }
        moments
    };
    let slices: Vec<Vec<Moments>> = labels.voxels().par_chunks(nx * ny).enumerate().map(of_slice).collect();
    slices.into_iter().fold(vec![Moments::default(); classes], |sum, slice| {
        sum.into_iter().zip(slice).map(|(a, b)| a.and(b)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Quantity, Rescale, Segment};
    use glam::DVec3;

    #[test]
    fn a_tissue_is_measured_by_its_voxels() {
        let grid = Grid::axis_aligned([4, 3, 2], DVec3::new(2.0, 2.0, 2.5)).unwrap();
        let of = |samples| Volume::new(grid, samples, Rescale { slope: 2.0, intercept: 5.0 }, Quantity::Hu).unwrap();
        let volume = of(Samples::I16((0..24).map(|n| n * 10 - 100).collect()));
        let mut voxels = vec![0; 24];
        for index in [0, 1, 23] {
            voxels[index] = 2;
        }
        let segment = |name: &str, label| Segment { name: name.into(), label, color_srgb: [1.0; 3], concept: None };
        let labels = LabelMap::new(grid, vec![segment("none", 1), segment("some", 9)], voxels).unwrap();
        let [none, some] = measure(&labels, &volume).unwrap().try_into().expect("two tissues");
        let floats = of(Samples::F32((0..24).map(|n| n as f32 * 10.0 - 100.0).collect()));
        let of_floats = measure(&labels, &floats).unwrap().swap_remove(1);
        let near = |a: Option<f64>, b: Option<f64>| (a.unwrap() - b.unwrap()).abs() < 1e-9;
        assert!(
            near(some.mean_hu, of_floats.mean_hu) && near(some.sd_hu, of_floats.sd_hu),
            "{some:?} and {of_floats:?}"
        );
        assert_eq!((none.voxels, none.mean_hu, none.sd_hu, none.bounds, none.parts), (0, None, None, None, 0));
        assert_eq!((some.label, some.voxels, some.parts), (9, 3, 2));
        assert!((some.ml - 0.03).abs() < 1e-12, "three voxels of 10 mm³: found {} ml", some.ml);
        assert_eq!(some.bounds, Some([[0, 3], [0, 2], [0, 1]]));
        // Values -195, -175 and 265: mean -35, variance (160² + 140² + 300²) / 3.
        let (mean, sd) = (some.mean_hu.unwrap(), some.sd_hu.unwrap());
        assert!((mean + 35.0).abs() < 1e-9, "found a mean of {mean}, expected -35");
        assert!((sd - (135_200.0_f64 / 3.0).sqrt()).abs() < 1e-6, "found an SD of {sd}");
    }
}
