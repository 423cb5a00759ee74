//! A majority filter: the median of a mask over a box.

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
    let mut part = crop.of(mask);
    let [nx, ny, _] = crop.dims;
    let counts = counts(&part, reach);
    let lattice = mask.dims;
    // Voxels of a box along an axis, as far as the lattice goes.
    let length = |axis: usize, at: usize| {
        let centre = crop.first[axis] + at;
        (centre + reach[axis]).min(lattice[axis] - 1) - centre.saturating_sub(reach[axis]) + 1
    };
    for (row, line) in part.inside.chunks_mut(nx).enumerate() {
        let across = length(1, row % ny) * length(2, row / ny);
        for (i, inside) in line.iter_mut().enumerate() {
            *inside = 2 * counts[row * nx + i] as usize > across * length(0, i);
        }
    }
    crop.put(&part, mask);
}

/// Voxels inside of the box around each voxel: sums along one axis after the other.
fn counts(mask: &Mask, reach: [usize; 3]) -> Vec<u32> {
    let [nx, ny, nz] = mask.dims;
    let window = |at: usize, axis: usize| at.saturating_sub(reach[axis])..(at + reach[axis] + 1).min(mask.dims[axis]);
    let mut within_slices = vec![0_u32; nx * ny * nz];
    within_slices.par_chunks_mut(nx * ny).enumerate().for_each_init(
        || vec![0_u32; nx * ny],
        |along_i, (k, sums)| {
            let slice = &mask.inside[k * nx * ny..][..nx * ny];
            for (row, line) in slice.chunks(nx).enumerate() {
                for i in 0..nx {
                    along_i[row * nx + i] = line[window(i, 0)].iter().map(|inside| u32::from(*inside)).sum();
                }
            }
            for (j, line) in sums.chunks_mut(nx).enumerate() {
                window(j, 1).for_each(|other| add(line, &along_i[other * nx..]));
            }
        },
    );
    let mut all = vec![0_u32; nx * ny * nz];
    all.par_chunks_mut(nx * ny).enumerate().for_each(|(k, sums)| {
        window(k, 2).for_each(|other| add(sums, &within_slices[other * nx * ny..]));
    });
    all
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
        let grid = Grid::axis_aligned([8, 7, 5], spacing).unwrap();
        for (every, reach_mm) in [(2, 1.0), (3, 2.5), (2, 5.0)] {
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
