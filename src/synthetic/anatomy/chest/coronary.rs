//! Coronary arteries, drawn on the surface of the heart.

use glam::Vec3;

use super::{ARTERIAL, heart};
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Node, Solid, tube};

/// How far above the muscle they run, in the fat, mm.
const ABOVE_MM: f32 = 0.4;

pub(super) fn tissues() -> Vec<Tissue> {
    let surface = heart::surface();
    [&RIGHT[..], &LEFT_ANTERIOR_DESCENDING[..], &CIRCUMFLEX[..], &DIAGONAL[..]]
        .into_iter()
        .map(|course| {
            // The first points are at the aorta, above the surface.
            let laid = course.iter().enumerate().map(|(n, &node)| if n < 2 { node } else { laid_on(&surface, node) });
            Tissue::new(ARTERIAL, tube(&laid.collect::<Vec<_>>()))
        })
        .collect()
}

/// A node moved along the slope of the distance until it lies on a surface.
fn laid_on(surface: &Solid, (x, y, z, radius_mm): Node) -> Node {
    let mut p = Vec3::new(x, y, z);
    const STEP_MM: f32 = 0.5;
    for _ in 0..8 {
        let along = |axis: Vec3| surface.distance(p + STEP_MM * axis) - surface.distance(p - STEP_MM * axis);
        let outward = Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z)).normalize_or_zero();
        p -= (surface.distance(p) - ABOVE_MM) * outward;
    }
    (p.x, p.y, p.z, radius_mm)
}

/// In the groove between right atrium and right ventricle, to the underside.
const RIGHT: [Node; 8] = [
    (-6.0, -38.0, 36.0, 2.0),
    (-10.0, -50.0, 36.0, 2.0),
    (-20.0, -58.0, 14.0, 2.0),
    (-28.0, -56.0, 0.0, 1.9),
    (-30.0, -48.0, -18.0, 1.8),
    (-22.0, -30.0, -34.0, 1.7),
    (0.0, -16.0, -38.0, 1.5),
    (24.0, -18.0, -40.0, 1.2),
];
/// In the groove between the ventricles, to the apex.
const LEFT_ANTERIOR_DESCENDING: [Node; 8] = [
    (6.0, -24.0, 38.0, 2.3),
    (24.0, -34.0, 38.0, 2.2),
    (34.0, -52.0, 30.0, 2.0),
    (38.0, -62.0, 18.0, 1.9),
    (44.0, -68.0, 4.0, 1.8),
    (52.0, -72.0, -10.0, 1.6),
    (62.0, -72.0, -24.0, 1.4),
    (68.0, -66.0, -34.0, 1.1),
];
/// In the groove between left atrium and left ventricle.
const CIRCUMFLEX: [Node; 6] = [
    (6.0, -24.0, 38.0, 2.3),
    (24.0, -32.0, 37.0, 2.1),
    (44.0, -24.0, 28.0, 1.8),
    (50.0, -6.0, 18.0, 1.7),
    (44.0, 8.0, 4.0, 1.5),
    (36.0, 10.0, -10.0, 1.2),
];
/// Over the left ventricle.
const DIAGONAL: [Node; 6] = [
    (24.0, -34.0, 38.0, 1.6),
    (34.0, -50.0, 31.0, 1.6),
    (46.0, -52.0, 22.0, 1.5),
    (58.0, -48.0, 8.0, 1.4),
    (68.0, -42.0, -6.0, 1.2),
    (74.0, -40.0, -16.0, 0.9),
];
