//! Vessels filled with contrast medium.

use super::skull;
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Node, Solid, blend, common, sphere, tube};
use crate::synthetic::tissue::CONTRAST;

/// Arteries and veins, one tissue each, so that far ones are skipped.
pub(super) fn tissues() -> Vec<Tissue> {
    let paired: Vec<&[Node]> = vec![
        &COMMON_AND_INTERNAL_CAROTID,
        &EXTERNAL_CAROTID,
        &SUPERFICIAL_TEMPORAL,
        &FACIAL,
        &VERTEBRAL,
        &MIDDLE_CEREBRAL,
        &SYLVIAN_UPPER,
        &SYLVIAN_LOWER,
        &ANTERIOR_CEREBRAL,
        &POSTERIOR_CEREBRAL,
        &POSTERIOR_COMMUNICATING,
        &JUGULAR,
    ];
    let mut tissues: Vec<Tissue> =
        paired.into_iter().map(|nodes| Tissue::new(CONTRAST, tube(nodes).mirrored()).beneath_skin(2.2)).collect();
    let single: [&[Node]; 3] = [&BASILAR, &ANTERIOR_COMMUNICATING, &STRAIGHT_SINUS];
    tissues.extend(single.into_iter().map(|nodes| Tissue::new(CONTRAST, tube(nodes))));
    for sinus in [tube(&SAGITTAL_SINUS), tube(&TRANSVERSE_SINUS).mirrored()] {
        // Sinuses run in the dura, flat against the bone.
        tissues.push(Tissue::new(CONTRAST, common(0.5, [sinus, skull::cavity().grown(0.4)])));
    }
    tissues.push(Tissue::new(CONTRAST, aneurysm()));
    tissues
}

/// At the bifurcation of the left middle cerebral artery.
fn aneurysm() -> Solid {
    blend(2.0, [sphere((37.0, -27.0, 31.0), 4.2), sphere((39.5, -30.0, 34.0), 2.6)])
}

const COMMON_AND_INTERNAL_CAROTID: [Node; 15] = [
    (25.0, -18.0, -160.0, 3.6),
    (26.0, -16.0, -120.0, 3.6),
    (27.0, -14.0, -98.0, 4.4),
    (28.0, -9.0, -84.0, 3.2),
    (28.0, -6.0, -60.0, 2.8),
    (26.0, -6.0, -36.0, 2.7),
    (27.0, -6.0, -14.0, 2.6),
    (24.0, -8.0, -4.0, 2.5),
    (14.0, -12.0, -1.0, 2.5),
    (12.0, -16.0, 8.0, 2.5),
    (11.0, -26.0, 15.0, 2.4),
    (11.0, -33.0, 18.0, 2.4),
    (11.0, -33.0, 24.0, 2.3),
    (11.0, -26.0, 27.0, 2.3),
    (14.0, -24.0, 32.0, 2.2),
];
const EXTERNAL_CAROTID: [Node; 5] = [
    (27.0, -15.0, -96.0, 2.8),
    (31.0, -19.0, -80.0, 2.3),
    (38.0, -12.0, -58.0, 2.1),
    (47.0, -4.0, -34.0, 1.9),
    (56.0, -5.0, -12.0, 1.7),
];
const SUPERFICIAL_TEMPORAL: [Node; 8] = [
    (56.0, -5.0, -12.0, 1.7),
    (67.0, -9.0, 8.0, 1.4),
    (69.5, -13.0, 24.0, 1.3),
    (70.5, -18.0, 38.0, 1.3),
    (68.0, -28.0, 50.0, 1.2),
    (65.5, -34.0, 60.0, 1.2),
    (61.0, -46.0, 68.0, 1.1),
    (55.0, -55.0, 80.0, 0.9),
];
const FACIAL: [Node; 7] = [
    (31.0, -19.0, -80.0, 1.8),
    (38.0, -34.0, -84.0, 1.6),
    (42.0, -48.0, -72.0, 1.5),
    (38.0, -64.0, -54.0, 1.4),
    (27.0, -82.0, -42.0, 1.3),
    (20.0, -87.0, -22.0, 1.2),
    (14.0, -86.0, 6.0, 1.0),
];
const VERTEBRAL: [Node; 9] = [
    (18.0, 6.0, -160.0, 2.0),
    (18.5, 4.0, -120.0, 2.0),
    (18.5, 4.0, -80.0, 2.0),
    (22.0, 8.0, -56.0, 2.0),
    (29.0, 11.0, -40.0, 2.0),
    (24.0, 20.0, -31.0, 2.0),
    (12.0, 16.0, -26.0, 2.0),
    (6.0, 4.0, -14.0, 1.9),
    (0.0, -7.0, -4.0, 1.9),
];
const BASILAR: [Node; 4] =
    [(0.0, -7.0, -5.0, 2.0), (1.0, -10.0, 4.0, 2.1), (0.5, -10.0, 14.0, 2.1), (0.0, -9.0, 21.0, 2.0)];
const MIDDLE_CEREBRAL: [Node; 4] =
    [(14.0, -24.0, 32.0, 2.1), (22.0, -26.0, 33.0, 1.9), (32.0, -27.0, 31.0, 1.8), (38.0, -24.0, 32.0, 1.6)];
const SYLVIAN_UPPER: [Node; 6] = [
    (38.0, -24.0, 32.0, 1.5),
    (40.0, -22.0, 42.0, 1.4),
    (44.0, -14.0, 52.0, 1.3),
    (52.0, -8.0, 56.0, 1.3),
    (56.0, 0.0, 70.0, 1.2),
    (52.0, 6.0, 84.0, 1.0),
];
const SYLVIAN_LOWER: [Node; 5] = [
    (38.0, -24.0, 32.0, 1.5),
    (42.0, -12.0, 34.0, 1.4),
    (48.0, 2.0, 42.0, 1.3),
    (56.0, 16.0, 48.0, 1.2),
    (56.0, 32.0, 56.0, 1.0),
];
const ANTERIOR_CEREBRAL: [Node; 8] = [
    (14.0, -24.0, 32.0, 1.8),
    (6.0, -32.0, 32.0, 1.6),
    (2.6, -36.0, 34.0, 1.5),
    (2.6, -46.0, 46.0, 1.5),
    (2.6, -42.0, 62.0, 1.4),
    (2.6, -22.0, 72.0, 1.3),
    (2.6, 2.0, 74.0, 1.2),
    (2.6, 20.0, 76.0, 1.0),
];
const ANTERIOR_COMMUNICATING: [Node; 2] = [(-2.6, -36.0, 34.0, 1.1), (2.6, -36.0, 34.0, 1.1)];
const POSTERIOR_CEREBRAL: [Node; 7] = [
    (0.0, -9.0, 21.0, 1.9),
    (7.0, -9.0, 23.0, 1.7),
    (16.0, -2.0, 24.0, 1.6),
    (18.0, 12.0, 25.0, 1.5),
    (14.0, 28.0, 27.0, 1.4),
    (12.0, 46.0, 30.0, 1.3),
    (8.0, 62.0, 34.0, 1.0),
];
const POSTERIOR_COMMUNICATING: [Node; 3] = [(12.0, -26.0, 28.0, 1.2), (10.0, -18.0, 25.0, 1.1), (8.0, -9.0, 23.0, 1.2)];
const SAGITTAL_SINUS: [Node; 9] = [
    (0.0, -76.0, 62.0, 2.0),
    (0.0, -62.0, 87.0, 2.8),
    (0.0, -40.0, 106.0, 3.6),
    (0.0, -8.0, 117.0, 4.2),
    (0.0, 28.0, 114.0, 4.8),
    (0.0, 57.0, 98.0, 5.2),
    (0.0, 76.0, 70.0, 5.5),
    (0.0, 81.0, 40.0, 5.7),
    (0.0, 74.0, 17.0, 5.8),
];
const STRAIGHT_SINUS: [Node; 3] = [(0.0, 30.0, 46.0, 2.2), (0.0, 52.0, 32.0, 2.4), (0.0, 74.0, 17.0, 3.0)];
const TRANSVERSE_SINUS: [Node; 5] = [
    (0.0, 74.0, 17.0, 5.6),
    (24.0, 66.0, 13.0, 5.4),
    (42.0, 46.0, 11.0, 5.4),
    (49.0, 30.0, 6.0, 5.2),
    (42.0, 18.0, -6.0, 5.0),
];
const JUGULAR: [Node; 5] = [
    (44.0, 22.0, -2.0, 4.4),
    (38.0, 10.0, -16.0, 4.6),
    (33.0, 3.0, -32.0, 5.0),
    (34.0, -5.0, -90.0, 5.4),
    (33.0, -12.0, -160.0, 6.0),
];
