//! The surface of the skin, and the muscles of the wall.

use super::cage;
use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, ellipsoid, tube};
use crate::synthetic::tissue::MUSCLE;

/// The whole surface; cut off above and below by the ends of the scan.
pub(super) fn skin() -> Solid {
    let trunk = ellipsoid((0.0, 2.0, -40.0), (168.0, 119.0, 430.0));
    let chest = ellipsoid((62.0, -84.0, 52.0), (64.0, 42.0, 62.0)).mirrored();
    let blade = ellipsoid((92.0, 78.0, 70.0), (58.0, 42.0, 90.0)).mirrored();
    let shoulder = ellipsoid((118.0, 12.0, 182.0), (58.0, 62.0, 70.0)).mirrored();
    let furrow = tube(&[(0.0, 128.0, -160.0, 6.0), (0.0, 131.0, 0.0, 7.0), (0.0, 128.0, 200.0, 5.0)]);
    blend(40.0, [trunk, chest, blade, shoulder]).cut(18.0, furrow)
}

/// In the order of painting; bone and what the chest holds come later and cover what reaches into them.
pub(super) fn muscles() -> Vec<Tissue> {
    let wall = ellipsoid((0.0, 4.0, -50.0), (143.0, 103.0, 330.0));
    let neck = ellipsoid((0.0, 24.0, 190.0), (72.0, 56.0, 60.0));
    [
        (wall, 12.0),
        (cage::shell(4.0), 9.0),
        (neck, 10.0),
        (pectoral().mirrored(), 8.0),
        (shoulder().mirrored(), 8.0),
        (latissimus().mirrored(), 9.0),
        (trapezius().mirrored(), 8.0),
        (erector().mirrored(), 10.0),
    ]
    .into_iter()
    .map(|(solid, depth_mm)| Tissue::new(MUSCLE, solid).beneath_skin(depth_mm))
    .collect()
}

/// From the breast bone and the clavicle to the arm.
fn pectoral() -> Solid {
    blend(
        12.0,
        [ellipsoid((60.0, -84.0, 58.0), (56.0, 22.0, 46.0)), ellipsoid((98.0, -50.0, 100.0), (40.0, 30.0, 38.0))],
    )
}

fn shoulder() -> Solid {
    ellipsoid((116.0, 14.0, 176.0), (48.0, 46.0, 54.0))
}

/// With the muscles on and beneath the shoulder blade.
fn latissimus() -> Solid {
    blend(
        14.0,
        [ellipsoid((98.0, 66.0, 78.0), (44.0, 28.0, 72.0)), ellipsoid((112.0, 44.0, -20.0), (30.0, 48.0, 90.0))],
    )
}

fn trapezius() -> Solid {
    ellipsoid((36.0, 98.0, 90.0), (50.0, 13.0, 100.0))
}

/// Beside the spinous processes.
fn erector() -> Solid {
    tube(&[(27.0, 82.0, -160.0, 22.0), (26.0, 92.0, -40.0, 19.0), (25.0, 90.0, 60.0, 16.0), (24.0, 66.0, 190.0, 16.0)])
}
