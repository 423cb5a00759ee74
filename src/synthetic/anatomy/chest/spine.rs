//! The thoracic spine, with marrow in its vertebrae.

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Node, Solid, blend, common, ellipsoid, half_space, rod, tube};
use crate::synthetic::tissue::{CSF, DISC, Material, VERTEBRAL_SPONGE, WHITE};

/// As in the neck, thinner than that of the skull.
const CORTEX: Material = Material::Uniform(750.0);

/// Centres of the vertebral bodies, y and z: the first to the twelfth of the chest, and the first lumbar one.
pub(super) const BODIES: [(f32, f32); 13] = [
    (28.0, 158.0),
    (36.0, 138.0),
    (43.0, 117.0),
    (49.0, 95.5),
    (53.0, 73.5),
    (56.0, 51.0),
    (58.0, 28.0),
    (59.0, 4.5),
    (58.0, -19.5),
    (56.0, -44.5),
    (52.0, -70.5),
    (47.0, -97.5),
    (41.0, -125.5),
];

/// From the middle of a body to that of the canal, mm to the back.
const CANAL_MM: f32 = 23.0;

pub(super) fn tissues() -> Vec<Tissue> {
    let mut tissues = Vec::new();
    for (level, &(y, z)) in BODIES.iter().enumerate() {
        let half_mm = 8.4 + 0.25 * level as f32;
        let disc = ellipsoid((0.0, y - 0.5, z - half_mm - 2.4), (14.0, 12.0, 3.4));
        tissues.push(Tissue::new(DISC, disc));
        tissues.push(Tissue::new(CORTEX, vertebra(level, y, z, half_mm)).core(1.2, VERTEBRAL_SPONGE));
    }
    tissues.push(Tissue::new(CSF, along_canal(8.0)));
    tissues.push(Tissue::new(WHITE, along_canal(4.4)));
    tissues
}

fn along_canal(radius_mm: f32) -> Solid {
    let (first, last) = (BODIES[0], BODIES[BODIES.len() - 1]);
    let ends = [(first.0 - 10.0, first.1 + 24.0), (last.0 - 7.0, last.1 - 26.0)];
    let [above, below] = ends.map(|(y, z)| (0.0, y + CANAL_MM, z, radius_mm));
    let mut nodes: Vec<Node> = vec![above];
    nodes.extend(BODIES.iter().map(|&(y, z)| (0.0, y + CANAL_MM, z, radius_mm)));
    nodes.push(below);
    tube(&nodes)
}

fn vertebra(level: usize, y: f32, z: f32, half_mm: f32) -> Solid {
    let wide = 1.0 + 0.02 * level as f32;
    let column = rod(&[(3.5, y, z - 30.0, 12.0 * wide), (3.5, y, z + 30.0, 12.0 * wide)]).mirrored();
    let [top, bottom] = [1.0, -1.0].map(|up| half_space((0.0, y, z + up * half_mm), (0.0, 0.0, up)));
    let body = common(3.0, [column, top, bottom]);
    let arch = tube(&[
        (10.5, y + 10.0, z + 2.0, 3.8),
        (12.5, y + 20.0, z + 1.0, 3.6),
        (8.5, y + 31.0, z - 3.0, 3.2),
        (0.0, y + 36.0, z - 6.0, 3.8),
    ])
    .mirrored();
    let transverse =
        tube(&[(12.0, y + 21.0, z + 1.0, 4.0), (22.0, y + 27.0, z + 4.0, 3.8), (31.0, y + 33.0, z + 4.0, 4.6)])
            .mirrored();
    // Steepest in the middle of the chest.
    let steep = 1.0 - (level as f32 - 6.0).abs() / 8.0;
    let spine = rod(&[(0.0, y + 36.0, z - 6.0, 3.8), (0.0, y + 56.0 - 6.0 * steep, z - 14.0 - 18.0 * steep, 3.4)]);
    let articular = rod(&[(13.0, y + 23.0, z + 11.0, 3.6), (13.0, y + 25.0, z - 11.0, 3.6)]).mirrored();
    blend(4.0, [body, arch, transverse, articular, spine])
}
