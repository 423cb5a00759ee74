//! Threads, order of tiles and empty-space skipping never change a picture.

use pellucid::integrate::{Rendered, Schedule, render_scheduled};
use pellucid::plan::{Exact, Method};
use pellucid::scene::Scene;
use pellucid::volume::Volume;

use super::{at_voxels, colored_ball, colors};
use crate::march::scenes::MARCH;
use crate::support::scenes::{rough_volume, scene_around, thin_shell, two_lights};

fn bytes(rendered: &Rendered) -> Vec<u32> {
    rendered.image.pixels().iter().flatten().map(|x| x.to_bits()).collect()
}

fn scenes() -> Vec<(Volume, Scene)> {
    let (ball, rough) = (colored_ball(20), rough_volume(20));
    let shell = at_voxels(&scene_around(&rough, vec![thin_shell()], Some(two_lights(true)), [37, 23]));
    vec![(ball.clone(), colors(&ball, [37, 23])), (rough, shell)]
}

#[test]
fn threads_and_tile_order_do_not_matter() {
    for (volume, scene) in scenes() {
        for method in [Method::March(MARCH), Method::Exact(Exact::within(1e-3))] {
            let rendered = |schedule| render_scheduled(&volume, &scene, &method, schedule, &|_| ()).unwrap();
            let expected = rendered(Schedule::default());
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let schedule = Schedule { shuffled_tiles: Some(threads as u64), ..Schedule::default() };
                let found = pool.install(|| rendered(schedule));
                assert!(bytes(&found) == bytes(&expected), "other bytes with {threads} threads");
                assert_eq!(found.statistics, expected.statistics, "{threads} threads");
            }
        }
    }
}

#[test]
fn empty_space_skipping_saves_samples_and_changes_nothing() {
    for (n, (volume, scene)) in scenes().into_iter().enumerate() {
        for step_mm in [0.07, 0.4] {
            let method = Method::March(pellucid::plan::March { step_mm, ..MARCH });
            let rendered = |empty_space_skipping| {
                let schedule = Schedule { empty_space_skipping, ..Schedule::default() };
                render_scheduled(&volume, &scene, &method, schedule, &|_| ()).unwrap()
            };
            let (all, skipped) = (rendered(false), rendered(true));
            assert!(bytes(&skipped) == bytes(&all), "other bytes in scene {n}, step {step_mm}");
            // The ball leaves corners empty; noise leaves nothing.
            let fewer = skipped.statistics.samples < all.statistics.samples;
            assert!(fewer || n == 1, "{} of {} samples", skipped.statistics.samples, all.statistics.samples);
        }
    }
}

#[test]
fn kernels_are_named_by_what_they_read() {
    let names: Vec<String> = scenes()
        .iter()
        .flat_map(|(volume, scene)| {
            [Method::March(MARCH), Method::Exact(Exact::within(1e-2))].map(|method| {
                render_scheduled(volume, scene, &method, Schedule::default(), &|_| ()).unwrap().statistics.kernel
            })
        })
        .collect();
    let expected = [
        "march/rgba8/unlit/scalar",
        "exact/rgba8/unlit/f64",
        "march/voxels/tf2d/lit/scalar",
        "exact/voxels/tf2d/lit/f64",
    ];
    assert_eq!(names, expected);
}
