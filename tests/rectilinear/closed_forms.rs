//! A linear field: trilinear interpolation and its gradients are exact on any lattice, so that pictures of it do not depend
//! on where the slices lie, and rays through it have a closed form.

use glam::DVec3;
use pellucid::TransferFunction;
use pellucid::integrate::exact::Precision;
use pellucid::oracle::Oracle;
use pellucid::scene::Ray;
use pellucid::transfer::Term;

use super::{exact, on, sampled, slices, truth};
use crate::march::scenes::{MARCH, apart, pixels, scene, sheared_grid, tissue_1d, tissue_2d, two_lights};
use crate::support::scenes::{BONE, curve, rays_through, scene as plain};

/// HU per mm, in multiples of 1/8.
const SLOPE: DVec3 = DVec3::new(30.0, -17.5, 41.25);

fn linear(at_mm: DVec3) -> f64 {
    SLOPE.dot(at_mm - sheared_grid().center_mm()) - 200.0
}

#[test]
fn pictures_of_a_linear_field_do_not_depend_on_the_slices() {
    let (uneven, even) = (sampled(Some(slices()), linear), sampled(None, linear));
    for function in [tissue_1d(), tissue_2d()] {
        for shading in [None, Some(two_lights())] {
            let lit = shading.is_some();
            let scene = scene(&even, function.clone(), shading);
            let by_oracle = apart(&truth(&uneven, &scene), &truth(&even, &scene));
            // Values of up to 2000 are rounded to f32, and the slopes of the transfer function are up to 1/100 per HU.
            assert!(by_oracle < 1e-5, "lit {lit}: {by_oracle:e} by the oracle");
            for precision in [Precision::Single, Precision::Double] {
                let tolerance = 1e-4;
                let found = apart(&exact(&uneven, &scene, tolerance, precision), &truth(&even, &scene));
                assert!(found < 1.1 * tolerance, "lit {lit}: {found:e} by {precision:?}");
            }
            let marched = apart(&pixels(&uneven, &scene, MARCH), &pixels(&even, &scene, MARCH));
            assert!(marched < 1e-4, "lit {lit}: {marched:e} by marching");
        }
    }
}

#[test]
fn the_optical_depth_of_a_ramp_is_its_mean_extinction_times_length() {
    // Extinction rises linearly over all values, so that the depth is known from the values at both ends.
    let (low, high, most_per_mm) = (-4000.0, 4000.0, 0.05);
    let knots = [(low, 0.0, BONE), (high, most_per_mm, BONE)];
    let term = Term { curve: curve(&knots), weight: None };
    let scene = plain(TransferFunction::new([low, high], 1000.0, vec![term]).unwrap());
    let volume = on(sheared_grid(), Some(slices()), linear);
    let oracle = Oracle::new(&volume, &scene);
    let grid = sheared_grid();
    let mut met = 0;
    for ray in rays_through(&grid, 200, 5) {
        let Some([from, to]) = pellucid::verify::chord_mm(&grid, &ray) else { continue };
        let Ray { origin_mm, direction } = ray;
        let middle = linear(origin_mm + 0.5 * (from + to) * direction);
        let expected = (to - from) * most_per_mm * (middle - low) / (high - low);
        let found = oracle.segment(&ray, 0.0, f64::INFINITY).optical_depth;
        assert!((found - expected).abs() < 2e-7 * (1.0 + expected), "found {found}, expected {expected}");
        met += 1;
    }
    assert!(met > 100, "only {met} rays met the volume");
}
