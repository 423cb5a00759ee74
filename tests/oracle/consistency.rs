//! The oracle held against itself by other ways: cut rays, reversed rays, the other method, whole pictures.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use pellucid::oracle::Oracle;
use pellucid::scene::{Background, Camera, Projection, Ray, Scene};
use pellucid::volume::{Grid, Volume};

use crate::support::scenes::{
    BLUE, BONE, RED, difference, function, function_1d, grid, headlight, lamp, next_unit, noise_hu, rays_through,
    scene, shaded, weighted,
};

fn sheared() -> Grid {
    grid([7, 5, 6], [[0.75, 0.1, 0.0], [-0.2, 0.9, 0.3], [0.0, 0.7, 2.5]], [10.0, -20.0, 30.0])
}

fn scenes() -> Vec<(&'static str, Scene)> {
    let tissues = [
        (-200.0, 0.0, RED),
        (-190.0, 0.5, RED),
        (150.0, 0.1, BLUE),
        (150.0, 2.0, BONE),
        (400.0, 0.0, BONE),
        (500.0, 3.0, BONE),
    ];
    let shells = [(-10.0, 0.0, BLUE), (0.0, 20.0, BLUE), (10.0, 0.0, RED), (790.0, 0.0, RED), (800.0, 20.0, RED)];
    let two_dimensional = || {
        function(vec![
            weighted(&tissues, &[[20.0, 0.0], [300.0, 1.0], [300.0, 0.25], [600.0, 0.5]]),
            weighted(&shells, &[[100.0, 1.0], [400.0, 0.0]]),
        ])
    };
    vec![
        ("tissues", scene(function_1d(&tissues))),
        ("shells", scene(function_1d(&shells))),
        ("2D", scene(two_dimensional())),
        ("opaque", scene(function_1d(&[(200.0, 0.0, BONE), (201.0, 1e5, BONE)]))),
        ("headlight", shaded(scene(function_1d(&tissues)), headlight())),
        ("lamp and 2D", shaded(scene(two_dimensional()), lamp(50.0))),
    ]
}

fn volume() -> Volume {
    noise_hu(sheared(), 42)
}

#[test]
fn a_ray_cut_anywhere_joins_to_the_whole() {
    let volume = volume();
    let mut state = 7;
    for (name, scene) in scenes() {
        let oracle = Oracle::new(&volume, &scene);
        for ray in rays_through(volume.grid(), 60, 5) {
            let whole = oracle.segment(&ray, 0.0, f64::INFINITY);
            let cut_mm = 40.0 * next_unit(&mut state);
            let joined = oracle.segment(&ray, 0.0, cut_mm).then(&oracle.segment(&ray, cut_mm, f64::INFINITY));
            let error = difference(whole.rgba(), joined.rgba());
            assert!(error < 1e-13, "{name}, cut at {cut_mm} mm: error {error:e}, {ray:?}");
        }
    }
}

#[test]
fn a_reversed_ray_has_the_same_transmittance() {
    let volume = volume();
    for (name, scene) in scenes() {
        let oracle = Oracle::new(&volume, &scene);
        for ray in rays_through(volume.grid(), 60, 6) {
            let back = Ray { origin_mm: ray.origin_mm + 64.0 * ray.direction, direction: -ray.direction };
            let (there, again) = (oracle.radiance(&ray)[3], oracle.radiance(&back)[3]);
            assert!((there - again).abs() < 1e-13, "{name}: found {there} and back {again}, {ray:?}");
        }
    }
}

#[test]
fn panels_and_collocation_agree() {
    let volume = volume();
    for (name, scene) in scenes().into_iter().filter(|(_, s)| s.shading.is_none()) {
        let oracle = Oracle::new(&volume, &scene);
        for ray in rays_through(volume.grid(), 100, 8) {
            let panels = oracle.segment(&ray, 0.0, f64::INFINITY).rgba();
            let collocation = oracle.segment_by_collocation(&ray, 0.0, f64::INFINITY).rgba();
            let error = difference(panels, collocation);
            assert!(error < 1e-12, "{name}: error {error:e}, {ray:?}");
        }
    }
}

#[test]
fn shading_with_ambient_light_alone_is_no_shading() {
    let volume = volume();
    for (name, scene) in scenes().into_iter().filter(|(_, s)| s.shading.is_none()) {
        let mut ambient = headlight();
        (ambient.ambient, ambient.diffuse, ambient.specular) = (1.0, 0.0, 0.0);
        let lit = shaded(scene.clone(), ambient);
        let (plain, lit) = (Oracle::new(&volume, &scene), Oracle::new(&volume, &lit));
        for ray in rays_through(volume.grid(), 30, 9) {
            let error = difference(plain.radiance(&ray), lit.radiance(&ray));
            assert!(error < 1e-12, "{name}: error {error:e}, {ray:?}");
        }
    }
}

#[test]
fn a_picture_is_its_pixels_over_the_background() {
    let volume = volume();
    let mut scene = scenes().swap_remove(0).1;
    let center = volume.grid().center_mm();
    let projection = Projection::Perspective { fov_degrees: 20.0 };
    scene.camera = Camera::look_at(center + DVec3::new(5.0, -50.0, 9.0), center, DVec3::Z, projection, [9, 6]).unwrap();
    let transparent = Oracle::new(&volume, &scene).render(|_| {});
    let behind = [0.25, 0.5, 1.0];
    scene.background = Background::Color(behind);
    let finished = AtomicUsize::new(0);
    let oracle = Oracle::new(&volume, &scene);
    let opaque = oracle.render(|pixels| {
        finished.fetch_add(pixels, Ordering::Relaxed);
    });
    assert_eq!(finished.into_inner(), 54, "progress counts every pixel");
    assert!(transparent.iter().any(|p| p[3] > 0.5) && transparent.iter().any(|p| p[3] == 0.0), "something and nothing");
    for (i, ([r, g, b, alpha], found)) in transparent.into_iter().zip(opaque).enumerate() {
        let over: [f64; 3] = std::array::from_fn(|c| [r, g, b][c] + (1.0 - alpha) * behind[c]);
        let expected = [over[0], over[1], over[2], 1.0];
        assert!(difference(found, expected) < 1e-15, "pixel {i}: found {found:?}, expected {expected:?}");
        assert_eq!(found, oracle.pixel(i % 9, i / 9), "pixel {i} alone");
    }
}
