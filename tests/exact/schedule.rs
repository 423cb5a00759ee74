//! What the exact integrator passes over costs no more than its bound says: blocks in which nothing shows, and the ends of rays.

use pellucid::image::Image;
use pellucid::integrate::{Rendered, Schedule, render_scheduled};
use pellucid::plan::{Bound, Exact, Method};
use pellucid::scene::{ClassifyAt, Effects, Haze, Scene};
use pellucid::transfer::{Curve, Knot, Optics, Term};
use pellucid::volume::Volume;

use crate::march::scenes::{blobs_f32, blobs_i16, scene, tissue_1d, tissue_2d, two_lights as lit};
use crate::support::scenes::{difference, headlight, rough_volume, scene_around, thin_shell, two_colors, two_lights};

const TOLERANCE: f64 = 1.0 / 255.0;

/// Two colours that absorb and shine so many times as much.
fn denser(strength: f64) -> Term {
    let term = two_colors();
    let knots = term.curve.knots().iter().map(|knot| {
        let Optics { extinction_per_mm, emission_per_mm } = knot.optics;
        let emission_per_mm = emission_per_mm.map(|q| strength * q);
        Knot { optics: Optics { extinction_per_mm: strength * extinction_per_mm, emission_per_mm }, ..*knot }
    });
    Term { curve: Curve::new(knots.collect()).expect("finite knots"), ..term }
}

/// Scenes for the kernels, by the start of their names.
fn subjects() -> Vec<(&'static str, Volume, Scene, Bound)> {
    let (estimated, proven) = (Bound::Estimated, Bound::Proven);
    let (rough, shorts, floats) = (rough_volume(14), blobs_i16(), blobs_f32());
    let around =
        |terms: Vec<Term>, shading, effects| Scene { effects, ..scene_around(&rough, terms, shading, [31, 23]) };
    let three_lights =
        pellucid::scene::Shading { lights: [two_lights(true).lights, headlight().lights].concat(), ..headlight() };
    let haze =
        Effects { haze: Some(Haze { extinction_per_mm: 0.01, color: [0.4; 3], end_mm: 100.0 }), ..Effects::default() };
    let at_voxels = Effects { classify: ClassifyAt::Voxels, ..Effects::default() };
    let plain = Effects::default;
    vec![
        ("exact/i16/tf1d/unlit/", rough.clone(), around(vec![denser(20.0)], None, plain()), estimated),
        ("exact/i16/tf1d/unlit/", shorts.clone(), scene(&shorts, tissue_1d(), None), estimated),
        ("exact/f32/tf2d/unlit/", floats.clone(), scene(&floats, tissue_2d(), None), estimated),
        ("exact/i16/tf2d/lit/", shorts.clone(), scene(&shorts, tissue_2d(), Some(lit())), estimated),
        ("exact/i16/tf2d/lit-proven/", shorts.clone(), scene(&shorts, tissue_2d(), Some(lit())), proven),
        ("exact/i16/tf1d/lit/", rough.clone(), around(vec![denser(20.0)], Some(two_lights(true)), plain()), estimated),
        ("exact/i16/tf2d/lit/f32", rough.clone(), around(vec![thin_shell()], Some(three_lights), plain()), estimated),
        ("exact/i16/tf1d/atmosphere/f64", rough.clone(), around(vec![denser(20.0)], None, haze), estimated),
        ("exact/voxels/tf1d/unlit/f64", rough.clone(), around(vec![denser(20.0)], None, at_voxels), estimated),
    ]
}

fn apart(a: &Image, b: &Image) -> f64 {
    let pairs = a.pixels().iter().zip(b.pixels());
    pairs.map(|(a, b)| difference(a.map(f64::from), b.map(f64::from))).fold(0.0, f64::max)
}

/// Rendered as usual and by a schedule that passes over less.
fn rendered([usual, other]: [Schedule; 2], volume: &Volume, scene: &Scene, bound: Bound) -> [Rendered; 2] {
    let method = Method::Exact(Exact { tolerance: TOLERANCE, bound });
    [usual, other].map(|schedule| render_scheduled(volume, scene, &method, schedule, &|_| ()).expect("a picture"))
}

#[test]
fn rays_that_go_on_to_their_end_bring_no_more_than_the_tolerance() {
    let to_the_end = Schedule { early_termination: false, ..Schedule::default() };
    let mut ended_early = Vec::new();
    for (name, volume, scene, bound) in subjects() {
        let [ended, whole] = rendered([Schedule::default(), to_the_end], &volume, &scene, bound);
        let kernel = &ended.statistics.kernel;
        assert!(kernel.starts_with(name) && whole.statistics.kernel == *kernel, "{name}: {kernel}");
        // Up to where a ray ends both do the same, so no more than the rest of it is between them.
        let apart = apart(&ended.image, &whole.image);
        assert!(apart <= TOLERANCE, "{name}: {apart:e} apart");
        let [few, many] = [&ended, &whole].map(|r| r.statistics.samples);
        assert!(few <= many, "{name}: rays of {few} pieces that end early, of {many} that do not");
        ended_early.extend((few < many && apart > 0.0).then_some(name));
        let [a, b] = [&ended, &whole].map(|r| r.statistics.error_bound.expect("a bound"));
        assert!(a.max(b) <= TOLERANCE * (1.0 + 1e-9), "{name}: bounds of {a:e}, and of {b:e} to the end");
    }
    for kernel in ["/lit/", "/unlit/"] {
        assert!(
            ended_early.iter().any(|name| name.contains(kernel)),
            "{kernel}: no ray ends early but in {ended_early:?}"
        );
    }
}

#[test]
fn empty_blocks_may_be_passed_over_or_looked_at() {
    let plodding = Schedule { empty_space_skipping: false, ..Schedule::default() };
    for (name, volume, scene, bound) in subjects() {
        let [skipped, looked_at] = rendered([Schedule::default(), plodding], &volume, &scene, bound);
        let apart = apart(&skipped.image, &looked_at.image);
        assert!(apart <= TOLERANCE, "{name}: {apart:e} apart");
        let [a, b] = [&skipped, &looked_at].map(|r| r.statistics.error_bound.expect("a bound"));
        assert!(a.max(b) <= TOLERANCE * (1.0 + 1e-9), "{name}: bounds of {a:e} and {b:e}");
        assert_eq!(skipped.statistics.rays, looked_at.statistics.rays, "{name}: rays");
    }
}

#[test]
fn what_lies_in_the_dark_is_not_halved_to_no_end() {
    // Opaque from the first cell on: to the end, all others are passed without any light.
    let volume = rough_volume(14);
    let scene = scene_around(&volume, vec![denser(1e3)], Some(headlight()), [12, 12]);
    let to_the_end = Schedule { early_termination: false, ..Schedule::default() };
    for bound in [Bound::Estimated, Bound::Proven] {
        let [_, whole] = rendered([Schedule::default(), to_the_end], &volume, &scene, bound);
        let per_ray = whole.statistics.samples / whole.statistics.rays;
        assert!(per_ray < 20_000, "{bound:?}: {per_ray} pieces on a ray");
    }
}
