//! Volumes whose slices lie at uneven distances: closed forms, the even case, the oracle, and files.

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::oracle::Oracle;
use pellucid::scene::Scene;
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Slices, Volume};

use crate::march::scenes::sheared_grid;

mod closed_forms;
mod even;
mod files;
mod march;
mod models;
mod pipelines;

/// Places of 13 slices: close, far, and in between.
const PLACES: [f64; 13] = [0.0, 0.3, 0.6, 0.8, 2.4, 4.0, 4.1, 6.0, 7.9, 8.0, 9.5, 11.5, 11.7];

fn slices() -> Slices {
    Slices::new(&PLACES).expect("ascending places")
}

/// A field of the position in mm, sampled in f32 at the voxels of the sheared grid, its slices at these places or even.
fn sampled(slices: Option<Slices>, field: impl Fn(DVec3) -> f64) -> Volume {
    on(sheared_grid(), slices, field)
}

fn on(grid: Grid, slices: Option<Slices>, field: impl Fn(DVec3) -> f64) -> Volume {
    let place = |samples| {
        let volume = Volume::new(grid, Samples::F32(samples), Rescale::IDENTITY, Quantity::Hu).expect("finite samples");
        slices.iter().cloned().try_fold(volume, Volume::with_slices).expect("as many places as slices")
    };
    let lattice = place(vec![0.0; grid.voxel_count()]);
    place((0..grid.voxel_count()).map(|i| field(lattice.voxel_mm(grid.unflatten(i))) as f32).collect())
}

/// Every pixel by the oracle.
fn truth(volume: &Volume, scene: &Scene) -> Vec<[f64; 4]> {
    Oracle::new(volume, scene).render(|_| ())
}

/// Every pixel by the exact integrator, without a background.
fn exact(volume: &Volume, scene: &Scene, tolerance: f64, precision: Precision) -> Vec<[f64; 4]> {
    let tracer = tracer(volume, scene, tolerance, precision);
    let [width, height] = scene.camera.size();
    let pixel = |n: usize| {
        tracer.trace(&scene.camera.pixel_ray(n % width, n / width)).map_or([0.0; 4], |traced| {
            let [r, g, b] = traced.radiance;
            [r, g, b, traced.opacity]
        })
    };
    (0..width * height).map(pixel).collect()
}
