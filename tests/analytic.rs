//! Pictures with a known answer.

use std::f64::consts::PI;

use glam::{DAffine3, DMat3, DVec3};
use pellucid::field::{GradientUnits, Position, Trilinear};
use pellucid::plan::{Jitter, JitterKind, Lattice, March, SampleRule};
use pellucid::scene::{Background, Camera, Effects, Light, Model, Projection, Scene, Shading};
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};

use crate::march::scenes::{MARCH, apart, blobs_i16, homogeneous, marched, pixels, scene};

const RULES: [SampleRule; 3] = [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid];

/// A field given by a formula of the position in mm, in f32.
fn sampled(grid: Grid, formula: impl Fn(DVec3) -> f64) -> Volume {
    let value = |index: usize| {
        let at = DVec3::from_array(grid.unflatten(index).map(|i| i as f64));
        formula(grid.index_to_lps_mm().transform_point3(at)) as f32
    };
    let stored = (0..grid.voxel_count()).map(value).collect();
    Volume::new(grid, Samples::F32(stored), Rescale::IDENTITY, Quantity::Arbitrary).unwrap()
}

fn seen(volume: &Volume, direction: DVec3, projection: Projection, size: [usize; 2]) -> Camera {
    let center = volume.grid().center_mm();
    Camera::look_at(center - 200.0 * direction, center, DVec3::new(0.0, 0.1, 1.0), projection, size).unwrap()
}

#[test]
fn a_homogeneous_slab_lets_through_exp_of_minus_sigma_length() {
    // 30 mm thick, 200 mm wide: rays at an angle stay inside from face to face.
    let grid = Grid::axis_aligned([41, 31, 41], DVec3::new(5.0, 1.0, 5.0)).unwrap();
    let volume = sampled(grid, |p| p.x + p.z);
    for angle in [0.0f64, 40.0] {
        let direction = DVec3::new(angle.to_radians().sin(), angle.to_radians().cos(), 0.0);
        let camera = seen(&volume, direction, Projection::Parallel { height_mm: 20.0 }, [6, 6]);
        let length_mm = 30.0 / angle.to_radians().cos();
        for sigma in [1e-6, 1e-3, 0.05, 2.0] {
            let scene = Scene { camera, ..scene(&volume, homogeneous(sigma, [0.5, 0.25, 1.0]), None) };
            for rule in RULES {
                for step_mm in [0.01, 0.37, 1.0, 29.0, 1e3] {
                    for jitter in [None, Some(Jitter { seed: 3, kind: JitterKind::White })] {
                        let settings = March { rule, step_mm, jitter, ..MARCH };
                        let alpha = -(-sigma * length_mm).exp_m1();
                        let expected = [0.5 * alpha, 0.25 * alpha, alpha, alpha];
                        let worst = apart(&pixels(&volume, &scene, settings), &[expected; 36]);
                        assert!(worst < 4e-6, "σ = {sigma}/mm, {angle}°, {settings:?}: {worst:e} from {expected:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn opacity_correction_makes_a_homogeneous_picture_independent_of_the_step() {
    let volume = blobs_i16();
    let scene = scene(&volume, homogeneous(0.08, [0.9, 0.5, 0.1]), None);
    let expected = pixels(&volume, &scene, MARCH);
    for rule in RULES {
        for lattice in [Lattice::PerRay, Lattice::ViewPlanes] {
            for step_mm in [0.02, 0.3, 1.0, 7.0] {
                let settings = March { rule, lattice, step_mm, ..MARCH };
                let worst = apart(&pixels(&volume, &scene, settings), &expected);
                assert!(worst < 2e-6, "{settings:?}: {worst:e} from the picture at {} mm", MARCH.step_mm);
            }
        }
    }
}

/// Affines with shear, of either handedness.
fn affines() -> [DAffine3; 3] {
    let sheared = DMat3::from_cols(DVec3::new(0.3, 0.1, 0.0), DVec3::new(-0.2, 0.5, 0.3), DVec3::new(0.0, 0.7, 5.0));
    let mirrored = DMat3::from_cols(sheared.y_axis, sheared.x_axis, sheared.z_axis);
    let turned = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
    [sheared, mirrored, turned].map(|m| DAffine3::from_mat3_translation(m, DVec3::new(5.0, -7.0, 11.0)))
}

#[test]
fn a_linear_field_has_its_own_gradient_in_any_affine() {
    let slope = DVec3::new(30.0, -20.0, 5.0);
    for affine in affines() {
        let volume = sampled(Grid::new([6, 5, 7], affine).unwrap(), |p| slope.dot(p));
        let Samples::F32(stored) = volume.samples() else { panic!("sampled in f32") };
        let field = Trilinear::new(stored, volume.grid().dims()).unwrap();
        let units = GradientUnits::new(volume.grid(), volume.rescale());
        for i in 0..200 {
            let u = |k: f64| (f64::from(i) * k).fract();
            let at = DVec3::new(5.0 * u(0.618), 4.0 * u(0.414), 6.0 * u(0.732));
            let cell = field.cell(Position::new(at, volume.grid().dims()));
            let found = DVec3::from_array(units.per_mm(field.gradient_per_index(&cell)).map(f64::from));
            assert!((found - slope).length() < 1e-2, "at {at}: found {found}, expected {slope}");
        }
    }
}

#[test]
fn a_linear_field_is_shaded_evenly_in_any_affine() {
    let slope = DVec3::new(30.0, -20.0, 5.0);
    let shading = Shading {
        ambient: 0.1,
        diffuse: 0.5,
        specular: 0.4,
        shininess: 3.0,
        two_sided: false,
        soft_gradient_per_mm: 10.0,
        lights: vec![Light::Directional { towards: DVec3::new(-0.6, 0.64, 0.48), color: [1.0, 0.5, 0.25] }],
    };
    let direction = DVec3::new(0.7, -0.1, -0.7).normalize();
    for affine in affines() {
        let volume = sampled(Grid::new([9, 9, 9], affine).unwrap(), |p| slope.dot(p));
        let camera = seen(&volume, direction, Projection::Parallel { height_mm: 1.0 }, [5, 5]);
        let scene = Scene { camera, ..scene(&volume, homogeneous(0.5, [0.2, 0.4, 0.8]), Some(shading.clone())) };
        let (reflected, highlight) = shading.factors(slope, direction);
        let color: [f64; 3] = std::array::from_fn(|c| [0.2, 0.4, 0.8][c] * reflected[c] + highlight[c]);
        assert!(highlight[0] > 0.01, "the highlight takes part: {highlight:?}");
        for pixel in pixels(&volume, &scene, MARCH) {
            let alpha = f64::from(pixel[3]);
            let expected = [color[0] * alpha, color[1] * alpha, color[2] * alpha, alpha];
            let worst = apart(&[pixel], &[expected]);
            assert!(alpha > 0.3 && worst < 1e-4, "{affine:?}: found {pixel:?}, expected {expected:?}");
        }
    }
}

/// An opaque ball of this radius in the middle of a volume of 60 mm: its signed distance, and what is inside shown.
fn ball(radius_mm: f64) -> (Volume, TransferFunction) {
    let grid = Grid::axis_aligned([61, 121, 41], DVec3::new(1.0, 0.5, 1.5)).unwrap();
    let center = grid.center_mm();
    let volume = sampled(grid, |p| radius_mm - (p - center).length());
    let knots = [(0.0, 0.0), (0.0, 100.0)].map(|(value, s)| Knot { value, optics: Optics::colored(s, [1.0; 3]) });
    let term = Term { curve: Curve::new(knots.to_vec()).unwrap(), weight: None };
    (volume, TransferFunction::new([-100.0, 100.0], 10.0, vec![term]).unwrap())
}

/// Share of the picture that is covered.
fn coverage(volume: &Volume, scene: &Scene) -> f64 {
    let covered = marched(volume, scene, March { step_mm: 0.1, ..MARCH });
    let alphas = covered.image.pixels().iter().map(|p| f64::from(p[3]));
    alphas.sum::<f64>() / covered.image.pixels().len() as f64
}

#[test]
fn a_ball_covers_the_area_of_its_silhouette() {
    let radius = 20.0;
    let (volume, transfer_function) = ball(radius);
    let direction = DVec3::new(0.6, 0.48, -0.64);
    let fov_degrees = 16.0f64;
    let half_height = (0.5 * fov_degrees.to_radians()).tan();
    // Seen from 200 mm the rim is a circle of tan(asin(r/d)) at unit distance.
    let rim = radius / (200.0f64 * 200.0 - radius * radius).sqrt();
    for (projection, expected) in [
        (Projection::Parallel { height_mm: 50.0 }, PI * radius * radius / (50.0 * 50.0)),
        (Projection::Perspective { fov_degrees }, PI * rim * rim / (4.0 * half_height * half_height)),
    ] {
        let camera = seen(&volume, direction, projection, [160, 160]);
        let scene = Scene {
            model: Model::Light,
            transfer_function: transfer_function.clone(),
            shading: None,
            camera,
            background: Background::Transparent,
            effects: Effects::default(),
        };
        let found = coverage(&volume, &scene);
        assert!((found / expected - 1.0).abs() < 5e-3, "{projection:?}: covers {found}, expected {expected}");
    }
}

/// Slope of log error over log step.
fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let points: Vec<(f64, f64)> = steps.iter().zip(errors).map(|(h, e)| (h.ln(), e.ln())).collect();
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let over: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    over / points.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>()
}

#[test]
fn the_order_is_the_slope_of_the_error() {
    let steps = [1.0, 0.5, 0.25];
    assert!((order(&steps, &steps.map(|h: f64| 3.0 * h)) - 1.0).abs() < 1e-12);
    assert!((order(&steps, &steps.map(|h: f64| 0.1 * h * h)) - 2.0).abs() < 1e-12);
    assert!(order(&steps, &[1e-3; 3]).abs() < 1e-12, "a floor has order 0");
}

#[test]
fn rules_converge_with_their_orders() {
    // One cell, so that the field is smooth along every ray (Etiene et al. 2014), and optics without a knot inside.
    let corners = vec![0.1f32, 0.9, 0.4, 0.2, 0.8, 0.3, 0.5, 1.0];
    let grid = Grid::axis_aligned([2, 2, 2], DVec3::splat(10.0)).unwrap();
    let volume = Volume::new(grid, Samples::F32(corners), Rescale::IDENTITY, Quantity::Arbitrary).unwrap();
    let optics = |s, q| Optics { extinction_per_mm: s, emission_per_mm: q };
    let knots = vec![
        Knot { value: 0.0, optics: optics(0.0, [0.0, 0.3, 0.1]) },
        Knot { value: 1.0, optics: optics(0.4, [0.4, 0.1, 0.0]) },
    ];
    let term = Term { curve: Curve::new(knots).unwrap(), weight: None };
    let transfer_function = TransferFunction::new([0.0, 1.0], 1.0, vec![term]).unwrap();
    let camera = seen(&volume, DVec3::new(0.48, 0.64, 0.6), Projection::Parallel { height_mm: 14.0 }, [12, 12]);
    let scene = Scene {
        model: Model::Light,
        transfer_function,
        shading: None,
        camera,
        background: Background::Transparent,
        effects: Effects::default(),
    };
    let truth = crate::march::naive_march(&volume, &scene, &March { step_mm: 1.0 / 512.0, ..MARCH });
    let steps = [2.0, 1.0, 0.5, 0.25];
    for (rule, expected) in [(SampleRule::Left, 1.0), (SampleRule::Midpoint, 2.0), (SampleRule::Trapezoid, 2.0)] {
        let errors = steps.map(|step_mm| apart(&pixels(&volume, &scene, March { rule, step_mm, ..MARCH }), &truth));
        let found = order(&steps, &errors);
        assert!((found - expected).abs() < 0.15, "{rule:?}: order {found:.2}, expected {expected}; errors {errors:?}");
    }
}
