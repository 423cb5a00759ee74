//! Masks: closed forms, the oracle, and that a mask which tells nothing apart changes nothing.

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::integrate::{Schedule, render, render_scheduled};
use pellucid::oracle::Oracle;
use pellucid::plan::{Exact, March, Method, Order, SampleRule};
use pellucid::scene::{
    Background, Class, Clip, Effects, HalfSpace, Mask, Model, Ray, Scene, Surface, ValueModel, ValueOf,
};
use pellucid::transfer::TransferFunction;
use pellucid::volume::Volume;
use proptest::prelude::*;

use crate::march::scenes::{MARCH, apart};
use crate::properties;
use crate::support::scenes::{
    BLUE, BONE, RED, function_1d, function_2d, next_u64, rough_volume, scene, scene_around, thin_shell, two_colors,
    two_lights, unit_grid, volume_of,
};

fn masked(scene: Scene, classes: Vec<Class>) -> Scene {
    Scene { effects: Effects { mask: Some(Mask { classes }), ..scene.effects }, ..scene }
}

/// A class for each voxel by its index.
fn classified(volume: Volume, class: impl Fn([usize; 3]) -> u8) -> Volume {
    let classes = (0..volume.grid().voxel_count()).map(|i| class(volume.grid().unflatten(i))).collect();
    volume.with_classes(classes).expect("a class for each voxel")
}

/// Blobs of `count` classes, a few voxels wide, that look random.
fn blobs(volume: Volume, count: u64, seed: u64) -> Volume {
    classified(volume, |index| {
        let [i, j, k] = index.map(|x| x as u64 / 2);
        (next_u64(&mut (seed ^ (i + 97 * j + 9409 * k))) % count) as u8
    })
}

fn exact(tolerance: f64) -> Method {
    Method::Exact(Exact::within(tolerance))
}

fn pixels(volume: &Volume, scene: &Scene, method: &Method) -> Vec<[f32; 4]> {
    render(volume, scene, method, &|_| ()).expect("it renders").image.pixels().to_vec()
}

fn own(extinction_per_mm: f64) -> Class {
    Class::Own(even(extinction_per_mm))
}

fn even(extinction_per_mm: f64) -> TransferFunction {
    function_1d(&[(0.0, extinction_per_mm, BLUE)])
}

/// Red, green, blue and alpha of one ray by the exact integrator and by the oracle.
fn seen(volume: &Volume, scene: &Scene, ray: &Ray) -> [[f64; 4]; 2] {
    let found = tracer(volume, scene, 1e-4, Precision::Single).trace(ray).map_or([0.0; 4], |t| {
        let [r, g, b] = t.radiance;
        [r, g, b, t.opacity]
    });
    [found, Oracle::new(volume, scene).radiance(ray)]
}

#[test]
fn half_a_slab_hidden_absorbs_as_the_half_that_is_left() {
    // Voxels 0 to 20: those up to 7 are hidden, so what is shown begins at 7.5.
    let volume = classified(volume_of(unit_grid([21; 3]), |_| 100.0), |[_, _, k]| u8::from(k <= 7));
    let sigma = 0.05_f64;
    let scene = masked(scene(even(sigma)), vec![Class::Shown, Class::Hidden]);
    for (origin_mm, direction, length_mm) in [
        (DVec3::new(5.0, 6.25, -9.0), DVec3::Z, 12.5),
        (DVec3::new(5.0, 6.25, 90.0), -DVec3::Z, 12.5),
        (DVec3::new(5.0, 6.25, 12.0), -DVec3::Z, 4.5),
        (DVec3::new(-4.0, 3.3, 7.4), DVec3::X, 0.0),
        (DVec3::new(-4.0, 3.3, 7.6), DVec3::X, 20.0),
        (DVec3::new(-4.0, 3.3, 7.5), DVec3::X, 20.0),
        (DVec3::new(1.0, 3.3, -9.0), DVec3::new(0.28, 0.0, 0.96), 12.5 / 0.96),
    ] {
        let expected = -(-sigma * length_mm).exp_m1();
        for found in seen(&volume, &scene, &Ray { origin_mm, direction }) {
            assert!((found[3] - expected).abs() < 1e-12, "{origin_mm} {direction}: {}, expected {expected}", found[3]);
        }
    }
}

#[test]
fn each_label_has_its_own_transfer_function() {
    // Three layers along the ray: 2.5, 3 and 4.5 mm.
    let volume = classified(volume_of(unit_grid([11, 5, 5]), |_| 100.0), |[i, _, _]| match i {
        0..=2 => 3,
        3..=5 => 1,
        _ => 2,
    });
    let scene = masked(scene(function_1d(&[(0.0, 0.1, RED)])), vec![Class::Hidden, Class::Shown, own(0.3), own(0.2)]);
    let ray = Ray { origin_mm: DVec3::new(-4.0, 2.2, 1.7), direction: DVec3::X };
    let [a, b, c] = [(0.2, 2.5), (0.1, 3.0), (0.3, 4.5)].map(|(s, mm): (f64, f64)| (-s * mm).exp());
    let red = a * (1.0 - b) * RED[0] + ((1.0 - a) + a * b * (1.0 - c)) * BLUE[0];
    for found in seen(&volume, &scene, &ray) {
        assert!((found[0] - red).abs() < 1e-12, "found {}, expected {red}", found[0]);
        assert!((found[3] - (1.0 - a * b * c)).abs() < 1e-12, "found {}, expected {}", found[3], 1.0 - a * b * c);
    }
}

#[test]
fn hiding_all_leaves_the_background_and_showing_all_changes_no_bit() {
    let volume = blobs(rough_volume(10), 3, 5);
    let plain = scene_around(&volume, vec![two_colors(), thin_shell()], Some(two_lights(true)), [24, 24]);
    let shown = masked(plain.clone(), vec![Class::Shown; 2]);
    let hidden = masked(plain.clone(), vec![Class::Hidden; 3]);
    let march = Method::March(MARCH);
    for method in [exact(1e-3), march, Method::Reference] {
        assert!(pixels(&volume, &hidden, &method).iter().all(|p| *p == [0.0; 4]), "{method:?}");
    }
    // Marching under a mask takes one sample after the other, without one in lanes, whose places are rounded more finely: the thin
    // shell magnifies what 24 bits of a voxel leave out.
    let [under_mask, without] = [&shown, &plain].map(|scene| pixels(&volume, scene, &march));
    let apart = |(a, b): (&[f32; 4], &[f32; 4])| (0..4).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
    let worst = under_mask.iter().zip(&without).map(apart).fold(0.0, f32::max);
    assert!(worst < 2e-5, "marching: {worst:e} apart");
    let one_class = classified(rough_volume(10), |_| 7);
    for scene in [&shown, &masked(plain.clone(), vec![])] {
        let [a, b] = [scene, &plain].map(|s| {
            let tracer = tracer(&one_class, s, 1e-3, Precision::Double);
            (0..576)
                .map(|i| {
                    tracer.trace(&plain.camera.pixel_ray(i % 24, i / 24)).map(|t| (t.radiance, t.opacity, t.bound))
                })
                .collect::<Vec<_>>()
        });
        assert!(a == b, "the exact integrator in f64");
    }
    let without_classes = rough_volume(10);
    let [a, b] = [&hidden, &plain].map(|s| pixels(&without_classes, s, &exact(1e-3)));
    assert!(a == b, "a volume without classes is shown");
}

#[test]
fn values_that_are_hidden_do_not_count() {
    // A ramp whose voxels 4 to 7 are hidden: 0 to 350 and 750 to 1000 are left.
    let ramp = volume_of(unit_grid([11, 5, 5]), |[i, _, _]| 100.0 * i as f64);
    let volume = classified(ramp, |[i, _, _]| u8::from((4..=7).contains(&i)));
    let upper = classified(volume.clone(), |[i, _, _]| u8::from(i >= 4));
    let mean = (350.0 * 3.5 / 2.0 + 875.0 * 2.5) / 6.0;
    let ray = Ray { origin_mm: DVec3::new(-4.0, 2.2, 1.7), direction: DVec3::X };
    for (volume, of, expected) in [
        (&volume, ValueOf::Maximum, 1000.0),
        (&upper, ValueOf::Maximum, 350.0),
        (&volume, ValueOf::Minimum, 0.0),
        (&volume, ValueOf::Mean, mean),
        (&upper, ValueOf::Mean, 175.0),
    ] {
        let model = Model::Value(ValueModel { of, window: [0.0, 1000.0] });
        let base = Scene { model, ..scene_around(volume, vec![], None, [1, 1]) };
        let scene = masked(base.clone(), vec![Class::Shown, Class::Hidden]);
        let expected = pellucid::image::srgb::decode(expected / 1000.0);
        for found in seen(volume, &scene, &ray) {
            assert!((found[1] - expected).abs() < 1e-12, "{of:?}: {}, expected {expected}", found[1]);
        }
        let nothing = masked(base, vec![Class::Hidden; 2]);
        assert_eq!(seen(volume, &nothing, &ray), [[0.0; 4]; 2], "{of:?} of nothing");
    }
}

#[test]
fn a_level_surface_is_open_where_a_label_ends() {
    let ramp = volume_of(unit_grid([11, 5, 5]), |[i, _, _]| 100.0 * i as f64);
    let ray = Ray { origin_mm: DVec3::new(-4.0, 2.2, 1.7), direction: DVec3::X };
    for (hidden, crossings) in [(0..=0, 1), (3..=4, 1), (4..=5, 0), (5..=6, 0), (7..=9, 1)] {
        let volume = classified(ramp.clone(), |[i, _, _]| u8::from(hidden.contains(&i)));
        // At 480 the ray is at 4.8, nearest to voxel 5.
        let surfaces = Model::Surfaces(vec![Surface { value: 480.0, opacity: 0.5, color: BONE }]);
        let scene = Scene { model: surfaces, ..scene_around(&volume, vec![], None, [1, 1]) };
        let expected = if crossings == 1 { 0.5 } else { 0.0 };
        for found in seen(&volume, &masked(scene.clone(), vec![Class::Shown, Class::Hidden]), &ray) {
            assert!((found[3] - expected).abs() < 1e-12, "{hidden:?} hidden: {}, expected {expected}", found[3]);
        }
    }
}

#[test]
fn values_and_surfaces_under_a_mask_agree_with_the_oracle() {
    let volume = blobs(rough_volume(9), 3, 11);
    let surface = |value, opacity| Surface { value, opacity, color: BONE };
    let value = |of| Model::Value(ValueModel { of, window: [-700.0, 1200.0] });
    let models = [
        value(ValueOf::Maximum),
        value(ValueOf::Minimum),
        value(ValueOf::Mean),
        Model::Surfaces(vec![surface(-100.0, 0.2), surface(300.0, 0.5)]),
    ];
    for model in models {
        let base = Scene { model, ..scene_around(&volume, vec![], Some(two_lights(true)), [24, 24]) };
        let scene = masked(base.clone(), vec![Class::Shown, Class::Hidden, Class::Shown]);
        let [found, truth, whole] = [(&scene, exact(1e-3)), (&scene, Method::Reference), (&base, exact(1e-3))]
            .map(|(s, m)| pixels(&volume, s, &m));
        assert!(apart(&found, &truth) < 1e-6, "{:?}: {:e}", scene.model, apart(&found, &truth));
        assert!(apart(&found, &whole) > 0.05, "{:?}: the mask takes part", scene.model);
    }
}

#[test]
fn marching_converges_to_the_oracle_under_a_mask() {
    let volume = blobs(rough_volume(8), 3, 2);
    let base = scene_around(&volume, vec![two_colors()], Some(two_lights(true)), [12, 12]);
    let weighted = function_2d(&[(-200.0, 0.0, BLUE), (300.0, 0.3, BLUE)], &[[0.0, 0.2], [900.0, 1.0]]);
    let in_domain = TransferFunction::new([-1024.0, 3071.0], 1500.0, weighted.terms().to_vec()).expect("a domain");
    let scene = masked(base, vec![Class::Shown, Class::Hidden, Class::Own(in_domain)]);
    let truth = pixels(&volume, &scene, &Method::Reference);
    // Each jump at the border of a class costs up to half a step on either side: first order.
    for rule in [SampleRule::Left, SampleRule::Midpoint] {
        let error = |step_mm| apart(&pixels(&volume, &scene, &Method::March(March { step_mm, rule, ..MARCH })), &truth);
        let (coarse, fine) = (error(0.2), error(0.003125));
        assert!(fine < coarse / 20.0 && fine < 2e-3, "{rule:?}: {coarse:e} then {fine:e}");
    }
}

#[test]
fn skipping_threads_and_tiles_do_not_matter() {
    let volume = blobs(rough_volume(20), 4, 3);
    let base = scene_around(&volume, vec![two_colors()], Some(two_lights(true)), [40, 33]);
    // The first half of the voxels is hidden altogether, so that there is something to skip.
    let volume = classified(volume.clone(), |index| {
        let i = volume.grid().flatten(index);
        if index[2] < 12 { 1 } else { volume.classes().expect("there are classes").values()[i] }
    });
    let scene = masked(base, vec![Class::Shown, Class::Hidden, Class::Own(thin_function()), Class::Hidden]);
    let backwards = March { order: Order::BackToFront, ..MARCH };
    for method in [exact(1e-3), Method::March(MARCH), Method::March(backwards)] {
        let render = |schedule| render_scheduled(&volume, &scene, &method, schedule, &|_| ()).expect("it renders");
        let expected = render(Schedule::default());
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let found = pool.install(|| render(Schedule { shuffled_tiles: Some(5), ..Schedule::default() }));
            assert!(found.image.pixels() == expected.image.pixels(), "{method:?}, {threads} threads");
        }
        let all = render(Schedule { empty_space_skipping: false, ..Schedule::default() });
        assert!(all.image.pixels() == expected.image.pixels(), "{method:?}, nothing skipped");
        if let Method::March(_) = method {
            assert!(expected.statistics.samples < all.statistics.samples, "hidden blocks are skipped");
        }
    }
}

fn thin_function() -> TransferFunction {
    TransferFunction::new([-1024.0, 3071.0], 1500.0, vec![thin_shell()]).expect("a domain")
}

#[test]
fn a_class_that_is_off_by_a_voxel_is_seen() {
    let volume = blobs(rough_volume(9), 3, 11);
    let scene = masked(scene_around(&volume, vec![two_colors()], None, [16, 16]), vec![Class::Shown, Class::Hidden]);
    let mut shifted = volume.classes().expect("there are classes").values().to_vec();
    shifted.rotate_right(1);
    let shifted = volume.clone().with_classes(shifted).expect("as many");
    let worst = apart(&pixels(&shifted, &scene, &exact(1e-3)), &pixels(&volume, &scene, &Method::Reference));
    assert!(worst > 0.05, "the comparisons above must see such a difference, found {worst:e}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn masked_and_clipped_pictures_are_within_tolerance_and_bound(
        volume in properties::volume(),
        functions in (properties::transfer_function(), properties::transfer_function()),
        shading in prop::option::of(properties::shading()),
        normal in prop::option::of(properties::direction()),
        seed in any::<u64>(),
        from in properties::direction(),
        distance in prop_oneof![Just(0.2), 1.2..6.0f64, Just(1e4)],
        tolerance in prop_oneof![Just(1.0 / 255.0), Just(1e-3)],
    ) {
        let mut state = seed;
        let labels = (0..volume.grid().voxel_count()).map(|_| (next_u64(&mut state) % 4) as u8).collect();
        let volume = volume.with_classes(labels).expect("a class for each voxel");
        let camera = properties::camera(volume.grid(), from, distance, seed % 2 == 0);
        let through = volume.grid().center_mm();
        let half_spaces = normal.iter().map(|&normal| HalfSpace { normal, offset_mm: normal.dot(through) }).collect();
        let mask = Mask { classes: vec![Class::Shown, Class::Hidden, Class::Own(functions.1)] };
        let effects = Effects { clip: Clip { half_spaces }, mask: Some(mask), ..Effects::default() };
        let scene = Scene { model: Model::Light, transfer_function: functions.0, shading, camera, background: Background::Transparent, effects };
        properties::held_to_tolerance_and_bound(&volume, &scene, tolerance)?;
    }
}
