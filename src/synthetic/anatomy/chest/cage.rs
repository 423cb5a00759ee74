//! The rib cage: twelve pairs of ribs on an ellipsoid, their cartilage, and the breast bone.

use glam::Vec2;

use super::spine::BODIES;
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Node, Solid, blend, ellipsoid, rod, tube};
use crate::synthetic::tissue::{CARTILAGE, Material};

const CORTEX: Material = Material::Uniform(800.0);
const MARROW: Material = Material::Spongy { mean_hu: 220.0, swing_hu: 70.0, grain_mm: 2.2 };

/// Centre and half axes of the ellipsoid on which the ribs lie, mm.
const CENTER_MM: [f32; 3] = [0.0, 3.0, -55.0];
const RADII_MM: [f32; 3] = [130.0, 94.0, 220.0];

/// Ribs in the order of vertebrae: how far round the bone goes, 0 at the spine and 2 at the breast bone, how far it falls from
/// the spine to the front, mm, and where its cartilage meets the breast bone (z, mm), or the cartilage above it.
const RIBS: [(f32, f32, Option<f32>); 12] = [
    (1.62, 38.0, Some(108.0)),
    (1.60, 58.0, Some(82.0)),
    (1.58, 70.0, Some(60.0)),
    (1.56, 78.0, Some(40.0)),
    (1.54, 84.0, Some(20.0)),
    (1.50, 88.0, Some(2.0)),
    (1.46, 90.0, Some(-12.0)),
    (1.38, 86.0, None),
    (1.30, 80.0, None),
    (1.20, 72.0, None),
    (0.90, 46.0, None),
    (0.62, 26.0, None),
];

/// The inner surface of the ribs, moved outwards by `mm`.
pub(super) fn shell(mm: f32) -> Solid {
    ellipsoid(CENTER_MM, RADII_MM.map(|radius| radius + mm))
}

/// What the ribs enclose: lungs, mediastinum and the organs beneath the diaphragm.
pub(super) fn cavity() -> Solid {
    shell(-4.5)
}

/// A point of the left half of the cage, so far round at a height: 0 behind, 1 at the side, 2 in front.
fn on_cage(around: f32, z: f32) -> (f32, f32) {
    let toward = if around < 1.0 { Vec2::new(around, 1.0 - around) } else { Vec2::new(2.0 - around, 1.0 - around) };
    let toward = toward.normalize();
    let up = (z - CENTER_MM[2]) / RADII_MM[2];
    let narrowed = (1.0 - up * up).max(0.09).sqrt();
    (CENTER_MM[0] + RADII_MM[0] * narrowed * toward.x, CENTER_MM[1] + RADII_MM[1] * narrowed * toward.y)
}

/// A point of a rib: how far round, and where it is.
fn on_rib(rib: usize, around: f32) -> (f32, f32, f32) {
    let z = BODIES[rib].1 + 5.0 - RIBS[rib].1 * around / 2.0;
    let (x, y) = on_cage(around, z);
    (x, y, z)
}

pub(super) fn ribs() -> Vec<Tissue> {
    let cartilage = (0..10).map(|rib| Tissue::new(CARTILAGE, tube(&cartilage(rib)).mirrored()));
    let bone = (0..RIBS.len()).map(|rib| Tissue::new(CORTEX, tube(&bone(rib)).mirrored()).core(1.1, MARROW));
    cartilage.chain(bone).map(|tissue| tissue.beneath_skin(5.0)).collect()
}

/// From the head of the rib, beside the vertebral body, over the transverse process and round the cage.
fn bone(rib: usize) -> Vec<Node> {
    let (y, z) = BODIES[rib];
    let mut nodes = vec![(15.0, y + 7.0, z + 8.0, 3.8), (27.0, y + 21.0, z + 8.0, 3.8)];
    let end = RIBS[rib].0;
    let pieces = (8.0 * end) as usize;
    nodes.extend((0..=pieces).map(|piece| {
        let (x, y, z) = on_rib(rib, 0.32 + (end - 0.32) * piece as f32 / pieces as f32);
        (x, y, z, 4.6)
    }));
    nodes
}

/// From the end of the bone to the breast bone, or to the cartilage of the rib above.
fn cartilage(rib: usize) -> Vec<Node> {
    let end = RIBS[rib].0;
    let (x, y, z) = on_rib(rib, end);
    let start = (x, y, z, 4.4);
    let Some(z_sternum) = RIBS[rib].2 else {
        let (x, y, z) = on_rib(rib - 1, RIBS[rib - 1].0 + 0.08);
        return vec![start, (x, y, z - 4.0, 4.2)];
    };
    let (middle_x, middle_y) = on_cage(0.5 * (end + 1.9), z - 3.0);
    let middle = (middle_x, middle_y, 0.5 * (z + z_sternum).min(2.0 * z - 6.0), 4.4);
    vec![start, middle, (15.0, sternum_y(z_sternum) + 1.0, z_sternum, 4.2)]
}

/// How far in front the middle of the breast bone is at a height.
fn sternum_y(z: f32) -> f32 {
    on_cage(2.0, z).1
}

pub(super) fn sternum() -> Vec<Tissue> {
    let at = |x: f32, z: f32, radius_mm: f32| (x, sternum_y(z), z, radius_mm);
    let manubrium = tube(&[at(20.0, 116.0, 6.4), at(15.0, 100.0, 6.4), at(8.0, 80.0, 5.8)]).mirrored();
    let notch = tube(&[at(-16.0, 108.0, 6.4), at(0.0, 104.0, 6.4), at(16.0, 108.0, 6.4)]);
    let body = tube(&[at(7.0, 76.0, 5.6), at(8.0, 40.0, 5.6), at(10.0, 5.0, 5.6), at(6.0, -16.0, 4.8)]).mirrored();
    let filling = tube(&[at(0.0, 104.0, 6.4), at(0.0, 70.0, 5.6), at(0.0, 30.0, 5.6), at(0.0, -16.0, 4.8)]);
    let xiphoid = rod(&[at(0.0, -20.0, 3.6), at(0.0, -44.0, 2.2)]);
    let bone = blend(9.0, [manubrium, notch, body, filling]);
    vec![Tissue::new(CARTILAGE, xiphoid), Tissue::new(CORTEX, bone).core(1.2, MARROW)]
}
