//! The lower jaw and the hyoid bone.

use crate::synthetic::sdf::{Solid, blend, ellipsoid, rod, tube};
use crate::synthetic::tissue::{CORTICAL, DIPLOE, Tissue};

/// Mandible and hyoid.
pub(super) fn tissues() -> Vec<Tissue> {
    let hyoid = tube(&[(0.0, -43.0, -92.0, 3.2), (12.0, -39.0, -92.0, 2.6), (22.0, -22.0, -88.0, 1.8)]).mirrored();
    vec![Tissue::new(CORTICAL, mandible()).core(1.9, DIPLOE).beneath_skin(2.6), Tissue::new(CORTICAL, hyoid)]
}

fn mandible() -> Solid {
    let lower_border = tube(&[
        (0.0, -85.0, -80.0, 6.0),
        (16.0, -81.0, -80.0, 6.0),
        (31.0, -60.0, -77.0, 5.5),
        (43.0, -32.0, -71.0, 5.2),
        (49.0, -16.0, -62.0, 4.6),
    ]);
    let body = tube(&[
        (0.0, -84.0, -70.0, 5.2),
        (15.0, -80.5, -70.0, 5.2),
        (28.0, -62.0, -69.0, 5.6),
        (39.0, -38.0, -65.0, 5.2),
        (46.0, -24.0, -58.0, 4.6),
    ]);
    let alveolar = tube(&[
        (0.0, -85.0, -60.0, 4.6),
        (13.0, -81.5, -60.0, 4.8),
        (23.0, -68.0, -60.0, 5.4),
        (30.0, -52.0, -59.5, 5.6),
        (39.0, -36.0, -56.0, 5.0),
    ]);
    let ramus_behind = tube(&[(49.0, -15.0, -61.0, 4.8), (50.5, -10.0, -40.0, 4.2), (51.0, -11.0, -14.0, 4.0)]);
    let ramus_between = tube(&[(45.0, -26.0, -60.0, 4.8), (48.5, -23.0, -40.0, 3.8), (50.0, -24.0, -24.0, 3.2)]);
    let ramus_before = tube(&[(41.0, -36.0, -57.0, 4.8), (46.5, -36.0, -40.0, 3.6), (49.0, -38.0, -14.0, 2.6)]);
    let condyle = rod(&[(45.0, -12.0, -7.0, 4.4), (55.0, -12.0, -6.0, 4.4)]);
    let chin = ellipsoid((0.0, -88.0, -81.0), (9.0, 4.5, 5.5));
    let half = blend(9.0, [lower_border, body, alveolar, ramus_behind, ramus_between, ramus_before, condyle]);
    blend(8.0, [half.mirrored(), chin])
}
