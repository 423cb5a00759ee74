//! A majority filter: the median of a mask over a box.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use crate::tissue::Mask;
use crate::tissue::crop::Crop;

/// Gives each voxel to the mask if more than half of the voxels of the box around it are inside: those not further from it
/// than `reach_mm` along each axis. Where the lattice ends, the box does.
pub(super) fn vote(mask: &mut Mask, spacing_mm: DVec3, reach_mm: f64) {
    let Some(bounds) = mask.bounds() else { return };
    let reach = (DVec3::splat(reach_mm * (1.0 + 1e-9)) / spacing_mm).to_array().map(|voxels| voxels as usize);
    // Beyond the mask's bounds less than half of a box is inside, except where the lattice cuts boxes off.
    let crop = Crop::around(bounds, reach, mask.dims);
    let part = crop.of(mask);
    let [nx, _, nz] = crop.dims;
    let lattice = mask.dims;
    // Voxels of a box along an axis, as far as the lattice goes.
    let length = |axis: usize, at: usize| {
        let centre = crop.first[axis] + at;
        (centre + reach[axis]).min(lattice[axis] - 1) - centre.saturating_sub(reach[axis]) + 1
    };
    for first in (0..nz).step_by(SLICES_AT_ONCE) {
        let slices = first..nz.min(first + SLICES_AT_ONCE);
        for (k, counts) in slices.clone().zip(counts(&part, reach, slices)) {
            for (j, counts) in counts.chunks(nx).enumerate() {
                let across = length(1, j) * length(2, k);
                let line = &mut mask.inside[crop.start([j, k])..][..nx];
                for (i, (inside, count)) in line.iter_mut().zip(counts).enumerate() {
                    *inside = 2 * *count as usize > across * length(0, i);
                }
            }
        }
    }
}

/// Slices that are counted at once, so that memory does not go with the volume.
const SLICES_AT_ONCE: usize = 8;

/// Voxels inside of the box around each voxel of some slices: sums along one axis after the other.
fn counts(mask: &Mask, reach: [usize; 3], slices: Range<usize>) -> Vec<Vec<u32>> {
    let [nx, ny, nz] = mask.dims;
    let window = |at: usize, axis: usize| at.saturating_sub(reach[axis])..(at + reach[axis] + 1).min(mask.dims[axis]);
    let within_slice = |along_i: &mut Vec<u32>, k: usize| {
        let slice = &mask.inside[k * nx * ny..][..nx * ny];
        for (row, line) in slice.chunks(nx).enumerate() {
            for i in 0..nx {
                along_i[row * nx + i] = line[window(i, 0)].iter().map(|inside| u32::from(*inside)).sum();
            }
        }
        let mut sums = vec![0_u32; nx * ny];
        for (j, line) in sums.chunks_mut(nx).enumerate() {
            window(j, 1).for_each(|other| add(line, &along_i[other * nx..]));
        }
        sums
    };
    let from = slices.start.saturating_sub(reach[2]);
    let to = nz.min(slices.end + reach[2]);
    let within_slices: Vec<Vec<u32>> =
        (from..to).into_par_iter().map_init(|| vec![0_u32; nx * ny], within_slice).collect();
    let boxes = |k: usize| {
        let mut sums = vec![0_u32; nx * ny];
        window(k, 2).for_each(|other| add(&mut sums, &within_slices[other - from]));
        sums
    };
    slices.into_par_iter().map(boxes).collect()
}

fn add(sums: &mut [u32], others: &[u32]) {
    sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += other);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::Grid;

    #[test]
    fn more_than_half_of_the_box_decides() {
        let spacing = DVec3::new(1.0, 1.0, 2.5);
        for (dims, every, reach_mm) in
            [([8, 7, 5], 2, 1.0), ([8, 7, 5], 3, 2.5), ([8, 7, 5], 2, 5.0), ([4, 5, 21], 2, 5.0)]
        {
            let grid = Grid::axis_aligned(dims, spacing).unwrap();
            let start = Mask::new(&grid, |index| (index * 7919) % 211 % every == 0);
            let mut found = start.clone();
            vote(&mut found, spacing, reach_mm);
            for index in 0..grid.voxel_count() {
                let centre = grid.unflatten(index);
                let near = |other: &usize| {
                    let at = grid.unflatten(*other);
                    (0..3).all(|a| at[a].abs_diff(centre[a]) as f64 * spacing[a] <= reach_mm + 1e-6)
                };
                let others: Vec<usize> = (0..grid.voxel_count()).filter(near).collect();
                let votes = others.iter().filter(|other| start.inside[**other]).count();
                let expected = 2 * votes > others.len();
                assert_eq!(
                    found.inside[index],
                    expected,
                    "{centre:?}: {votes} of {} within {reach_mm} mm",
                    others.len()
                );
            }
        }
    }
}
