//! Windpipe and bronchi: walls, then the air in them.

use super::lung::LUNGS;
use super::tree::{Root, grown_from};
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Node, Solid, tube};
use crate::synthetic::tissue::{AIR, MUSCLE};

const TRACHEA: [Node; 5] = [
    (0.0, -8.0, 178.0, 10.6),
    (-1.0, 0.0, 150.0, 10.6),
    (-3.0, 10.0, 118.0, 10.6),
    (-4.0, 16.0, 94.0, 10.8),
    (-2.0, 19.0, 80.0, 11.0),
];
/// Steep and wide: what is inhaled by mistake goes here.
const RIGHT: [Node; 4] =
    [(-4.0, 19.0, 82.0, 8.6), (-20.0, 18.0, 66.0, 8.2), (-36.0, 18.0, 52.0, 7.2), (-46.0, 20.0, 42.0, 6.4)];
/// Longer and flatter, beneath the arch of the aorta.
const LEFT: [Node; 4] =
    [(0.0, 19.0, 82.0, 8.0), (18.0, 20.0, 66.0, 7.4), (36.0, 23.0, 54.0, 6.8), (46.0, 26.0, 46.0, 6.2)];

/// Bronchi of the lobes.
const LOBAR: [[Node; 2]; 4] = [
    [(-20.0, 18.0, 66.0, 5.8), (-40.0, 12.0, 70.0, 4.8)],
    [(-40.0, 18.0, 48.0, 5.6), (-52.0, 13.0, 36.0, 4.6)],
    [(38.0, 23.0, 53.0, 5.6), (49.0, 6.0, 62.0, 4.8)],
    [(44.0, 25.0, 48.0, 5.6), (46.0, 27.0, 38.0, 4.8)],
];

/// Where those of the segments begin, and where they go: beside the arteries, and dividing like them.
const SEGMENTAL: [Root; 10] = [
    Root::new((48.0, 5.0, 66.0, 4.2), (0.5, -0.1, 1.0)),
    Root::new((51.0, 7.0, 60.0, 4.2), (0.8, -0.7, 0.35)),
    Root::new((46.0, 31.0, 46.0, 3.8), (0.8, 0.6, 0.1)),
    Root::new((47.0, 23.0, 41.0, 4.2), (0.75, -0.3, -0.7)),
    Root::new((46.0, 27.0, 36.0, 4.4), (0.45, 0.4, -1.0)),
    Root::new((-40.0, 12.0, 72.0, 4.2), (-0.45, 0.1, 1.0)),
    Root::new((-42.0, 10.0, 68.0, 4.2), (-0.8, -0.7, 0.3)),
    Root::new((-46.0, 23.0, 50.0, 4.0), (-0.8, 0.6, 0.2)),
    Root::new((-53.0, 12.0, 34.0, 4.2), (-0.75, -0.5, -0.6)),
    Root::new((-48.0, 22.0, 38.0, 4.4), (-0.45, 0.5, -1.0)),
];

/// Walls of these, mm.
const TRACHEAL_WALL_MM: f32 = 2.0;
const WALL_MM: f32 = 1.4;

pub(super) fn tissues() -> Vec<Tissue> {
    let mut large = vec![(tube(&TRACHEA), TRACHEAL_WALL_MM), (tube(&RIGHT), WALL_MM), (tube(&LEFT), WALL_MM)];
    large.extend(LOBAR.iter().map(|nodes| (tube(nodes), WALL_MM)));
    for (root, seed) in SEGMENTAL.iter().zip(100..) {
        large.extend(grown_from(root, seed, &LUNGS, 4).into_iter().map(|twig| (twig, 0.9)));
    }
    let walls = large.iter().map(|(solid, _)| Tissue::new(MUSCLE, solid.clone()));
    let air = large.iter().map(|(solid, wall_mm)| Tissue::new(AIR, hollow(solid, *wall_mm)));
    walls.chain(air).collect()
}

fn hollow(solid: &Solid, wall_mm: f32) -> Solid {
    solid.clone().grown(-wall_mm)
}
