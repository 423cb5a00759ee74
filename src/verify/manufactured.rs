//! Fields, transfer functions and cameras for which theory predicts an order.

use glam::DVec3;

use crate::error::Result;
use crate::scene::{Background, Camera, Effects, Model, Projection, Scene};
use crate::transfer::{Curve, Knot, Optics, Term, TransferFunction};
use crate::volume::{Grid, Quantity, Rescale, Samples, Volume};

/// Side of the cube in which every field lives, mm.
pub(super) const SIDE_MM: f64 = 8.0;

/// A field over the unit cube, with values in [0, 1024].
pub(super) type Field = fn(DVec3) -> f64;

/// The trilinear field of these corners. They are multiples of 8, so that samples on lattices of up to 33 points a side
/// have no more than 24 bits and are exact in f32.
pub(super) fn trilinear(x: DVec3) -> f64 {
    const CORNERS: [f64; 8] = [64.0, 320.0, 832.0, 192.0, 480.0, 16.0, 280.0, 1000.0];
    let weight = |c: usize| (0..3).map(|a| if c >> a & 1 == 1 { x[a] } else { 1.0 - x[a] }).product::<f64>();
    (0..8).map(|c| weight(c) * CORNERS[c]).sum()
}

/// A smooth field that is trilinear nowhere.
pub(super) fn wave(x: DVec3) -> f64 {
    512.0 + 200.0 * (4.0 * x.x + 1.0).sin() * (3.0 * x.y).cos() + 180.0 * (5.0 * x.z - 2.0 * x.x).cos()
}

/// A field on a lattice of `n` points a side, the outermost on the faces of the cube.
pub(super) fn sampled(field: Field, n: usize) -> Result<Volume> {
    let cells = (n - 1) as f64;
    let grid = Grid::axis_aligned([n; 3], DVec3::splat(SIDE_MM / cells))?;
    let at = |index: usize| DVec3::from_array(grid.unflatten(index).map(|i| i as f64 / cells));
    let samples = (0..grid.voxel_count()).map(|index| field(at(index)) as f32).collect();
    Volume::new(grid, Samples::F32(samples), Rescale::IDENTITY, Quantity::Arbitrary)
}

/// Extinction and emission that are linear in the value throughout, and not in proportion: nothing is bent.
pub(super) fn smooth() -> Result<TransferFunction> {
    let low = Optics { extinction_per_mm: 0.02, emission_per_mm: [0.002, 0.15, 0.05] };
    let high = Optics { extinction_per_mm: 0.6, emission_per_mm: [0.55, 0.05, 0.2] };
    function(&[(-64.0, low), (1088.0, high)])
}

/// The same with a knot at which both turn.
pub(super) fn with_knot() -> Result<TransferFunction> {
    let low = Optics { extinction_per_mm: 0.02, emission_per_mm: [0.002, 0.15, 0.05] };
    let turn = Optics { extinction_per_mm: 0.5, emission_per_mm: [0.1, 0.4, 0.05] };
    let high = Optics { extinction_per_mm: 0.1, emission_per_mm: [0.09, 0.01, 0.1] };
    function(&[(-64.0, low), (437.0, turn), (1088.0, high)])
}

/// A transfer function of the value through these points.
pub(super) fn function(points: &[(f64, Optics)]) -> Result<TransferFunction> {
    let knots = points.iter().map(|&(value, optics)| Knot { value, optics }).collect();
    let term = Term { curve: Curve::new(knots)?, weight: None };
    TransferFunction::new([-64.0, 1088.0], 1.0, vec![term])
}

/// The cube from a direction along nothing, by parallel rays, all of it in `size` x `size` pixels.
pub(super) fn oblique(transfer_function: TransferFunction, size: usize) -> Result<Scene> {
    looking(transfer_function, -20.0, DVec3::new(0.48, 0.6, 0.64), 12.0, size)
}

/// A window within the cube: all rays enter by one face and leave by another, so that the picture is smooth.
pub(super) fn window(transfer_function: TransferFunction, size: usize) -> Result<Scene> {
    looking(transfer_function, -20.0, DVec3::new(0.1, 0.99, -0.06), 5.0, size)
}

/// Parallel rays in a direction through the cube's centre, from a plane at `from_mm` along it.
pub(super) fn looking(
    transfer_function: TransferFunction,
    from_mm: f64,
    direction: DVec3,
    height_mm: f64,
    size: usize,
) -> Result<Scene> {
    let center = DVec3::splat(0.5 * SIDE_MM);
    let eye = center + from_mm * direction.normalize();
    let projection = Projection::Parallel { height_mm };
    let camera = Camera::look_at(eye, eye + direction, DVec3::Z, projection, [size; 2])?;
    Ok(Scene {
        model: Model::Light,
        transfer_function,
        shading: None,
        camera,
        background: Background::Transparent,
        effects: Effects::default(),
    })
}

/// The rays of a scene's picture, row by row.
pub(super) fn rays(scene: &Scene) -> impl Iterator<Item = crate::scene::Ray> + '_ {
    let [width, height] = scene.camera.size();
    (0..height).flat_map(move |row| (0..width).map(move |column| scene.camera.pixel_ray(column, row)))
}
