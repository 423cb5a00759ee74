//! Settings that must not matter, and settings that must.

use glam::DVec3;
use pellucid::plan::{Colors, Emission, Jitter, JitterKind, Lattice, March, Order, SampleRule};
use pellucid::scene::{Background, Camera, Projection, Shading};

use super::scenes::{
    MARCH, apart, blobs_i16, homogeneous, marched, oblique, pixels, scene, tissue_1d, tissue_2d, two_lights,
};

const ORDERS: [Order; 2] = [Order::FrontToBack, Order::BackToFront];
const COLORS: [Colors; 2] = [Colors::Associated, Colors::Straight];
const RULES: [SampleRule; 3] = [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid];

#[test]
fn directions_and_colors_differ_by_rounding_only() {
    let volume = blobs_i16();
    let scene = scene(&volume, tissue_2d(), Some(two_lights()));
    for rule in RULES {
        for emission in [Emission::PerLength, Emission::PerSample] {
            for lattice in [Lattice::PerRay, Lattice::ViewPlanes] {
                let base = March { rule, emission, lattice, ..MARCH };
                let expected = pixels(&volume, &scene, base);
                for order in ORDERS {
                    for colors in COLORS {
                        let settings = March { order, colors, ..base };
                        let worst = apart(&pixels(&volume, &scene, settings), &expected);
                        assert!(worst < 5e-6, "{settings:?}: {worst:e} from front to back with associated colours");
                    }
                }
            }
        }
    }
}

#[test]
fn view_planes_converge_to_the_picture_of_rays() {
    let volume = blobs_i16();
    let mut scene = scene(&volume, tissue_1d(), None);
    scene.camera = oblique(volume.grid(), Projection::Parallel { height_mm: 25.0 });
    let worst = |step_mm: f64| {
        let per_ray = pixels(&volume, &scene, March { step_mm, ..MARCH });
        apart(&per_ray, &pixels(&volume, &scene, March { step_mm, lattice: Lattice::ViewPlanes, ..MARCH }))
    };
    let (coarse, fine) = (worst(0.2), worst(0.05));
    assert!(coarse < 5e-3, "{coarse:e} apart at 0.2 mm");
    assert!(fine < 0.15 * coarse, "{fine:e} apart at 0.05 mm, {coarse:e} at 0.2 mm: not of second order");
}

#[test]
fn each_setting_does_something() {
    let volume = blobs_i16();
    let mut scene = scene(&volume, tissue_1d(), None);
    // From inside a blob, so that the ends of rays count: the left rule and the trapezoid differ there.
    let from = volume.grid().index_to_lps_mm().transform_point3(DVec3::new(7.0, 7.0, 6.0));
    let projection = Projection::Perspective { fov_degrees: 60.0 };
    scene.camera = Camera::look_at(from, volume.grid().center_mm(), DVec3::Z, projection, [37, 29]).unwrap();
    let base = pixels(&volume, &scene, MARCH);
    let jitter = |seed, kind| Some(Jitter { seed, kind });
    let changed = [
        March { step_mm: 0.8, ..MARCH },
        March { rule: SampleRule::Left, ..MARCH },
        March { rule: SampleRule::Trapezoid, ..MARCH },
        March { emission: Emission::PerSample, ..MARCH },
        March { lattice: Lattice::ViewPlanes, ..MARCH },
        March { jitter: jitter(1, JitterKind::White), ..MARCH },
        March { jitter: jitter(2, JitterKind::White), ..MARCH },
        March { jitter: jitter(1, JitterKind::LowDiscrepancy), ..MARCH },
        March { jitter: jitter(1, JitterKind::White), lattice: Lattice::ViewPlanes, ..MARCH },
        March { termination_transmittance: 0.3, ..MARCH },
    ];
    let pictures: Vec<_> = changed.iter().map(|&settings| pixels(&volume, &scene, settings)).collect();
    for (i, picture) in pictures.iter().enumerate() {
        assert!(apart(picture, &base) > 1e-4, "{:?} changes nothing", changed[i]);
        for (j, other) in pictures[..i].iter().enumerate() {
            assert!(apart(picture, other) > 1e-4, "{:?} and {:?} are alike", changed[i], changed[j]);
        }
    }
}

#[test]
fn jitter_is_repeatable_and_costs_no_more_than_its_order() {
    let volume = blobs_i16();
    let scene = scene(&volume, tissue_1d(), None);
    let fine = pixels(&volume, &scene, March { step_mm: 0.01, ..MARCH });
    for kind in [JitterKind::White, JitterKind::LowDiscrepancy] {
        let settings = March { jitter: Some(Jitter { seed: 9, kind }), step_mm: 0.1, ..MARCH };
        let found = pixels(&volume, &scene, settings);
        assert_eq!(found, pixels(&volume, &scene, settings), "{kind:?} twice");
        let worst = apart(&found, &fine);
        assert!(worst < 2e-3, "{kind:?}: {worst:e} from the fine picture");
    }
}

#[test]
fn early_termination_costs_at_most_its_transmittance() {
    let volume = blobs_i16();
    let scene = scene(&volume, homogeneous(0.6, [1.0, 0.5, 0.25]), None);
    let full = marched(&volume, &scene, MARCH);
    let mut before = f64::INFINITY;
    for eps in [0.5, 0.1, 1e-2, 1e-3] {
        let early = marched(&volume, &scene, March { termination_transmittance: eps, ..MARCH });
        let worst = apart(early.image.pixels(), full.image.pixels());
        // What is left behind has a transmittance below ε and colours of at most 1.
        assert!(worst <= eps && worst <= before, "stopped at {eps}: {worst:e} off, {before:e} at the one before");
        assert!(
            early.statistics.samples < full.statistics.samples,
            "stopped at {eps} after {} of {} samples",
            early.statistics.samples,
            full.statistics.samples
        );
        before = worst;
    }
    assert!(before < 1e-3);
    let backwards = March { order: Order::BackToFront, ..MARCH };
    let stopped = March { termination_transmittance: 0.5, ..backwards };
    assert_eq!(pixels(&volume, &scene, stopped), pixels(&volume, &scene, backwards), "nothing to stop from behind");
}

#[test]
fn a_lit_scene_without_strength_is_the_unlit_one() {
    let volume = blobs_i16();
    let off = Shading { ambient: 1.0, diffuse: 0.0, specular: 0.0, ..two_lights() };
    let lit = pixels(&volume, &scene(&volume, tissue_1d(), Some(off)), MARCH);
    // What is shaded is summed in another order than what is not.
    let worst = apart(&lit, &pixels(&volume, &scene(&volume, tissue_1d(), None), MARCH));
    assert!(worst < 1e-6, "{worst:e} apart");
}

#[test]
fn a_background_shines_through_what_the_volume_lets_pass() {
    let volume = blobs_i16();
    let mut scene = scene(&volume, tissue_1d(), None);
    let over_nothing = pixels(&volume, &scene, MARCH);
    scene.background = Background::Color([0.25, 0.5, 1.0]);
    let over_color = pixels(&volume, &scene, MARCH);
    let expected: Vec<[f32; 4]> = over_nothing
        .iter()
        .map(|[r, g, b, a]| [r + 0.25 * (1.0 - a), g + 0.5 * (1.0 - a), b + (1.0 - a), 1.0])
        .collect();
    let worst = apart(&over_color, &expected);
    assert!(worst < 1e-6, "{worst:e} from the over operator");
}
