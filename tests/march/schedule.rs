//! Threads, order of tiles and empty-space skipping never change a picture.

use std::sync::atomic::{AtomicUsize, Ordering};

use pellucid::integrate::{Rendered, Schedule, render_scheduled};
use pellucid::plan::{Jitter, JitterKind, Lattice, March, Method, Order, SampleRule};
use pellucid::scene::Scene;
use pellucid::volume::Volume;

use super::scenes::{MARCH, blobs_f32, blobs_i16, scene, tissue_1d, tissue_2d, two_lights};

fn rendered(volume: &Volume, scene: &Scene, settings: March, schedule: Schedule) -> Rendered {
    render_scheduled(volume, scene, &Method::March(settings), schedule, &|_| ()).unwrap()
}

fn bytes(rendered: &Rendered) -> Vec<u32> {
    rendered.image.pixels().iter().flatten().map(|x| x.to_bits()).collect()
}

#[test]
fn threads_and_tile_order_do_not_matter() {
    let volume = blobs_i16();
    let scene = scene(&volume, tissue_2d(), Some(two_lights()));
    let settings =
        March { jitter: Some(Jitter { seed: 4, kind: JitterKind::White }), termination_transmittance: 1e-3, ..MARCH };
    let expected = rendered(&volume, &scene, settings, Schedule::default());
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for shuffled_tiles in [None, Some(1), Some(2)] {
            let schedule = Schedule { shuffled_tiles, ..Schedule::default() };
            let found = pool.install(|| rendered(&volume, &scene, settings, schedule));
            assert!(bytes(&found) == bytes(&expected), "other bytes with {threads} threads and {schedule:?}");
            assert_eq!(found.statistics, expected.statistics, "{threads} threads");
        }
    }
}

#[test]
fn empty_space_skipping_saves_samples_and_changes_nothing() {
    for volume in [blobs_i16(), blobs_f32()] {
        for (transfer_function, shading) in [(tissue_1d(), None), (tissue_2d(), Some(two_lights()))] {
            let scene = scene(&volume, transfer_function, shading);
            for rule in [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid] {
                for order in [Order::FrontToBack, Order::BackToFront] {
                    for (lattice, step_mm) in
                        [(Lattice::PerRay, 0.07), (Lattice::ViewPlanes, 0.3), (Lattice::PerRay, 3.0)]
                    {
                        let settings = March { rule, order, lattice, step_mm, termination_transmittance: 0.3, ..MARCH };
                        let all = Schedule { empty_space_skipping: false, ..Schedule::default() };
                        let all = rendered(&volume, &scene, settings, all);
                        let skipped = rendered(&volume, &scene, settings, Schedule::default());
                        assert!(bytes(&skipped) == bytes(&all), "other bytes with {settings:?}");
                        assert!(
                            skipped.statistics.samples < all.statistics.samples,
                            "{} of {} samples with {settings:?}",
                            skipped.statistics.samples,
                            all.statistics.samples
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn every_pixel_is_reported_and_rays_are_counted() {
    let volume = blobs_i16();
    let scene = scene(&volume, tissue_1d(), None);
    let done = AtomicUsize::new(0);
    let progress = |pixels: usize| {
        done.fetch_add(pixels, Ordering::Relaxed);
    };
    let method = Method::March(MARCH);
    let found = render_scheduled(&volume, &scene, &method, Schedule::default(), &progress).unwrap();
    assert_eq!(done.into_inner(), 37 * 29);
    let rays = found.statistics.rays;
    assert!(rays > 100 && rays < 37 * 29, "{rays} of {} rays meet the volume", 37 * 29);
    assert!(found.statistics.samples > rays);
}
