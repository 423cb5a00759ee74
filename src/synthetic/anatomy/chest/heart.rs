//! The heart: muscle, four chambers filled with contrast medium, and the fat around it.
//!
//! Its axis runs from behind on the right to the front, down and to the patient's left, where the apex is. The right ventricle
//! lies in front, wrapped around the left one; the left atrium lies behind, before the oesophagus.

use glam::Vec3;

use super::{ARTERIAL, MIXED, coronary};
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, common, ellipsoid, half_space, rod, tube};
use crate::synthetic::tissue::{FAT, Material};

const MYOCARDIUM: Material = Material::Uniform(115.0);

/// From the valves to the apex.
const AXIS: Vec3 = Vec3::new(0.62, -0.60, -0.50);
/// The middle of the left ventricle.
const CENTER_MM: Vec3 = Vec3::new(37.0, -28.0, -2.0);
/// Where its cavity ends: the plane of the mitral valve is so far from the middle.
const BASE_MM: f32 = 29.0;
const LEFT_WALL_MM: f32 = 10.0;
const RIGHT_WALL_MM: f32 = 3.6;
const ATRIAL_WALL_MM: f32 = 2.4;

/// A solid drawn along z, put along the axis of the heart, its x to the patient's left.
fn along_axis(solid: Solid) -> Solid {
    solid.placed(CENTER_MM, Vec3::X, AXIS)
}

fn left_ventricle() -> Solid {
    let base = half_space(CENTER_MM - BASE_MM * AXIS, -AXIS);
    common(6.0, [along_axis(ellipsoid((0.0, 0.0, 0.0), (32.0, 32.0, 52.0))), base])
}

/// A wedge in front of the left ventricle: from the tricuspid valve along the diaphragm almost to the apex, and up to the
/// pulmonary trunk.
fn right_ventricle() -> Solid {
    let floor = tube(&[
        (-12.0, -42.0, -10.0, 24.0),
        (16.0, -55.0, -21.0, 21.0),
        (36.0, -62.0, -30.0, 15.0),
        (52.0, -64.0, -36.0, 9.0),
    ]);
    let outlet = tube(&[
        (4.0, -54.0, -6.0, 22.0),
        (11.0, -60.0, 10.0, 19.0),
        (15.0, -61.0, 24.0, 16.0),
        (16.0, -59.0, 36.0, 15.0),
    ]);
    blend(26.0, [floor, outlet])
}

/// With the openings of the caval veins, and an appendage before the aorta.
fn right_atrium() -> Solid {
    let body = ellipsoid((-38.0, -24.0, 6.0), (23.0, 26.0, 32.0));
    let appendage = ellipsoid((-22.0, -48.0, 30.0), (15.0, 11.0, 14.0));
    blend(12.0, [body, appendage])
}

/// With an appendage beside the pulmonary trunk.
fn left_atrium() -> Solid {
    let body = ellipsoid((2.0, 10.0, 26.0), (34.0, 18.0, 22.0));
    let appendage = tube(&[(28.0, 2.0, 34.0, 9.0), (40.0, -16.0, 40.0, 8.0), (42.0, -34.0, 38.0, 5.0)]);
    blend(8.0, [body, appendage])
}

/// All of it, without fat.
pub(super) fn surface() -> Solid {
    blend(5.0, [left_ventricle(), right_ventricle(), right_atrium(), left_atrium()])
}

/// The sac around it.
pub(super) fn pericardium() -> Solid {
    blend(22.0, [left_ventricle(), right_ventricle(), right_atrium(), left_atrium()]).grown(4.0)
}

pub(super) fn tissues() -> Vec<Tissue> {
    let mitral = rod(&[(24.0, -16.0, 9.0, 13.0), (10.0, 4.0, 22.0, 13.0)]);
    let aortic = tube(&[(24.0, -20.0, 8.0, 11.0), (12.0, -22.0, 20.0, 11.5), (-1.0, -26.0, 33.0, 13.0)]);
    let tricuspid = rod(&[(-10.0, -42.0, -8.0, 15.0), (-34.0, -28.0, 2.0, 15.0)]);
    let caval = tube(&[(-36.0, -20.0, 40.0, 10.0), (-37.0, -22.0, 10.0, 12.0), (-35.0, -14.0, -18.0, 11.0)]);
    let outflow = tube(&[(15.0, -60.0, 24.0, 12.0), (17.0, -57.0, 40.0, 13.5)]);
    let left_cavity = along_axis(ellipsoid((0.0, 0.0, -2.0), (32.0 - LEFT_WALL_MM, 32.0 - LEFT_WALL_MM, 42.0)));
    let mut tissues = vec![
        Tissue::new(FAT, surface().grown(2.0)),
        Tissue::new(MYOCARDIUM, right_atrium()),
        Tissue::new(MYOCARDIUM, left_atrium()),
        Tissue::new(MYOCARDIUM, right_ventricle()),
        Tissue::new(MIXED, right_atrium().grown(-ATRIAL_WALL_MM)),
        Tissue::new(MIXED, right_ventricle().grown(-RIGHT_WALL_MM)),
        Tissue::new(MIXED, blend(3.0, [tricuspid, caval, outflow])),
        Tissue::new(ARTERIAL, left_atrium().grown(-ATRIAL_WALL_MM)),
        Tissue::new(MYOCARDIUM, left_ventricle()),
        Tissue::new(MYOCARDIUM, septum_of_atria()),
        Tissue::new(ARTERIAL, left_cavity),
        Tissue::new(ARTERIAL, blend(3.0, [mitral, aortic])),
        Tissue::new(MYOCARDIUM, papillary_muscles()),
    ];
    tissues.extend(coronary::tissues());
    tissues
}

/// Where right and left atrium touch.
fn septum_of_atria() -> Solid {
    ellipsoid((0.0, 0.0, 0.0), (1.6, 13.0, 15.0)).placed((-21.0, -6.0, 20.0), (0.75, 0.6, 0.1), (0.0, 0.0, 1.0))
}

/// Two columns from the wall towards the mitral valve.
fn papillary_muscles() -> Solid {
    let column = |x: f32, y: f32| rod(&[(x, y, 20.0, 4.6), (0.72 * x, 0.72 * y, -4.0, 2.8)]);
    along_axis(blend(1.0, [column(14.0, 11.0), column(13.0, -12.0)]))
}
