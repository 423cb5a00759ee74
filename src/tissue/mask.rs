//! Voxels that are of a tissue, and those that are not.

use crate::volume::Grid;

/// True for each voxel of a tissue, x fastest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    /// Number of voxels along i, j and k.
    pub dims: [usize; 3],
    /// The voxels.
    pub inside: Vec<bool>,
}

impl Mask {
    /// The voxels of a lattice for which `inside` is true, given the linear index.
    pub fn new(grid: &Grid, inside: impl Fn(usize) -> bool) -> Self {
        Mask { dims: grid.dims(), inside: (0..grid.voxel_count()).map(inside).collect() }
    }

    /// Number of voxels inside.
    pub fn count(&self) -> usize {
        self.inside.iter().filter(|inside| **inside).count()
    }

    /// Lowest and highest index inside along i, j and k; `None` if nothing is.
    pub(super) fn bounds(&self) -> Option<[[usize; 2]; 3]> {
        let [nx, ny, _] = self.dims;
        let mut bounds: Option<[[usize; 2]; 3]> = None;
        for (row, line) in self.inside.chunks(nx).enumerate() {
            let Some(first) = line.iter().position(|inside| *inside) else { continue };
            let last = line.iter().rposition(|inside| *inside).unwrap_or(first);
            let ends = [[first, last], [row % ny; 2], [row / ny; 2]];
            let known = bounds.get_or_insert(ends);
            for (known, [low, high]) in known.iter_mut().zip(ends) {
                *known = [known[0].min(low), known[1].max(high)];
            }
        }
        bounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn bounds_hold_what_is_inside() {
        let grid = Grid::axis_aligned([4, 3, 2], DVec3::ONE).unwrap();
        let corner = [grid.flatten([1, 0, 1]), grid.flatten([2, 2, 1])];
        let mask = Mask::new(&grid, |index| corner.contains(&index));
        assert_eq!((mask.count(), mask.bounds()), (2, Some([[1, 2], [0, 2], [1, 1]])));
        assert_eq!(Mask::new(&grid, |_| false).bounds(), None);
    }
}
