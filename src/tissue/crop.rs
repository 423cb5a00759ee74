//! A box of voxels around what is inside a mask, so that work is done there only.

use super::Mask;

/// A box of a lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Crop {
    /// Its first voxel.
    pub(super) first: [usize; 3],
    /// Its number of voxels along i, j and k.
    pub(super) dims: [usize; 3],
    /// That of the lattice.
    lattice: [usize; 3],
}

impl Crop {
    /// The box around these bounds, larger by `margin` voxels on each side where the lattice has as many.
    pub(super) fn around(bounds: [[usize; 2]; 3], margin: [usize; 3], lattice: [usize; 3]) -> Self {
        let first = std::array::from_fn(|a| bounds[a][0].saturating_sub(margin[a]));
        let last: [usize; 3] = std::array::from_fn(|a| bounds[a][1].saturating_add(margin[a]).min(lattice[a] - 1));
        Crop { first, dims: std::array::from_fn(|a| last[a] - first[a] + 1), lattice }
    }

    /// The part of a mask in the box.
    pub(super) fn of(&self, mask: &Mask) -> Mask {
        let rows = (0..self.dims[2]).flat_map(|k| (0..self.dims[1]).map(move |j| [j, k]));
        let inside = rows.flat_map(|row| mask.inside[self.start(row)..][..self.dims[0]].iter().copied());
        Mask { dims: self.dims, inside: inside.collect() }
    }

    /// Linear index in the lattice of the first voxel of a row of the box.
    pub(super) fn start(&self, [j, k]: [usize; 2]) -> usize {
        let [nx, ny, _] = self.lattice;
        self.first[0] + nx * (self.first[1] + j + ny * (self.first[2] + k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_its_rows_of_the_lattice() {
        let lattice = [5, 4, 3];
        let crop = Crop::around([[1, 2], [3, 3], [0, 1]], [1, 1, 0], lattice);
        assert_eq!((crop.first, crop.dims), ([0, 2, 0], [4, 2, 2]), "cut off where the lattice ends");
        let whole = Mask { dims: lattice, inside: (0..60).map(|n| n % 3 == 0).collect() };
        let part = crop.of(&whole);
        assert_eq!(part.inside.len(), 16);
        assert_eq!(part.inside[1], whole.inside[1 + 5 * 2], "voxel (1, 2, 0)");
        assert_eq!(crop.start([1, 1]), 5 * (3 + 4), "the row of voxel (0, 3, 1)");
    }
}
