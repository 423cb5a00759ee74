//! Effects of light against closed forms, against the oracle, and against themselves where nothing may change.

mod closed_forms;
mod identity;
mod march;
mod random;
mod scattering;
mod shadows;

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::integrate::{Schedule, render_scheduled};
use pellucid::oracle::Oracle;
use pellucid::plan::{Method, SampleRule};
use pellucid::scene::{Camera, Projection, Scene};
use pellucid::volume::Volume;

use crate::march::scenes::MARCH;
use crate::support::scenes::difference;

/// A parallel camera of 1 x 1 pixels whose ray starts at a point.
fn one_ray(from_mm: DVec3, direction: DVec3) -> Camera {
    let projection = Projection::Parallel { height_mm: 1e-3 };
    let up = direction.any_orthonormal_vector();
    Camera::look_at(from_mm, from_mm + direction, up, projection, [1, 1]).expect("a valid camera")
}

/// The first pixel of a scene, with its background, by a method.
fn pixel(volume: &Volume, scene: &Scene, method: Method) -> [f64; 4] {
    let rendered = render_scheduled(volume, scene, &method, Schedule::default(), &|_| ()).expect("a picture");
    rendered.image.pixel(0, 0).map(f64::from)
}

/// A march with midpoint samples.
fn march(step_mm: f64) -> Method {
    Method::March(pellucid::plan::March { step_mm, rule: SampleRule::Midpoint, ..MARCH })
}

/// What the oracle, the exact integrator at a tolerance of 1e-6 and a march make of the first pixel must be this:
/// `[error allowed of the first two, step of the march in mm, error allowed of it]`.
fn assert_everyone_sees(
    volume: &Volume,
    scene: &Scene,
    expected: [f64; 4],
    [allowed, step_mm, of_march]: [f64; 3],
    what: &str,
) {
    let oracle = Oracle::new(volume, scene).pixel(0, 0);
    let exact = pixel(volume, scene, Method::Exact(pellucid::plan::Exact::within(1e-6)));
    let marched = pixel(volume, scene, march(step_mm));
    for (name, found, allowed) in
        [("oracle", oracle, allowed), ("exact", exact, allowed + 2e-7), ("march", marched, of_march)]
    {
        let off = difference(found, expected);
        assert!(off <= allowed, "{what}, {name}: found {found:?}, expected {expected:?}, {off:e} apart");
    }
}

/// Largest error of the exact integrator over all pixels of a scene, and largest ratio to its bound.
fn against_the_oracle(volume: &Volume, scene: &Scene, tolerance: f64) -> (f64, f64) {
    let tracer = tracer(volume, scene, tolerance, Precision::Single);
    let oracle = Oracle::new(volume, scene);
    let [width, height] = scene.camera.size();
    (0..width * height).fold((0.0, 0.0), |worst: (f64, f64), i| {
        let ray = scene.camera.pixel_ray(i % width, i / width);
        let truth = oracle.radiance(&ray);
        let (found, bound) = tracer.trace(&ray).map_or(([0.0; 4], 0.0), |t| {
            let [r, g, b] = t.radiance;
            ([r, g, b, t.opacity], t.bound)
        });
        let error = difference(found, truth);
        (worst.0.max(error), if error > 0.0 { worst.1.max(error / bound) } else { worst.1 })
    })
}
