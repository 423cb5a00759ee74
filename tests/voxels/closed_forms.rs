//! What formulas say of RGBA volumes.

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::oracle::Oracle;
use pellucid::scene::Ray;
use pellucid::volume::{ColorEncoding, Grid, RgbaEncoding};

use super::{colors, rgba};
use crate::support::scenes::{difference, rays_through, unit_grid};

#[test]
fn a_homogeneous_volume_is_beer_and_lambert() {
    let grid = Grid::axis_aligned([5, 4, 6], DVec3::new(0.7, 1.3, 2.0)).unwrap();
    for (alpha, length_mm) in [(1, 0.5), (128, 0.5), (128, 20.0), (255, 3.0)] {
        let volume = rgba(grid, vec![[255, 51, 0, alpha]; 120], length_mm);
        let scene = colors(&volume, [1, 1]);
        let (oracle, exact) = (Oracle::new(&volume, &scene), tracer(&volume, &scene, 1e-4, Precision::Single));
        let opacity = (f64::from(alpha) / 255.0).min(1.0 - (-24.0_f64).exp2());
        let extinction = -(-opacity).ln_1p() / length_mm;
        for ray in rays_through(&grid, 40, 2) {
            let Some(traced) = exact.trace(&ray) else { continue };
            let (low, high) = grid.index_bounds();
            let (from, step) = (grid.lps_mm_to_index().transform_point3(ray.origin_mm), DVec3::new(0.7, 1.3, 2.0));
            let (a, b) = ((low - from) * step / ray.direction, (high - from) * step / ray.direction);
            let length = a.max(b).min_element() - a.min(b).max_element();
            let absorbed = -(-extinction * length).exp_m1();
            let expected = [absorbed, 0.2 * absorbed, 0.0, absorbed];
            let [r, g, b] = traced.radiance;
            let found = [r, g, b, traced.opacity];
            let error = difference(found, expected);
            // A ray ends where what is left of it is within the tolerance.
            let allowed = if absorbed < 0.999 { 1e-12 } else { traced.bound };
            assert!(error < allowed, "alpha {alpha} over {length_mm} mm: found {found:?}, expected {expected:?}");
            let error = difference(oracle.radiance(&ray), expected);
            assert!(error < 1e-12, "the oracle, alpha {alpha} over {length_mm} mm: error {error:e}");
        }
    }
}

#[test]
fn the_color_of_a_transparent_voxel_does_not_bleed() {
    // Opaque red beside transparent green.
    let volume = rgba(unit_grid([2, 1, 1]), vec![[255, 0, 0, 200], [0, 255, 0, 0]], 0.25);
    let scene = colors(&volume, [1, 1]);
    for x in [0.0, 0.25, 0.5, 0.999] {
        let ray = Ray { origin_mm: DVec3::new(x, 0.0, -5.0), direction: DVec3::Z };
        let [r, g, b, alpha] = Oracle::new(&volume, &scene).radiance(&ray);
        assert!(r > 0.0 && (r - alpha).abs() < 1e-15, "at {x}: as red as it is opaque, found {r} of {alpha}");
        assert_eq!([g, b], [0.0; 2], "at {x}: no green");
        let found = tracer(&volume, &scene, 1e-3, Precision::Single).trace(&ray).expect("the ray meets the volume");
        assert_eq!(found.radiance[1..], [0.0; 2], "at {x}: no green");
    }
}

#[test]
fn a_linear_ramp_of_extinction_is_its_closed_form() {
    let volume = rgba(unit_grid([2, 1, 1]), vec![[255, 255, 255, 0], [255, 255, 255, 240]], 1.0);
    let scene = colors(&volume, [1, 1]);
    let along = Ray { origin_mm: DVec3::new(-3.0, 0.0, 0.0), direction: DVec3::X };
    // σ rises linearly from 0 to σ₁ over 1 mm: τ = σ₁/2, so that 1 − T is the root of what alpha leaves.
    let expected = 1.0 - (1.0 - 240.0 / 255.0_f64).sqrt();
    for found in [
        Oracle::new(&volume, &scene).radiance(&along)[3],
        tracer(&volume, &scene, 1e-3, Precision::Single).trace(&along).unwrap().opacity,
    ] {
        assert!((found - expected).abs() < 1e-14, "found {found}, expected {expected}");
    }
}

#[test]
fn the_opacity_of_twice_the_length_is_half_the_extinction() {
    let texels: Vec<[u8; 4]> = (0..27).map(|i: u8| [9 * i, 255 - 9 * i, 128, 8 * i]).collect();
    let volume = rgba(unit_grid([3, 3, 3]), texels, 1.0);
    let twice = RgbaEncoding { opacity_length_mm: 2.0, color: ColorEncoding::Linear };
    let half = volume.clone().with_rgba_encoding(twice);
    let scene = colors(&volume, [1, 1]);
    for ray in rays_through(volume.grid(), 20, 4) {
        let depth = |volume| -(-Oracle::new(volume, &scene).radiance(&ray)[3]).ln_1p();
        let (whole, halved) = (depth(&volume), depth(&half));
        assert!((whole - 2.0 * halved).abs() < 1e-12, "optical depths {whole} and {halved}");
    }
}
