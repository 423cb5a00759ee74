//! Marching numbers along rays: towards the truth, at the order of the rule, and whatever the schedule.

use pellucid::integrate::{Rendered, Schedule, render_scheduled};
use pellucid::oracle::Oracle;
use pellucid::plan::{Jitter, JitterKind, Lattice, March, Method, SampleRule};
use pellucid::scene::{Model, Scene, ValueModel, ValueOf};
use pellucid::volume::{Rescale, Volume};

use super::NUMBERS;
use crate::march::scenes::{MARCH, blobs_f32, blobs_i16, scene, tissue_1d, tissue_2d};
use crate::support::scenes::{rough_volume, scene_around, two_colors, unit_grid, volume_of};

const RULES: [SampleRule; 3] = [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid];

/// All that can be shown of a volume of blobs, with windows that nothing leaves.
fn scenes(volume: &Volume) -> Vec<Scene> {
    let shown = |of, window, transfer_function| {
        let model = Model::Value(ValueModel { of, window });
        Scene { model, ..scene(volume, transfer_function, None) }
    };
    let values = NUMBERS.map(|of| {
        let window = if of == ValueOf::Sum { [-60_000.0, 60_000.0] } else { [-1100.0, 1700.0] };
        shown(of, window, tissue_1d())
    });
    let depths = [tissue_1d(), tissue_2d()].map(|tf| shown(ValueOf::OpticalDepth, [0.0, 20.0], tf));
    values.into_iter().chain(depths).collect()
}

fn rendered(volume: &Volume, scene: &Scene, settings: March, schedule: Schedule) -> Rendered {
    render_scheduled(volume, scene, &Method::March(settings), schedule, &|_| ()).expect("it renders")
}

fn bytes(rendered: &Rendered) -> Vec<u32> {
    rendered.image.pixels().iter().flatten().map(|x| x.to_bits()).collect()
}

/// Root mean square of the errors of the greys.
fn error(volume: &Volume, scene: &Scene, settings: March) -> f64 {
    let found = rendered(volume, scene, settings, Schedule::default());
    let truth = Oracle::new(volume, scene).render(|_| ());
    let grey = pellucid::image::srgb::encode;
    let squares = found.image.pixels().iter().zip(&truth).map(|(x, t)| {
        assert_eq!(f64::from(x[3]), t[3], "the same pixels meet the volume");
        (grey(f64::from(x[0])) - grey(t[0])).powi(2)
    });
    (squares.sum::<f64>() / truth.len() as f64).sqrt()
}

#[test]
fn integrals_converge_at_the_order_of_the_rule() {
    let volume = blobs_i16();
    for scene in scenes(&volume) {
        let Model::Value(ValueModel { of, .. }) = scene.model else { unreachable!("scenes of values") };
        if !matches!(of, ValueOf::Mean | ValueOf::Sum | ValueOf::OpticalDepth) {
            continue;
        }
        // The left rule errs at the ends of a ray only, and there nothing absorbs.
        let left = if of == ValueOf::OpticalDepth { 2.0 } else { 1.0 };
        for (rule, order) in RULES.into_iter().zip([left, 2.0, 2.0]) {
            let at = |step_mm| error(&volume, &scene, March { rule, step_mm, ..MARCH });
            let (coarse, fine) = (at(0.8), at(0.2));
            let found = (coarse / fine).log2() / 2.0;
            // Steps straddle the faces of cells, so the errors of neighbouring steps do not fall alike.
            assert!((found - order).abs() < 0.35, "{of:?}, {rule:?}: order {found:.2}, errors {coarse:e} and {fine:e}");
        }
    }
}

#[test]
fn extremes_converge_from_the_inside() {
    for volume in [blobs_i16(), blobs_f32().with_rescale(Rescale { slope: -0.5, intercept: 200.0 })] {
        for of in [ValueOf::Maximum, ValueOf::Minimum] {
            let model = Model::Value(ValueModel { of, window: [-1100.0, 1700.0] });
            let scene = Scene { model, ..scene(&volume, tissue_1d(), None) };
            let truth = Oracle::new(&volume, &scene).render(|_| ());
            let found = rendered(&volume, &scene, MARCH, Schedule::default());
            for (x, t) in found.image.pixels().iter().zip(&truth) {
                let beyond = if of == ValueOf::Maximum { f64::from(x[0]) - t[0] } else { t[0] - f64::from(x[0]) };
                assert!(beyond < 1e-6, "{of:?}: samples lie within the extremes, found {} and {}", x[0], t[0]);
            }
            let at = |step_mm| error(&volume, &scene, March { step_mm, ..MARCH });
            let (coarse, fine) = (at(1.6), at(0.1));
            assert!(fine < 0.1 * coarse, "{of:?}: errors {coarse:e} and {fine:e} at a 16th of the step");
        }
    }
}

#[test]
fn a_smooth_maximum_is_of_second_order() {
    // One trilinear cell, so that nothing is bent: the maximum lies inside it for most rays.
    let volume = volume_of(unit_grid([2; 3]), |[i, j, _]| if i != j { 1000.0 } else { 0.0 });
    let model = Model::Value(ValueModel { of: ValueOf::Maximum, window: [0.0, 1000.0] });
    let scene = Scene { model, ..scene_around(&volume, vec![], None, [48, 48]) };
    let at = |step_mm| error(&volume, &scene, March { rule: SampleRule::Trapezoid, step_mm, ..MARCH });
    let (coarse, fine) = (at(0.1), at(0.025));
    assert!(fine < 0.1 * coarse, "errors {coarse:e} and {fine:e} at a quarter of the step");
}

#[test]
fn first_maxima_converge_where_the_volume_is_smooth() {
    let volume = blobs_i16();
    let model = Model::Value(ValueModel { of: ValueOf::LocalMaximum { threshold: -500.0 }, window: [-1100.0, 1700.0] });
    let scene = Scene { model, ..scene(&volume, tissue_1d(), None) };
    let at = |step_mm| error(&volume, &scene, March { step_mm, ..MARCH });
    let (coarse, fine) = (at(0.8), at(0.05));
    assert!(fine < 5e-3 && fine < 0.3 * coarse, "errors {coarse:e} and {fine:e}");
}

#[test]
fn the_schedule_changes_nothing_and_skipping_saves_samples() {
    for volume in [blobs_i16(), blobs_f32(), blobs_i16().with_rescale(Rescale { slope: -0.5, intercept: 200.0 })] {
        for scene in scenes(&volume) {
            let Model::Value(ValueModel { of, .. }) = scene.model else { unreachable!("scenes of values") };
            for (rule, lattice, step_mm) in [
                (SampleRule::Left, Lattice::PerRay, 0.07),
                (SampleRule::Midpoint, Lattice::ViewPlanes, 0.3),
                (SampleRule::Trapezoid, Lattice::PerRay, 3.0),
            ] {
                let jitter = Some(Jitter { seed: 3, kind: JitterKind::White });
                let settings = March { rule, lattice, step_mm, jitter, ..MARCH };
                let every = Schedule { empty_space_skipping: false, ..Schedule::default() };
                let all = rendered(&volume, &scene, settings, every);
                let skipped = rendered(&volume, &scene, settings, Schedule::default());
                assert!(bytes(&skipped) == bytes(&all), "{of:?}: other bytes with {settings:?}");
                let (some, all) = (skipped.statistics.samples, all.statistics.samples);
                let reads_all = matches!(of, ValueOf::Mean | ValueOf::Sum);
                assert!(some == all || some < all && !reads_all, "{of:?}: {some} of {all} samples with {settings:?}");
            }
            let settings = March { step_mm: 0.1, ..MARCH };
            let base = rendered(&volume, &scene, settings, Schedule::default());
            for (threads, shuffled_tiles) in [(1, None), (3, Some(5))] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
                let schedule = Schedule { shuffled_tiles, ..Schedule::default() };
                let found = pool.install(|| rendered(&volume, &scene, settings, schedule));
                assert!(bytes(&found) == bytes(&base), "{of:?}: other bytes with {threads} threads");
                assert_eq!(found.statistics, base.statistics, "{of:?}, {threads} threads");
            }
        }
    }
}

#[test]
fn whatever_has_no_need_of_every_block_skips_some() {
    let rising = blobs_i16();
    // With holes in place of blobs, so that there is something to skip for the minimum, too.
    let falling = blobs_i16().with_rescale(Rescale { slope: -0.5, intercept: 200.0 });
    for scene in scenes(&rising) {
        let Model::Value(ValueModel { of, .. }) = scene.model else { unreachable!("scenes of values") };
        let volume = if of == ValueOf::Minimum { &falling } else { &rising };
        let settings = March { step_mm: 0.1, ..MARCH };
        let every = Schedule { empty_space_skipping: false, ..Schedule::default() };
        let all = rendered(volume, &scene, settings, every).statistics.samples;
        let some = rendered(volume, &scene, settings, Schedule::default()).statistics.samples;
        let skips = some < all;
        assert_eq!(skips, !matches!(of, ValueOf::Mean | ValueOf::Sum), "{of:?}: {some} of {all} samples");
    }
}

#[test]
fn a_rough_volume_is_marched_towards_the_truth_for_any_rescale() {
    for rescale in [Rescale::IDENTITY, Rescale { slope: -0.5, intercept: 200.0 }] {
        let volume = rough_volume(9).with_rescale(rescale);
        for of in NUMBERS.into_iter().chain([ValueOf::OpticalDepth]) {
            let window = match of {
                ValueOf::Sum => [-3000.0, 9000.0],
                ValueOf::OpticalDepth => [0.0, 8.0],
                _ => [-700.0, 1200.0],
            };
            let model = Model::Value(ValueModel { of, window });
            let scene = Scene { model, ..scene_around(&volume, vec![two_colors()], None, [24, 24]) };
            let worst = error(&volume, &scene, March { step_mm: 0.01, ..MARCH });
            // A summit that falls by less between two samples than it rises again is missed, and the next one found.
            let allowed = if matches!(of, ValueOf::LocalMaximum { .. }) { 1e-2 } else { 1e-3 };
            assert!(worst < allowed, "{of:?}, {rescale:?}: error {worst:e}");
            let wrong = error(&volume.clone().with_rescale(Rescale { slope: 0.6, intercept: 30.0 }), &scene, MARCH);
            assert!(wrong > worst, "another picture has another error, {wrong:e}");
        }
    }
}
