//! The exact integrator within its tolerance and its bound of the oracle, over random volumes; the oracle's two methods
//! against each other.

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::oracle::Oracle;
use pellucid::scene::{Projection, Scene};
use pellucid::volume::{ColorEncoding, Grid, Quantity, Rescale, RgbaEncoding, Samples, Volume};
use proptest::prelude::*;

use super::{at_voxels, colored_ball, colors};
use crate::support::scenes::{
    difference, rays_through, rough_volume, scene_around, thin_shell, two_colors, two_lights,
};

fn volume() -> impl Strategy<Value = Volume> {
    let grid = (prop::array::uniform3(1usize..6), prop::array::uniform3(0.2..4.0f64))
        .prop_map(|(dims, spacing)| Grid::axis_aligned(dims, spacing.into()).expect("a valid grid"));
    let alpha = prop_oneof![Just(0u16), Just(65_535), 0..3000u16, any::<u16>()];
    let color = prop_oneof![Just(ColorEncoding::Srgb), Just(ColorEncoding::Linear)];
    (grid, 0.05..20.0f64, color, any::<bool>()).prop_flat_map(move |(grid, opacity_length_mm, color, wide)| {
        let texel = (prop::array::uniform3(any::<u16>()), alpha.clone()).prop_map(|([r, g, b], a)| [r, g, b, a]);
        prop::collection::vec(texel, grid.voxel_count()).prop_map(move |texels| {
            let samples = if wide {
                Samples::Rgba16(texels)
            } else {
                Samples::Rgba8(texels.into_iter().map(|texel| texel.map(|x| (x >> 8) as u8)).collect())
            };
            let volume = Volume::new(grid, samples, Rescale::IDENTITY, Quantity::Arbitrary).expect("valid texels");
            volume.with_rgba_encoding(RgbaEncoding { opacity_length_mm, color })
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn pictures_of_colors_are_within_tolerance_and_bound(
        volume in volume(),
        seed in any::<u64>(),
        tolerance in prop_oneof![Just(1.0 / 255.0), Just(1e-3), Just(1e-5)],
    ) {
        let scene = colors(&volume, [1, 1]);
        let (oracle, exact) = (Oracle::new(&volume, &scene), tracer(&volume, &scene, tolerance, Precision::Single));
        for ray in rays_through(volume.grid(), 4, seed) {
            let truth = oracle.radiance(&ray);
            let Some(found) = exact.trace(&ray) else {
                prop_assert_eq!(truth, [0.0; 4], "missed, but the oracle sees something");
                continue;
            };
            let [r, g, b] = found.radiance;
            let error = difference([r, g, b, found.opacity], truth);
            prop_assert!(error <= found.bound, "error {:e}, bound {:e}", error, found.bound);
            prop_assert!(found.bound <= 1.001 * tolerance, "bound {:e} over tolerance {:e}", found.bound, tolerance);
        }
    }
}

/// Scenes classified at the voxels, of a volume rougher than any scan.
fn scenes(volume: &Volume) -> Vec<(&'static str, Scene)> {
    let shell = vec![two_colors(), thin_shell()];
    let mut scenes: Vec<(&str, Scene)> = [
        ("1D", vec![two_colors()], None),
        ("2D", shell.clone(), None),
        ("1D lit", vec![two_colors()], Some(two_lights(true))),
        ("2D lit, one-sided", shell, Some(two_lights(false))),
    ]
    .map(|(name, terms, shading)| (name, at_voxels(&scene_around(volume, terms, shading, [24, 24]))))
    .to_vec();
    let mut parallel = scenes[3].1.clone();
    let camera = parallel.camera;
    let projection = Projection::Parallel { height_mm: 20.0 };
    let center = volume.grid().center_mm();
    parallel.camera =
        pellucid::scene::Camera::look_at(camera.position_mm(), center, DVec3::Z, projection, [24, 24]).unwrap();
    scenes.push(("2D lit, parallel", parallel));
    scenes
}

#[test]
fn pictures_classified_at_the_voxels_are_within_tolerance_and_bound() {
    for rescale in [Rescale::IDENTITY, Rescale { slope: -0.5, intercept: 100.0 }] {
        let volume = rough_volume(14).with_rescale(rescale);
        for (name, scene) in scenes(&volume) {
            let oracle = Oracle::new(&volume, &scene);
            for tolerance in [1.0 / 255.0, 1e-4] {
                let exact = tracer(&volume, &scene, tolerance, Precision::Single);
                let mut worst = 0.0_f64;
                for pixel in 0..24 * 24 {
                    let ray = scene.camera.pixel_ray(pixel % 24, pixel / 24);
                    let truth = oracle.radiance(&ray);
                    let Some(found) = exact.trace(&ray) else {
                        assert_eq!(truth, [0.0; 4], "{name}: pixel {pixel} is missed");
                        continue;
                    };
                    let [r, g, b] = found.radiance;
                    let error = difference([r, g, b, found.opacity], truth);
                    assert!(error <= found.bound, "{name}: error {error:e} of bound {:e}", found.bound);
                    worst = worst.max(error);
                }
                assert!(worst <= tolerance, "{name}: error {worst:e} over tolerance {tolerance:e}");
                assert!(worst > 1e-3 * tolerance, "{name}: nothing was traded for time, error {worst:e}");
            }
        }
    }
}

#[test]
fn the_oracles_methods_agree() {
    let ball = colored_ball(12);
    let rough = rough_volume(9);
    let mut all: Vec<(&str, &Volume, Scene)> = vec![("RGBA", &ball, colors(&ball, [1, 1]))];
    all.extend(scenes(&rough).into_iter().map(|(name, scene)| (name, &rough, scene)));
    for (name, volume, scene) in all {
        let oracle = Oracle::new(volume, &scene);
        for ray in rays_through(volume.grid(), 30, 11) {
            let panels = oracle.segment(&ray, 0.0, f64::INFINITY).rgba();
            let collocation = oracle.segment_by_collocation(&ray, 0.0, f64::INFINITY).rgba();
            let error = difference(panels, collocation);
            assert!(error < 1e-12, "{name}: error {error:e}, {ray:?}");
        }
    }
}

#[test]
fn the_comparison_fails_for_colors_that_are_slightly_wrong() {
    let volume = colored_ball(12);
    let Some(RgbaEncoding { opacity_length_mm, color }) = volume.rgba_encoding() else { panic!("no colours") };
    let other = RgbaEncoding { opacity_length_mm: 1.01 * opacity_length_mm, color };
    let wrong = volume.clone().with_rgba_encoding(other);
    let scene = colors(&volume, [1, 1]);
    let (oracle, exact) = (Oracle::new(&volume, &scene), tracer(&wrong, &scene, 1e-4, Precision::Single));
    let rays = rays_through(volume.grid(), 200, 8);
    let off = rays.iter().filter(|ray| {
        exact.trace(ray).is_some_and(|found| (found.opacity - oracle.radiance(ray)[3]).abs() > found.bound)
    });
    assert!(off.count() > 50, "a length that is 1 % too long must break the bound");
}
