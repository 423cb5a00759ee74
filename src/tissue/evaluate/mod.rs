//! How well labels agree with a reference.
//!
//! With `A` the voxels of a tissue in the labels and `B` those in the reference:
//!
//! * Dice `2 |A ∩ B| / (|A| + |B|)`, Jaccard `|A ∩ B| / |A ∪ B|`: 1 for the same, 0 for nothing in common, undefined if both
//!   are empty.
//! * The *surface* of a set is its voxels with a face to a voxel that is not in it, or to the end of the volume. Distances are
//!   between the centres of surface voxels, from each of one set to the nearest of the other, in mm.
//! * 95 % Hausdorff distance: the larger of the two directed distances that 95 % of a surface's voxels stay below (as
//!   Maier-Hein et al. 2024, doi 10.1038/s41592-023-02151-z).
//! * Mean surface distance: the mean over the voxels of both surfaces.
//!
//! Both distances are undefined if either set is empty; whoever must have a number takes infinity.

mod overlap;
mod surface_distance;

pub use overlap::{Comparison, Confusion, Pair, confusion, mask_of};

use serde::Serialize;

use super::distance::orthogonal_spacing_mm;
use crate::error::Result;
use crate::volume::LabelMap;
use surface_distance::SurfaceDistances;

/// Agreement of one tissue.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Agreement {
    /// The tissue.
    pub tissue: String,
    /// Voxels in the labels.
    pub voxels: u64,
    /// Voxels in the reference.
    pub reference_voxels: u64,
    /// Volume in the labels, ml.
    pub ml: f64,
    /// Volume in the reference, ml.
    pub reference_ml: f64,
    /// Volume in the labels less that in the reference, ml.
    pub difference_ml: f64,
    /// The same as a share of the reference, %; `None` if that is empty.
    pub difference_percent: Option<f64>,
    /// Dice's coefficient.
    pub dice: Option<f64>,
    /// Jaccard's coefficient.
    pub jaccard: Option<f64>,
    /// 95 % Hausdorff distance, mm.
    pub hausdorff_95_mm: Option<f64>,
    /// Mean surface distance, mm.
    pub mean_surface_distance_mm: Option<f64>,
}

/// Agreement of each tissue of a comparison.
///
/// # Errors
/// `Fault::Unsupported` for a lattice whose axes are not at right angles.
pub fn agreement(comparison: &Comparison<'_>) -> Result<Vec<Agreement>> {
    let spacing_mm = orthogonal_spacing_mm(comparison.labels.grid())?;
    let of = |pair: &Pair| {
        let (a, b) = (comparison.mask(pair), comparison.reference_mask(pair));
        let distances = SurfaceDistances::between(&a, &b, spacing_mm);
        agreement_of(pair, comparison.labels, &a.inside, &b.inside, distances)
    };
    Ok(comparison.pairs.iter().map(of).collect())
}

fn agreement_of(
    pair: &Pair,
    labels: &LabelMap,
    a: &[bool],
    b: &[bool],
    distances: Option<SurfaceDistances>,
) -> Agreement {
    let count = |of: &dyn Fn(bool, bool) -> bool| a.iter().zip(b).filter(|(a, b)| of(**a, **b)).count() as u64;
    let (in_a, in_b, in_both) = (count(&|a, _| a), count(&|_, b| b), count(&|a, b| a && b));
    let share = |part: u64, whole: u64| (whole > 0).then(|| part as f64 / whole as f64);
    let ml_per_voxel = labels.grid().voxel_mm3() / 1000.0;
    let (ml, reference_ml) = (in_a as f64 * ml_per_voxel, in_b as f64 * ml_per_voxel);
    Agreement {
        tissue: pair.tissue.clone(),
        voxels: in_a,
        reference_voxels: in_b,
        ml,
        reference_ml,
        difference_ml: ml - reference_ml,
        difference_percent: (in_b > 0).then(|| 100.0 * (ml - reference_ml) / reference_ml),
        dice: share(2 * in_both, in_a + in_b),
        jaccard: share(in_both, in_a + in_b - in_both),
        hausdorff_95_mm: distances.as_ref().map(SurfaceDistances::hausdorff_95_mm),
        mean_surface_distance_mm: distances.as_ref().map(SurfaceDistances::mean_mm),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Fault;
    use crate::volume::{Grid, Segment};
    use glam::DVec3;

    /// A box of 4 x 4 x 4 voxels of 1 x 1 x 2 mm, moved along i.
    fn labels(first: usize, origin_mm: f64) -> LabelMap {
        let affine = glam::DAffine3::from_scale_rotation_translation(
            DVec3::new(1.0, 1.0, 2.0),
            glam::DQuat::IDENTITY,
            DVec3::splat(origin_mm),
        );
        let grid = Grid::new([12, 6, 6], affine).unwrap();
        let inside = |index: usize| {
            let [i, j, k] = grid.unflatten(index);
            (first..first + 4).contains(&i) && (1..5).contains(&j) && (1..5).contains(&k)
        };
        let voxels = (0..grid.voxel_count()).map(|index| u8::from(inside(index))).collect();
        let segment = Segment { name: "box".into(), label: 1, color_srgb: [1.0; 3], concept: None };
        LabelMap::new(grid, vec![segment], voxels).unwrap()
    }

    fn pair(reference: Vec<u8>) -> Vec<Pair> {
        vec![Pair { tissue: "box".into(), label: 1, reference }]
    }

    #[test]
    fn a_box_that_is_moved_by_a_quarter_agrees_by_three() {
        let (a, b) = (labels(2, 0.0), labels(3, 0.0));
        let comparison = Comparison::new(&a, &b, pair(vec![1])).unwrap();
        let found = agreement(&comparison).unwrap().remove(0);
        assert_eq!((found.dice, found.jaccard), (Some(0.75), Some(0.6)), "48 of 64 and 64 voxels are common");
        assert_eq!((found.voxels, found.ml, found.difference_ml), (64, 0.128, 0.0));
        assert_eq!(found.hausdorff_95_mm, Some(1.0), "no voxel is further away than the step");
        let confusion = confusion(&comparison);
        assert_eq!(confusion.voxels, [[48, 0, 16], [16, 0, 432 - 80]], "box and none; box, other, none");
    }

    #[test]
    fn what_is_empty_has_no_distance() {
        let (a, b) = (labels(2, 0.0), labels(2, 0.0));
        let found = agreement(&Comparison::new(&a, &b, pair(vec![])).unwrap()).unwrap().remove(0);
        assert_eq!((found.dice, found.hausdorff_95_mm, found.difference_percent), (Some(0.0), None, None));
    }

    #[test]
    fn labels_of_another_place_are_refused() {
        let (a, b) = (labels(2, 0.0), labels(2, 0.5));
        let error = Comparison::new(&a, &b, pair(vec![1])).unwrap_err();
        assert_eq!(error.fault(), Fault::Geometry, "{error}");
    }
}
