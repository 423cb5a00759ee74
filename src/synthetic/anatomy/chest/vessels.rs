//! The great vessels: aorta with its branches, pulmonary arteries and veins up to the lungs, and the caval veins.

use super::{ARTERIAL, MIXED, PULMONARY, VENOUS};
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Node, tube};
use crate::synthetic::tissue::Material;

pub(super) fn tissues() -> Vec<Tissue> {
    let vessels: [(Material, &[Node]); 16] = [
        (VENOUS, &INFERIOR_CAVA),
        (MIXED, &SUPERIOR_CAVA),
        (MIXED, &LEFT_BRACHIOCEPHALIC_VEIN),
        (MIXED, &RIGHT_BRACHIOCEPHALIC_VEIN),
        (VENOUS, &AZYGOS),
        (ARTERIAL, &PULMONARY_VEINS[0]),
        (ARTERIAL, &PULMONARY_VEINS[1]),
        (ARTERIAL, &PULMONARY_VEINS[2]),
        (ARTERIAL, &PULMONARY_VEINS[3]),
        (PULMONARY, &RIGHT_PULMONARY_ARTERY),
        (PULMONARY, &LEFT_PULMONARY_ARTERY),
        (PULMONARY, &PULMONARY_TRUNK),
        (ARTERIAL, &AORTA),
        (ARTERIAL, &BRACHIOCEPHALIC_ARTERY),
        (ARTERIAL, &LEFT_CAROTID),
        (ARTERIAL, &LEFT_SUBCLAVIAN),
    ];
    vessels.into_iter().map(|(blood, nodes)| Tissue::new(blood, tube(nodes))).collect()
}

/// Up to the right, over the left bronchus, and down on the left of the spine.
const AORTA: [Node; 14] = [
    (0.0, -26.0, 32.0, 14.5),
    (-8.0, -32.0, 50.0, 15.5),
    (-14.0, -36.0, 68.0, 15.0),
    (-13.0, -33.0, 86.0, 14.5),
    (-5.0, -24.0, 98.0, 14.0),
    (8.0, -6.0, 103.0, 13.2),
    (18.0, 14.0, 101.0, 12.8),
    (25.0, 31.0, 92.0, 12.4),
    (27.0, 40.0, 76.0, 12.2),
    (27.0, 42.0, 50.0, 12.0),
    (27.0, 45.0, 10.0, 11.8),
    (26.0, 42.0, -40.0, 11.5),
    (23.0, 33.0, -90.0, 11.2),
    (18.0, 17.0, -145.0, 10.5),
];
const BRACHIOCEPHALIC_ARTERY: [Node; 4] =
    [(-4.0, -22.0, 104.0, 7.0), (-14.0, -20.0, 126.0, 6.4), (-26.0, -14.0, 148.0, 6.0), (-32.0, -8.0, 180.0, 4.4)];
const LEFT_CAROTID: [Node; 4] =
    [(7.0, -8.0, 108.0, 4.4), (13.0, -12.0, 130.0, 4.0), (20.0, -12.0, 155.0, 3.8), (24.0, -10.0, 180.0, 3.8)];
const LEFT_SUBCLAVIAN: [Node; 5] = [
    (18.0, 10.0, 106.0, 5.2),
    (24.0, 8.0, 130.0, 4.8),
    (36.0, 0.0, 150.0, 4.6),
    (62.0, -18.0, 158.0, 4.4),
    (100.0, -16.0, 156.0, 4.0),
];
const PULMONARY_TRUNK: [Node; 5] = [
    (16.0, -60.0, 30.0, 14.0),
    (18.0, -54.0, 46.0, 14.5),
    (19.0, -40.0, 60.0, 14.5),
    (18.0, -22.0, 68.0, 13.5),
    (16.0, -8.0, 70.0, 11.5),
];
/// Behind the ascending aorta and the superior caval vein.
const RIGHT_PULMONARY_ARTERY: [Node; 4] =
    [(14.0, -14.0, 67.0, 11.5), (-6.0, -4.0, 62.0, 11.0), (-28.0, 0.0, 61.0, 10.5), (-48.0, 5.0, 56.0, 8.0)];
/// Over the left bronchus.
const LEFT_PULMONARY_ARTERY: [Node; 5] = [
    (17.0, -14.0, 69.0, 11.5),
    (30.0, 4.0, 75.0, 10.5),
    (42.0, 22.0, 72.0, 9.0),
    (52.0, 32.0, 56.0, 7.2),
    (53.0, 33.0, 42.0, 6.0),
];
const PULMONARY_VEINS: [[Node; 3]; 4] = [
    [(22.0, 8.0, 32.0, 7.0), (38.0, 2.0, 42.0, 6.4), (52.0, -1.0, 50.0, 5.2)],
    [(24.0, 18.0, 22.0, 7.0), (38.0, 24.0, 18.0, 6.4), (48.0, 27.0, 16.0, 5.2)],
    [(-18.0, 6.0, 32.0, 7.0), (-36.0, -4.0, 40.0, 6.4), (-52.0, -9.0, 48.0, 5.2)],
    [(-18.0, 16.0, 22.0, 7.0), (-36.0, 19.0, 18.0, 6.4), (-50.0, 21.0, 15.0, 5.2)],
];
const SUPERIOR_CAVA: [Node; 4] =
    [(-36.0, -22.0, 28.0, 10.5), (-38.0, -24.0, 54.0, 10.0), (-36.0, -26.0, 84.0, 9.6), (-32.0, -28.0, 110.0, 9.0)];
const LEFT_BRACHIOCEPHALIC_VEIN: [Node; 5] = [
    (-31.0, -29.0, 108.0, 8.0),
    (-12.0, -46.0, 114.0, 7.4),
    (14.0, -48.0, 122.0, 7.2),
    (40.0, -34.0, 138.0, 7.0),
    (84.0, -34.0, 150.0, 6.4),
];
const RIGHT_BRACHIOCEPHALIC_VEIN: [Node; 4] =
    [(-32.0, -28.0, 108.0, 8.4), (-36.0, -28.0, 128.0, 7.4), (-48.0, -32.0, 144.0, 7.0), (-90.0, -34.0, 150.0, 6.4)];
const INFERIOR_CAVA: [Node; 4] =
    [(-34.0, -10.0, -16.0, 11.5), (-32.0, -2.0, -44.0, 12.0), (-27.0, 14.0, -90.0, 12.0), (-24.0, 22.0, -145.0, 11.5)];
/// In front of the spine, over the right bronchus to the superior caval vein.
const AZYGOS: [Node; 7] = [
    (-12.0, 22.0, -120.0, 3.0),
    (-14.0, 36.0, -60.0, 3.4),
    (-14.0, 41.0, -10.0, 3.6),
    (-14.0, 36.0, 50.0, 4.0),
    (-14.0, 32.0, 78.0, 4.2),
    (-24.0, 10.0, 88.0, 4.4),
    (-34.0, -18.0, 84.0, 4.6),
];
