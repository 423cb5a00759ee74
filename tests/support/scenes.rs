//! Small scenes that are hard on an integrator.

use glam::DVec3;
use pellucid::scene::{Background, Camera, Light, Projection, Scene, Shading};
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction, Weight};
use pellucid::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// Pseudo-random numbers, the same on every machine (Knuth's MMIX constants).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A volume of independent random values from -1000 to 1000 HU: rougher than any scan.
pub(crate) fn rough_volume(n: usize) -> Volume {
    let mut random = Random(3);
    let samples = (0..n * n * n).map(|_| (2000.0 * random.unit() - 1000.0) as i16).collect();
    let grid = Grid::axis_aligned([n, n, n], DVec3::new(0.7, 0.8, 1.5)).unwrap();
    Volume::new(grid, Samples::I16(samples), Rescale::IDENTITY, Quantity::Hu).unwrap()
}

fn knot(value: f64, extinction_per_mm: f64, color: [f64; 3]) -> Knot {
    Knot { value, optics: Optics::colored(extinction_per_mm, color) }
}

const RED: [f64; 3] = [0.9, 0.2, 0.1];
const BLUE: [f64; 3] = [0.1, 0.2, 0.9];

/// Soft parts in changing colours.
pub(crate) fn two_colors() -> Term {
    let knots =
        vec![knot(-300.0, 0.0, RED), knot(-100.0, 0.15, RED), knot(300.0, 0.05, BLUE), knot(600.0, 0.9, [1.0; 3])];
    Term { curve: Curve::new(knots).unwrap(), weight: None }
}

/// A thin, dense shell where the gradient is large.
pub(crate) fn thin_shell() -> Term {
    let knots = vec![knot(90.0, 0.0, BLUE), knot(100.0, 3.0, BLUE), knot(110.0, 0.0, BLUE)];
    let weight = Weight::new(vec![[100.0, 0.0], [500.0, 1.0]]).unwrap();
    Term { curve: Curve::new(knots).unwrap(), weight: Some(weight) }
}

/// A headlight and a coloured light from the side.
pub(crate) fn lit(two_sided: bool) -> Shading {
    Shading {
        ambient: 0.2,
        diffuse: 0.7,
        specular: 0.3,
        shininess: 20.0,
        two_sided,
        soft_gradient_per_mm: 10.0,
        lights: vec![
            Light::Headlight { color: [1.0; 3] },
            Light::Directional { towards: DVec3::new(0.48, -0.6, 0.64), color: [0.3, 0.5, 0.9] },
        ],
    }
}

/// The whole volume in perspective, transparent behind, from a direction that is along nothing.
pub(crate) fn scene_around(volume: &Volume, terms: Vec<Term>, shading: Option<Shading>, size: [usize; 2]) -> Scene {
    let center = volume.grid().center_mm();
    let radius = volume.grid().corners_mm()[0].distance(center);
    let eye = center - DVec3::new(0.72, 0.6, 0.36).normalize() * (4.0 * radius);
    let projection = Projection::Perspective { fov_degrees: 28.0 };
    Scene {
        transfer_function: TransferFunction::new([-1024.0, 3071.0], 1500.0, terms).unwrap(),
        shading,
        camera: Camera::look_at(eye, center, DVec3::Z, projection, size).unwrap(),
        background: Background::Transparent,
    }
}
