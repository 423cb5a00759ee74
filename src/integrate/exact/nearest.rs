//! The classes that a ray passes: those of the voxels nearest to its points.

use crate::math::each;
use crate::volume::{Classes, Grid};

use super::cells::Segment;

/// Classes by voxel index.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest<'a> {
    classes: &'a [u8],
    dims: [usize; 3],
}

/// The parts of a segment that have one class each, in order. A segment passes at most three planes halfway between voxels,
/// so there are at most four.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Parts {
    /// Where each part ends, in `[0, 1]` of the segment; the first begins at 0, the last ends at 1.
    ends: [f64; 4],
    classes: [u8; 4],
    count: usize,
}

impl<'a> Nearest<'a> {
    pub(super) fn new(classes: &'a Classes, grid: &Grid) -> Self {
        Nearest { classes: classes.values(), dims: grid.dims() }
    }

    /// Classes at the corners of a cell, x fastest.
    fn corners(&self, cell: [usize; 3]) -> [u8; 8] {
        let [nx, ny, _] = self.dims;
        each(|c| {
            let [i, j, k] = each(|a| (cell[a] + (c >> a & 1)).min(self.dims[a] - 1));
            self.classes[i + nx * (j + ny * k)]
        })
    }

    /// The parts of a segment.
    pub(super) fn parts(&self, segment: &Segment) -> Parts {
        let corners = self.corners(segment.cell);
        let mut parts = Parts { ends: [1.0; 4], classes: [corners[0]; 4], count: 1 };
        if corners == [corners[0]; 8] {
            return parts;
        }
        let Segment { from, to, .. } = segment;
        let mut planes: [f64; 3] = each(|a| {
            let u = (0.5 - from[a]) / (to[a] - from[a]);
            // Neither what lies outside nor the NaN of a segment along the plane.
            if u > 0.0 && u < 1.0 { u } else { 1.0 }
        });
        planes.sort_by(f64::total_cmp);
        let mut begin = 0.0;
        parts.count = 0;
        for end in planes.into_iter().chain([1.0]).filter(|&u| u > 0.0) {
            if end <= begin {
                continue;
            }
            let middle = 0.5 * (begin + end);
            let upper = |a: usize| usize::from(from[a] + middle * (to[a] - from[a]) >= 0.5) << a;
            let class = corners[upper(0) | upper(1) | upper(2)];
            if parts.count > 0 && parts.classes[parts.count - 1] == class {
                parts.ends[parts.count - 1] = end;
            } else {
                (parts.ends[parts.count], parts.classes[parts.count]) = (end, class);
                parts.count += 1;
            }
            begin = end;
        }
        parts
    }
}

impl Parts {
    /// Number of parts, at least 1.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Where a part begins and ends in the segment, and its class.
    pub(super) fn part(&self, i: usize) -> ([f64; 2], usize) {
        let begin = if i == 0 { 0.0 } else { self.ends[i - 1] };
        ([begin, self.ends[i]], usize::from(self.classes[i]))
    }

    /// Each part.
    pub(super) fn iter(&self) -> impl Iterator<Item = ([f64; 2], usize)> + '_ {
        (0..self.count).map(|i| self.part(i))
    }

    /// The class at a place in the segment.
    pub(super) fn class_at(&self, u: f64) -> usize {
        let part = self.ends[..self.count - 1].iter().take_while(|&&end| end <= u).count();
        usize::from(self.classes[part])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Quantity, Rescale, Samples, Volume};
    use glam::DVec3;

    fn parts(classes: [u8; 8], from: [f64; 3], to: [f64; 3]) -> Vec<([f64; 2], usize)> {
        let grid = Grid::axis_aligned([2, 2, 2], DVec3::ONE).unwrap();
        let volume = Volume::new(grid, Samples::I16(vec![0; 8]), Rescale::IDENTITY, Quantity::Hu).unwrap();
        let volume = volume.with_classes(classes.to_vec()).unwrap();
        let segment = Segment { cell: [0; 3], from, to, length_mm: 1.0, exit_mm: 1.0 };
        let parts = Nearest::new(volume.classes().unwrap(), &grid).parts(&segment);
        for (ends, class) in parts.iter() {
            assert_eq!(parts.class_at(0.5 * (ends[0] + ends[1])), class, "{parts:?}");
        }
        parts.iter().collect()
    }

    #[test]
    fn a_segment_is_cut_halfway_between_voxels_of_different_classes() {
        let classes = [0, 1, 2, 3, 4, 5, 6, 7];
        assert_eq!(parts(classes, [0.0; 3], [1.0, 0.25, 0.0]), [([0.0, 0.5], 0), ([0.5, 1.0], 1)]);
        let through = parts(classes, [0.0, 0.25, 1.0], [1.0, 0.75, 0.6]);
        assert_eq!(through, [([0.0, 0.5], 4), ([0.5, 1.0], 7)], "two planes at once");
        let four = parts(classes, [0.4, 0.2, 0.1], [0.8, 1.0, 0.9]);
        assert_eq!(four.iter().map(|p| p.1).collect::<Vec<_>>(), [0, 1, 3, 7]);
        assert_eq!(parts([3; 8], [0.0; 3], [1.0, 0.25, 0.0]), [([0.0, 1.0], 3)], "one class");
        assert_eq!(
            parts([0, 0, 1, 1, 0, 0, 1, 1], [0.0; 3], [1.0, 0.25, 0.9]),
            [([0.0, 1.0], 0)],
            "no change on the way"
        );
    }

    #[test]
    fn on_the_plane_itself_the_upper_voxel_is_nearest() {
        let classes = [0, 1, 2, 3, 4, 5, 6, 7];
        assert_eq!(parts(classes, [0.5, 0.0, 0.0], [0.5, 0.0, 0.4]), [([0.0, 1.0], 1)]);
        assert_eq!(parts(classes, [0.5, 0.0, 0.0], [0.0, 0.0, 0.0]), [([0.0, 1.0], 0)], "it only begins there");
    }
}
