//! Where a formula is sampled.

use glam::{DAffine3, DMat3, DVec3};

use crate::error::{Error, Fault, Result};
use crate::volume::{Grid, Slices};

/// Most voxels of a volume by formula: 8 GiB.
const MOST_VOXELS: u128 = 1 << 31;

/// A lattice along the patient's axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Lattice {
    pub(super) grid: Grid,
    pub(super) slices: Option<Slices>,
}

impl Lattice {
    /// Number of lattice points.
    pub fn voxel_count(&self) -> usize {
        self.grid.voxel_count()
    }

    /// An even lattice, its domain centred at the origin.
    ///
    /// # Errors
    /// `Fault::Limit` for more than 2³¹ voxels, and as [`Grid::new`].
    pub fn centered(size: [usize; 3], spacing_mm: DVec3) -> Result<Self> {
        let last = DVec3::from_array(size.map(|n| n.max(1) as f64 - 1.0));
        Ok(Lattice { grid: grid(size, spacing_mm, -0.5 * last * spacing_mm)?, slices: None })
    }

    /// A rectilinear lattice: even and centred along x and y, with slices at these places along z.
    ///
    /// # Errors
    /// As [`Lattice::centered`] and [`Slices::new`].
    pub fn on_planes(size: [usize; 2], spacing_mm: [f64; 2], planes_mm: &[f64]) -> Result<Self> {
        let slices = Slices::new(planes_mm)?;
        let (first_mm, last_mm) = (planes_mm[0], planes_mm[planes_mm.len() - 1]);
        let [x, y] = spacing_mm;
        let spacing_mm = DVec3::new(x, y, (last_mm - first_mm) / (planes_mm.len() - 1) as f64);
        let half = |n: usize| -0.5 * (n.max(1) as f64 - 1.0);
        let first_voxel_mm = DVec3::new(half(size[0]) * x, half(size[1]) * y, first_mm);
        let grid = grid([size[0], size[1], planes_mm.len()], spacing_mm, first_voxel_mm)?;
        Ok(Lattice { grid, slices: Some(slices) })
    }
}

fn grid(size: [usize; 3], spacing_mm: DVec3, first_voxel_mm: DVec3) -> Result<Grid> {
    let voxels = size.into_iter().map(|n| n as u128).try_fold(1u128, |product, n| product.checked_mul(n));
    if voxels.is_none_or(|count| count > MOST_VOXELS) {
        return Err(Error::new(Fault::Limit, "the volume has too many voxels")
            .found(format!("{} x {} x {}", size[0], size[1], size[2]))
            .expected(format!("at most {MOST_VOXELS}"))
            .remedy("ask for a smaller size"));
    }
    Grid::new(size, DAffine3::from_mat3_translation(DMat3::from_diagonal(spacing_mm), first_voxel_mm))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_domain_is_centred_at_the_origin() {
        let grid = Lattice::centered([5, 4, 1], DVec3::new(2.0, 1.0, 3.0)).unwrap().grid;
        assert!(grid.center_mm().length() < 1e-15, "found {}", grid.center_mm());
        assert_eq!(grid.corners_mm()[0], DVec3::new(-4.0, -1.5, -1.5), "an axis of one voxel is one spacing thick");
    }

    #[test]
    fn planes_lie_where_they_are_asked_for() {
        let lattice = Lattice::on_planes([3, 2], [2.0, 1.0], &[-5.0, -4.0, 1.0]).unwrap();
        assert_eq!(lattice.grid.corners_mm()[0], DVec3::new(-2.0, -0.5, -5.0));
        assert_eq!(lattice.grid.corners_mm()[7], DVec3::new(2.0, 0.5, 1.0));
        assert_eq!(lattice.slices.unwrap().positions(), [0.0, 1.0 / 3.0, 2.0]);
    }

    #[test]
    fn a_lattice_that_no_memory_holds_is_refused() {
        let error = Lattice::centered([usize::MAX, 2, 2], DVec3::ONE).expect_err("too many voxels");
        assert_eq!(error.fault(), Fault::Limit, "found {error}");
    }
}
