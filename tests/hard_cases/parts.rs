//! Parts that renderers are made of, on their own.

use glam::DVec3;
use pellucid::field::{GradientUnits, Macrocells, Position, Trilinear, Voxel, gradient_magnitude_per_mm};
use pellucid::image::srgb::{decode8, encode8};
use pellucid::integrate::render;
use pellucid::plan::{Exact, Method};
use pellucid::scene::Background;
use pellucid::transfer::shapes::extinction_per_mm;
use pellucid::volume::Samples;

use super::{camera_along, settings};
use crate::support::scenes::{function_1d, next_unit, noise_hu, ray, scene, unit_grid, volume_i16};

#[test]
fn opacity_correction_keeps_its_digits() {
    // Opacity over 1 mm to opacity over r mm: 1 - (1 - a)^r, written so that nothing cancels.
    for opacity in [0.0, 1e-18, 1e-8, 1e-6, 0.5, 1.0 - 1e-7, 1.0] {
        for ratio in [0.0, 0.01, 0.5, 2.0, 100.0] {
            let found = -(-extinction_per_mm(opacity, 1.0) * ratio).exp_m1();
            let most = 1.0 - (-24_f64).exp2();
            let expected = -(ratio * (-opacity.min(most)).ln_1p()).exp_m1();
            let error = (found - expected).abs();
            assert!(
                error <= 1e-15 * expected,
                "opacity {opacity:e} over {ratio} mm: found {found:e}, expected {expected:e}"
            );
            assert!((0.0..=1.0).contains(&found), "opacity {opacity:e} over {ratio} mm: found {found:e}");
        }
        let over_half = extinction_per_mm(opacity, 0.5);
        let apart = (over_half - 2.0 * extinction_per_mm(opacity, 1.0)).abs();
        assert!(apart <= 1e-15 * over_half, "half the length needs twice the extinction: found {over_half}");
    }
}

#[test]
fn greys_survive_encoding_and_half_of_white_is_188() {
    for level in 0..=255 {
        let grey = [level, level, level, 255];
        assert_eq!(encode8(decode8(grey)), grey, "level {level}");
    }
    // Fog that lets half of the light through, white before black. Compositing encoded values would give 128.
    let volume = volume_i16(unit_grid([11, 3, 3]), vec![0; 99]);
    let half = scene(function_1d(&[(0.0, 0.1 * std::f64::consts::LN_2, [1.0; 3])]));
    let camera = camera_along(&ray([-4.0, 1.25, 0.6], [1.0, 0.0, 0.0]));
    let half = pellucid::Scene { camera, background: Background::Color([0.0; 3]), ..half };
    for method in [Method::Exact(Exact::within(1e-4)), Method::March(settings(0.1)), Method::Reference] {
        let picture = render(&volume, &half, &method, &|_| ()).expect("a picture");
        assert_eq!(encode8(picture.image.pixel(0, 0)), [188, 188, 188, 255], "{method:?}");
    }
}

#[test]
fn what_is_interpolated_lies_in_the_range_of_its_macrocell() {
    for dims in [[20, 17, 33], [9, 8, 1], [16, 16, 16], [17, 25, 2]] {
        let volume = noise_hu(unit_grid(dims), 40);
        let Samples::I16(samples) = volume.samples() else { panic!("16-bit samples") };
        let values = Trilinear::new(samples, dims).expect("a short lattice");
        let magnitudes = gradient_magnitude_per_mm(&values, &GradientUnits::new(volume.grid(), volume.rescale()));
        let magnitudes = Trilinear::new(&magnitudes, dims).expect("a short lattice");
        assert_in_range("value", &values, dims);
        assert_in_range("gradient magnitude", &magnitudes, dims);
    }
}

fn assert_in_range<V: Voxel>(channel: &str, field: &Trilinear<'_, V>, dims: [usize; 3]) {
    let macrocells = Macrocells::new(field);
    let [across, down, _] = macrocells.blocks();
    let mut state = 41;
    let end = DVec3::from_array(dims.map(|n| (n - 1) as f64));
    for _ in 0..100_000 {
        // A third of the coordinates are whole, where one block ends and the next begins.
        let coordinate = |u: f64, pick: f64, end: f64| if pick < 1.0 / 3.0 { (u * end).round() } else { u * end };
        let at = DVec3::from_array(std::array::from_fn(|a| {
            coordinate(next_unit(&mut state), next_unit(&mut state), end[a])
        }));
        let position = Position::new(at, dims);
        let [i, j, k] = position.block(Macrocells::LOG2_CELLS);
        let [low, high] = macrocells.ranges()[i + across * (j + down * k)];
        let found = field.value(&field.cell(position));
        assert!(low - 1e-3 <= found && found <= high + 1e-3, "{channel} at {at}: {found} not in [{low}, {high}]");
    }
}
