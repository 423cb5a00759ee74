//! Clipping as graphics programs take it: cropping along the voxels' axes, and planes.

use crate::scene::{Clip, HalfSpace, Model, Scene};
use crate::volume::Grid;

/// Cosine to a voxel axis above which a half-space counts as cut along it.
const ALONG: f64 = 1.0 - 1e-12;

/// The half-spaces of a [`Clip`], those along the voxels' axes told from the others.
///
/// Programs on graphics hardware cut the two at different places: a plane moves the ends of a ray, cropping leaves samples
/// out. Only scenes of light are cropped: where samples are left out, a surface has a lid and a projection a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Crop {
    /// What is left along i, j and k, as continuous voxel indices `[low, high]`; infinite where nothing is cut off.
    pub ranges: [[f64; 2]; 3],
    /// The half-spaces across the axes.
    pub planes: Clip,
}

impl Crop {
    /// Sorts a scene's half-spaces.
    pub fn new(scene: &Scene, grid: &Grid) -> Self {
        let mut crop = Crop { ranges: [[f64::NEG_INFINITY, f64::INFINITY]; 3], planes: Clip::default() };
        for half_space in &scene.effects.clip.half_spaces {
            let along = (scene.model == Model::Light).then(|| along(half_space, grid)).flatten();
            match along {
                Some((axis, index, true)) => crop.ranges[axis][0] = crop.ranges[axis][0].max(index),
                Some((axis, index, false)) => crop.ranges[axis][1] = crop.ranges[axis][1].min(index),
                None => crop.planes.half_spaces.push(*half_space),
            }
        }
        crop
    }

    /// Whether anything is cut off along the voxels' axes.
    pub fn is_cropped(&self) -> bool {
        self.ranges.iter().flatten().any(|end| end.is_finite())
    }
}

/// The voxel axis that a half-space is along, the index where it begins, and whether higher indices are inside.
fn along(half_space: &HalfSpace, grid: &Grid) -> Option<(usize, f64, bool)> {
    // Seen from the first voxel, an index is the product with a row of the inverse map.
    let to_index = grid.lps_mm_to_index();
    let rows = to_index.matrix3.transpose();
    let HalfSpace { normal, offset_mm } = half_space;
    (0..3).find_map(|axis| {
        let row = rows.col(axis);
        let cosine = normal.normalize().dot(row.normalize());
        let upwards = cosine > 0.0;
        let steps = offset_mm * row.length() / normal.length() * if upwards { 1.0 } else { -1.0 };
        (cosine.abs() > ALONG).then_some((axis, steps + to_index.translation[axis], upwards))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3, DVec3};

    #[test]
    fn what_is_cut_along_an_axis_is_a_range_of_indices() {
        let m = DMat3::from_cols(DVec3::new(0.0, 2.0, 0.0), DVec3::new(-0.5, 0.0, 0.0), DVec3::new(0.0, 0.0, -3.0));
        let grid = Grid::new([9, 9, 9], DAffine3::from_mat3_translation(m, DVec3::new(5.0, 6.0, 7.0))).unwrap();
        let plane = |normal: DVec3, through: DVec3| HalfSpace { normal, offset_mm: normal.dot(through) };
        let at = |i: f64, j: f64, k: f64| grid.index_to_lps_mm().transform_point3(DVec3::new(i, j, k));
        let (i, j, k) = (DVec3::Y, -DVec3::X, -DVec3::Z);
        for (half_space, expected) in [
            (plane(i, at(2.5, 0.0, 0.0)), Some((0, 2.5, true))),
            (plane(-4.0 * j, at(0.0, 3.0, 0.0)), Some((1, 3.0, false))),
            (plane(0.1 * k, at(0.0, 0.0, 7.0)), Some((2, 7.0, true))),
            (plane(i + 1e-3 * k, at(2.5, 0.0, 0.0)), None),
        ] {
            let found = along(&half_space, &grid);
            let near = match (found, expected) {
                (Some(found), Some(expected)) => {
                    (found.0, found.2) == (expected.0, expected.2) && (found.1 - expected.1).abs() < 1e-12
                }
                (found, expected) => found == expected,
            };
            assert!(near, "{half_space:?}: found {found:?}, expected {expected:?}");
        }
    }
}
