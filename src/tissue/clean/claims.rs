//! Which tissue has a voxel, while one after the other is cleaned: in one byte per voxel, the label before and after.

use crate::tissue::Mask;

/// Labels, of which those of the tissues that are settled are final.
pub(super) struct Claims {
    /// For each voxel, the tissue that has it, or, until that is settled, the one that it was of; counted from 1, 0 for none.
    pub(super) voxels: Vec<u8>,
    /// For each tissue, voxels that were of it and that a settled one has taken.
    taken: Vec<Vec<usize>>,
    settled: [bool; 256],
}

impl Claims {
    /// Labels of so many tissues, none of them settled.
    pub(super) fn new(voxels: Vec<u8>, tissues: usize) -> Self {
        Claims { voxels, taken: vec![Vec::new(); tissues + 1], settled: [false; 256] }
    }

    /// The voxels that were of a tissue.
    pub(super) fn mask(&self, dims: [usize; 3], tissue: u8) -> Mask {
        let mut inside: Vec<bool> = self.voxels.iter().map(|voxel| *voxel == tissue).collect();
        self.taken[usize::from(tissue)].iter().for_each(|&index| inside[index] = true);
        Mask { dims, inside }
    }

    /// Gives a tissue the voxels of its cleaned mask, but for those that a settled one has.
    pub(super) fn settle(&mut self, tissue: u8, mask: &Mask) {
        for (index, (voxel, &inside)) in self.voxels.iter_mut().zip(&mask.inside).enumerate() {
            match (inside, *voxel) {
                (false, old) if old == tissue => *voxel = 0,
                (true, old) if old != tissue && !self.settled[usize::from(old)] => {
                    // Whoever it was of still wants it in its mask. Nobody asks for the mask of none.
                    if old != 0 {
                        self.taken[usize::from(old)].push(index);
                    }
                    *voxel = tissue;
                }
                _ => {}
            }
        }
        self.taken[usize::from(tissue)] = Vec::new();
        self.settled[usize::from(tissue)] = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_to_be_settled_has_the_voxel_and_no_mask_changes() {
        let mut claims = Claims::new(vec![1, 1, 2, 2, 3, 0], 3);
        let mask = |inside: [u8; 6]| Mask { dims: [6, 1, 1], inside: inside.map(|bit| bit == 1).to_vec() };
        assert_eq!(claims.mask([6, 1, 1], 2), mask([0, 0, 1, 1, 0, 0]));
        // The second grows over the first and the third, and leaves a voxel.
        claims.settle(2, &mask([0, 1, 1, 0, 1, 0]));
        assert_eq!(claims.voxels, [1, 2, 2, 0, 2, 0]);
        assert_eq!(claims.mask([6, 1, 1], 1), mask([1, 1, 0, 0, 0, 0]), "the first is what it was");
        claims.settle(1, &mask([1, 1, 1, 1, 0, 0]));
        assert_eq!(claims.voxels, [1, 2, 2, 1, 2, 0], "only what nobody has");
        assert_eq!(claims.mask([6, 1, 1], 3), mask([0, 0, 0, 0, 1, 0]));
        claims.settle(3, &mask([0, 0, 0, 0, 1, 1]));
        assert_eq!(claims.voxels, [1, 2, 2, 1, 2, 3]);
    }
}
