//! Counts by value and gradient magnitude.

use rayon::prelude::*;

use super::sampled::{Sampled, Task, on_values};
use super::{Axis, Counts};
use crate::error::Result;
use crate::field::{Spacing, Voxel};
use crate::volume::Volume;

/// Voxels by value (horizontal axis) and gradient magnitude per mm (vertical axis). Gradients are computed a row at a time
/// and never held.
///
/// # Errors
/// `Fault::Unsupported` for a volume of colours, `Fault::Limit` for an axis of more voxels than the field can address.
pub fn joint(volume: &Volume, value: Axis, gradient_per_mm: Axis) -> Result<Counts> {
    on_values(volume, &Joint { value, gradient_per_mm })
}

struct Joint {
    value: Axis,
    gradient_per_mm: Axis,
}

impl Task for Joint {
    type Output = Counts;

    fn on<V: Voxel, K: Spacing>(&self, sampled: &Sampled<'_, V, K>) -> Counts {
        let nothing = || Counts::new(self.value, self.gradient_per_mm);
        count_rows(sampled, nothing, |counts, [j, k], gradients| {
            for (i, gradient) in gradients.iter().enumerate() {
                counts.add(sampled.value([i, j, k]), f64::from(*gradient));
            }
        })
    }
}

/// Counts row by row, in parallel: `row` gets the counts so far, the row's `(j, k)` and its gradient magnitudes.
pub(super) fn count_rows<V: Voxel, K: Spacing>(
    sampled: &Sampled<'_, V, K>,
    nothing: impl Fn() -> Counts + Sync,
    row: impl Fn(&mut Counts, [usize; 2], &[f32]) + Sync,
) -> Counts {
    let [nx, ny, nz] = sampled.field.dims();
    let rows = ny * nz;
    // Each part has counts of its own, so there must not be many parts.
    let longest = rows.div_ceil(4 * rayon::current_num_threads());
    let parts = (0..rows).into_par_iter().with_min_len(longest);
    let counts = parts.fold(
        || (nothing(), vec![0.0_f32; nx]),
        |(mut counts, mut gradients), n| {
            let at = [n % ny, n / ny];
            sampled.gradients(at, &mut gradients);
            row(&mut counts, at, &gradients);
            (counts, gradients)
        },
    );
    counts.map(|(counts, _)| counts).reduce(&nothing, Counts::plus)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Fault;
    use crate::volume::{Grid, Quantity, Rescale, Samples, Slices};
    use glam::DVec3;

    fn volume(dims: [usize; 3], spacing_mm: DVec3, hu: impl Fn([usize; 3]) -> i16) -> Volume {
        let grid = Grid::axis_aligned(dims, spacing_mm).expect("a valid grid");
        let samples = (0..grid.voxel_count()).map(|index| hu(grid.unflatten(index))).collect();
        Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).expect("a valid volume")
    }

    /// A ramp of 20 HU per 2 mm along i has one gradient, 10 HU/mm, on the border too, and as many voxels at each value.
    #[test]
    fn a_ramp_has_known_counts() {
        let ramp = volume([10, 3, 4], DVec3::new(2.0, 1.0, 1.0), |[i, ..]| 20 * i as i16 - 100);
        let value = Axis::new([-100.0, 80.0], 6).unwrap();
        let counts = joint(&ramp, value, Axis::new([0.0, 20.0], 4).unwrap()).unwrap();
        assert_eq!((counts.voxels(), counts.counted(), counts.highest()), (120, 120, 24));
        // Bins of 30 HU from -100: two voxels, one, two, one, two, and two, the last with its upper end.
        assert_eq!(counts.along_x(), [24, 12, 24, 12, 24, 24]);
        assert_eq!(counts.along_y(), [0, 0, 120, 0], "10 HU/mm begins the third bin");
        assert_eq!((counts.at(1, 2), counts.at(1, 1), counts.column(0)), (12, 0, &[0, 0, 24, 0][..]));
    }

    #[test]
    fn voxels_outside_of_the_axes_are_in_no_bin_but_known() {
        let ramp = volume([10, 3, 4], DVec3::ONE, |[i, ..]| 20 * i as i16);
        let counts = joint(&ramp, Axis::new([0.0, 99.0], 3).unwrap(), Axis::new([0.0, 50.0], 2).unwrap()).unwrap();
        assert_eq!((counts.voxels(), counts.counted()), (120, 60), "values of 100 and above");
        let counts = joint(&ramp, Axis::new([0.0, 180.0], 3).unwrap(), Axis::new([0.0, 19.0], 2).unwrap()).unwrap();
        assert_eq!((counts.voxels(), counts.counted()), (120, 0), "the gradient is 20 HU/mm everywhere");
    }

    #[test]
    fn slices_count_where_they_lie() {
        // 10 HU/mm along k, sampled at uneven distances: as an even lattice it would have other gradients.
        let at = [0.0, 1.0, 1.5, 3.0];
        let ramp = volume([2, 2, 4], DVec3::ONE, |[.., k]| (10.0 * at[k]) as i16);
        let ramp = ramp.with_slices(Slices::new(&at).unwrap()).unwrap();
        let axis = Axis::new([9.99, 10.01], 1).unwrap();
        let counts = joint(&ramp, Axis::new([0.0, 30.0], 1).unwrap(), axis).unwrap();
        assert_eq!(counts.counted(), 16, "all voxels have 10 HU/mm");
    }

    #[test]
    fn colours_are_refused() {
        let grid = Grid::axis_aligned([1, 1, 1], DVec3::ONE).unwrap();
        let colors = Volume::new(grid, Samples::Rgba8(vec![[0; 4]]), Rescale::IDENTITY, Quantity::Arbitrary).unwrap();
        let axis = Axis::new([0.0, 1.0], 1).unwrap();
        assert_eq!(joint(&colors, axis, axis).expect_err("no values").fault(), Fault::Unsupported);
    }
}
