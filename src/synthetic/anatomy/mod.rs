//! The head, region by region.
//!
//! Coordinates are LPS mm with the origin between the ear canals and the plane z = 0 through the ear canals and the
//! lower rims of the orbits (the Frankfort plane): +x is the patient's left, the face looks to -y, the crown is at
//! z = 130. What exists twice is drawn on the left and mirrored.

mod airway;
mod brain;
mod ear;
mod eye;
mod face;
mod jaw;
mod muscle;
mod skull;
mod spine;
mod teeth;
mod vessels;

use super::scene::{Scene, Tissue};
use super::tissue::{FAT, SKIN};

/// All tissues, in the order in which they are painted.
pub(super) fn head(edge_mm: f32) -> Scene {
    let skin = face::skin();
    let mut tissues = vec![Tissue::new(SKIN, skin.clone()).core(2.0, FAT)];
    tissues.extend(muscle::tissues());
    tissues.extend(brain::tissues());
    tissues.extend(eye::tissues());
    tissues.extend(skull::tissues());
    tissues.extend(jaw::tissues());
    tissues.extend(spine::tissues());
    tissues.extend(airway::tissues());
    tissues.extend(teeth::tissues());
    tissues.extend(vessels::tissues());
    Scene { skin, tissues, edge_mm }
}
