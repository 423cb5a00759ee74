//! Orbits and eyes.

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, common, ellipsoid, half_space, sphere, tube};
use crate::synthetic::tissue::{FAT, GREY, LENS, MUSCLE, SKIN, VITREOUS};

const GLOBE: (f32, f32, f32) = (31.5, -71.5, 15.0);

/// The bony sockets: cones whose inner walls are parallel.
pub(super) fn orbits() -> Solid {
    tube(&[(34.0, -90.0, 17.0, 18.5), (30.0, -74.0, 16.0, 17.5), (23.0, -57.0, 15.0, 11.5), (13.0, -36.0, 14.0, 3.4)])
        .mirrored()
}

/// Orbital fat, muscles, nerve, globe and lens.
pub(super) fn tissues() -> Vec<Tissue> {
    let fat = common(1.0, [orbits(), half_space((0.0, -72.0, 0.0), (0.0, -1.0, 0.0))]);
    let nerve =
        tube(&[(30.0, -60.0, 15.0, 2.4), (24.0, -50.0, 14.0, 2.4), (13.0, -36.0, 15.0, 2.2), (4.0, -26.0, 24.0, 2.4)]);
    let recti = [
        tube(&[(14.0, -38.0, 14.0, 1.4), (18.0, -58.0, 15.0, 2.2), (20.5, -73.0, 15.0, 1.2)]),
        tube(&[(15.0, -38.0, 14.0, 1.4), (36.0, -58.0, 15.0, 2.2), (43.0, -72.0, 15.0, 1.2)]),
        tube(&[(14.0, -38.0, 15.0, 1.4), (28.0, -58.0, 25.0, 2.2), (31.5, -74.0, 26.8, 1.2)]),
        tube(&[(14.0, -38.0, 13.0, 1.4), (28.0, -58.0, 5.0, 2.2), (31.5, -73.0, 3.4, 1.2)]),
    ];
    let mut tissues = vec![Tissue::new(FAT, fat).beneath_skin(2.0), Tissue::new(GREY, nerve.mirrored())];
    tissues.extend(recti.into_iter().map(|r| Tissue::new(MUSCLE, r.mirrored())));
    tissues.push(Tissue::new(SKIN, sphere(GLOBE, 12.0).mirrored()).core(1.2, VITREOUS));
    tissues.push(Tissue::new(LENS, ellipsoid((31.5, -79.6, 15.0), (4.6, 2.1, 4.6)).mirrored()));
    tissues
}
