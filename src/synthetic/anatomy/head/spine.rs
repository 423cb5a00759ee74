//! The cervical spine.

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, ellipsoid, rod, tube};
use crate::synthetic::tissue::{CSF, DISC, Material, VERTEBRAL_SPONGE, WHITE};

/// Cortical bone of the vertebrae is thinner, so looks softer, than that of the skull.
const VERTEBRAL_CORTEX: Material = Material::Uniform(850.0);

/// Centres of the bodies of C3 to C7: y and z.
const BODIES: [(f32, f32); 5] = [(4.0, -72.0), (3.0, -89.0), (4.0, -106.0), (7.0, -123.0), (11.0, -140.0)];

/// Spinal canal and cord, vertebrae and discs.
pub(super) fn tissues() -> Vec<Tissue> {
    let mut tissues = vec![Tissue::new(VERTEBRAL_CORTEX, atlas()).core(1.3, VERTEBRAL_SPONGE)];
    tissues.push(Tissue::new(VERTEBRAL_CORTEX, axis()).core(1.3, VERTEBRAL_SPONGE));
    for (level, &(y, z)) in BODIES.iter().enumerate() {
        let disc = ellipsoid((0.0, y - 0.5, z + 8.5), (8.5, 7.5, 3.0));
        tissues.push(Tissue::new(DISC, disc));
        tissues.push(Tissue::new(VERTEBRAL_CORTEX, vertebra(level, y, z)).core(1.3, VERTEBRAL_SPONGE));
    }
    let canal = tube(&[
        (0.0, 19.0, -28.0, 9.0),
        (0.0, 19.0, -52.0, 7.5),
        (0.0, 18.0, -80.0, 7.2),
        (0.0, 19.0, -106.0, 7.2),
        (0.0, 26.0, -150.0, 7.2),
    ]);
    let cord = tube(&[
        (0.0, 18.0, -24.0, 6.0),
        (0.0, 19.0, -52.0, 4.6),
        (0.0, 18.0, -80.0, 4.6),
        (0.0, 19.0, -106.0, 4.6),
        (0.0, 26.0, -150.0, 4.6),
    ]);
    tissues.push(Tissue::new(CSF, canal));
    tissues.push(Tissue::new(WHITE, cord));
    tissues
}

/// C1, a ring.
fn atlas() -> Solid {
    let ring = tube(&[
        (0.0, -3.0, -38.0, 4.0),
        (13.0, 2.0, -38.0, 4.5),
        (19.0, 12.0, -38.0, 5.0),
        (15.0, 30.0, -38.0, 3.6),
        (0.0, 37.0, -38.0, 4.2),
    ]);
    let lateral_mass = ellipsoid((18.0, 9.0, -38.0), (7.0, 9.0, 6.5));
    let transverse = rod(&[(20.0, 11.0, -38.0, 4.0), (36.0, 12.0, -38.0, 3.6)]);
    blend(4.0, [ring, lateral_mass, transverse]).mirrored()
}

/// C2, with the dens.
fn axis() -> Solid {
    let dens = rod(&[(0.0, 6.0, -52.0, 6.0), (0.0, 5.5, -36.0, 4.6)]);
    let body = ellipsoid((0.0, 6.0, -55.0), (9.0, 7.5, 8.5));
    let shoulder = ellipsoid((16.0, 8.0, -49.0), (8.0, 8.0, 5.0)).mirrored();
    let arch = arch(7.0, -55.0, 15.0).mirrored();
    let spine = rod(&[(0.0, 34.0, -57.0, 4.0), (0.0, 50.0, -64.0, 5.0)]);
    blend(4.0, [dens, body, shoulder, arch, spine])
}

/// C3 to C7.
fn vertebra(level: usize, y: f32, z: f32) -> Solid {
    let body = blend(
        3.0,
        [ellipsoid((0.0, y, z), (11.0, 8.5, 6.6)), ellipsoid((6.0, y + 1.0, z), (7.0, 7.0, 6.8)).mirrored()],
    );
    let transverse =
        tube(&[(10.0, y + 1.0, z, 3.0), (19.0, y + 2.0, z - 1.0, 3.2), (26.0, y + 6.0, z - 2.0, 2.8)]).mirrored();
    let articular = rod(&[(20.0, y + 13.0, z + 5.0, 5.2), (20.0, y + 15.0, z - 5.0, 5.2)]).mirrored();
    let length = 12.0 + 3.5 * level as f32;
    let spine = rod(&[(0.0, y + 29.0, z - 4.0, 3.4), (0.0, y + 30.0 + length, z - 10.0, 3.6)]);
    blend(4.0, [body, transverse, articular, arch(y, z, 14.0).mirrored(), spine])
}

/// Left half of a neural arch.
fn arch(y: f32, z: f32, half_width_mm: f32) -> Solid {
    tube(&[
        (10.0, y + 5.0, z, 3.6),
        (half_width_mm + 1.0, y + 12.0, z - 1.0, 3.8),
        (10.0, y + 24.0, z - 3.0, 3.0),
        (0.0, y + 29.0, z - 4.0, 3.4),
    ])
}
