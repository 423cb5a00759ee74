//! Scalar fields given by a formula, sampled on a lattice, so that f(r) renders like a scan.
//!
//! Each is a function of the position in patient coordinates (LPS, mm) with values of any unit, in f64. [`sample`] takes
//! it at the lattice points, as f32; between them the volume is trilinear as any other, so what is rendered is the
//! interpolant, which comes as near to the formula as the square of the spacing.

mod expression;
mod lattice;
mod marschner_lobb;
mod ramp;
mod sphere;
mod torus;

pub use expression::{Expression, SyntaxError};
pub use lattice::Lattice;
pub use marschner_lobb::MarschnerLobb;
pub use ramp::Ramp;
pub use sphere::Sphere;
pub use torus::Torus;

use glam::DVec3;
use rayon::prelude::*;

use crate::error::{Error, Fault, Result};
use crate::volume::{Quantity, Rescale, Samples, Volume};

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

/// The field's values at the lattice points, rounded to f32. The same on any number of threads.
///
/// # Errors
/// `Fault::Spec`, with the point, where a value is no finite number of 32 bits; `Fault::Limit` where memory for the
/// voxels cannot be had.
pub fn sample(field: &(impl ScalarField + ?Sized), lattice: Lattice, quantity: Quantity) -> Result<Volume> {
    let Lattice { grid, slices } = lattice;
    let mut voxels: Vec<f32> = Vec::new();
    voxels.try_reserve_exact(grid.voxel_count()).map_err(|error| {
        Error::new(Fault::Limit, "there is no memory for the volume")
            .found(format!("{:?} voxels of 4 bytes", grid.dims()))
            .remedy("ask for a smaller size")
            .caused_by(error)
    })?;
    let point_mm = |index: usize| {
        let [i, j, k] = grid.unflatten(index);
        let p = slices.as_ref().map_or(k as f64, |slices| slices.positions()[k]);
        grid.index_to_lps_mm().transform_point3(DVec3::new(i as f64, j as f64, p))
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
    let volume = Volume::new(grid, Samples::F32(voxels), Rescale::IDENTITY, quantity)?;
    slices.into_iter().try_fold(volume, Volume::with_slices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_the_formula_at_the_lattice_points() {
        let ramp = |r: DVec3| r.x + 10.0 * r.y + 100.0 * r.z;
        let even = Lattice::centered([4, 3, 2], DVec3::new(1.0, 2.0, 4.0)).unwrap();
        let uneven = Lattice::on_planes([4, 3], [1.0, 2.0], &[-2.0, 2.0, 7.0]).unwrap();
        for lattice in [even, uneven] {
            let volume = sample(&ramp, lattice, Quantity::Arbitrary).unwrap();
            assert_eq!(volume.value([0, 0, 0]), -1.5 - 20.0 - 200.0);
            assert_eq!(volume.value([3, 1, 1]), 1.5 + 200.0);
            for index in 0..volume.grid().voxel_count() {
                let voxel = volume.grid().unflatten(index);
                let (found, expected) = (volume.value(voxel), ramp(volume.voxel_mm(voxel)));
                assert!((found - expected).abs() < 1e-3, "{voxel:?}: found {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn a_pole_is_refused_with_its_place() {
        let lattice = || Lattice::centered([3, 3, 3], DVec3::ONE).unwrap();
        let error = sample(&|r: DVec3| 1.0 / r.length(), lattice(), Quantity::Hu).expect_err("a pole at the origin");
        assert_eq!(error.fault(), Fault::Spec);
        assert!(error.to_string().contains("inf at x = 0, y = 0, z = 0 mm"), "found {error}");
        let error = sample(&|r: DVec3| 1e39 * r.x, lattice(), Quantity::Hu).expect_err("beyond f32");
        assert!(error.to_string().contains("at x = -1, y = -1, z = -1 mm"), "found {error}");
    }
}
