//! Muscles, glands and the deep soft tissue of face and neck.

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, ellipsoid, tube};
use crate::synthetic::tissue::{CARTILAGE, GLAND, MUSCLE, THYROID};

/// Soft tissue in the order of painting; bone comes later and covers what reaches into it.
pub(super) fn tissues() -> Vec<Tissue> {
    let mut tissues: Vec<Tissue> = [
        (deep_face(), 9.0),
        (neck_core(), 5.0),
        (temporalis().mirrored(), 3.4),
        (masseter().mirrored(), 3.4),
        (sternomastoid().mirrored(), 3.6),
        (nuchal().mirrored(), 6.0),
        (lips(), 1.6),
        (tongue(), 4.0),
    ]
    .into_iter()
    .map(|(solid, depth_mm)| Tissue::new(MUSCLE, solid).beneath_skin(depth_mm))
    .collect();
    let parotid = ellipsoid((59.0, 0.0, -36.0), (9.0, 13.0, 22.0)).mirrored();
    let submandibular = ellipsoid((33.0, -44.0, -82.0), (9.0, 14.0, 8.0)).mirrored();
    let thyroid = ellipsoid((17.0, -28.0, -136.0), (7.0, 8.0, 17.0)).mirrored();
    let thyroid_cartilage =
        tube(&[(0.0, -42.0, -112.0, 2.4), (10.0, -34.0, -112.0, 3.0), (19.0, -18.0, -112.0, 2.4)]).mirrored();
    let cricoid = tube(&[
        (0.0, -34.0, -130.0, 3.0),
        (11.0, -28.0, -129.0, 3.0),
        (9.0, -14.0, -126.0, 4.0),
        (0.0, -11.0, -126.0, 4.5),
    ])
    .mirrored();
    tissues.push(Tissue::new(GLAND, parotid).beneath_skin(4.0));
    tissues.push(Tissue::new(GLAND, submandibular).beneath_skin(4.0));
    tissues.push(Tissue::new(THYROID, thyroid).beneath_skin(5.0));
    tissues.push(Tissue::new(CARTILAGE, thyroid_cartilage).beneath_skin(3.0));
    tissues.push(Tissue::new(CARTILAGE, cricoid).beneath_skin(3.0));
    tissues
}

fn deep_face() -> Solid {
    let pterygoids = tube(&[(18.0, -38.0, -6.0, 9.0), (36.0, -26.0, -22.0, 9.0), (43.0, -20.0, -50.0, 7.0)]).mirrored();
    let pharynx = tube(&[(0.0, -24.0, -6.0, 15.0), (0.0, -20.0, -50.0, 16.0), (0.0, -22.0, -95.0, 17.0)]);
    let floor_of_mouth = ellipsoid((0.0, -58.0, -70.0), (26.0, 30.0, 10.0));
    let buccinator =
        tube(&[(30.0, -82.0, -46.0, 4.0), (37.0, -62.0, -46.0, 4.0), (40.0, -46.0, -46.0, 4.0)]).mirrored();
    let mimic = ellipsoid((0.0, -80.0, -50.0), (26.0, 18.0, 34.0));
    blend(6.0, [pterygoids, pharynx, floor_of_mouth, buccinator, mimic])
}

fn neck_core() -> Solid {
    tube(&[(0.0, 6.0, -30.0, 24.0), (0.0, 6.0, -80.0, 30.0), (0.0, 8.0, -160.0, 34.0)])
}

fn temporalis() -> Solid {
    let fan = ellipsoid((64.0, -24.0, 40.0), (14.0, 46.0, 48.0));
    let tendon = tube(&[(58.0, -36.0, 20.0, 10.0), (52.0, -38.0, -14.0, 6.0)]);
    blend(10.0, [fan, tendon])
}

fn masseter() -> Solid {
    let superficial = tube(&[(59.0, -46.0, -12.0, 6.0), (59.0, -34.0, -34.0, 9.0), (55.0, -24.0, -60.0, 7.0)]);
    let deep = tube(&[(60.0, -30.0, -10.0, 5.0), (57.0, -24.0, -34.0, 6.0), (54.0, -18.0, -56.0, 5.0)]);
    blend(6.0, [superficial, deep])
}

fn sternomastoid() -> Solid {
    tube(&[(58.0, 17.0, -20.0, 7.0), (48.0, -6.0, -78.0, 9.0), (24.0, -30.0, -150.0, 8.0)])
}

fn nuchal() -> Solid {
    blend(6.0, [ellipsoid((17.0, 42.0, -80.0), (18.0, 20.0, 80.0)), ellipsoid((38.0, 30.0, -80.0), (13.0, 18.0, 70.0))])
}

fn lips() -> Solid {
    tube(&[
        (0.0, -97.0, -41.0, 5.0),
        (14.0, -93.0, -43.0, 5.0),
        (25.0, -86.0, -45.5, 4.0),
        (13.0, -92.0, -50.0, 5.0),
        (0.0, -95.0, -52.0, 5.0),
    ])
    .mirrored()
}

fn tongue() -> Solid {
    blend(8.0, [ellipsoid((0.0, -60.0, -48.0), (21.0, 26.0, 14.0)), ellipsoid((0.0, -42.0, -60.0), (18.0, 18.0, 22.0))])
}
