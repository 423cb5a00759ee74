//! The surface of the skin: head, face and neck.

use super::ear;
use crate::synthetic::sdf::{Solid, blend, ellipsoid, rod, sphere, tube};

/// The whole surface.
pub(super) fn skin() -> Solid {
    let head = blend(26.0, [cranium(), cheeks_and_jaw(), neck()]);
    let modelled = blend(14.0, [head, brow(), chin()]).cut(10.0, eye_hollows());
    let with_muzzle = blend(14.0, [modelled, muzzle()]);
    let with_eyes = blend(4.0, [with_muzzle, eyelids()]).cut(1.6, palpebral_fissures());
    let with_nose = blend(9.0, [with_eyes, nose()]).cut(2.0, nostrils()).cut(5.0, nasolabial_folds());
    let with_lips = blend(3.5, [with_nose, lips()]).cut(2.5, mouth_line());
    blend(6.0, [with_lips, ear::auricles()]).cut(4.0, ear::concha())
}

fn cranium() -> Solid {
    blend(
        30.0,
        [
            ellipsoid((0.0, 8.0, 54.0), (74.0, 87.0, 76.0)),
            ellipsoid((0.0, -36.0, 54.0), (58.0, 58.0, 56.0)),
            ellipsoid((0.0, 44.0, 38.0), (64.0, 50.0, 50.0)),
            ellipsoid((0.0, 0.0, 20.0), (72.0, 76.0, 44.0)),
        ],
    )
}

fn cheeks_and_jaw() -> Solid {
    let upper_face = ellipsoid((0.0, -38.0, -4.0), (60.0, 51.0, 48.0));
    let lower_face = ellipsoid((0.0, -44.0, -46.0), (46.0, 48.0, 42.0));
    let zygoma = ellipsoid((42.0, -60.0, -6.0), (17.0, 21.0, 14.0));
    let arch = tube(&[(50.0, -56.0, -6.0, 10.0), (58.0, -34.0, -6.0, 11.0), (60.0, -8.0, -4.0, 12.0)]);
    let cheek = ellipsoid((31.0, -62.0, -36.0), (22.0, 23.0, 28.0));
    let masseter = ellipsoid((47.0, -29.0, -38.0), (17.0, 24.0, 34.0));
    let jaw = tube(&[
        (0.0, -80.0, -77.0, 12.0),
        (22.0, -74.0, -75.0, 12.0),
        (39.0, -48.0, -70.0, 13.0),
        (49.0, -16.0, -60.0, 13.0),
        (56.0, -4.0, -24.0, 14.0),
    ]);
    let side = blend(20.0, [zygoma, arch, cheek, masseter, jaw]).mirrored();
    blend(20.0, [upper_face, lower_face, side])
}

fn neck() -> Solid {
    let column = rod(&[(6.0, 10.0, -30.0, 48.0), (7.0, 18.0, -180.0, 53.0)]).mirrored();
    let larynx = ellipsoid((0.0, -27.0, -116.0), (14.0, 16.0, 22.0));
    let sternomastoid = tube(&[(57.0, 17.0, -20.0, 8.0), (47.0, -6.0, -78.0, 11.0), (24.0, -28.0, -150.0, 10.0)]);
    let trapezius = ellipsoid((20.0, 36.0, -100.0), (36.0, 28.0, 70.0));
    blend(14.0, [column, larynx, blend(10.0, [sternomastoid, trapezius]).mirrored()])
}

fn brow() -> Solid {
    tube(&[
        (4.0, -88.0, 35.0, 6.0),
        (22.0, -88.0, 37.0, 6.5),
        (38.0, -79.5, 35.0, 6.0),
        (50.0, -65.0, 24.0, 4.5),
        (55.0, -52.0, 10.0, 3.0),
    ])
    .mirrored()
}

fn eye_hollows() -> Solid {
    ellipsoid((30.0, -98.0, 15.0), (15.0, 15.0, 11.0)).mirrored()
}

fn chin() -> Solid {
    let ball = ellipsoid((0.0, -84.0, -78.0), (14.0, 12.0, 11.0));
    let sides = ellipsoid((9.0, -83.0, -80.0), (11.0, 11.0, 9.0)).mirrored();
    blend(8.0, [ball, sides])
}

/// The convexity of the teeth under the lips.
fn muzzle() -> Solid {
    ellipsoid((0.0, -79.0, -42.0), (28.0, 23.0, 22.0))
}

/// Closed lids over the eyeballs, with the fold of the upper lid.
fn eyelids() -> Solid {
    let globe = sphere((31.5, -71.5, 15.0), 13.8);
    let upper_fold = tube(&[(17.0, -81.0, 18.0, 2.0), (31.0, -83.0, 24.0, 3.0), (46.0, -74.0, 19.0, 2.0)]);
    let lower_fold = tube(&[(19.0, -82.0, 8.0, 1.6), (32.0, -82.0, 2.5, 2.2), (45.0, -75.0, 8.0, 1.6)]);
    blend(5.0, [globe, upper_fold, lower_fold]).mirrored()
}

fn palpebral_fissures() -> Solid {
    tube(&[
        (18.0, -82.6, 12.5, 0.9),
        (25.0, -84.2, 10.8, 1.0),
        (32.0, -85.0, 10.0, 1.0),
        (40.0, -82.2, 10.8, 1.0),
        (45.0, -77.6, 12.4, 0.8),
    ])
    .mirrored()
}

fn nose() -> Solid {
    let dorsum =
        tube(&[(0.0, -87.0, 30.0, 6.5), (0.0, -92.0, 17.0, 6.0), (0.0, -100.0, 3.0, 6.5), (0.0, -108.0, -13.0, 7.6)]);
    let side_wall = tube(&[(5.0, -86.0, 16.0, 6.0), (7.5, -92.5, -1.0, 6.5), (7.0, -101.0, -15.0, 6.5)]);
    let ala = ellipsoid((10.5, -100.0, -18.0), (6.0, 8.0, 6.6));
    let columella = tube(&[(0.0, -109.0, -20.0, 4.0), (0.0, -103.0, -24.0, 3.6), (0.0, -97.0, -26.0, 4.5)]);
    blend(10.0, [dorsum, blend(8.0, [side_wall, ala]).mirrored(), columella])
}

fn nostrils() -> Solid {
    tube(&[(8.0, -104.0, -29.0, 3.4), (7.0, -103.5, -22.0, 3.6), (6.0, -100.0, -14.0, 3.8)]).mirrored()
}

fn nasolabial_folds() -> Solid {
    tube(&[(17.5, -93.5, -18.0, 0.8), (24.0, -92.3, -30.0, 1.0), (28.5, -89.5, -40.0, 0.6)]).mirrored()
}

fn lips() -> Solid {
    let upper = tube(&[
        (0.0, -100.5, -40.5, 3.8),
        (6.5, -101.0, -39.5, 4.2),
        (15.0, -97.2, -42.0, 3.4),
        (23.0, -91.0, -45.0, 2.0),
    ]);
    let lower = tube(&[(0.0, -98.4, -50.3, 5.0), (10.0, -96.9, -49.8, 4.4), (22.0, -91.0, -45.8, 2.0)]);
    blend(2.0, [upper, lower]).mirrored()
}

fn mouth_line() -> Solid {
    let between_lips = tube(&[(0.0, -104.6, -45.2, 1.2), (12.0, -101.0, -44.8, 1.1), (23.5, -92.5, -45.6, 0.7)]);
    let philtrum = rod(&[(0.0, -105.6, -28.0, 2.2), (0.0, -106.5, -36.5, 2.2)]);
    blend(1.0, [between_lips.mirrored(), philtrum])
}
