//! Air: nose, sinuses, mouth, throat and windpipe.

use super::eye;
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, ellipsoid, rod, tube};
use crate::synthetic::tissue::{AIR, MUSCLE, Material, THIN_BONE};

/// Air spaces, then what stands in them.
pub(super) fn tissues() -> Vec<Tissue> {
    vec![
        Tissue::new(MUSCLE, nasal_mucosa()).beneath_skin(2.0),
        Tissue::new(AIR, nose()),
        Tissue::new(AIR, throat()),
        Tissue::new(AIR, mouth()),
        Tissue::new(MUSCLE, soft_palate()),
        Tissue::new(MUSCLE, conchae().mirrored()).core(1.8, Material::Uniform(300.0)),
        Tissue::new(MUSCLE, septum()).core(1.3, THIN_BONE),
        Tissue::new(Material::AirCells { cell_mm: 8.0 }, ethmoid()),
        Tissue::new(AIR, sinuses()),
    ]
}

fn nasal_mucosa() -> Solid {
    ellipsoid((0.0, -64.0, -8.0), (14.5, 40.0, 18.5))
}

fn nose() -> Solid {
    let meatus = ellipsoid((6.8, -64.0, -9.0), (5.8, 32.0, 14.5));
    let vestibule = tube(&[
        (8.0, -104.0, -29.0, 3.4),
        (7.0, -103.0, -22.0, 3.6),
        (6.0, -98.0, -14.0, 3.8),
        (6.0, -84.0, -9.0, 4.0),
    ]);
    let choana = tube(&[(6.5, -42.0, -12.0, 6.0), (4.0, -26.0, -12.0, 7.0)]);
    blend(4.0, [meatus, vestibule, choana]).mirrored()
}

fn throat() -> Solid {
    let pharynx = tube(&[
        (4.0, -23.0, -10.0, 7.0),
        (4.0, -18.0, -26.0, 6.0),
        (5.0, -18.0, -48.0, 5.5),
        (5.0, -19.0, -72.0, 6.0),
        (3.0, -22.0, -96.0, 5.0),
    ])
    .mirrored();
    let larynx = tube(&[
        (0.0, -22.0, -94.0, 6.0),
        (0.0, -27.0, -112.0, 4.5),
        (0.0, -23.0, -130.0, 7.5),
        (0.0, -18.0, -160.0, 8.5),
    ]);
    blend(4.0, [pharynx, larynx])
}

fn mouth() -> Solid {
    ellipsoid((0.0, -60.0, -32.5), (17.0, 24.0, 2.4))
}

fn soft_palate() -> Solid {
    tube(&[(0.0, -38.0, -27.0, 4.0), (0.0, -28.0, -32.0, 4.0), (0.0, -24.0, -44.0, 3.0)])
}

fn conchae() -> Solid {
    let inferior = tube(&[(8.5, -84.0, -17.0, 2.6), (8.0, -66.0, -18.0, 3.6), (7.5, -46.0, -17.0, 2.8)]);
    let middle = tube(&[(7.5, -76.0, -4.0, 2.4), (7.0, -60.0, -6.0, 3.0), (6.5, -46.0, -8.0, 2.2)]);
    blend(1.0, [inferior, middle])
}

/// Bowed to the patient's left, with a spur.
fn septum() -> Solid {
    let front =
        ellipsoid((0.0, 0.0, 0.0), (1.7, 24.0, 16.0)).placed((1.0, -80.0, -10.0), (1.0, 0.09, 0.0), (0.04, 0.0, 1.0));
    let back =
        ellipsoid((0.0, 0.0, 0.0), (1.7, 22.0, 16.0)).placed((1.2, -52.0, -8.0), (1.0, -0.07, 0.0), (0.04, 0.0, 1.0));
    let spur = rod(&[(2.0, -64.0, -13.0, 2.0), (5.0, -62.0, -12.0, 1.2)]);
    blend(6.0, [front, back, spur])
}

/// Cells between the orbits.
fn ethmoid() -> Solid {
    ellipsoid((7.5, -60.0, 15.0), (6.5, 21.0, 10.0)).mirrored().cut(0.5, eye::orbits().grown(1.6))
}

fn sinuses() -> Solid {
    let maxillary = ellipsoid((27.0, -63.0, -11.0), (12.0, 15.5, 13.0)).mirrored();
    let sphenoid =
        blend(2.0, [ellipsoid((5.0, -33.0, 9.0), (7.0, 11.0, 9.0)), ellipsoid((-6.0, -34.0, 8.0), (5.0, 10.0, 7.5))]);
    let frontal_left =
        blend(4.0, [ellipsoid((10.0, -83.5, 39.0), (9.0, 3.0, 9.0)), ellipsoid((19.0, -81.5, 41.0), (8.0, 2.6, 6.0))]);
    let frontal_right = ellipsoid((-9.0, -83.5, 37.5), (7.0, 2.8, 7.0));
    let middle_ear = ellipsoid((47.0, 0.0, 3.0), (4.0, 4.0, 5.0)).mirrored();
    blend(0.5, [maxillary, sphenoid, frontal_left, frontal_right, middle_ear])
}
