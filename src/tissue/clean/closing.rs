//! Closing by a ball (Serra 1982): what no ball of this radius that stays outside can reach is taken in.

use glam::DVec3;

use crate::error::Result;
use crate::tissue::Mask;
use crate::tissue::crop::Crop;
use crate::tissue::distance::{orthogonal_spacing_mm, tell_near};
use crate::volume::Grid;

/// Grows the mask by a ball of this radius and shrinks it by the same ball. What lies beyond the lattice has no say.
pub(super) fn close(mask: &mut Mask, grid: &Grid, radius_mm: f64) -> Result<()> {
    let spacing_mm = orthogonal_spacing_mm(grid)?;
    let Some(bounds) = mask.bounds() else { return Ok(()) };
    // The grown mask and one voxel beyond it: the nearest voxel outside is then in the crop.
    let reach = (DVec3::splat(radius_mm) / spacing_mm).to_array().map(|voxels| voxels as usize + 2);
    let crop = Crop::around(bounds, reach, mask.dims);
    let mut grown = Vec::with_capacity(crop.dims.iter().product());
    let row = |row: [usize; 2]| &mask.inside[crop.start(row)..][..crop.dims[0]];
    tell_near(crop.dims, spacing_mm, radius_mm, true, row, |_, near| grown.extend_from_slice(near));
    let [nx, ny, _] = crop.dims;
    let row = |[j, k]: [usize; 2]| &grown[nx * (j + ny * k)..][..nx];
    tell_near(crop.dims, spacing_mm, radius_mm, false, row, |first, outside_is_near| {
        for (n, outside_is_near) in outside_is_near.chunks(nx).enumerate() {
            let line = &mut mask.inside[crop.start([n % ny, first + n / ny])..][..nx];
            line.iter_mut().zip(outside_is_near).for_each(|(inside, near)| *inside = !near);
        }
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the definition: offsets of the ball, voxel by voxel; what is beyond the lattice has no say.
    fn closed_by_definition(mask: &Mask, spacing: DVec3, radius: f64) -> Vec<bool> {
        let [nx, ny, nz] = mask.dims;
        let at = |index: usize| DVec3::new((index % nx) as f64, (index / nx % ny) as f64, (index / (nx * ny)) as f64);
        let near = |a: usize, b: usize| (spacing * (at(a) - at(b))).length() <= radius * (1.0 + 1e-9);
        let all = 0..nx * ny * nz;
        let grown: Vec<bool> = all.clone().map(|a| all.clone().any(|b| mask.inside[b] && near(a, b))).collect();
        all.clone().map(|a| all.clone().all(|b| grown[b] || !near(a, b))).collect()
    }

    #[test]
    fn it_grows_and_shrinks_by_a_ball() {
        for (dims, spacing, radius) in [
            ([9, 8, 7], DVec3::new(1.0, 1.0, 2.0), 2.0),
            ([9, 8, 7], DVec3::new(0.7, 1.1, 3.0), 1.6),
            ([12, 12, 1], DVec3::splat(3.0), 4.5),
            ([5, 6, 21], DVec3::new(1.0, 1.0, 0.7), 2.0),
        ] {
            let grid = Grid::axis_aligned(dims, spacing).unwrap();
            for every in [5, 11, 29] {
                let start = Mask::new(&grid, |index| (index * 7919) % 211 % every == 0);
                let mut found = start.clone();
                close(&mut found, &grid, radius).unwrap();
                let expected = closed_by_definition(&start, spacing, radius);
                let wrong = found.inside.iter().zip(&expected).filter(|(a, b)| a != b).count();
                assert_eq!(wrong, 0, "{wrong} voxels of {dims:?} differ for a ball of {radius} mm");
                assert!(found.count() > start.count(), "the case has gaps to close");
            }
        }
    }
}
