//! The exact integrator against its own tightest setting; against the oracle in `tests/oracle.rs`.

use std::time::Instant;

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::scene::{Background, Camera, Light, Projection, Scene, Shading};
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction, Weight};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};

fn rough_volume(n: usize) -> Volume {
    let mut seed = 3u64;
    let samples = (0..n * n * n)
        .map(|_| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((seed >> 40) % 2000) as i16 - 1000
        })
        .collect();
    let grid = Grid::axis_aligned([n, n, n], DVec3::new(0.7, 0.8, 1.5)).unwrap();
    Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap()
}

#[test]
fn explore() {
    let volume = rough_volume(24);
    let knot = |value, s, color| Knot { value, optics: Optics::colored(s, color) };
    let (red, white, blue) = ([0.9, 0.2, 0.1], [1.0; 3], [0.1, 0.2, 0.9]);
    let soft = Term {
        curve: Curve::new(vec![
            knot(-300.0, 0.0, red),
            knot(-100.0, 0.15, red),
            knot(300.0, 0.05, blue),
            knot(600.0, 0.9, white),
        ])
        .unwrap(),
        weight: None,
    };
    let shell = Term {
        curve: Curve::new(vec![knot(90.0, 0.0, blue), knot(100.0, 3.0, blue), knot(110.0, 0.0, blue)]).unwrap(),
        weight: Some(Weight::new(vec![[100.0, 0.0], [500.0, 1.0]]).unwrap()),
    };
    let center = volume.grid().center_mm();
    let shading = Shading {
        ambient: 0.2,
        diffuse: 0.7,
        specular: 0.3,
        shininess: 20.0,
        two_sided: true,
        soft_gradient_per_mm: 10.0,
        lights: vec![Light::Headlight { color: [1.0; 3] }],
    };
    for (name, terms) in [("1d", vec![soft.clone()]), ("2d", vec![soft, shell])] {
        for lit in [None, Some(shading.clone())] {
            let scene = Scene {
                transfer_function: TransferFunction::new([-1024.0, 3071.0], 1500.0, terms.clone()).unwrap(),
                shading: lit,
                camera: Camera::look_at(
                    center - DVec3::new(60.0, 50.0, 30.0),
                    center,
                    DVec3::Z,
                    Projection::Perspective { fov_degrees: 25.0 },
                    [64, 64],
                )
                .unwrap(),
                background: Background::Transparent,
            };
            let run = |tolerance: f64, precision| {
                let t = tracer(&volume, &scene, tolerance, precision);
                let start = Instant::now();
                let all: Vec<_> =
                    (0..64 * 64).filter_map(|i| t.trace(&scene.camera.pixel_ray(i % 64, i / 64))).collect();
                (all, start.elapsed(), t.kernel().to_string())
            };
            let (truth, time, _) = run(if scene.shading.is_some() { 1e-5 } else { 1e-9 }, Precision::Double);
            println!(
                "{name} lit {} truth in {time:?}, {} pieces",
                scene.shading.is_some(),
                truth.iter().map(|t| t.pieces).sum::<u64>()
            );
            for tolerance in [1.0 / 255.0, 1e-3, 1e-4] {
                for precision in [Precision::Double, Precision::Single] {
                    let (found, time, kernel) = run(tolerance, precision);
                    let mut worst = 0.0f64;
                    let mut tight = 0.0f64;
                    for (f, t) in found.iter().zip(&truth) {
                        let e = (0..3)
                            .map(|c| (f.radiance[c] - t.radiance[c]).abs())
                            .fold((f.transmittance - t.transmittance).abs(), f64::max);
                        worst = worst.max(e);
                        tight = tight.max(e / f.bound);
                    }
                    let bound = found.iter().map(|t| t.bound).fold(0.0, f64::max);
                    println!(
                        "{kernel} tol {tolerance:.1e}: error {worst:.2e}, error/bound {tight:.3}, bound {bound:.2e}, {} pieces, {time:?}",
                        found.iter().map(|t| t.pieces).sum::<u64>()
                    );
                    assert!(worst < tolerance);
                }
            }
        }
    }
}
