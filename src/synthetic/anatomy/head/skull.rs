//! The skull without the lower jaw.

use super::eye;
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, common, ellipsoid, half_space, rod, sphere, tube};
use crate::synthetic::tissue::{CORTICAL, DIPLOE, Material, SUTURE, THIN_BONE};

/// Thickness of the vault, mm.
const VAULT_MM: f32 = 6.0;

/// Bones in the order of painting.
pub(super) fn tissues() -> Vec<Tissue> {
    let openings = blend(3.0, [eye::orbits(), nasal_aperture(), foramen_magnum()]);
    let bone = blend(8.0, [braincase().grown(VAULT_MM), base(), face()])
        .cut(2.0, cavity())
        .cut(3.0, openings)
        .cut(2.0, burr_hole());
    vec![
        Tissue::new(CORTICAL, bone).core(1.9, DIPLOE).beneath_skin(2.6),
        Tissue::new(SUTURE, sutures()),
        Tissue::new(THIN_BONE, hard_palate()),
        Tissue::new(Material::AirCells { cell_mm: 5.0 }, mastoid_cells()),
    ]
}

/// Inner surface of the braincase before the base is built into it.
fn braincase() -> Solid {
    blend(
        26.0,
        [
            ellipsoid((0.0, 7.0, 58.0), (63.0, 76.0, 61.0)),
            ellipsoid((0.0, -35.0, 54.0), (47.0, 47.0, 46.0)),
            ellipsoid((0.0, 42.0, 37.0), (52.0, 41.0, 41.0)),
            ellipsoid((0.0, 36.0, 6.0), (46.0, 36.0, 28.0)),
            ellipsoid((36.0, -14.0, 18.0), (21.0, 32.0, 23.0)).mirrored(),
        ],
    )
}

/// The room for the brain.
pub(super) fn cavity() -> Solid {
    let orbital_roofs = eye::orbits().grown(3.0);
    let midline = tube(&[
        (0.0, -78.0, 25.0, 9.0),
        (0.0, -55.0, 18.0, 12.0),
        (0.0, -32.0, 9.0, 12.0),
        (0.0, -12.0, 6.0, 10.0),
        (0.0, -2.0, -10.0, 8.0),
        (0.0, 3.0, -24.0, 6.0),
    ]);
    let petrous = tube(&[(14.0, -8.0, 0.0, 6.0), (34.0, 6.0, 1.0, 8.5), (60.0, 12.0, 0.0, 12.0)]).mirrored();
    braincase().cut(6.0, blend(6.0, [orbital_roofs, midline, petrous]))
}

/// Floor of the braincase and what hangs from it.
fn base() -> Solid {
    let clivus =
        tube(&[(0.0, -58.0, 14.0, 12.0), (0.0, -32.0, 9.0, 12.0), (0.0, -12.0, 4.0, 10.0), (0.0, 2.0, -22.0, 6.0)]);
    let petrous = tube(&[(14.0, -8.0, 0.0, 6.0), (34.0, 6.0, 0.0, 9.0), (60.0, 12.0, -2.0, 12.0)]);
    let mastoid = rod(&[(58.0, 16.0, -4.0, 11.0), (54.0, 14.0, -24.0, 6.0)]);
    let condyle = ellipsoid((18.0, 9.0, -27.0), (6.0, 9.0, 5.0));
    let styloid = rod(&[(46.0, 4.0, -14.0, 2.2), (40.0, -6.0, -42.0, 1.4)]);
    let pterygoid = rod(&[(14.0, -34.0, 0.0, 4.0), (15.0, -34.0, -26.0, 2.0)]);
    let inion = ellipsoid((0.0, 84.0, 6.0), (8.0, 6.0, 6.0));
    blend(5.0, [clivus, blend(5.0, [petrous, mastoid, condyle, styloid, pterygoid]).mirrored(), inion])
}

/// Forehead above the orbits, cheek bones, upper jaw, nasal bones.
fn face() -> Solid {
    let forehead = ellipsoid((0.0, -64.0, 40.0), (46.0, 26.0, 16.0));
    let brow =
        tube(&[(4.0, -87.0, 35.0, 5.0), (22.0, -87.5, 37.0, 4.5), (40.0, -79.0, 33.0, 4.5), (49.0, -69.0, 22.0, 4.5)]);
    let lateral_rim = tube(&[(49.0, -69.0, 24.0, 4.5), (50.5, -67.0, 10.0, 4.2), (48.0, -68.0, -2.0, 6.0)]);
    let lower_rim =
        tube(&[(48.0, -70.0, -2.0, 4.0), (34.0, -79.0, -5.0, 3.8), (20.0, -84.0, 0.0, 3.6), (13.0, -86.0, 14.0, 3.6)]);
    let zygoma = ellipsoid((44.0, -64.0, -9.0), (10.0, 12.0, 9.0));
    let arch = tube(&[
        (50.0, -60.0, -9.0, 5.0),
        (58.0, -46.0, -8.5, 3.8),
        (63.0, -28.0, -7.0, 3.4),
        (63.5, -12.0, -4.0, 3.8),
        (60.0, 2.0, 2.0, 5.0),
    ]);
    let maxilla = ellipsoid((22.0, -64.0, -14.0), (19.0, 21.0, 18.0));
    let pillar =
        tube(&[(8.0, -87.0, 22.0, 4.0), (13.5, -86.0, 4.0, 4.5), (16.5, -85.0, -14.0, 4.5), (17.0, -84.0, -30.0, 5.0)]);
    let alveolar = tube(&[
        (0.0, -88.5, -32.0, 5.5),
        (14.0, -85.5, -32.0, 5.5),
        (24.0, -72.0, -32.0, 6.5),
        (29.0, -56.0, -31.0, 7.0),
        (30.0, -44.0, -29.0, 7.0),
    ]);
    let nasal_bone = tube(&[(2.5, -87.0, 32.0, 5.0), (3.0, -90.0, 20.0, 4.0), (3.0, -97.0, 6.0, 2.8)]);
    let greater_wing = ellipsoid((42.0, -56.0, 12.0), (7.0, 17.0, 20.0));
    let rims = blend(6.0, [brow, lateral_rim, lower_rim, nasal_bone, pillar]);
    let cheek = blend(10.0, [zygoma, arch, maxilla, alveolar, greater_wing]);
    let spine = rod(&[(0.0, -88.0, -27.0, 3.5), (0.0, -94.0, -26.0, 1.4)]);
    blend(5.0, [forehead, blend(6.0, [rims, cheek]).mirrored(), spine])
}

/// The pear-shaped opening, and the nasal cavity behind it.
fn nasal_aperture() -> Solid {
    let pear = tube(&[(0.0, -97.0, 1.0, 4.5), (0.0, -97.0, -10.0, 8.5), (0.0, -97.0, -16.0, 9.5)]);
    let wings = sphere((5.5, -94.0, -17.5), 6.5).mirrored();
    let depth = ellipsoid((0.0, -64.0, -8.0), (13.0, 38.0, 16.5));
    blend(4.0, [pear, wings, depth])
}

fn foramen_magnum() -> Solid {
    rod(&[(0.0, 21.0, -10.0, 14.0), (0.0, 22.0, -50.0, 14.0)])
}

fn hard_palate() -> Solid {
    common(1.0, [ellipsoid((0.0, -62.0, -27.0), (24.0, 28.0, 3.2)), half_space((0.0, -36.0, 0.0), (0.0, 1.0, 0.0))])
}

fn mastoid_cells() -> Solid {
    rod(&[(55.0, 16.0, -3.0, 7.0), (54.0, 14.0, -20.0, 3.4)]).mirrored()
}

/// The seams between frontal, parietal and occipital bones, in the outer table.
fn sutures() -> Solid {
    let seam = |point: (f32, f32, f32), normal: (f32, f32, f32)| {
        let (x, y, z) = normal;
        let back = half_space(point, (-x, -y, -z)).grown(0.55);
        common(0.1, [half_space(point, normal).grown(0.55), back]).rippled(1.3, 3.2)
    };
    let outer_table = |solid: Solid| {
        let vault = common(0.1, [braincase().grown(VAULT_MM), half_space((0.0, 0.0, 32.0), (0.0, 0.0, -1.0))]);
        common(0.1, [solid, vault.cut(0.1, braincase().grown(VAULT_MM - 2.2))])
    };
    let coronal = seam((0.0, -10.0, 124.0), (0.0, 0.94, -0.34));
    let between = [half_space((0.0, -10.0, 124.0), (0.0, -0.94, 0.34)), half_space((0.0, 76.0, 90.0), (0.0, 1.0, 0.0))];
    let sagittal = common(0.1, between.into_iter().chain([seam((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))]));
    let lambdoid =
        common(0.1, [seam((0.0, 76.0, 90.0), (0.62, 0.66, -0.42)), half_space((0.0, 50.0, 0.0), (0.0, -1.0, 0.0))]);
    outer_table(blend(0.1, [coronal, sagittal, lambdoid.mirrored()]))
}

/// A trephination on the patient's right, under the healed skin.
fn burr_hole() -> Solid {
    rod(&[(-30.0, -40.0, 80.0, 6.0), (-50.0, -62.0, 125.0, 6.0)])
}
