//! The surface of a sphere is where the formula puts it, but for interpolation, whose error falls with the square of the
//! spacing.

use glam::DVec3;
use pellucid::TransferFunction;
use pellucid::oracle::Oracle;
use pellucid::scene::Ray;
use pellucid::transfer::Term;

use super::volume;
use crate::support::scenes::{curve, scene};

const RADIUS_MM: f64 = 20.0;

/// Extinction where the value is above 0, 1/mm.
const EXTINCTION_PER_MM: f64 = 0.25;

/// Root mean square error of the length of a ray inside the sphere, over rays in all directions at many distances from
/// its centre, mm. The optical depth of a body of even extinction is its length.
fn rms_length_error_mm(size: u32) -> f64 {
    let sphere =
        volume(&format!("{{ field: {{ sphere: {{ radius_mm: {RADIUS_MM} }} }}, size: {size}, extent_mm: 50 }}"));
    let white = [1.0; 3];
    let step = curve(&[(0.0, 0.0, white), (0.0, EXTINCTION_PER_MM, white), (100.0, EXTINCTION_PER_MM, white)]);
    let function = TransferFunction::new([-100.0, 100.0], 10.0, vec![Term { curve: step, weight: None }]).unwrap();
    let scene = scene(function);
    let oracle = Oracle::new(&sphere, &scene);
    let mut squares = 0.0;
    let count = 400;
    for i in 0..count {
        let u = |k: f64| (f64::from(i) * k).fract();
        let (z, angle) = (2.0 * u(0.618) - 1.0, std::f64::consts::TAU * u(0.414));
        let direction = DVec3::new((1.0 - z * z).sqrt() * angle.cos(), (1.0 - z * z).sqrt() * angle.sin(), z);
        let aside = direction.any_orthonormal_vector();
        // Not where a ray grazes the sphere: there an error of the surface is one of the length's square.
        let distance_mm = 0.8 * RADIUS_MM * u(0.732);
        let ray = Ray { origin_mm: distance_mm * aside - 100.0 * direction, direction };
        let found = oracle.segment(&ray, 0.0, f64::INFINITY).optical_depth / EXTINCTION_PER_MM;
        squares += (found - 2.0 * (RADIUS_MM.powi(2) - distance_mm.powi(2)).sqrt()).powi(2);
    }
    (squares / f64::from(count)).sqrt()
}

#[test]
fn its_error_falls_with_the_square_of_the_spacing() {
    // Spacings of 50/12, 50/24 and 50/48 mm.
    let errors = [13, 25, 49].map(rms_length_error_mm);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.8..2.2).contains(&order), "order {order} of errors {errors:?} mm");
    }
    assert!(errors[2] < 0.03, "1 mm of spacing and 20 mm of radius: found {} mm", errors[2]);
}
