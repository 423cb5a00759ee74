//! Extremes, means and level surfaces through uneven slices, held against the oracle and a closed form.

use glam::DVec3;
use pellucid::integrate::exact::Precision;
use pellucid::scene::{Model, Scene, Surface, ValueModel, ValueOf};
use pellucid::volume::{Grid, Slices, Volume};

use super::{exact, on, truth};
use crate::march::scenes::apart;
use crate::support::scenes::{BLUE, BONE, RED, rough_volume, scene_around, two_lights};

fn rough() -> Volume {
    let places = [0.0, 0.1, 1.0, 1.5, 4.0, 4.2, 7.0, 7.1, 8.0];
    rough_volume(9).with_slices(Slices::new(&places).unwrap()).unwrap()
}

fn greatest_error(volume: &Volume, scene: &Scene) -> f64 {
    apart(&exact(volume, scene, 1e-3, Precision::Single), &truth(volume, scene))
}

#[test]
fn numbers_of_the_values_agree_with_the_oracle() {
    let volume = rough();
    for of in [ValueOf::Maximum, ValueOf::Minimum, ValueOf::Mean] {
        let model = Model::Value(ValueModel { of, window: [-700.0, 1200.0] });
        let error = greatest_error(&volume, &Scene { model, ..scene_around(&volume, vec![], None, [24, 24]) });
        assert!(error < 1e-12, "{of:?}: error {error:e}");
    }
}

#[test]
fn surfaces_agree_with_the_oracle() {
    let volume = rough();
    for shading in [None, Some(two_lights(true))] {
        let surface = |value, opacity, color| Surface { value, opacity, color };
        let surfaces = vec![surface(-250.5, 0.3, RED), surface(100.5, 0.5, BLUE), surface(700.5, 1.0, BONE)];
        let model = Model::Surfaces(surfaces);
        let lit = shading.is_some();
        let error = greatest_error(&volume, &Scene { model, ..scene_around(&volume, vec![], shading, [24, 24]) });
        assert!(error < 1e-7, "lit {lit}: error {error:e}");
    }
}

#[test]
fn the_mean_of_the_values_counts_lengths_not_slices() {
    // 0 up to the second last slice and 100 on the last: a ramp over half of the length.
    let grid = Grid::axis_aligned([2, 2, 4], DVec3::ONE).unwrap();
    let slices = Slices::new(&[0.0, 1.0, 2.0, 4.0]).unwrap();
    let volume = on(grid, Some(slices), |at| if at.z > 2.9 { 100.0 } else { 0.0 });
    let model = Model::Value(ValueModel { of: ValueOf::Mean, window: [0.0, 100.0] });
    let scene = Scene { model, ..scene_around(&volume, vec![], None, [1, 1]) };
    let ray = pellucid::scene::Ray { origin_mm: DVec3::new(0.5, 0.5, -5.0), direction: DVec3::Z };
    let found = pellucid::integrate::exact::tracer(&volume, &scene, 1e-3, Precision::Double).trace(&ray).unwrap();
    let expected = pellucid::image::srgb::decode(0.25);
    assert!((found.radiance[0] - expected).abs() < 1e-12, "found {}, expected {expected}", found.radiance[0]);
}
