//! Beneath the diaphragm: liver, stomach with air in it, and spleen.

use super::cage;
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, common, ellipsoid, half_space};
use crate::synthetic::tissue::{AIR, FAT, MUSCLE, Material};

/// In the arterial phase the liver has had little contrast medium yet.
const LIVER: Material = Material::Uniform(68.0);
/// The spleen takes it up in bands.
const SPLEEN: Material = Material::Spongy { mean_hu: 115.0, swing_hu: 28.0, grain_mm: 11.0 };
const STOMACH_CONTENTS: Material = Material::Uniform(20.0);

/// How thick the diaphragm is, mm.
const DIAPHRAGM_MM: f32 = 3.5;

/// The upper side of the diaphragm: a dome on either side, the right one higher, and the tendon under the heart between them.
pub(super) fn dome() -> Solid {
    let right = ellipsoid((-60.0, -2.0, -132.0), (84.0, 92.0, 102.0));
    let left = ellipsoid((62.0, 2.0, -140.0), (80.0, 90.0, 96.0));
    let tendon = ellipsoid((10.0, -14.0, -136.0), (64.0, 70.0, 84.0));
    blend(16.0, [right, left, tendon])
}

/// Diaphragm, fat, stomach and spleen.
pub(super) fn tissues() -> Vec<Tissue> {
    let diaphragm = common(1.0, [dome(), cage::cavity()]);
    let stomach = within(blend(
        18.0,
        [ellipsoid((62.0, 8.0, -92.0), (36.0, 46.0, 36.0)), ellipsoid((44.0, -30.0, -118.0), (38.0, 34.0, 30.0))],
    ));
    let hollow = stomach.clone().grown(-3.5);
    // Air rises to the front of a patient who lies on the back.
    let air = common(1.0, [hollow.clone(), half_space((0.0, -26.0, 0.0), (0.0, 1.0, 0.0))]);
    let spleen = within(ellipsoid((96.0, 52.0, -98.0), (30.0, 40.0, 46.0)));
    vec![
        Tissue::new(MUSCLE, diaphragm).core(DIAPHRAGM_MM, FAT),
        Tissue::new(SPLEEN, spleen.cut(3.0, stomach.clone().grown(2.0))),
        Tissue::new(MUSCLE, stomach),
        Tissue::new(STOMACH_CONTENTS, hollow),
        Tissue::new(AIR, air),
    ]
}

/// The liver, its dome on the right.
pub(super) fn liver() -> Vec<Tissue> {
    let right = ellipsoid((-62.0, 4.0, -128.0), (86.0, 88.0, 104.0));
    let left = ellipsoid((-4.0, -44.0, -118.0), (64.0, 40.0, 62.0));
    let spine = ellipsoid((6.0, 62.0, -120.0), (46.0, 46.0, 80.0));
    vec![Tissue::new(LIVER, within(blend(20.0, [right, left])).cut(8.0, spine))]
}

/// What of a solid is beneath the diaphragm.
fn within(solid: Solid) -> Solid {
    common(4.0, [solid, dome().grown(-DIAPHRAGM_MM - 1.5), cage::cavity().grown(-DIAPHRAGM_MM - 1.5)])
}
