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

use crate::synthetic::scene::{Scene, Tissue};
use crate::synthetic::tissue::{FAT, SKIN};

/// Names of the structures of the head, from number 1, in the order in which they are painted. The skin is all that is
/// in no other, the fat beneath it included; glands and cartilage count as muscle, air and membranes as airways.
pub(in crate::synthetic) const STRUCTURES: [&str; 10] =
    ["skin", "muscle", "brain", "eyes", "skull", "jaw", "spine", "airways", "teeth", "vessels"];

/// All tissues, in the order in which they are painted.
pub(in crate::synthetic) fn head(edge_mm: f32) -> Scene {
    let skin = face::skin();
    let structures = [
        vec![Tissue::new(SKIN, skin.clone()).core(2.0, FAT)],
        muscle::tissues(),
        brain::tissues(),
        eye::tissues(),
        skull::tissues(),
        jaw::tissues(),
        spine::tissues(),
        airway::tissues(),
        teeth::tissues(),
        vessels::tissues(),
    ];
    Scene::of_structures(skin, structures, edge_mm)
}
