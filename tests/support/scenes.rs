//! Small volumes, transfer functions and rays for tests, each in one line.
#![allow(dead_code, reason = "used as modules need it")]

use glam::{DAffine3, DMat3, DVec3};
use pellucid::scene::{Background, Camera, Effects, Light, Model, Projection, Ray, Scene, Shading};
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction, Weight};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};
use sha2::{Digest, Sha256};

/// Colours of the tests.
pub(crate) const BONE: [f64; 3] = [0.875, 0.75, 0.5];
pub(crate) const RED: [f64; 3] = [1.0, 0.25, 0.125];
pub(crate) const BLUE: [f64; 3] = [0.125, 0.375, 1.0];

/// A volume of 16-bit samples, one unit per HU.
pub(crate) fn volume_i16(grid: Grid, samples: Vec<i16>) -> Volume {
    Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).expect("a valid volume")
}

/// A volume that samples `f` of the voxel's index at every lattice point, in f32.
pub(crate) fn volume_of(grid: Grid, f: impl Fn([usize; 3]) -> f64) -> Volume {
    let samples = (0..grid.voxel_count()).map(|i| f(grid.unflatten(i)) as f32).collect();
    Volume::new(grid, Samples::F32(samples), Rescale::IDENTITY, Quantity::Hu).expect("a valid volume")
}

/// A grid of 1 mm along the patient's axes, first voxel at the origin.
pub(crate) fn unit_grid(dims: [usize; 3]) -> Grid {
    Grid::axis_aligned(dims, DVec3::ONE).expect("a valid grid")
}

/// A grid with these steps along i, j and k.
pub(crate) fn grid(dims: [usize; 3], steps_mm: [[f64; 3]; 3], first_mm: [f64; 3]) -> Grid {
    let matrix = DMat3::from_cols_array_2d(&steps_mm);
    Grid::new(dims, DAffine3::from_mat3_translation(matrix, first_mm.into())).expect("a valid grid")
}

/// Whole numbers between -600 and 1100 HU that look random, the same for every run.
pub(crate) fn noise_hu(grid: Grid, seed: u64) -> Volume {
    let mut state = seed;
    let mut next = || (next_u64(&mut state) % 1701) as i16 - 600;
    volume_i16(grid, (0..grid.voxel_count()).map(|_| next()).collect())
}

/// Steele's SplitMix64.
pub(crate) fn next_u64(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// Evenly distributed in [0, 1).
pub(crate) fn next_unit(state: &mut u64) -> f64 {
    (next_u64(state) >> 11) as f64 * (-53_f64).exp2()
}

/// A curve through `(HU, extinction per mm, straight colour)`.
pub(crate) fn curve(points: &[(f64, f64, [f64; 3])]) -> Curve {
    let knot = |&(value, s, color): &(f64, f64, [f64; 3])| Knot { value, optics: Optics::colored(s, color) };
    Curve::new(points.iter().map(knot).collect()).expect("a valid curve")
}

/// A transfer function of the value alone, over the usual window.
pub(crate) fn function_1d(points: &[(f64, f64, [f64; 3])]) -> TransferFunction {
    function(vec![Term { curve: curve(points), weight: None }])
}

/// One term with a weight along the gradient.
pub(crate) fn function_2d(points: &[(f64, f64, [f64; 3])], weight: &[[f64; 2]]) -> TransferFunction {
    function(vec![weighted(points, weight)])
}

/// A term with a weight along the gradient.
pub(crate) fn weighted(points: &[(f64, f64, [f64; 3])], weight: &[[f64; 2]]) -> Term {
    Term { curve: curve(points), weight: Some(Weight::new(weight.to_vec()).expect("a valid weight")) }
}

/// Terms over a window that holds every 16-bit sample.
pub(crate) fn function(terms: Vec<Term>) -> TransferFunction {
    TransferFunction::new([-40_000.0, 40_000.0], 5000.0, terms).expect("a valid transfer function")
}

/// A scene with this transfer function, unshaded, without background, and a camera that nobody looks through.
pub(crate) fn scene(transfer_function: TransferFunction) -> Scene {
    let projection = Projection::Parallel { height_mm: 1.0 };
    let camera = Camera::look_at(DVec3::NEG_Y, DVec3::ZERO, DVec3::Z, projection, [1, 1]).expect("a valid camera");
    Scene {
        model: Model::Light,
        transfer_function,
        shading: None,
        camera,
        background: Background::Transparent,
        effects: Effects::default(),
    }
}

/// The same scene, shaded.
pub(crate) fn shaded(mut scene: Scene, shading: Shading) -> Scene {
    scene.shading = Some(shading);
    scene
}

/// A two-sided white headlight with a highlight and no fade.
pub(crate) fn headlight() -> Shading {
    Shading {
        ambient: 0.125,
        diffuse: 0.75,
        specular: 0.25,
        shininess: 20.0,
        two_sided: true,
        soft_gradient_per_mm: 0.0,
        lights: vec![Light::Headlight { color: [1.0; 3] }],
    }
}

/// A one-sided lamp, with its fade at `soft_gradient_per_mm`.
pub(crate) fn lamp(soft_gradient_per_mm: f64) -> Shading {
    let towards = DVec3::new(1.0, -2.0, 2.5).normalize();
    Shading {
        two_sided: false,
        soft_gradient_per_mm,
        lights: vec![Light::Directional { towards, color: [1.0, 0.875, 0.75] }],
        ..headlight()
    }
}

/// A ray from a point along a direction of any length.
pub(crate) fn ray(origin_mm: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray { origin_mm: origin_mm.into(), direction: DVec3::from_array(direction).normalize() }
}

/// Seeded rays through a grid: from outside, between two random points of its bounding sphere.
pub(crate) fn rays_through(grid: &Grid, count: usize, seed: u64) -> Vec<Ray> {
    let mut state = seed;
    let center = grid.center_mm();
    let radius = grid.corners_mm().iter().map(|c| c.distance(center)).fold(0.0, f64::max);
    let mut on_sphere = move || {
        let (z, angle) = (2.0 * next_unit(&mut state) - 1.0, std::f64::consts::TAU * next_unit(&mut state));
        let across = (1.0 - z * z).sqrt();
        center + radius * DVec3::new(across * angle.cos(), across * angle.sin(), z)
    };
    (0..count)
        .map(|_| {
            // The way to the chord's other end is halved towards the centre, so that most rays meet the grid.
            let (from, to) = (on_sphere(), on_sphere());
            let aim = center + 0.5 * (to - center);
            Ray { origin_mm: from, direction: (aim - from).normalize() }
        })
        .collect()
}

/// Largest difference of a channel; infinite if any is not a number.
pub(crate) fn difference<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.into_iter().zip(b).fold(0.0, |worst: f64, (x, y)| {
        let d = (x - y).abs();
        if d.is_nan() { f64::INFINITY } else { worst.max(d) }
    })
}

#[test]
fn a_difference_that_is_not_a_number_is_infinite() {
    assert_eq!(difference([0.0, f64::NAN], [0.0, 0.0]), f64::INFINITY);
    assert_eq!(difference([0.0, 1.0], [0.5, f64::INFINITY]), f64::INFINITY);
    assert_eq!(difference([0.0, 1.0], [0.5, 1.25]), 0.5);
}

/// A volume of independent random values on a grid of uneven spacing: rougher than any scan.
pub(crate) fn rough_volume(n: usize) -> Volume {
    noise_hu(Grid::axis_aligned([n, n, n], DVec3::new(0.7, 0.8, 1.5)).expect("a valid grid"), 3)
}

/// Soft parts in changing colours.
pub(crate) fn two_colors() -> Term {
    let points = [(-300.0, 0.0, RED), (-100.0, 0.15, RED), (300.0, 0.05, BLUE), (600.0, 0.9, [1.0; 3])];
    Term { curve: curve(&points), weight: None }
}

/// A thin, dense shell where the gradient is large.
pub(crate) fn thin_shell() -> Term {
    weighted(&[(90.0, 0.0, BLUE), (100.0, 3.0, BLUE), (110.0, 0.0, BLUE)], &[[100.0, 0.0], [500.0, 1.0]])
}

/// A headlight and a coloured light from the side, faded where the gradient vanishes.
pub(crate) fn two_lights(two_sided: bool) -> Shading {
    let side = Light::Directional { towards: DVec3::new(0.48, -0.6, 0.64), color: [0.3, 0.5, 0.9] };
    let lights = vec![Light::Headlight { color: [1.0; 3] }, side];
    Shading { two_sided, soft_gradient_per_mm: 10.0, lights, ..headlight() }
}

/// The whole volume in perspective, transparent behind, from a direction that is along nothing.
pub(crate) fn scene_around(volume: &Volume, terms: Vec<Term>, shading: Option<Shading>, size: [usize; 2]) -> Scene {
    let center = volume.grid().center_mm();
    let radius = volume.grid().corners_mm()[0].distance(center);
    let eye = center - DVec3::new(0.72, 0.6, 0.36).normalize() * (4.0 * radius);
    let projection = Projection::Perspective { fov_degrees: 28.0 };
    let camera = Camera::look_at(eye, center, DVec3::Z, projection, size).expect("a valid camera");
    Scene {
        model: Model::Light,
        transfer_function: TransferFunction::new([-1024.0, 3071.0], 1500.0, terms).expect("a valid transfer function"),
        shading,
        camera,
        background: Background::Transparent,
        effects: Effects::default(),
    }
}

/// The samples of a volume in 16 bits.
pub(crate) fn stored(volume: &Volume) -> &[i16] {
    match volume.samples() {
        Samples::I16(voxels) => voxels,
        _ => panic!("the volume is stored in 16 bits"),
    }
}

/// Value of the voxel nearest to a point in LPS mm.
pub(crate) fn value_at(volume: &Volume, [x, y, z]: [f64; 3]) -> f64 {
    let index = volume.grid().lps_mm_to_index().transform_point3(DVec3::new(x, y, z)).round();
    volume.value([index.x as usize, index.y as usize, index.z as usize])
}

/// SHA-256 of the samples of a volume in 16 bits that so many threads make.
pub(crate) fn digest_on(threads: usize, make: impl Fn() -> Volume + Send) -> String {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let volume = pool.install(make);
    let bytes: Vec<u8> = stored(&volume).iter().flat_map(|sample| sample.to_le_bytes()).collect();
    Sha256::digest(bytes).iter().fold(String::new(), |hex, byte| hex + &format!("{byte:02x}"))
}
