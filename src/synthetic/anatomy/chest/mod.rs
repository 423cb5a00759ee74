//! The chest in the arterial phase, region by region: arms raised, breath held.
//!
//! Coordinates are LPS mm: +x is the patient's left, the breast bone is at -y and the spine at +y. The plane z = 0 goes through
//! the eighth thoracic vertebra and the middle of the heart; the first is at z = 158, and the scan ends below the domes of the
//! diaphragm, in the liver. What exists twice is drawn on the left and mirrored; heart, great vessels, airways and the organs
//! below are as one-sided as they are.

mod abdomen;
mod airway;
mod cage;
mod coronary;
mod heart;
mod lung;
mod shoulder;
mod spine;
mod tree;
mod vessels;
mod wall;

use crate::synthetic::scene::{Scene, Tissue};
use crate::synthetic::tissue::{FAT, Material, SKIN};

/// Names of the structures of the chest, from number 1, in the order in which they are painted. The skin is all that is in no
/// other, the fat beneath it included; cartilage of ribs counts as ribs, and vessels in the lungs as lungs.
pub(in crate::synthetic) const STRUCTURES: [&str; 13] = [
    "skin",
    "muscle",
    "mediastinum",
    "abdomen",
    "liver",
    "lungs",
    "airways",
    "vessels",
    "heart",
    "spine",
    "ribs",
    "sternum",
    "shoulders",
];

/// Blood that came from the lungs, in the left heart and the aorta.
const ARTERIAL: Material = Material::Uniform(350.0);
/// Blood on its way to the lungs, in the right heart: the bolus and what follows it.
const MIXED: Material = Material::Uniform(270.0);
const PULMONARY: Material = Material::Uniform(300.0);
/// Blood of the body below, which the bolus has not reached again.
const VENOUS: Material = Material::Uniform(90.0);

/// All tissues, in the order in which they are painted.
pub(in crate::synthetic) fn chest(edge_mm: f32) -> Scene {
    let skin = wall::skin();
    let structures = [
        vec![Tissue::new(SKIN, skin.clone()).core(2.0, FAT)],
        wall::muscles(),
        lung::mediastinum(),
        abdomen::tissues(),
        abdomen::liver(),
        lung::tissues(),
        airway::tissues(),
        vessels::tissues(),
        heart::tissues(),
        spine::tissues(),
        cage::ribs(),
        cage::sternum(),
        shoulder::tissues(),
    ];
    Scene::of_structures(skin, structures, edge_mm)
}
