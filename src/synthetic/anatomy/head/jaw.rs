//! The lower jaw and the hyoid bone.

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, block, ellipsoid, rod, tube};
use crate::synthetic::tissue::{CORTICAL, DIPLOE};

/// Mandible and hyoid.
pub(super) fn tissues() -> Vec<Tissue> {
    let hyoid = tube(&[(0.0, -39.0, -97.0, 3.2), (12.0, -35.0, -97.0, 2.6), (22.0, -20.0, -93.0, 1.8)]).mirrored();
    vec![
        Tissue::new(CORTICAL, mandible()).core(2.6, DIPLOE).beneath_skin(2.6),
        Tissue::new(CORTICAL, hyoid).beneath_skin(3.0),
    ]
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
    let ramus = block((0.0, 0.0, 0.0), (3.6, 15.5, 21.0), 3.5).placed(
        (48.0, -24.5, -42.0),
        (1.0, 0.12, 0.0),
        (0.06, 0.08, 1.0),
    );
    let coronoid = rod(&[(48.5, -34.0, -28.0, 3.8), (49.5, -37.5, -10.0, 2.4)]);
    let neck = rod(&[(50.0, -14.0, -30.0, 4.0), (50.5, -12.0, -10.0, 3.8)]);
    let angle = rod(&[(47.0, -22.0, -64.0, 4.6), (49.0, -14.0, -58.0, 4.4)]);
    let condyle = rod(&[(45.0, -12.0, -7.0, 4.4), (55.0, -12.0, -6.0, 4.4)]);
    let chin = ellipsoid((0.0, -88.0, -81.0), (9.0, 4.5, 5.5));
    let half = blend(13.0, [blend(16.0, [lower_border, body, alveolar]), ramus, angle]);
    blend(8.0, [blend(8.0, [half, coronoid, neck, condyle]).mirrored(), chin])
}
