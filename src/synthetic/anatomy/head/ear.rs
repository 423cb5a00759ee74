//! The outer ears.

use crate::synthetic::sdf::{Solid, blend, ellipsoid, rod, sphere, tube};

/// Both auricles: a plate that stands off the head, with the rim (helix), the inner fold (antihelix), the tragus in
/// front of the canal and the lobule.
pub(super) fn auricles() -> Solid {
    let plate =
        ellipsoid((0.0, 0.0, 0.0), (16.0, 3.0, 28.0)).placed((82.0, 14.0, 4.0), (0.45, 0.89, 0.0), (0.12, 0.1, 1.0));
    let helix = tube(&[
        (77.0, 7.0, 2.0, 2.0),
        (79.0, -1.0, 12.0, 2.6),
        (82.0, 3.0, 27.0, 2.8),
        (87.0, 15.0, 34.0, 2.9),
        (92.0, 27.0, 28.0, 2.9),
        (93.0, 31.0, 14.0, 2.8),
        (90.0, 29.0, 0.0, 2.6),
        (86.0, 22.0, -14.0, 2.6),
        (82.0, 13.0, -23.0, 3.0),
    ]);
    let antihelix = tube(&[
        (83.0, 9.0, 24.0, 1.8),
        (87.0, 18.0, 16.0, 2.4),
        (87.5, 21.0, 4.0, 2.4),
        (84.5, 15.0, -10.0, 2.4),
        (81.0, 6.0, -14.0, 2.6),
    ]);
    let tragus = ellipsoid((73.5, -4.0, -2.0), (4.5, 6.0, 8.0));
    let lobule = ellipsoid((77.5, 8.0, -22.0), (3.2, 7.5, 8.0));
    let root = ellipsoid((72.0, 12.0, 2.0), (10.0, 9.0, 20.0));
    blend(5.0, [plate, helix, antihelix, tragus, lobule, root]).mirrored()
}

/// The bowl in front of the ear canal, and the canal.
pub(super) fn concha() -> Solid {
    let bowl = blend(4.0, [sphere((85.0, 8.0, -2.0), 7.0), sphere((85.0, 8.0, 8.0), 4.5)]);
    let canal = rod(&[(80.0, 3.0, -1.0, 3.8), (66.0, 1.0, 1.0, 3.2), (53.0, 0.0, 2.0, 3.4)]);
    blend(4.0, [bowl, canal]).mirrored()
}
