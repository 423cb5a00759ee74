//! Scalar fields given by a formula, sampled on a lattice, so that f(r) renders like a scan.
//!
//! Each is a function of the position in patient coordinates (LPS, mm) with values of any unit, in f64. [`sample`] takes
//! it at the lattice points, as f32; between them the volume is trilinear as any other, so what is rendered is the
//! interpolant, which comes as near to the formula as the square of the spacing.

mod expression;
mod marschner_lobb;
mod ramp;
mod sphere;
mod torus;

pub use expression::{Expression, SyntaxError};
pub use marschner_lobb::MarschnerLobb;
pub use ramp::Ramp;
pub use sphere::Sphere;
pub use torus::Torus;

use glam::{DAffine3, DMat3, DVec3};
use rayon::prelude::*;

use crate::error::{Error, Fault, Result};
use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// Most voxels of a volume by formula: 8 GiB.
const MOST_VOXELS: u128 = 1 << 31;

/// A scalar field in space.
pub trait ScalarField: Sync {
    /// Value at a point, LPS mm.
    fn value(&self, at_mm: DVec3) -> f64;
}

impl<F: Fn(DVec3) -> f64 + Sync> ScalarField for F {
    fn value(&self, at_mm: DVec3) -> f64 {
        self(at_mm)
    }
}

/// A lattice along the patient's axes, its domain centred at the origin.
///
/// # Errors
/// `Fault::Limit` for more than 2³¹ voxels, and as [`Grid::new`].
pub fn centered_grid(size: [usize; 3], spacing_mm: DVec3) -> Result<Grid> {
    let voxels = size.into_iter().map(|n| n as u128).try_fold(1u128, |product, n| product.checked_mul(n));
    if voxels.is_none_or(|count| count > MOST_VOXELS) {
        return Err(Error::new(Fault::Limit, "the volume has too many voxels")
            .found(format!("{} x {} x {}", size[0], size[1], size[2]))
            .expected(format!("at most {MOST_VOXELS}"))
            .remedy("ask for a smaller size"));
    }
    let last = DVec3::from_array(size.map(|n| n.max(1) as f64 - 1.0));
    Grid::new(size, DAffine3::from_mat3_translation(DMat3::from_diagonal(spacing_mm), -0.5 * last * spacing_mm))
}

/// The field's values at the lattice points, rounded to f32. The same on any number of threads.
///
/// # Errors
/// `Fault::Spec`, with the point, where a value is no finite number of 32 bits; `Fault::Limit` where memory for the
/// voxels cannot be had.
pub fn sample(field: &(impl ScalarField + ?Sized), grid: Grid, quantity: Quantity) -> Result<Volume> {
    let mut voxels: Vec<f32> = Vec::new();
    voxels.try_reserve_exact(grid.voxel_count()).map_err(|error| {
        Error::new(Fault::Limit, "there is no memory for the volume")
            .found(format!("{:?} voxels of 4 bytes", grid.dims()))
            .remedy("ask for a smaller size")
            .caused_by(error)
    })?;
    let point_mm = |index: usize| {
        let voxel = grid.unflatten(index).map(|i| i as f64);
        grid.index_to_lps_mm().transform_point3(voxel.into())
    };
    // Adding 0 makes one zero of the two.
    let at = |index: usize| field.value(point_mm(index)) as f32 + 0.0;
    (0..grid.voxel_count()).into_par_iter().map(at).collect_into_vec(&mut voxels);
    if let Some(index) = voxels.iter().position(|value| !value.is_finite()) {
        let (at_mm, value) = (point_mm(index), field.value(point_mm(index)));
        return Err(Error::new(Fault::Spec, "the formula has no usable value at a point")
            .found(format!("{value} at x = {}, y = {}, z = {} mm", at_mm.x, at_mm.y, at_mm.z))
            .expected(format!("a finite number of at most {:.1e}", f32::MAX))
            .remedy("change the formula, or sample where it has values"));
    }
    Volume::new(grid, Samples::F32(voxels), Rescale::IDENTITY, quantity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_domain_is_centred_at_the_origin() {
        let grid = centered_grid([5, 4, 1], DVec3::new(2.0, 1.0, 3.0)).unwrap();
        assert!(grid.center_mm().length() < 1e-15, "found {}", grid.center_mm());
        assert_eq!(grid.corners_mm()[0], DVec3::new(-4.0, -1.5, -1.5), "an axis of one voxel is one spacing thick");
    }

    #[test]
    fn samples_are_the_formula_at_the_lattice_points() {
        let grid = centered_grid([4, 3, 2], DVec3::new(1.0, 2.0, 4.0)).unwrap();
        let volume = sample(&|r: DVec3| r.x + 10.0 * r.y + 100.0 * r.z, grid, Quantity::Arbitrary).unwrap();
        assert_eq!(volume.value([0, 0, 0]), -1.5 - 20.0 - 200.0);
        assert_eq!(volume.value([3, 1, 1]), 1.5 + 200.0);
    }

    #[test]
    fn a_pole_is_refused_with_its_place() {
        let grid = centered_grid([3, 3, 3], DVec3::ONE).unwrap();
        let error = sample(&|r: DVec3| 1.0 / r.length(), grid, Quantity::Hu).expect_err("a pole at the origin");
        assert_eq!(error.fault(), Fault::Spec);
        assert!(error.to_string().contains("inf at x = 0, y = 0, z = 0 mm"), "found {error}");
        let error = sample(&|r: DVec3| 1e39 * r.x, grid, Quantity::Hu).expect_err("beyond f32");
        assert!(error.to_string().contains("at x = -1, y = -1, z = -1 mm"), "found {error}");
    }

    #[test]
    fn a_lattice_that_no_memory_holds_is_refused() {
        let error = centered_grid([usize::MAX, 2, 2], DVec3::ONE).expect_err("too many voxels");
        assert_eq!(error.fault(), Fault::Limit, "found {error}");
    }
}
