//! Small volumes and scenes, and the distance between pictures.

use glam::{DAffine3, DMat3, DVec3};
use pellucid::integrate::{Rendered, render};
use pellucid::plan::{Colors, Emission, Lattice, March, Method, Order, Reflection, SampleRule};
use pellucid::scene::{Background, Camera, Effects, Light, Model, Projection, Scene, Shading};
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction, Weight};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// Settings that every test starts from.
pub(crate) const MARCH: March = March {
    step_mm: 0.4,
    rule: SampleRule::Midpoint,
    order: Order::FrontToBack,
    colors: Colors::Associated,
    emission: Emission::PerLength,
    lattice: Lattice::PerRay,
    bisections: 0,
    jitter: None,
    termination_transmittance: 0.0,
    table: None,
    reflection: Reflection::BlinnPhong,
};

/// A sheared, anisotropic grid of 21 x 18 x 13 voxels.
pub(crate) fn sheared_grid() -> Grid {
    let m = DMat3::from_cols(DVec3::new(0.9, 0.1, 0.0), DVec3::new(-0.2, 1.1, 0.1), DVec3::new(0.0, 0.3, 1.7));
    Grid::new([21, 18, 13], DAffine3::from_mat3_translation(m, DVec3::new(-40.0, 12.0, 100.0))).unwrap()
}

/// Two blobs in air, HU from -1000 to about 1500, stored as 16-bit numbers with a rescale.
pub(crate) fn blobs_i16() -> Volume {
    let rescale = Rescale { slope: 0.5, intercept: -1000.0 };
    let stored = blobs(&sheared_grid()).iter().map(|&hu| rescale.stored(hu).round() as i16).collect();
    Volume::new(sheared_grid(), Samples::I16(stored), rescale, Quantity::Hu).unwrap()
}

/// The same in f32, without a rescale.
pub(crate) fn blobs_f32() -> Volume {
    let stored = blobs(&sheared_grid()).iter().map(|&hu| hu as f32).collect();
    Volume::new(sheared_grid(), Samples::F32(stored), Rescale::IDENTITY, Quantity::Hu).unwrap()
}

fn blobs(grid: &Grid) -> Vec<f64> {
    let (low, high) = grid.index_bounds();
    (0..grid.voxel_count())
        .map(|index| {
            let at = DVec3::from_array(grid.unflatten(index).map(|i| i as f64)) / (high - low);
            let blob = |c: DVec3, r: f64| (-(at - c).length_squared() / (r * r)).exp();
            let one = 1800.0 * blob(DVec3::new(0.35, 0.4, 0.5), 0.2);
            let other = 1200.0 * blob(DVec3::new(0.7, 0.65, 0.4), 0.15);
            (-1000.0 + one + other).round()
        })
        .collect()
}

/// Skin and bone by value alone.
pub(crate) fn tissue_1d() -> TransferFunction {
    transfer_function(false)
}

/// Skin and bone by value and gradient magnitude.
pub(crate) fn tissue_2d() -> TransferFunction {
    transfer_function(true)
}

fn transfer_function(reads_gradient: bool) -> TransferFunction {
    let knot = |value, s, color| Knot { value, optics: Optics::colored(s, color) };
    let (skin, bone) = ([0.9, 0.6, 0.5], [1.0, 0.9, 0.8]);
    let curve = |knots| Curve::new(knots).unwrap();
    let weight = |knots| reads_gradient.then(|| Weight::new(knots).unwrap());
    let terms = vec![
        Term {
            curve: curve(vec![knot(-700.0, 0.0, skin), knot(-300.0, 0.2, skin), knot(0.0, 0.0, skin)]),
            weight: weight(vec![[0.0, 0.1], [150.0, 1.0]]),
        },
        Term {
            curve: curve(vec![knot(100.0, 0.0, bone), knot(600.0, 0.8, bone), knot(3000.0, 0.9, bone)]),
            weight: weight(vec![[50.0, 1.0], [400.0, 0.3]]),
        },
    ];
    TransferFunction::new([-1024.0, 3071.0], 500.0, terms).unwrap()
}

/// The same extinction (1/mm) and colour everywhere.
pub(crate) fn homogeneous(extinction_per_mm: f64, color: [f64; 3]) -> TransferFunction {
    let knots = vec![Knot { value: 0.0, optics: Optics::colored(extinction_per_mm, color) }];
    let term = Term { curve: Curve::new(knots).unwrap(), weight: None };
    TransferFunction::new([-1024.0, 3071.0], 500.0, vec![term]).unwrap()
}

/// Two lights, two-sided, soft.
pub(crate) fn two_lights() -> Shading {
    Shading {
        ambient: 0.2,
        diffuse: 0.6,
        specular: 0.3,
        shininess: 12.0,
        two_sided: true,
        soft_gradient_per_mm: 30.0,
        lights: vec![
            Light::Headlight { color: [0.8; 3] },
            Light::Directional { towards: DVec3::new(0.48, -0.6, 0.64), color: [0.2, 0.4, 0.3] },
        ],
    }
}

/// An oblique view of the whole grid.
pub(crate) fn oblique(grid: &Grid, projection: Projection) -> Camera {
    let center = grid.center_mm();
    Camera::look_at(center + DVec3::new(-40.0, -70.0, 25.0), center, DVec3::Z, projection, [37, 29]).unwrap()
}

/// A scene without a background, seen by a perspective camera.
pub(crate) fn scene(volume: &Volume, transfer_function: TransferFunction, shading: Option<Shading>) -> Scene {
    let camera = oblique(volume.grid(), Projection::Perspective { fov_degrees: 20.0 });
    Scene {
        model: Model::Light,
        transfer_function,
        shading,
        camera,
        background: Background::Transparent,
        effects: Effects::default(),
    }
}

/// Renders by marching.
pub(crate) fn marched(volume: &Volume, scene: &Scene, settings: March) -> Rendered {
    render(volume, scene, &Method::March(settings), &|_| ()).unwrap()
}

/// Renders by marching; the pixels.
pub(crate) fn pixels(volume: &Volume, scene: &Scene, settings: March) -> Vec<[f32; 4]> {
    marched(volume, scene, settings).image.pixels().to_vec()
}

/// The largest difference of a channel; infinite if one is not a number.
pub(crate) fn apart<A: Into<f64> + Copy, B: Into<f64> + Copy>(a: &[[A; 4]], b: &[[B; 4]]) -> f64 {
    assert_eq!(a.len(), b.len(), "pictures of one size");
    let channels = a.iter().flatten().zip(b.iter().flatten());
    channels
        .map(|(&a, &b)| (a.into() - b.into()).abs())
        .fold(0.0, |worst, d| if d <= worst { worst } else { finite(d) })
}

fn finite(difference: f64) -> f64 {
    if difference.is_nan() { f64::INFINITY } else { difference }
}

#[test]
fn the_distance_of_pictures_sees_differences_and_nan() {
    let a = [[0.0f32, 0.25, 0.5, 1.0], [0.0; 4]];
    let mut b = a;
    assert_eq!(apart(&a, &b), 0.0);
    b[1][2] = 0.125;
    assert_eq!(apart(&a, &b), 0.125);
    b[0][0] = f32::NAN;
    assert_eq!(apart(&a, &b), f64::INFINITY);
    assert_eq!(apart(&b, &a), f64::INFINITY);
}
