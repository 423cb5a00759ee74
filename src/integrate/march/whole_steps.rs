//! Where whole steps begin and end if something is clipped: as VTK's GPU mapper does it, which `tests/vtk/conventions.py`
//! shows by experiments.
//!
//! A plane that a ray enters by moves the beginning: the first sample is a step behind it, and there is none if that is
//! outside the volume. A plane that it leaves by is looked at after a sample has been taken, so that one sample lies beyond
//! it. What is cut off along the voxels' axes is cropped: the samples stay where they are, and those outside are left out.
//! Half a voxel is wrong with that: a cut at index `p` of `n` voxels lies at `p n/(n − 1) − 1/2`.

use super::lattice::Stretch;
use crate::field::Chord;
use crate::plan::Crop;
use crate::scene::{Clip, Ray, Scene};
use crate::volume::Grid;

/// What is cut off, as whole steps see it.
pub(super) struct WholeSteps {
    /// The samples that are taken, as continuous indices, the lower end included.
    ranges: [[f64; 2]; 3],
    planes: Clip,
}

/// What rounding may make of a number of steps.
const ROUNDING: f64 = 1e-9;

impl WholeSteps {
    pub(super) fn new(scene: &Scene, grid: &Grid) -> Self {
        let Crop { mut ranges, planes } = Crop::new(scene, grid);
        for (range, voxels) in ranges.iter_mut().zip(grid.dims()) {
            let voxels = voxels.max(2) as f64;
            *range = range.map(|p| p * voxels / (voxels - 1.0) - 0.5);
        }
        WholeSteps { ranges, planes }
    }

    /// A ray's way through the volume from where it enters what the planes leave.
    pub(super) fn chord(&self, grid: &Grid, ray: Ray) -> Option<Chord> {
        let [from_mm, to_mm] = self.planes.interval_mm(&ray)?;
        let chord = Chord::new(grid, &Clip::default(), ray)?;
        if to_mm <= chord.entry_mm { None } else { chord.beyond_mm(from_mm) }
    }

    /// The samples that are left of a chord's whole steps; `None` if there are none.
    pub(super) fn left(&self, chord: &Chord, ray: Ray, whole: Stretch) -> Option<Stretch> {
        let step_mm = whole.delta_mm;
        let (mut from, mut to) = (0.0_f64, whole.samples as f64);
        if !self.planes.half_spaces.is_empty() {
            if whole.first_mm > chord.length_mm + ROUNDING * step_mm {
                return None;
            }
            let [_, exit_mm] = self.planes.interval_mm(&ray)?;
            let behind_first_mm = (exit_mm - chord.entry_mm - whole.first_mm).abs();
            to = to.min(1.0 + (behind_first_mm / step_mm - ROUNDING).ceil());
        }
        for (a, [low, high]) in self.ranges.into_iter().enumerate() {
            let first = chord.index_at(whole.first_mm)[a];
            let per_step = chord.index_per_mm[a] * step_mm;
            if per_step == 0.0 {
                if first < low || first >= high {
                    return None;
                }
                continue;
            }
            let (s, t) = ((low - first) / per_step, (high - first) / per_step);
            from = from.max((s.min(t) - ROUNDING).ceil());
            to = to.min((s.max(t) - ROUNDING).ceil());
        }
        let place_mm = |sample: f64| whole.first_mm + sample * step_mm;
        (from < to).then(|| Stretch {
            first_mm: place_mm(from),
            last_mm: place_mm(to - 1.0),
            samples: (to - from) as usize,
            delta_mm: step_mm,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::HalfSpace;
    use glam::DVec3;

    /// Samples of a ray along x through voxels 0 to 8 of 1 mm: the first, and how many.
    fn samples(planes: &[(f64, f64)], ranges: [f64; 2], step_mm: f64) -> Option<(f64, usize)> {
        let grid = Grid::axis_aligned([9, 9, 9], DVec3::ONE).unwrap();
        let half_space = |&(side, x): &(f64, f64)| HalfSpace { normal: side * DVec3::X, offset_mm: side * x };
        let open = [f64::NEG_INFINITY, f64::INFINITY];
        let clip = Clip { half_spaces: planes.iter().map(half_space).collect() };
        let steps = WholeSteps { ranges: [ranges, open, open], planes: clip };
        let ray = Ray { origin_mm: DVec3::new(-9.0, 4.0, 4.0), direction: DVec3::X };
        let chord = steps.chord(&grid, ray)?;
        let count = 1 + ((chord.length_mm - step_mm) / step_mm + ROUNDING).floor().max(0.0) as usize;
        let last_mm = step_mm * count as f64;
        let whole = Stretch { first_mm: step_mm, last_mm, samples: count, delta_mm: step_mm };
        let left = steps.left(&chord, ray, whole)?;
        Some((chord.index_at(left.first_mm).x, left.samples))
    }

    const OPEN: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    #[test]
    fn a_step_behind_the_plane_it_enters_by_and_one_sample_beyond_the_other() {
        assert_eq!(samples(&[(1.0, 2.25)], OPEN, 1.0), Some((3.25, 5)), "3.25 to 7.25");
        assert_eq!(samples(&[(-1.0, 5.25)], OPEN, 1.0), Some((1.0, 6)), "1 to 6, one of them beyond");
        assert_eq!(samples(&[(-1.0, 5.25)], OPEN, 0.75), Some((0.75, 7)), "0.75 to 5.25, on the plane");
        assert_eq!(samples(&[(1.0, 2.0), (-1.0, 2.5)], OPEN, 1.0), Some((3.0, 2)), "a slab thinner than a step");
        assert_eq!(samples(&[(1.0, 7.5)], OPEN, 1.0), None, "the first sample would be outside");
        assert_eq!(samples(&[(-1.0, -1.0)], OPEN, 1.0), None, "nothing is left");
    }

    #[test]
    fn cropping_leaves_samples_where_they_are() {
        assert_eq!(samples(&[], [1.75, 6.25], 0.5), Some((2.0, 9)), "2 to 6");
        assert_eq!(samples(&[], [2.0, 4.0], 0.5), Some((2.0, 4)), "the lower end is inside, the upper is not");
        assert_eq!(samples(&[], [2.1, 2.2], 0.5), None, "between two samples");
    }
}
