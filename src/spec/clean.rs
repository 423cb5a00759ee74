//! Steps that clean labels, as written.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A step that cleans the labels of one tissue. Parts are joined through the faces of voxels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum CleanSpec {
    /// Keeps the part with the most voxels.
    #[serde(rename = "largest-part")]
    LargestPart,
    /// Keeps parts of at least this volume, ml.
    #[serde(rename = "smallest_part_ml")]
    SmallestPartMl(f64),
    /// Takes in what the tissue encloses on all sides.
    #[serde(rename = "fill-holes")]
    FillHoles,
    /// Leaves out what lies outside the body, such as the table.
    #[serde(rename = "body")]
    Body,
    /// Closes gaps: grows by a ball of this radius, mm, and shrinks by it.
    #[serde(rename = "closing_mm")]
    ClosingMm(f64),
    /// Gives each voxel to the majority of the box that reaches this far from it, mm.
    #[serde(rename = "majority_mm")]
    MajorityMm(f64),
}
