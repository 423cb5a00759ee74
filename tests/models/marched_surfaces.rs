//! Marching towards level surfaces.

use glam::DVec3;
use pellucid::integrate::{Rendered, Schedule, render_scheduled};
use pellucid::oracle::Oracle;
use pellucid::plan::{Jitter, JitterKind, Lattice, March, Method};
use pellucid::scene::{Camera, Model, Projection, Scene, Surface};
use pellucid::volume::{Rescale, Volume};

use crate::march::scenes::{MARCH, blobs_f32, blobs_i16, scene, tissue_1d};
use crate::support::scenes::{BLUE, BONE, RED, difference, scene_around, two_lights, unit_grid, volume_of};

fn rendered(volume: &Volume, scene: &Scene, settings: March, schedule: Schedule) -> Rendered {
    render_scheduled(volume, scene, &Method::March(settings), schedule, &|_| ()).expect("it renders")
}

fn bytes(rendered: &Rendered) -> Vec<u32> {
    rendered.image.pixels().iter().flatten().map(|x| x.to_bits()).collect()
}

/// Per pixel, the largest error of a channel.
fn errors(volume: &Volume, scene: &Scene, settings: March) -> Vec<f64> {
    let found = rendered(volume, scene, settings, Schedule::default());
    let truth = Oracle::new(volume, scene).render(|_| ());
    found.image.pixels().iter().zip(truth).map(|(x, t)| difference(x.map(f64::from), t)).collect()
}

fn blob_surfaces(volume: &Volume) -> Scene {
    let surface = |value, opacity, color| Surface { value, opacity, color };
    let surfaces = vec![surface(-600.0, 0.25, RED), surface(-100.0, 0.5, BLUE), surface(300.0, 1.0, BONE)];
    Scene { model: Model::Surfaces(surfaces), ..scene(volume, tissue_1d(), Some(two_lights(true))) }
}

/// A ball, seen from so near its axis that no ray grazes it.
fn ball() -> (Volume, Scene) {
    let center = 15.0;
    let volume = volume_of(unit_grid([31; 3]), |index| {
        let d = DVec3::from_array(index.map(|i| i as f64 - center)).length();
        // Bent, so that a line between two samples misses the level.
        (1200.0 - 3.0 * d * d * (1.0 + 0.02 * d)).max(-900.0)
    });
    let surface = |value, opacity, color| Surface { value, opacity, color };
    let surfaces = vec![surface(450.0, 0.4, RED), surface(800.0, 1.0, BONE)];
    let mut scene = scene_around(&volume, vec![], Some(two_lights(true)), [24, 24]);
    scene.model = Model::Surfaces(surfaces);
    let target = volume.grid().center_mm();
    let eye = target + DVec3::new(30.0, -60.0, 20.0);
    let projection = Projection::Parallel { height_mm: 6.0 };
    scene.camera = Camera::look_at(eye, target, DVec3::Z, projection, [24, 24]).expect("a valid camera");
    (volume, scene)
}

#[test]
fn crossings_are_of_second_order_and_bisection_makes_them_exact() {
    let (volume, scene) = ball();
    let rms = |errors: Vec<f64>| (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    let at = |step_mm, bisections| rms(errors(&volume, &scene, March { step_mm, bisections, ..MARCH }));
    let (coarse, fine) = (at(0.8, 0), at(0.2, 0));
    let order = (coarse / fine).log2() / 2.0;
    assert!((1.6..2.6).contains(&order), "order {order:.2}, errors {coarse:e} and {fine:e}");
    let bisected = at(0.8, 16);
    assert!(bisected < 1e-5, "after 16 bisections: error {bisected:e}, {coarse:e} without");
}

#[test]
fn translucent_stacks_come_in_order() {
    let volume = blobs_i16();
    let scene = blob_surfaces(&volume);
    let errors = errors(&volume, &scene, March { step_mm: 0.02, bisections: 8, ..MARCH });
    // A pair of crossings closer than a step is missed: few rays graze a surface.
    let off = errors.iter().filter(|&&e| e > 1e-3).count();
    assert!(off * 100 < errors.len(), "{off} of {} pixels differ by more than 1e-3", errors.len());
    let wrong_order = {
        let mut scene = scene.clone();
        let Model::Surfaces(surfaces) = &mut scene.model else { unreachable!("surfaces") };
        let (first, last) = (surfaces[0].color, surfaces[2].color);
        (surfaces[0].color, surfaces[2].color) = (last, first);
        Oracle::new(&volume, &scene).render(|_| ())
    };
    let found = rendered(&volume, &scene, March { step_mm: 0.02, ..MARCH }, Schedule::default());
    let swapped = found.image.pixels().iter().zip(wrong_order);
    let off = swapped.filter(|(x, t)| difference(x.map(f64::from), *t) > 1e-3).count();
    assert!(off * 20 > errors.len(), "swapped colours are seen in {off} pixels only");
}

#[test]
fn a_falling_rescale_shows_the_same() {
    let volume = blobs_f32();
    let samples = volume.samples();
    let negated = (0..samples.len()).map(|i| (500.0 - samples.stored(i)) as f32).collect();
    let falling = pellucid::volume::Samples::F32(negated);
    let falling =
        Volume::new(*volume.grid(), falling, Rescale { slope: -1.0, intercept: 500.0 }, volume.quantity()).unwrap();
    let scene = blob_surfaces(&volume);
    let rising = rendered(&volume, &scene, MARCH, Schedule::default());
    let falling = rendered(&falling, &scene, MARCH, Schedule::default());
    let apart = rising.image.pixels().iter().zip(falling.image.pixels());
    let apart = apart.map(|(a, b)| difference(a.map(f64::from), b.map(f64::from))).fold(0.0, f64::max);
    assert!(apart < 1e-3, "{apart:e} apart");
}

#[test]
fn the_schedule_changes_nothing_and_skipping_saves_samples() {
    for volume in [blobs_i16(), blobs_f32()] {
        let mut scene = blob_surfaces(&volume);
        for shading in [None, scene.shading.clone()] {
            scene.shading = shading;
            for (lattice, step_mm) in [(Lattice::PerRay, 0.07), (Lattice::ViewPlanes, 0.3), (Lattice::PerRay, 3.0)] {
                let jitter = Some(Jitter { seed: 8, kind: JitterKind::LowDiscrepancy });
                let settings =
                    March { lattice, step_mm, jitter, bisections: 2, termination_transmittance: 0.3, ..MARCH };
                let every = Schedule { empty_space_skipping: false, ..Schedule::default() };
                let all = rendered(&volume, &scene, settings, every);
                for threads in [1, 3] {
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
                    let schedule = Schedule { shuffled_tiles: Some(threads as u64), ..Schedule::default() };
                    let skipped = pool.install(|| rendered(&volume, &scene, settings, schedule));
                    assert!(bytes(&skipped) == bytes(&all), "other bytes with {settings:?}");
                    let (some, all) = (skipped.statistics.samples, all.statistics.samples);
                    assert!(some < all || step_mm == 3.0, "{some} of {all} samples with {settings:?}");
                }
            }
        }
    }
}
