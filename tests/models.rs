//! Pictures that are not of light, or of a part of it: numbers along rays, level surfaces, absorption and emission alone,
//! radiographs; held against the oracle and closed forms.

mod closed_forms;
mod marched;
mod marched_surfaces;
mod radiographs;
mod transport;

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::integrate::render;
use pellucid::oracle::Oracle;
use pellucid::plan::{Exact, Method};
use pellucid::scene::{Background, Model, Projection, Scene, Surface, ValueModel, ValueOf};
use pellucid::volume::{Rescale, Volume};

use crate::support::scenes::{
    BLUE, BONE, RED, rough_volume, scene_around, thin_shell, two_colors, two_lights, unit_grid, volume_of,
};

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

/// Numbers of the values alone.
const NUMBERS: [ValueOf; 5] =
    [ValueOf::Maximum, ValueOf::Minimum, ValueOf::Mean, ValueOf::Sum, ValueOf::LocalMaximum { threshold: 250.0 }];

fn values(volume: &Volume, of: ValueOf) -> Scene {
    let window = if of == ValueOf::Sum { [-1000.0, 7000.0] } else { [-700.0, 1200.0] };
    let model = Model::Value(ValueModel { of, window });
    Scene { model, ..scene_around(volume, vec![], None, [24, 24]) }
}

#[test]
fn numbers_of_the_values_agree_with_the_oracle_for_any_rescale() {
    for rescale in [Rescale::IDENTITY, Rescale { slope: -0.5, intercept: 200.0 }] {
        let volume = rough_volume(9).with_rescale(rescale);
        for of in NUMBERS {
            let error = greatest_error(&volume, &values(&volume, of));
            assert!(error < 1e-10, "{of:?}, {rescale:?}: error {error:e}");
        }
    }
}

#[test]
fn local_maxima_agree_with_the_oracle_for_any_threshold() {
    let volume = rough_volume(9);
    let shown = |threshold| values(&volume, ValueOf::LocalMaximum { threshold });
    for threshold in [-5000.0, -200.0, 250.0, 700.0, 5000.0] {
        let error = greatest_error(&volume, &shown(threshold));
        assert!(error < 1e-10, "from {threshold} HU: error {error:e}");
    }
    // And they differ from the overall one, where the threshold is low.
    let ray = shown(0.0).camera.pixel_ray(12, 12);
    let [low, high] = [250.0, 5000.0].map(|threshold| Oracle::new(&volume, &shown(threshold)).radiance(&ray)[0]);
    assert!(low < high, "first local maximum {low}, overall maximum {high}");
}

#[test]
fn optical_depths_agree_with_the_oracle_in_one_and_two_dimensions() {
    for rescale in [Rescale::IDENTITY, Rescale { slope: -0.5, intercept: 200.0 }] {
        let volume = rough_volume(9).with_rescale(rescale);
        for terms in [vec![two_colors()], vec![two_colors(), thin_shell()]] {
            let of = ValueOf::OpticalDepth;
            let model = Model::Value(ValueModel { of, window: [0.0, 8.0] });
            let scene = Scene { model, ..scene_around(&volume, terms, None, [24, 24]) };
            let error = greatest_error(&volume, &scene);
            let reads_gradient = scene.transfer_function.reads_gradient();
            assert!(error < 1e-10, "reads the gradient {reads_gradient}, {rescale:?}: error {error:e}");
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
    let rendered = render(&volume, &scene, &Method::Exact(Exact::within(1e-3)), &|_| {}).unwrap();
    let covered: f64 = rendered.image.pixels().iter().map(|p| f64::from(p[3])).sum::<f64>() * 0.04;
    let expected = std::f64::consts::PI * radius * radius;
    assert!((covered / expected - 1.0).abs() < 5e-3, "covered {covered} mm², expected {expected} mm²");
}
