//! Teeth: enamel over dentine over pulp, in two arches, with one filling on the patient's left.

use glam::Vec3;

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, block, ellipsoid, rod, sphere};
use crate::synthetic::tissue::{DENTINE, ENAMEL, FILLING, MUSCLE};

/// One tooth of the left half.
struct Tooth {
    /// Centre of the crown.
    x: f32,
    y: f32,
    /// Half the width of the crown along the arch and across it, and half its height, mm.
    along_mm: f32,
    across_mm: f32,
    half_height_mm: f32,
    /// Molars have two roots.
    roots: u8,
}

const fn tooth(x: f32, y: f32, along_mm: f32, across_mm: f32, half_height_mm: f32, roots: u8) -> Tooth {
    Tooth { x, y, along_mm, across_mm, half_height_mm, roots }
}

/// Two incisors, canine, two premolars, two molars.
const UPPER: [Tooth; 7] = [
    tooth(4.5, -91.5, 4.5, 3.6, 5.6, 1),
    tooth(12.1, -88.8, 3.5, 3.4, 5.0, 1),
    tooth(18.4, -83.8, 3.9, 4.2, 5.6, 1),
    tooth(22.6, -77.0, 3.6, 4.6, 4.4, 1),
    tooth(25.4, -70.0, 3.6, 4.6, 4.2, 1),
    tooth(28.3, -60.9, 5.2, 5.4, 4.0, 2),
    tooth(30.5, -50.4, 5.0, 5.2, 3.8, 2),
];

const LOWER: [Tooth; 7] = [
    tooth(2.8, -87.8, 2.7, 3.2, 4.8, 1),
    tooth(8.3, -86.6, 3.0, 3.3, 4.8, 1),
    tooth(14.5, -83.0, 3.6, 4.0, 5.4, 1),
    tooth(19.4, -76.8, 3.6, 4.2, 4.4, 1),
    tooth(23.0, -69.8, 3.6, 4.4, 4.2, 1),
    tooth(27.1, -60.2, 5.3, 5.2, 4.0, 2),
    tooth(30.7, -49.6, 5.1, 5.0, 3.8, 2),
];

/// Height at which the arches meet.
const OCCLUSAL_PLANE_MM: f32 = -45.5;

/// All teeth.
pub(super) fn tissues() -> Vec<Tissue> {
    let mut tissues = Vec::new();
    for (arch, upwards) in [(&UPPER, 1.0), (&LOWER, -1.0)] {
        for (index, tooth) in arch.iter().enumerate() {
            let (previous, next) = (&arch[index.saturating_sub(1)], &arch[(index + 1).min(arch.len() - 1)]);
            // At the midline the arch runs along x.
            let along = if index == 0 { Vec3::X } else { Vec3::new(next.x - previous.x, next.y - previous.y, 0.0) };
            let along = along.normalize();
            tissues.push(Tissue::new(DENTINE, tooth.root(upwards, along).mirrored()));
            let crown = tooth.crown(upwards, along).mirrored();
            tissues.push(Tissue::new(ENAMEL, crown).core(1.4, DENTINE).core(3.0, MUSCLE));
        }
    }
    let molar = &UPPER[5];
    tissues.push(Tissue::new(FILLING, sphere((molar.x, molar.y, OCCLUSAL_PLANE_MM + 2.6), 3.0)));
    tissues
}

impl Tooth {
    fn center(&self, upwards: f32) -> Vec3 {
        Vec3::new(self.x, self.y, OCCLUSAL_PLANE_MM + upwards * (self.half_height_mm + 0.3))
    }

    /// Squarish at the biting edge, round at the neck.
    fn crown(&self, upwards: f32, along: Vec3) -> Solid {
        let Tooth { along_mm, across_mm, half_height_mm, .. } = *self;
        let edge = block(
            (0.0, 0.0, -0.25 * upwards * half_height_mm),
            (0.97 * along_mm, 0.86 * across_mm, 0.75 * half_height_mm),
            0.55 * along_mm.min(across_mm),
        );
        let neck = ellipsoid(
            (0.0, 0.0, 0.2 * upwards * half_height_mm),
            (0.9 * along_mm, 0.95 * across_mm, 0.9 * half_height_mm),
        );
        blend(2.0, [edge, neck]).placed(self.center(upwards), along, Vec3::Z)
    }

    fn root(&self, upwards: f32, along: Vec3) -> Solid {
        let center = self.center(upwards);
        let (neck_z, tip_z) = (center.z + 0.5 * upwards * self.half_height_mm, center.z + 14.0 * upwards);
        let radius_mm = 0.6 * self.along_mm.min(self.across_mm);
        let one = |side: f32| {
            let neck = center + if self.roots == 2 { side * 0.5 * self.along_mm * along } else { Vec3::ZERO };
            rod(&[(neck.x, neck.y, neck_z, radius_mm), (neck.x, neck.y + 1.0, tip_z, 1.0)])
        };
        blend(1.0, [one(-1.0), one(1.0)])
    }
}
