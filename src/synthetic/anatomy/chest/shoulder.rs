//! Clavicles and shoulder blades.

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, ellipsoid, rod, tube};
use crate::synthetic::tissue::Material;

const CORTEX: Material = Material::Uniform(850.0);
const MARROW: Material = Material::Spongy { mean_hu: 260.0, swing_hu: 80.0, grain_mm: 2.4 };

pub(super) fn tissues() -> Vec<Tissue> {
    [clavicle(), blade()].map(|bone| Tissue::new(CORTEX, bone.mirrored()).core(1.3, MARROW).beneath_skin(5.0)).to_vec()
}

/// S-shaped, from the breast bone to the acromion.
fn clavicle() -> Solid {
    tube(&[
        (18.0, -66.0, 122.0, 8.0),
        (42.0, -74.0, 128.0, 6.2),
        (74.0, -62.0, 140.0, 5.6),
        (104.0, -30.0, 152.0, 5.8),
        (128.0, -4.0, 162.0, 6.6),
    ])
}

/// A plate on the back of the ribs, with its spine and the socket of the arm.
fn blade() -> Solid {
    let plate =
        ellipsoid((0.0, 0.0, 0.0), (3.2, 36.0, 62.0)).placed((92.0, 71.0, 82.0), (0.66, 0.75, -0.1), (0.12, 0.05, 1.0));
    let rim = rod(&[(118.0, 44.0, 128.0, 5.0), (84.0, 76.0, 24.0, 4.2)]);
    let spine = tube(&[
        (64.0, 93.0, 112.0, 3.4),
        (92.0, 84.0, 126.0, 4.4),
        (120.0, 58.0, 148.0, 6.0),
        (132.0, 26.0, 164.0, 6.0),
    ]);
    let socket = ellipsoid((122.0, 34.0, 140.0), (10.0, 12.0, 16.0));
    blend(6.0, [plate, rim, spine, socket])
}
