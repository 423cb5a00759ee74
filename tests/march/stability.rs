//! Hard cases: nothing is ever NaN, and what cannot be done is refused.

use glam::DVec3;
use pellucid::integrate::render;
use pellucid::plan::{Colors, Emission, Exact, Lattice, March, Method, Order, SampleRule};
use pellucid::scene::{Background, Camera, Projection, Scene};
use pellucid::transfer::TransferFunction;
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};
use pellucid::{Fault, Result};

use super::scenes::{MARCH, apart, blobs_i16, homogeneous, pixels, scene, tissue_1d, tissue_2d, two_lights};

/// Noise between the extremes of 16 bits.
fn extremes(dims: [usize; 3]) -> Volume {
    let grid = Grid::axis_aligned(dims, DVec3::new(0.3, 0.3, 5.0)).unwrap();
    let stored = (0..grid.voxel_count()).map(|i| [i16::MIN, i16::MAX, 0, 0, -1][i * 7919 % 5]).collect();
    Volume::new(grid, Samples::I16(stored), Rescale::IDENTITY, Quantity::Hu).unwrap()
}

fn looking(volume: &Volume, from: DVec3, direction: DVec3, projection: Projection) -> Scene {
    let up = if direction.z.abs() > 0.9 { DVec3::Y } else { DVec3::Z };
    let camera = Camera::look_at(from, from + direction, up, projection, [9, 8]).unwrap();
    Scene { camera, ..scene(volume, tissue_2d(), Some(two_lights())) }
}

#[test]
fn extreme_samples_thin_volumes_and_any_ray_give_numbers() {
    let perspective = Projection::Perspective { fov_degrees: 100.0 };
    let parallel = Projection::Parallel { height_mm: 3.0 };
    let steep = homogeneous(1e30, [1.0; 3]);
    for dims in [[5, 6, 4], [1, 1, 1], [2, 2, 2], [1, 5, 5], [5, 1, 5], [5, 5, 1]] {
        let volume = extremes(dims);
        let center = volume.grid().center_mm();
        let corner = volume.grid().corners_mm()[7];
        for projection in [perspective, parallel] {
            for direction in [DVec3::X, -DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 1.0), DVec3::new(1e-12, 1.0, 1e-30)] {
                for from in [center, corner, center - 30.0 * direction, center + 30.0 * direction] {
                    for rule in [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid] {
                        for (colors, order, emission, lattice, step_mm) in [
                            (Colors::Associated, Order::FrontToBack, Emission::PerLength, Lattice::PerRay, 0.05),
                            (Colors::Straight, Order::BackToFront, Emission::PerSample, Lattice::ViewPlanes, 1e6),
                        ] {
                            let settings = March { rule, colors, order, emission, lattice, step_mm, ..MARCH };
                            let mut scene = looking(&volume, from, direction, projection);
                            let found = pixels(&volume, &scene, settings);
                            assert!(found.iter().flatten().all(|x| x.is_finite()), "{dims:?} {direction} {settings:?}");
                            scene.transfer_function = steep.clone();
                            scene.shading = None;
                            let found = pixels(&volume, &scene, settings);
                            assert!(found.iter().flatten().all(|x| x.is_finite()), "steep {dims:?} {settings:?}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn rays_on_faces_equal_rays_beside_them() {
    let volume = blobs_i16();
    let grid = Grid::axis_aligned(volume.grid().dims(), DVec3::new(1.0, 1.0, 1.0)).unwrap();
    let volume = Volume::new(grid, volume.samples().clone(), volume.rescale(), Quantity::Hu).unwrap();
    let at = |shift: DVec3| {
        // 9 x 8 pixels of 1 mm: each ray runs along voxels, through (n, m + 1/2) for an odd number of pixels.
        let from = DVec3::new(10.0, -20.0, 6.0) + shift;
        pixels(&volume, &looking(&volume, from, DVec3::Y, Projection::Parallel { height_mm: 8.0 }), MARCH)
    };
    let on = at(DVec3::ZERO);
    for shift in [DVec3::new(1e-9, 0.0, 1e-9), DVec3::new(-1e-9, 0.0, -1e-9)] {
        let worst = apart(&on, &at(shift));
        assert!(worst < 1e-6, "{worst:e} from rays {shift} beside");
    }
}

#[test]
fn a_far_camera_sees_what_a_near_one_sees() {
    let volume = blobs_i16();
    let center = volume.grid().center_mm();
    let direction = DVec3::new(0.5, 0.8, -0.3).normalize();
    let at = |distance: f64| {
        let parallel = Projection::Parallel { height_mm: 25.0 };
        let camera = Camera::look_at(center - distance * direction, center, DVec3::Z, parallel, [9, 8]).unwrap();
        pixels(&volume, &Scene { camera, ..scene(&volume, tissue_2d(), Some(two_lights())) }, MARCH)
    };
    let worst = apart(&at(100.0), &at(1e6));
    assert!(worst < 1e-5, "{worst:e} from 1 km away");
}

#[test]
fn nothing_in_front_of_the_camera_is_an_empty_picture() {
    let volume = blobs_i16();
    let center = volume.grid().center_mm();
    let away = looking(&volume, center + DVec3::X * 100.0, DVec3::X, Projection::Perspective { fov_degrees: 40.0 });
    assert!(pixels(&volume, &away, MARCH).iter().all(|p| *p == [0.0; 4]));
}

#[test]
fn an_empty_transfer_function_is_an_empty_picture() {
    let volume = blobs_i16();
    let mut scene = scene(&volume, tissue_1d(), None);
    scene.transfer_function = TransferFunction::new([-1024.0, 3071.0], 500.0, vec![]).unwrap();
    scene.background = Background::Transparent;
    let found = render(&volume, &scene, &Method::March(MARCH), &|_| ()).unwrap();
    assert!(found.image.pixels().iter().all(|p| *p == [0.0; 4]));
}

fn refused(settings: March) -> Fault {
    let grid = Grid::axis_aligned([200, 2, 2], DVec3::ONE).unwrap();
    let volume = Volume::new(grid, Samples::I16(vec![0; 800]), Rescale::IDENTITY, Quantity::Hu).unwrap();
    let scene = scene(&volume, tissue_1d(), None);
    let result: Result<_> = render(&volume, &scene, &Method::March(settings), &|_| ());
    result.expect_err("settings that mean nothing").fault()
}

#[test]
fn steps_that_would_take_for_ever_or_mean_nothing_are_refused() {
    assert_eq!(refused(March { step_mm: 1e-6, ..MARCH }), Fault::Limit);
    for step_mm in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(March { step_mm, ..MARCH }), Fault::Spec, "a step of {step_mm} mm");
    }
    for termination_transmittance in [-0.1, 1.0, f64::NAN] {
        assert_eq!(refused(March { termination_transmittance, ..MARCH }), Fault::Spec);
    }
}

#[test]
fn other_methods_are_not_mistaken_for_marching() {
    let volume = blobs_i16();
    let scene = scene(&volume, tissue_1d(), None);
    for method in [Method::Exact(Exact::within(1e-3)), Method::Reference] {
        match render(&volume, &scene, &method, &|_| ()) {
            Ok(found) => assert!(!found.statistics.kernel.starts_with("march/"), "{}", found.statistics.kernel),
            Err(error) => assert_eq!(error.fault(), Fault::Unsupported),
        }
    }
}
