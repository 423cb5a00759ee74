//! Where two media are one by their definitions, and where marching leads to.

use pellucid::Fault;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::integrate::render;
use pellucid::oracle::Oracle;
use pellucid::plan::{March, Method};
use pellucid::scene::Scene;
use pellucid::volume::{Grid, Volume};

use super::{at_voxels, colored_ball, colors};
use crate::march::scenes::MARCH;
use crate::support::scenes::{
    BLUE, BONE, RED, difference, function_1d, headlight, noise_hu, rays_through, rough_volume, scene, scene_around,
    shaded, two_colors, two_lights, unit_grid, volume_of,
};

/// Noise from -600 to 1100 HU, and a function that is linear there, in changing colours.
fn linear() -> (Volume, Scene) {
    let grid = Grid::axis_aligned([7, 6, 5], glam::DVec3::new(1.0, 0.6, 2.0)).unwrap();
    (noise_hu(grid, 9), scene(function_1d(&[(-600.0, 0.01, RED), (1100.0, 0.7, BLUE)])))
}

#[test]
fn a_function_that_is_linear_in_the_value_may_be_evaluated_anywhere() {
    let (volume, samples) = linear();
    let voxels = at_voxels(&samples);
    let exact = tracer(&volume, &voxels, 1e-5, Precision::Single);
    for ray in rays_through(volume.grid(), 100, 3) {
        let truth = Oracle::new(&volume, &samples).radiance(&ray);
        let error = difference(Oracle::new(&volume, &voxels).radiance(&ray), truth);
        assert!(error < 1e-13, "the oracle: error {error:e}, {ray:?}");
        let Some(found) = exact.trace(&ray) else { continue };
        let [r, g, b] = found.radiance;
        let error = difference([r, g, b, found.opacity], truth);
        assert!(error <= found.bound, "exact: error {error:e} of bound {:e}", found.bound);
    }
}

#[test]
fn a_function_with_a_knot_between_the_voxels_differs() {
    // The value passes the top of the tent half way between voxels, where classification at the voxels sees nothing.
    let volume = volume_of(unit_grid([2, 1, 1]), |[i, ..]| 100.0 * i as f64);
    let samples = scene(function_1d(&[(0.0, 0.0, BONE), (50.0, 2.0, BONE), (100.0, 0.0, BONE)]));
    let ray = crate::support::scenes::ray([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    let alpha = |scene: &Scene| Oracle::new(&volume, scene).radiance(&ray)[3];
    let expected = 1.0 - (-1.0_f64).exp();
    assert!((alpha(&samples) - expected).abs() < 1e-14, "found {}, expected {expected}", alpha(&samples));
    assert_eq!(alpha(&at_voxels(&samples)), 0.0);
}

#[test]
fn shading_at_the_voxels_with_ambient_light_alone_is_no_shading() {
    let (volume, scene) = linear();
    let mut ambient = headlight();
    (ambient.ambient, ambient.diffuse, ambient.specular) = (1.0, 0.0, 0.0);
    let (plain, lit) = (at_voxels(&scene), at_voxels(&shaded(scene.clone(), ambient)));
    for ray in rays_through(volume.grid(), 30, 9) {
        let [plain, lit] = [&plain, &lit].map(|scene| Oracle::new(&volume, scene).radiance(&ray));
        assert_eq!(plain, lit, "{ray:?}");
    }
}

/// Largest difference of a channel of a marched picture to the oracle.
fn error_of(volume: &Volume, scene: &Scene, step_mm: f64) -> f64 {
    let method = Method::March(March { step_mm, ..MARCH });
    let found = render(volume, scene, &method, &|_| ()).unwrap().image;
    let oracle = Oracle::new(volume, scene);
    let pixels = found.pixels().iter().enumerate();
    pixels.fold(0.0, |worst: f64, (i, pixel)| {
        let truth = oracle.pixel(i % found.width(), i / found.width());
        worst.max(difference(pixel.map(f64::from), truth))
    })
}

#[test]
fn marching_converges_to_the_truth_with_the_square_of_its_step() {
    let ball = colored_ball(12);
    let rough = rough_volume(10);
    let lit = at_voxels(&scene_around(&rough, vec![two_colors()], Some(two_lights(true)), [16, 16]));
    for (name, volume, scene) in [("RGBA", &ball, colors(&ball, [16, 16])), ("classified", &rough, lit)] {
        let [coarse, fine] = [0.2, 0.025].map(|step_mm| error_of(volume, &scene, step_mm));
        let order = (coarse / fine).log2() / 3.0;
        assert!(order > 1.7, "{name}: errors {coarse:e} and {fine:e}, order {order}");
        assert!(error_of(volume, &scene, 2e-3) < 2e-6, "{name}: the error ends at rounding");
    }
}

#[test]
fn colors_have_no_values_to_show() {
    let volume = colored_ball(4);
    let lit = shaded(colors(&volume, [2, 2]), headlight());
    for method in [Method::March(MARCH), Method::Reference] {
        let error = render(&volume, &lit, &method, &|_| ()).expect_err("there is no gradient to shade by");
        assert_eq!(error.fault(), Fault::Unsupported, "{error}");
        assert!(error.to_string().contains("an RGBA volume has no values"), "found {error}");
    }
}
