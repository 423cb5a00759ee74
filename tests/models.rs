//! Pictures that are not of light: extremes, means and level surfaces, held against the oracle and closed forms.

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::integrate::render;
use pellucid::oracle::Oracle;
use pellucid::plan::{Exact, Method};
use pellucid::scene::{Background, Model, Projection, Scene, Surface, ValueModel, ValueOf};
use pellucid::volume::{Rescale, Volume};

use crate::support::scenes::{BLUE, BONE, RED, rough_volume, scene_around, two_lights, unit_grid, volume_of};

fn greatest_error(volume: &Volume, scene: &Scene) -> f64 {
    let oracle = Oracle::new(volume, scene);
    let tracer = tracer(volume, scene, 1e-3, Precision::Single);
    let [width, height] = scene.camera.size();
    let mut worst = 0.0;
    for pixel in 0..width * height {
        let ray = scene.camera.pixel_ray(pixel % width, pixel / width);
        let truth = oracle.radiance(&ray);
        let found = tracer.trace(&ray).map_or([0.0; 4], |t| {
            let [r, g, b] = t.radiance;
            [r, g, b, t.opacity]
        });
        for (x, t) in found.into_iter().zip(truth) {
            let error = if x.is_nan() { f64::INFINITY } else { (x - t).abs() };
            worst = f64::max(worst, error);
        }
    }
    worst
}

fn values(volume: &Volume, of: ValueOf) -> Scene {
    let model = Model::Value(ValueModel { of, window: [-700.0, 1200.0] });
    Scene { model, ..scene_around(volume, vec![], None, [24, 24]) }
}

#[test]
fn numbers_of_the_values_agree_with_the_oracle_for_any_rescale() {
    for rescale in [Rescale::IDENTITY, Rescale { slope: -0.5, intercept: 200.0 }] {
        let volume = rough_volume(9).with_rescale(rescale);
        for of in [ValueOf::Maximum, ValueOf::Minimum, ValueOf::Mean] {
            let error = greatest_error(&volume, &values(&volume, of));
            assert!(error < 1e-12, "{of:?}, {rescale:?}: error {error:e}");
        }
    }
}

#[test]
fn the_largest_smallest_and_mean_value_of_a_ramp_are_known() {
    let volume = volume_of(unit_grid([11, 5, 5]), |[i, _, _]| 100.0 * i as f64);
    let ray = pellucid::scene::Ray { origin_mm: DVec3::new(-4.0, 2.2, 1.7), direction: DVec3::X };
    for (of, expected) in [(ValueOf::Maximum, 1000.0), (ValueOf::Minimum, 0.0), (ValueOf::Mean, 500.0)] {
        let scene = Scene {
            model: Model::Value(ValueModel { of, window: [0.0, 1000.0] }),
            ..scene_around(&volume, vec![], None, [4, 4])
        };
        let found = tracer(&volume, &scene, 1e-3, Precision::Single).trace(&ray).expect("the ray meets the volume");
        let expected = pellucid::image::srgb::decode(expected / 1000.0);
        assert!(
            (found.radiance[1] - expected).abs() < 1e-12,
            "{of:?}: found {}, expected {expected}",
            found.radiance[1]
        );
    }
}

fn levels() -> Vec<Surface> {
    let surface = |value, opacity, color| Surface { value, opacity, color };
    vec![surface(-100.0, 0.2, RED), surface(300.0, 0.5, BONE), surface(301.0, 0.9, BLUE)]
}

#[test]
fn translucent_surfaces_agree_with_the_oracle_lit_and_unlit() {
    let volume = rough_volume(9);
    for shading in [None, Some(two_lights(true)), Some(two_lights(false))] {
        let lit = shading.is_some();
        let scene = Scene { model: Model::Surfaces(levels()), ..scene_around(&volume, vec![], shading, [24, 24]) };
        let error = greatest_error(&volume, &scene);
        assert!(error < 1e-9, "lit {lit}: error {error:e}");
    }
}

#[test]
fn a_level_that_is_off_by_a_unit_is_seen() {
    let volume = rough_volume(9);
    let scene = |value| Scene {
        model: Model::Surfaces(vec![Surface { value, opacity: 1.0, color: RED }]),
        ..scene_around(&volume, vec![], Some(two_lights(true)), [24, 24])
    };
    let (right, wrong) = (scene(300.0), scene(301.0));
    let ray = right.camera.pixel_ray(12, 12);
    let truth = Oracle::new(&volume, &right).radiance(&ray)[0];
    let found = tracer(&volume, &wrong, 1e-3, Precision::Single).trace(&ray).expect("met").radiance[0];
    assert!((found - truth).abs() > 1e-6, "the comparison above must see the difference, found {found} and {truth}");
}

#[test]
fn an_opaque_sphere_covers_its_disc() {
    let (n, radius) = (41, 14.0);
    let center = (n - 1) as f64 / 2.0;
    let volume = volume_of(unit_grid([n; 3]), |index| {
        let d = DVec3::from_array(index.map(|i| i as f64 - center)).length();
        1000.0 * (radius - d)
    });
    let mut scene = scene_around(&volume, vec![], None, [200, 200]);
    scene.model = Model::Surfaces(vec![Surface { value: 0.0, opacity: 1.0, color: [1.0; 3] }]);
    let eye = volume.grid().center_mm() - 100.0 * DVec3::Y;
    let projection = Projection::Parallel { height_mm: 40.0 };
    scene.camera =
        pellucid::scene::Camera::look_at(eye, volume.grid().center_mm(), DVec3::Z, projection, [200, 200]).unwrap();
    scene.background = Background::Transparent;
    let rendered = render(&volume, &scene, &Method::Exact(Exact { tolerance: 1e-3 }), &|_| {}).unwrap();
    let covered: f64 = rendered.image.pixels().iter().map(|p| f64::from(p[3])).sum::<f64>() * 0.04;
    let expected = std::f64::consts::PI * radius * radius;
    assert!((covered / expected - 1.0).abs() < 5e-3, "covered {covered} mm², expected {expected} mm²");
}
