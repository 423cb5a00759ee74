//! Lungs with the vessels in them, and what lies between the two.

use std::sync::LazyLock;

use super::tree::{Root, grown_from};
use super::{ARTERIAL, PULMONARY, abdomen, cage, heart};
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Node, Solid, blend, common, ellipsoid, tube};
use crate::synthetic::tissue::{AIR, FAT, MUSCLE, Material};

/// Air and the walls of alveoli, too small to be seen.
const PARENCHYMA: Material = Material::Spongy { mean_hu: -860.0, swing_hu: 22.0, grain_mm: 7.0 };

/// Where arteries enter a lung, (x, y, z) and radius, and where they go.
const ARTERIES: [Root; 10] = [
    Root::new((46.0, 12.0, 70.0, 5.2), (0.5, -0.1, 1.0)),
    Root::new((50.0, 17.0, 66.0, 5.0), (0.8, -0.7, 0.35)),
    Root::new((54.0, 28.0, 58.0, 5.0), (0.8, 0.6, 0.2)),
    Root::new((55.0, 29.0, 44.0, 5.2), (0.75, -0.3, -0.7)),
    Root::new((53.0, 33.0, 38.0, 5.4), (0.45, 0.4, -1.0)),
    Root::new((-42.0, 2.0, 74.0, 5.2), (-0.45, 0.1, 1.0)),
    Root::new((-50.0, -2.0, 62.0, 5.0), (-0.8, -0.7, 0.3)),
    Root::new((-54.0, 14.0, 58.0, 5.0), (-0.8, 0.6, 0.2)),
    Root::new((-54.0, 6.0, 38.0, 5.2), (-0.75, -0.5, -0.6)),
    Root::new((-52.0, 22.0, 36.0, 5.4), (-0.45, 0.5, -1.0)),
];

/// Where veins leave it.
const VEINS: [Root; 6] = [
    Root::new((50.0, 0.0, 48.0, 4.6), (0.8, -0.5, 0.8)),
    Root::new((46.0, 26.0, 18.0, 4.8), (0.7, 0.5, -0.7)),
    Root::new((56.0, 10.0, 28.0, 4.2), (1.0, 0.0, -0.1)),
    Root::new((-50.0, -8.0, 46.0, 4.6), (-0.8, -0.5, 0.8)),
    Root::new((-48.0, 20.0, 16.0, 4.8), (-0.7, 0.5, -0.7)),
    Root::new((-56.0, 2.0, 26.0, 4.2), (-1.0, -0.1, -0.1)),
];

/// Both lungs.
pub(super) static LUNGS: LazyLock<Solid> =
    LazyLock::new(|| cage::cavity().grown(-1.5).cut(3.0, between()).cut(2.0, abdomen::dome().grown(0.5)));

/// What keeps the lungs apart: heart, great vessels, oesophagus and spine.
fn between() -> Solid {
    let upper = ellipsoid((-1.0, -14.0, 92.0), (34.0, 46.0, 52.0));
    let top = ellipsoid((0.0, 0.0, 150.0), (32.0, 44.0, 46.0));
    let front = ellipsoid((2.0, -86.0, 30.0), (12.0, 22.0, 110.0));
    let hila = ellipsoid((0.0, 12.0, 50.0), (46.0, 18.0, 26.0));
    let spine =
        tube(&[(0.0, 58.0, 170.0, 20.0), (0.0, 70.0, 90.0, 22.0), (2.0, 78.0, 10.0, 24.0), (0.0, 68.0, -140.0, 26.0)]);
    let aorta = tube(&[
        (26.0, 40.0, 84.0, 15.0),
        (27.0, 45.0, 10.0, 15.0),
        (25.0, 41.0, -50.0, 15.0),
        (18.0, 17.0, -145.0, 15.0),
    ]);
    let gullet = blend(8.0, [oesophagus(9.0), ellipsoid((2.0, 36.0, -10.0), (15.0, 24.0, 100.0))]);
    blend(10.0, [heart::pericardium(), upper, top, front, hila, spine, aorta, gullet])
}

/// Fat, with the oesophagus in it.
pub(super) fn mediastinum() -> Vec<Tissue> {
    let thymus = ellipsoid((4.0, -60.0, 84.0), (16.0, 8.0, 26.0));
    vec![
        Tissue::new(FAT, cage::cavity()),
        Tissue::new(Material::Uniform(-30.0), thymus),
        Tissue::new(MUSCLE, oesophagus(6.5)),
        Tissue::new(AIR, oesophagus(1.8)),
    ]
}

fn oesophagus(radius_mm: f32) -> Solid {
    let at = |x: f32, y: f32, z: f32| -> Node { (x, y, z, radius_mm) };
    tube(&[
        at(3.0, 8.0, 175.0),
        at(4.0, 20.0, 135.0),
        at(5.0, 28.0, 100.0),
        at(3.0, 35.0, 60.0),
        at(4.0, 38.0, 20.0),
        at(10.0, 34.0, -20.0),
        at(26.0, 22.0, -56.0),
    ])
}

pub(super) fn tissues() -> Vec<Tissue> {
    let mut tissues = vec![Tissue::new(PARENCHYMA, LUNGS.clone())];
    let grown = |roots: &[Root], seed: u64, blood: Material| -> Vec<Tissue> {
        let twigs = roots.iter().zip(seed..).flat_map(|(root, seed)| grown_from(root, seed, &LUNGS, 7));
        twigs.map(|twig| Tissue::new(blood, twig)).collect()
    };
    tissues.extend(grown(&ARTERIES, 100, PULMONARY));
    tissues.extend(grown(&VEINS, 200, ARTERIAL));
    let fissure = common(0.3, [LUNGS.clone().grown(-0.5), oblique_fissure().mirrored()]);
    tissues.insert(1, Tissue::new(Material::Uniform(-650.0), fissure));
    tissues
}

/// Between the upper and the lower lobe: a sheet that falls from behind to the front.
fn oblique_fissure() -> Solid {
    ellipsoid((0.0, 0.0, 0.0), (90.0, 130.0, 0.6)).placed((70.0, 4.0, 20.0), (1.0, 0.0, -0.12), (0.1, -0.72, 0.7))
}
