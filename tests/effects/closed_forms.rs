//! Fog, haze and depth cue where a formula says what is seen.

use glam::DVec3;
use pellucid::scene::{
    Background, Camera, DepthCue, Effects, Fog, FogLaw, Haze, Light, Model, Projection, Scene, Shading, Surface,
};
use pellucid::volume::{Grid, Volume};

use super::{assert_everyone_sees, one_ray};
use crate::support::scenes::{BLUE, RED, function_1d, headlight, scene, volume_of};

/// A wall whose front is at z = 0, so dense that only its front is seen and so thin that a short march passes it.
fn wall(value: impl Fn([usize; 3]) -> f64) -> Volume {
    let grid = Grid::axis_aligned([5, 5, 4], DVec3::new(10.0, 10.0, 1e-3)).expect("a valid grid");
    volume_of(grid, value)
}

/// Opaque at any value.
fn opaque_scene(distance_mm: f64) -> Scene {
    let mut scene = scene(function_1d(&[(-2000.0, 1e6, RED), (2000.0, 1e6, RED)]));
    scene.camera = one_ray(DVec3::new(17.0, 23.0, -distance_mm), DVec3::Z);
    scene
}

/// OpenGL 2.1, equations 3.24 to 3.26, on an eye distance c.
fn opengl(law: FogLaw, c: f64) -> f64 {
    match law {
        FogLaw::Exp { density_per_mm: d } => (-(d * c)).exp(),
        FogLaw::Exp2 { density_per_mm: d } => (-((d * c) * (d * c))).exp(),
        FogLaw::Linear { start_mm: s, end_mm: e } => ((e - c) / (e - s)).clamp(0.0, 1.0),
    }
}

#[test]
fn fog_on_a_wall_is_opengls() {
    let wall = wall(|_| 0.0);
    for distance in [0.5, 40.0, 120.0, 350.0] {
        for law in [
            FogLaw::Linear { start_mm: 60.0, end_mm: 300.0 },
            FogLaw::Exp { density_per_mm: 0.004 },
            FogLaw::Exp2 { density_per_mm: 0.006 },
        ] {
            let mut scene = opaque_scene(distance);
            scene.effects.fog = Some(Fog { law, color: BLUE });
            let f = opengl(law, distance);
            let [r, g, b] = std::array::from_fn(|c| f * RED[c] + (1.0 - f) * BLUE[c]);
            let what = format!("{law:?} at {distance} mm");
            assert_everyone_sees(&wall, &scene, [r, g, b, 1.0], [1e-6, 1e-4, 2e-6], &what);
        }
    }
}

#[test]
fn fog_on_a_level_surface_is_opengls() {
    // The level is crossed half way between voxels 1 and 2 along z, at 1.5 mm.
    let grid = Grid::axis_aligned([4, 4, 5], DVec3::ONE).expect("a valid grid");
    let volume = volume_of(grid, |[_, _, k]| if k < 2 { 0.0 } else { 100.0 });
    let mut scene = opaque_scene(80.0);
    scene.camera = one_ray(DVec3::new(1.3, 1.6, -80.0), DVec3::Z);
    scene.model = Model::Surfaces(vec![Surface { value: 50.0, opacity: 0.5, color: RED }]);
    let law = FogLaw::Exp2 { density_per_mm: 0.01 };
    scene.effects.fog = Some(Fog { law, color: BLUE });
    let f = opengl(law, 81.5);
    let [r, g, b] = std::array::from_fn(|c| 0.5 * (f * RED[c] + (1.0 - f) * BLUE[c]));
    let ray = scene.camera.pixel_ray(0, 0);
    let exact =
        pellucid::integrate::exact::tracer(&volume, &scene, 1e-6, pellucid::integrate::exact::Precision::Single);
    let exact = exact.trace(&ray).expect("the ray meets the volume");
    let oracle = pellucid::oracle::Oracle::new(&volume, &scene).radiance(&ray);
    for (c, expected) in [r, g, b].into_iter().enumerate() {
        for (name, found) in [("exact", exact.radiance[c]), ("oracle", oracle[c])] {
            assert!((found - expected).abs() < 1e-12, "{name}, channel {c}: found {found}, expected {expected}");
        }
    }
}

/// I₀T + C(1 − T).
fn through_haze(background: [f64; 3], haze: &Haze, length_mm: f64) -> [f64; 4] {
    let t = (-haze.extinction_per_mm * length_mm).exp();
    let [r, g, b] = std::array::from_fn(|c| background[c] * t + haze.color[c] * (1.0 - t));
    [r, g, b, 1.0]
}

const HAZE: Haze = Haze { extinction_per_mm: 0.006, color: [0.5, 0.75, 1.0], end_mm: 250.0 };

#[test]
fn haze_alone_is_background_through_a_homogeneous_medium() {
    let empty = volume_of(Grid::axis_aligned([9, 9, 9], DVec3::ONE).expect("a valid grid"), |_| -500.0);
    let mut scene = scene(function_1d(&[(0.0, 0.0, RED), (100.0, 1.0, RED)]));
    scene.background = Background::Color([0.25, 0.5, 0.125]);
    scene.effects.haze = Some(HAZE);
    for (what, x) in [("through an empty volume", 4.3), ("past the volume", 30.0)] {
        scene.camera = one_ray(DVec3::new(x, 4.6, -100.0), DVec3::Z);
        let expected = through_haze([0.25, 0.5, 0.125], &HAZE, 250.0);
        assert_everyone_sees(&empty, &scene, expected, [1e-6, 0.5, 1e-6], what);
        let transparent = Scene { background: Background::Transparent, ..scene.clone() };
        let [r, g, b, _] = through_haze([0.0; 3], &HAZE, 250.0);
        let alpha = 1.0 - (-HAZE.extinction_per_mm * 250.0).exp();
        assert_everyone_sees(&empty, &transparent, [r, g, b, alpha], [1e-6, 0.5, 1e-6], what);
    }
}

#[test]
fn haze_in_a_homogeneous_volume_adds_to_it() {
    // 8 mm of σ 0.2 in red, from 100 mm on, in haze up to 250 mm.
    let volume = volume_of(Grid::axis_aligned([9, 9, 9], DVec3::ONE).expect("a valid grid"), |_| 50.0);
    let mut scene = scene(function_1d(&[(0.0, 0.2, RED), (100.0, 0.2, RED)]));
    scene.camera = one_ray(DVec3::new(4.3, 4.6, -100.0), DVec3::Z);
    scene.effects.haze = Some(HAZE);
    let (sigma, h) = (0.2, HAZE.extinction_per_mm);
    let [t_before, t_inside, t_behind] = [h * 100.0, (sigma + h) * 8.0, h * 142.0].map(|tau| (-tau).exp());
    let seen = |c: usize| {
        let mixed = (sigma * RED[c] + h * HAZE.color[c]) / (sigma + h);
        let behind = HAZE.color[c] * (1.0 - t_behind);
        HAZE.color[c] * (1.0 - t_before) + t_before * (mixed * (1.0 - t_inside) + t_inside * behind)
    };
    let expected = [seen(0), seen(1), seen(2), 1.0 - t_before * t_inside * t_behind];
    assert_everyone_sees(&volume, &scene, expected, [1e-6, 0.5, 1e-6], "a red cube in haze");
    scene.effects.haze = Some(Haze { color: [0.0; 3], ..HAZE });
    let blue = |c: usize| t_before * sigma * RED[c] / (sigma + h) * (1.0 - t_inside);
    let dark = [blue(0), blue(1), blue(2), expected[3]];
    assert_everyone_sees(&volume, &scene, dark, [1e-6, 0.5, 1e-6], "a red cube in smoke");
}

#[test]
fn the_depth_cue_dims_what_is_lit_by_its_distance_from_the_picture_plane() {
    // Dense from the front on, and rising along z: the normal is against it.
    let volume = wall(|[_, _, k]| 100.0 * k as f64);
    let cue = DepthCue { constant: 0.8, per_mm: 0.01 };
    let lights = vec![Light::Directional { towards: -DVec3::Z, color: [1.0, 0.5, 0.25] }];
    for distance in [20.0, 100.0] {
        let mut scene = opaque_scene(distance);
        scene.shading = Some(Shading { specular: 0.0, lights: lights.clone(), ..headlight() });
        scene.effects = Effects { depth_cue: Some(cue), ..Effects::default() };
        let factor = 1.0 / (0.8 + 0.01 * distance);
        let lit = |c: usize| RED[c] * (0.125 + 0.75 * [1.0, 0.5, 0.25][c] * factor);
        let expected = [lit(0), lit(1), lit(2), 1.0];
        assert_everyone_sees(&volume, &scene, expected, [1e-6, 1e-4, 2e-6], "parallel rays");
        // The same through an oblique ray of a perspective camera: what counts is the distance from the plane.
        let eye = DVec3::new(8.0, 12.0, -distance);
        let projection = Projection::Perspective { fov_degrees: 10.0 };
        scene.camera = Camera::look_at(eye, eye + DVec3::Z, DVec3::Y, projection, [2, 2]).expect("a valid camera");
        assert_everyone_sees(&volume, &scene, expected, [1e-6, 1e-4, 2e-6], "perspective");
    }
}
