//! Media given at the voxels: RGBA volumes, and transfer functions evaluated there.

mod closed_forms;
mod equivalence;
mod invariance;
mod random;
mod slices;

use glam::DVec3;
use pellucid::scene::{Background, Camera, ClassifyAt, Effects, Model, Projection, Scene};
use pellucid::transfer::TransferFunction;
use pellucid::volume::{ColorEncoding, Grid, Quantity, Rescale, RgbaEncoding, Samples, Volume};

use crate::support::scenes::next_u64;

/// An RGBA volume whose colours are linear and whose alpha is the opacity of `opacity_length_mm`.
fn rgba(grid: Grid, texels: Vec<[u8; 4]>, opacity_length_mm: f64) -> Volume {
    let volume = Volume::new(grid, Samples::Rgba8(texels), Rescale::IDENTITY, Quantity::Arbitrary);
    let encoding = RgbaEncoding { opacity_length_mm, color: ColorEncoding::Linear };
    volume.expect("a valid volume").with_rgba_encoding(encoding)
}

/// A ball of random colours, transparent elsewhere.
fn colored_ball(n: usize) -> Volume {
    let grid = Grid::axis_aligned([n, n, n], DVec3::new(0.7, 0.8, 1.5)).expect("a valid grid");
    let mut state = 5;
    let middle = DVec3::splat(0.5 * (n - 1) as f64);
    let texel = |voxel| {
        let at = DVec3::from_array(grid.unflatten(voxel).map(|i| i as f64));
        let [r, g, b, a, ..] = next_u64(&mut state).to_le_bytes();
        if at.distance(middle) < 0.35 * n as f64 { [r, g, b, a / 2] } else { [r, g, b, 0] }
    };
    rgba(grid, (0..grid.voxel_count()).map(texel).collect(), 1.0)
}

/// A scene without a transfer function, for volumes with colours of their own: all of it, from along nothing.
fn colors(volume: &Volume, size: [usize; 2]) -> Scene {
    let center = volume.grid().center_mm();
    let radius = volume.grid().corners_mm()[0].distance(center);
    let eye = center - DVec3::new(0.72, 0.6, 0.36).normalize() * (4.0 * radius);
    let projection = Projection::Perspective { fov_degrees: 28.0 };
    Scene {
        model: Model::Light,
        transfer_function: TransferFunction::new([-1024.0, 3071.0], 1500.0, Vec::new()).expect("an empty function"),
        shading: None,
        camera: Camera::look_at(eye, center, DVec3::Z, projection, size).expect("a valid camera"),
        background: Background::Transparent,
        effects: Effects::default(),
    }
}

/// The same scene, classified at the voxels.
fn at_voxels(scene: &Scene) -> Scene {
    let effects = Effects { classify: ClassifyAt::Voxels, ..scene.effects.clone() };
    Scene { effects, ..scene.clone() }
}
