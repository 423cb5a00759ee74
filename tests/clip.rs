//! Clipping: closed forms, the oracle, the same volume cropped, and that what cuts nothing off changes nothing.

use glam::{DAffine3, DMat3, DVec3};
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::integrate::{Schedule, render, render_scheduled};
use pellucid::oracle::Oracle;
use pellucid::plan::{Exact, Lattice, March, Method, SampleRule};
use pellucid::scene::{Background, Clip, Effects, HalfSpace, Model, Ray, Scene, Surface, ValueModel, ValueOf};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};
use proptest::prelude::*;

use crate::march::scenes::{MARCH, apart};
use crate::properties;
use crate::support::scenes::{
    BLUE, BONE, RED, difference, function_1d, rays_through, rough_volume, scene, scene_around, thin_shell, two_colors,
    two_lights, unit_grid, volume_of,
};

fn half_space(normal: [f64; 3], offset_mm: f64) -> HalfSpace {
    HalfSpace { normal: normal.into(), offset_mm }
}

fn clipped(scene: Scene, half_spaces: Vec<HalfSpace>) -> Scene {
    Scene { effects: Effects { clip: Clip { half_spaces }, ..scene.effects }, ..scene }
}

fn exact(tolerance: f64) -> Method {
    Method::Exact(Exact::within(tolerance))
}

fn pixels(volume: &Volume, scene: &Scene, method: &Method) -> Vec<[f32; 4]> {
    render(volume, scene, method, &|_| ()).expect("it renders").image.pixels().to_vec()
}

/// Alpha of one ray by every integrator that traces rays alone.
fn alphas(volume: &Volume, scene: &Scene, ray: &Ray) -> [f64; 3] {
    let exact = |precision| tracer(volume, scene, 1e-4, precision).trace(ray).map_or(0.0, |t| t.opacity);
    [exact(Precision::Single), exact(Precision::Double), Oracle::new(volume, scene).radiance(ray)[3]]
}

#[test]
fn a_homogeneous_slab_shows_the_length_between_the_planes() {
    let volume = volume_of(unit_grid([21; 3]), |_| 100.0);
    let sigma = 0.07;
    let base = scene(function_1d(&[(0.0, sigma, RED), (200.0, sigma, RED)]));
    let (along, angle) = (DVec3::Z, 0.9_f64);
    // A plane that is inclined by `angle` to the ray meets it where its distance along the normal says.
    let inclined = half_space([angle.sin(), 0.0, angle.cos()], 8.0);
    for distance in [3.0, 1e3, 1e6] {
        let ray = Ray { origin_mm: DVec3::new(5.0, 6.25, -distance), direction: along };
        let meets = (8.0 - 5.0 * angle.sin()) / angle.cos();
        for (half_spaces, length_mm) in [
            (vec![], 20.0),
            (vec![half_space([0.0, 0.0, 1.0], 4.5)], 15.5),
            (vec![half_space([0.0, 0.0, 2.0], 9.0), half_space([0.0, 0.0, -1.0], -5.25)], 0.75),
            (vec![inclined], 20.0 - meets),
            (vec![inclined, half_space([0.0, 0.0, -1.0], -19.0)], 19.0 - meets),
            (vec![half_space([0.0, 0.0, -1.0], 0.5)], 0.0),
            (vec![half_space([1.0, 0.0, 0.0], 5.5)], 0.0),
            (vec![half_space([1.0, 0.0, 0.0], 4.5)], 20.0),
        ] {
            let scene = clipped(base.clone(), half_spaces.clone());
            let expected = -(-sigma * length_mm).exp_m1();
            for found in alphas(&volume, &scene, &ray) {
                assert!(
                    (found - expected).abs() < 3e-7,
                    "{half_spaces:?}, {distance} mm: {found}, expected {expected}"
                );
            }
        }
    }
}

#[test]
fn a_camera_behind_the_plane_sees_what_is_ahead_of_it() {
    let volume = volume_of(unit_grid([21; 3]), |_| 100.0);
    let base = scene(function_1d(&[(0.0, 0.1, RED)]));
    let inside = Ray { origin_mm: DVec3::new(5.0, 5.0, 10.0), direction: DVec3::Z };
    for (offset_mm, length_mm) in [(4.0, 10.0), (15.0, 5.0)] {
        let scene = clipped(base.clone(), vec![half_space([0.0, 0.0, 1.0], offset_mm)]);
        let expected = -(-0.1_f64 * length_mm).exp_m1();
        for found in alphas(&volume, &scene, &inside) {
            assert!((found - expected).abs() < 3e-7, "plane at {offset_mm}: {found}, expected {expected}");
        }
    }
}

/// A volume whose voxels look random, on this affine, and the part of it from voxel 2 to voxel 6 along each axis.
fn whole_and_cropped(affine: DAffine3) -> (Volume, Volume) {
    let value = |index: [usize; 3]| ((index[0] * 7919 + index[1] * 104_729 + index[2] * 1_299_709) % 1700) as i16 - 600;
    let made = |first: usize, n: usize| {
        let corner = affine.transform_point3(DVec3::splat(first as f64));
        let grid = Grid::new([n; 3], DAffine3::from_mat3_translation(affine.matrix3, corner)).unwrap();
        let samples = (0..grid.voxel_count()).map(|i| value(grid.unflatten(i).map(|x| x + first))).collect();
        Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap()
    };
    (made(0, 9), made(2, 5))
}

/// The half-spaces of voxels `low` to `high` along each axis.
fn voxels(grid: &Grid, low: f64, high: f64) -> Vec<HalfSpace> {
    let rows = grid.lps_mm_to_index().matrix3.transpose();
    let of_origin = grid.lps_mm_to_index().translation;
    (0..3)
        .flat_map(|a| {
            let row = rows.col(a);
            [(row, low - of_origin[a]), (-row, of_origin[a] - high)]
                .map(|(normal, offset_mm)| HalfSpace { normal, offset_mm })
        })
        .collect()
}

#[test]
fn a_box_of_voxels_shows_what_the_cropped_volume_shows() {
    let sheared = DMat3::from_cols(DVec3::new(0.9, 0.1, 0.0), DVec3::new(-0.2, 1.1, 0.3), DVec3::new(0.0, 0.4, -1.6));
    let mirrored = DMat3::from_cols(sheared.y_axis, sheared.x_axis, sheared.z_axis);
    let turned = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
    for matrix in [sheared, mirrored, turned] {
        let (whole, cropped) =
            whole_and_cropped(DAffine3::from_mat3_translation(matrix, DVec3::new(50.0, -70.0, 11.0)));
        // Without gradients, which differ at the border of the cropped volume.
        let base = scene_around(&cropped, vec![two_colors()], None, [24, 24]);
        let models = [
            Model::Light,
            Model::Value(ValueModel { of: ValueOf::Maximum, window: [-700.0, 1200.0] }),
            Model::Value(ValueModel { of: ValueOf::Mean, window: [-700.0, 1200.0] }),
            Model::Surfaces(vec![Surface { value: 300.0, opacity: 0.5, color: BONE }]),
        ];
        for model in models {
            let part = Scene { model, ..base.clone() };
            let boxed = clipped(part.clone(), voxels(whole.grid(), 2.0, 6.0));
            let light = part.model == Model::Light;
            let methods = [(exact(1e-4), 2e-4), (Method::March(MARCH), 1e-5), (Method::Reference, 1e-9)];
            for (method, allowed) in methods.into_iter().filter(|(m, _)| light || !matches!(m, Method::March(_))) {
                let (found, expected) = (pixels(&whole, &boxed, &method), pixels(&cropped, &part, &method));
                let worst = apart(&found, &expected);
                assert!(worst < allowed, "{method:?}, {:?}: {worst:e} from the cropped volume", part.model);
                let shown = apart(&found, &pixels(&whole, &part, &method));
                assert!(shown > 0.01, "{method:?}: the box takes part");
            }
        }
    }
}

#[test]
fn planes_that_cut_nothing_off_change_no_bit() {
    let volume = rough_volume(12);
    let far: Vec<HalfSpace> =
        (0..3).flat_map(|a| [DVec3::AXES[a], -DVec3::AXES[a]]).map(|n| half_space(n.to_array(), -1e3)).collect();
    let terms = vec![two_colors(), thin_shell()];
    let light = scene_around(&volume, terms, Some(two_lights(true)), [24, 24]);
    let maximum = Model::Value(ValueModel { of: ValueOf::Maximum, window: [-700.0, 1200.0] });
    let surfaces = Model::Surfaces(vec![Surface { value: 100.0, opacity: 0.4, color: BLUE }]);
    for model in [Model::Light, maximum, surfaces] {
        let plain = Scene { model, ..light.clone() };
        for method in [exact(1e-3), Method::March(MARCH), Method::Reference] {
            if plain.model != Model::Light && matches!(method, Method::March(_)) {
                continue;
            }
            let [a, b] = [plain.clone(), clipped(plain.clone(), far.clone())].map(|s| pixels(&volume, &s, &method));
            assert!(a == b, "{method:?}, {:?}", plain.model);
        }
    }
}

#[test]
fn the_largest_value_is_that_of_the_part_that_is_shown() {
    let volume = volume_of(unit_grid([11, 5, 5]), |[i, _, _]| 100.0 * i as f64);
    let ray = Ray { origin_mm: DVec3::new(-4.0, 2.2, 1.7), direction: DVec3::X };
    let between = vec![half_space([1.0, 0.0, 0.0], 2.25), half_space([-1.0, 0.0, 0.0], -6.5)];
    for (of, expected) in [(ValueOf::Maximum, 650.0), (ValueOf::Minimum, 225.0), (ValueOf::Mean, 437.5)] {
        let model = Model::Value(ValueModel { of, window: [0.0, 1000.0] });
        let scene = clipped(Scene { model, ..scene_around(&volume, vec![], None, [1, 1]) }, between.clone());
        let expected = pellucid::image::srgb::decode(expected / 1000.0);
        let found =
            tracer(&volume, &scene, 1e-3, Precision::Single).trace(&ray).expect("it meets the part").radiance[1];
        let truth = Oracle::new(&volume, &scene).radiance(&ray)[1];
        assert!(
            (found - expected).abs() < 1e-12 && (truth - expected).abs() < 1e-12,
            "{of:?}: {found}, {truth}, expected {expected}"
        );
    }
}

#[test]
fn a_face_made_by_clipping_is_no_level_surface() {
    let volume = volume_of(unit_grid([11, 5, 5]), |[i, _, _]| 100.0 * i as f64);
    let ray = Ray { origin_mm: DVec3::new(20.0, 2.2, 1.7), direction: DVec3::NEG_X };
    let base = scene_around(&volume, vec![], None, [1, 1]);
    let base = Scene { model: Model::Surfaces(vec![Surface { value: 500.0, opacity: 0.5, color: RED }]), ..base };
    // Before the clip the ray begins inside the level; behind x = 5 there is no crossing left.
    for (offset_mm, crossings) in [(-8.0, 1), (-5.1, 1), (-4.9, 0)] {
        let scene = clipped(base.clone(), vec![half_space([-1.0, 0.0, 0.0], offset_mm)]);
        let expected = if crossings == 1 { 0.5 } else { 0.0 };
        let found = alphas(&volume, &scene, &ray);
        assert!(
            found.iter().all(|a| (a - expected).abs() < 1e-12),
            "plane at {offset_mm}: {found:?}, expected {expected}"
        );
    }
}

#[test]
fn marching_converges_to_the_oracle_between_planes() {
    let volume = rough_volume(8);
    let center = volume.grid().center_mm();
    let normal = DVec3::new(0.5, 0.7, -0.2);
    let planes = vec![
        HalfSpace { normal, offset_mm: normal.dot(center) - 0.9 },
        half_space([-0.3, 0.1, 0.9], DVec3::new(-0.3, 0.1, 0.9).dot(center) - 1.3),
    ];
    let scene = clipped(scene_around(&volume, vec![two_colors()], Some(two_lights(true)), [12, 12]), planes);
    let truth = pixels(&volume, &scene, &Method::Reference);
    for lattice in [Lattice::PerRay, Lattice::ViewPlanes] {
        for rule in [SampleRule::Midpoint, SampleRule::Trapezoid] {
            let error = |step_mm| {
                apart(&pixels(&volume, &scene, &Method::March(March { step_mm, rule, lattice, ..MARCH })), &truth)
            };
            let (coarse, fine) = (error(0.2), error(0.0125));
            // Second order but for kinks of the field: at least a factor 16 · 2 over four halvings.
            assert!(fine < coarse / 32.0 && fine < 2e-4, "{lattice:?}, {rule:?}: {coarse:e} then {fine:e}");
        }
    }
}

#[test]
fn threads_and_tiles_do_not_matter() {
    let volume = rough_volume(10);
    let plane = half_space([0.5, 0.7, -0.2], DVec3::new(0.5, 0.7, -0.2).dot(volume.grid().center_mm()));
    let scene = clipped(scene_around(&volume, vec![two_colors()], Some(two_lights(true)), [40, 33]), vec![plane]);
    for method in [exact(1e-3), Method::March(MARCH)] {
        let render = |schedule| render_scheduled(&volume, &scene, &method, schedule, &|_| ()).expect("it renders");
        let expected = render(Schedule::default());
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            for schedule in [
                Schedule { shuffled_tiles: Some(5), ..Schedule::default() },
                Schedule { empty_space_skipping: false, ..Schedule::default() },
            ] {
                let found = pool.install(|| render(schedule));
                assert!(found.image.pixels() == expected.image.pixels(), "{method:?}, {threads} threads, {schedule:?}");
            }
        }
    }
}

/// Planes through random points of the volume.
fn planes(volume: &Volume, directions: &[DVec3], seed: u64) -> Vec<HalfSpace> {
    let through = rays_through(volume.grid(), directions.len(), seed);
    let radius = 0.3 * volume.grid().corners_mm()[0].distance(volume.grid().center_mm());
    let point = |ray: &Ray| volume.grid().center_mm() + radius * ray.direction;
    directions
        .iter()
        .zip(&through)
        .map(|(&normal, ray)| HalfSpace { normal, offset_mm: normal.dot(point(ray)) })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn clipped_pictures_are_within_tolerance_and_bound(
        volume in properties::volume(),
        transfer_function in properties::transfer_function(),
        shading in prop::option::of(properties::shading()),
        directions in prop::collection::vec(properties::direction(), 1..5),
        seed in any::<u64>(),
        from in properties::direction(),
        distance in prop_oneof![Just(0.2), 1.2..6.0f64, Just(1e5)],
        tolerance in prop_oneof![Just(1.0 / 255.0), Just(1e-3)],
    ) {
        let camera = properties::camera(volume.grid(), from, distance, seed % 2 == 0);
        let base = Scene { model: Model::Light, transfer_function, shading, camera, background: Background::Transparent, effects: Effects::default() };
        let scene = clipped(base, planes(&volume, &directions, seed));
        properties::held_to_tolerance_and_bound(&volume, &scene, tolerance)?;
    }
}

#[test]
fn a_plane_that_is_off_by_a_hundredth_is_seen() {
    let volume = rough_volume(8);
    let base = scene_around(&volume, vec![two_colors()], None, [12, 12]);
    let normal = DVec3::new(0.5, 0.7, -0.2);
    let at = |mm: f64| {
        clipped(base.clone(), vec![HalfSpace { normal, offset_mm: normal.dot(volume.grid().center_mm()) + mm }])
    };
    let (right, wrong) = (at(0.0), at(0.01));
    let off = (0..144).filter(|&i| {
        let ray = base.camera.pixel_ray(i % 12, i / 12);
        let [a, b] = [&right, &wrong].map(|s| Oracle::new(&volume, s).radiance(&ray));
        difference(a, b) > 1e-4
    });
    assert!(off.count() > 20, "the comparisons above must see such a difference");
}
