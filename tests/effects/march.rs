//! Marching through effects of light converges, with order 2, to what the exact integrator and the oracle see.

use glam::DVec3;
use pellucid::integrate::render;
use pellucid::oracle::Oracle;
use pellucid::plan::{March, Method, Order, SampleRule};
use pellucid::scene::{Camera, DepthCue, Effects, Fog, FogLaw, Haze, Projection, Scattering, Scene, Shadows};
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction};
use pellucid::verify::order;
use pellucid::volume::{Grid, Volume};

use crate::march::scenes::MARCH;
use crate::support::scenes::{lamp, scene, volume_of};

/// One cell of 8 mm with a transfer function without a knot in it: nothing is bent but by shading, and that is not.
fn one_cell() -> (Volume, Scene) {
    let grid = Grid::axis_aligned([2, 2, 2], DVec3::splat(8.0)).expect("a valid grid");
    let corners = [100.0, 320.0, 540.0, 700.0, 260.0, 480.0, 690.0, 900.0];
    let volume = volume_of(grid, |[i, j, k]| corners[i + 2 * j + 4 * k]);
    let optics = |s, q| Optics { extinction_per_mm: s, emission_per_mm: q };
    let knots = [(0.0, optics(0.01, [0.0, 0.05, 0.02])), (1000.0, optics(0.2, [0.15, 0.05, 0.1]))];
    let curve = Curve::new(knots.map(|(value, optics)| Knot { value, optics }).to_vec()).expect("a valid curve");
    let tf = TransferFunction::new([0.0, 1000.0], 500.0, vec![Term { curve, weight: None }]);
    let center = volume.grid().center_mm();
    let eye = center - 40.0 * DVec3::new(0.48, 0.64, 0.6);
    let projection = Projection::Perspective { fov_degrees: 22.0 };
    let mut scene = scene(tf.expect("a valid transfer function"));
    scene.camera = Camera::look_at(eye, center, DVec3::Z, projection, [9, 9]).expect("a valid camera");
    scene.shading = Some(lamp(20.0));
    (volume, scene)
}

fn effects() -> Vec<(&'static str, Effects)> {
    let towards = DVec3::new(1.0, -2.0, 2.5).normalize();
    let off = Effects::default;
    let depth_cue = Some(DepthCue { constant: 0.5, per_mm: 0.02 });
    let shadows = Some(Shadows { strength: 1.0 });
    let scattering = Some(Scattering { albedo: 0.6, anisotropy: 0.4, lights: vec![(towards, [1.0, 0.8, 0.6])] });
    let fog = Some(Fog { law: FogLaw::Exp2 { density_per_mm: 0.02 }, color: [0.2, 0.4, 0.6] });
    let haze = Some(Haze { extinction_per_mm: 0.02, color: [0.5, 0.3, 0.1], end_mm: 90.0 });
    vec![
        ("depth cue", Effects { depth_cue, ..off() }),
        ("shadows", Effects { shadows, ..off() }),
        ("scattering", Effects { scattering: scattering.clone(), ..off() }),
        ("fog", Effects { fog, ..off() }),
        ("haze", Effects { haze, ..off() }),
        ("all", Effects { depth_cue, shadows, scattering, fog, haze, ..off() }),
    ]
}

fn off_the_truth(volume: &Volume, scene: &Scene, truth: &[[f64; 4]], settings: March) -> f64 {
    let rendered = render(volume, scene, &Method::March(settings), &|_| ()).expect("a picture");
    let found: Vec<[f64; 4]> = rendered.image.pixels().iter().map(|p| p.map(f64::from)).collect();
    pellucid::verify::largest_difference(&found, truth)
}

#[test]
fn every_effect_is_of_second_order_in_the_step() {
    let (volume, mut scene) = one_cell();
    for (name, effects) in effects() {
        scene.effects = effects;
        let truth = Oracle::new(&volume, &scene).render(|_| ());
        for rule in [SampleRule::Midpoint, SampleRule::Trapezoid] {
            for marching in [Order::FrontToBack, Order::BackToFront] {
                let error = |step_mm: f64| {
                    [step_mm, off_the_truth(&volume, &scene, &truth, March { rule, order: marching, step_mm, ..MARCH })]
                };
                let series = [1.6, 0.8, 0.4, 0.2].map(error);
                let found = order(&series);
                assert!((found - 2.0).abs() < 0.2, "{name}, {rule:?}, {marching:?}: order {found:.2} of {series:?}");
            }
        }
    }
}

#[test]
fn a_scene_with_another_haze_is_not_what_the_march_converges_to() {
    let (volume, mut scene) = one_cell();
    scene.effects = effects().pop().map(|(_, all)| all).expect("all of them");
    let truth = Oracle::new(&volume, &scene).render(|_| ());
    if let Some(haze) = &mut scene.effects.haze {
        haze.end_mm += 1.0;
    }
    let off = off_the_truth(&volume, &scene, &truth, March { step_mm: 0.1, ..MARCH });
    assert!(off > 1e-3, "a millimetre of haze must be seen, found {off:e}");
}
