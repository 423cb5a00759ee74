//! One body over all registers, thread counts and orders of tiles: the same bits from each, and those near the twin's.

use pellucid::integrate::exact::{Precision, tracer, tracer_at};
use pellucid::integrate::{Rendered, Schedule, render_scheduled};
use pellucid::plan::{Bound, Exact, Method};
use pellucid::scene::Scene;
use pellucid::simd::Level;
use pellucid::transfer::Term;
use pellucid::volume::Volume;

use crate::march::scenes::{blobs_f32, blobs_i16, scene, tissue_1d, tissue_2d, two_lights as lit};
use crate::support::scenes::{rough_volume, scene_around, thin_shell, two_colors, two_lights};

const TOLERANCE: f64 = 1e-3;

fn levels() -> impl Iterator<Item = Level> {
    Level::ALL.into_iter().filter(|level| level.is_available())
}

fn scenes() -> Vec<(Volume, Scene)> {
    let (rough, shorts, floats) = (rough_volume(14), blobs_i16(), blobs_f32());
    let around = |terms: Vec<Term>| scene_around(&rough, terms, None, [41, 29]);
    vec![
        (rough.clone(), around(vec![two_colors()])),
        (rough.clone(), around(vec![thin_shell(), two_colors()])),
        (shorts.clone(), scene(&shorts, tissue_1d(), None)),
        (shorts.clone(), scene(&shorts, tissue_2d(), None)),
        (floats.clone(), scene(&floats, tissue_2d(), None)),
        (rough.clone(), scene_around(&rough, vec![two_colors()], Some(two_lights(true)), [41, 29])),
        (rough.clone(), scene_around(&rough, vec![thin_shell(), two_colors()], Some(two_lights(false)), [23, 17])),
        (shorts.clone(), scene(&shorts, tissue_2d(), Some(lit()))),
    ]
}

/// With nodes and without, where they are for something.
fn bounds(scene: &Scene) -> impl Iterator<Item = Bound> {
    let lit = scene.shading.is_some();
    [Bound::Proven, Bound::Estimated].into_iter().filter(move |&bound| lit || bound == Bound::Proven)
}

fn precisions(scene: &Scene) -> impl Iterator<Item = Precision> {
    bounds(scene).map(|bound| if bound == Bound::Proven { Precision::Single } else { Precision::Estimated })
}

fn bits(rendered: &Rendered) -> Vec<u32> {
    rendered.image.pixels().iter().flatten().map(|x| x.to_bits()).collect()
}

#[test]
fn levels_threads_and_orders_of_tiles_give_the_same_bits() {
    for (n, (volume, scene)) in scenes().iter().enumerate() {
        for bound in bounds(scene) {
            let method = Method::Exact(Exact { tolerance: TOLERANCE, bound });
            let rendered = |schedule| render_scheduled(volume, scene, &method, schedule, &|_| ()).unwrap();
            let expected = rendered(Schedule { level: Level::Scalar, ..Schedule::default() });
            for level in levels() {
                for (threads, shuffled_tiles) in [(1, None), (2, Some(3)), (3, Some(8))] {
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                    let schedule = Schedule { shuffled_tiles, level, ..Schedule::default() };
                    let found = pool.install(|| rendered(schedule));
                    let same = bits(&found) == bits(&expected);
                    assert!(
                        same,
                        "scene {n}, {bound:?}: other bits by {level} on {threads} threads, tiles shuffled by {shuffled_tiles:?}"
                    );
                    assert_eq!(found.statistics.samples, expected.statistics.samples, "scene {n}, {level}");
                    assert_eq!(found.statistics.error_bound, expected.statistics.error_bound, "scene {n}, {level}");
                    assert!(found.statistics.kernel.ends_with(&format!("/{level}")), "{}", found.statistics.kernel);
                }
            }
        }
    }
}

#[test]
fn many_rays_at_once_are_each_as_if_alone() {
    for (n, (volume, scene)) in scenes().iter().enumerate() {
        for precision in precisions(scene) {
            let tracer = tracer(volume, scene, TOLERANCE, precision);
            let [width, height] = scene.camera.size();
            let ray = |pixel: usize| scene.camera.pixel_ray(pixel % width, pixel / width);
            let mut together = vec![None; width * height];
            tracer.trace_all(&(0..width * height).map(ray).collect(), &mut |pixel, traced| {
                together[pixel] = Some(traced)
            });
            assert!(together.iter().any(Option::is_some), "scene {n}: no ray meets the volume");
            for (pixel, together) in together.iter().enumerate() {
                let light =
                    |traced: pellucid::integrate::exact::Traced| (traced.radiance, traced.transmittance, traced.bound);
                assert_eq!(tracer.trace(&ray(pixel)).map(light), together.map(light), "scene {n}, pixel {pixel}");
            }
        }
    }
}

#[test]
fn every_level_is_within_both_bounds_of_the_twin() {
    for (n, (volume, scene)) in scenes().iter().enumerate() {
        let twin = tracer(volume, scene, TOLERANCE, Precision::Double);
        for (level, precision) in levels().flat_map(|level| precisions(scene).map(move |p| (level, p))) {
            let fast = tracer_at(level, volume, scene, TOLERANCE, precision);
            let (mut met, mut changed) = (0, 0);
            for pixel in 0..scene.camera.size().iter().product() {
                let width = scene.camera.size()[0];
                let ray = scene.camera.pixel_ray(pixel % width, pixel / width);
                let (found, expected) = (fast.trace(&ray), twin.trace(&ray));
                assert_eq!(found.is_some(), expected.is_some(), "scene {n}, {level}, pixel {pixel}: only one met it");
                let Some((found, expected)) = found.zip(expected) else { continue };
                let channels = found.radiance.iter().zip(&expected.radiance);
                let apart = channels.map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
                let apart = apart.max((found.transmittance - expected.transmittance).abs());
                assert!(
                    apart <= found.bound + expected.bound && found.bound <= TOLERANCE,
                    "scene {n}, {level}, {precision:?}, pixel {pixel}: {apart:e} apart, bounds {:e} and {:e}",
                    found.bound,
                    expected.bound
                );
                met += 1;
                changed += usize::from(apart > 0.0);
            }
            assert!(met > 100 && changed > 0, "scene {n}, {level}: {met} rays, {changed} not the twin's to the bit");
        }
    }
}
