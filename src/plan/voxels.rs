//! The stages of media that are given at the voxels: RGBA volumes, and transfer functions evaluated there.

use crate::scene::{ClassifyAt, Model, Scene};
use crate::volume::{ColorEncoding, RgbaEncoding};

use super::stages::{Stage, marched_block_count};
use super::{Plan, VolumeInfo};

/// True if emission and extinction are given at the voxels.
pub(super) fn are_given(plan: &Plan) -> bool {
    plan.scene.model == Model::Light && (plan.colors.is_some() || plan.scene.effects.classify == ClassifyAt::Voxels)
}

/// What is computed before the first ray of such a medium.
pub(super) fn stages(plan: &Plan, volume: &VolumeInfo, classify: impl Fn() -> Stage) -> Vec<Stage> {
    let mut stages = Vec::new();
    let mut add = |name, what: String, bytes| stages.push(Stage { name, what, bytes });
    match plan.colors {
        Some(encoding) => add("classify", describe(encoding), table_bytes(volume)),
        None => {
            if plan.demand.gradient || plan.demand.gradient_magnitude {
                add("field", "gradient at the voxels that show, by central differences, not stored".to_owned(), 0);
            }
            let Stage { name, what, .. } = classify();
            let lit = if plan.demand.gradient { ", shaded" } else { "" };
            let bytes = 16 * volume.grid.voxel_count() as u64;
            add(name, format!("{what}, evaluated at the voxels{lit}, f32"), bytes);
        }
    }
    if plan.demand.macrocells {
        add(
            "field",
            "macrocells: blocks of 8 x 8 x 8 cells with a voxel that shows".to_owned(),
            marched_block_count(&volume.grid),
        );
    }
    stages
}

fn describe(RgbaEncoding { opacity_length_mm, color }: RgbaEncoding) -> String {
    let colors = match color {
        ColorEncoding::Srgb => "sRGB",
        ColorEncoding::Linear => "linear",
    };
    format!("the volume's own colours ({colors}), alpha is the opacity of {opacity_length_mm:.4} mm")
}

/// Two tables over all values of a component, in f64.
fn table_bytes(volume: &VolumeInfo) -> u64 {
    2 * 8 * (1 << (8 * volume.storage.bytes() / 4))
}

/// Name of the kernel less its method.
pub(super) fn kernel(scene: &Scene, volume: &VolumeInfo) -> String {
    if volume.storage.rgba_encoding().is_some() {
        return format!("{}/unlit", volume.storage.name());
    }
    let classifier = if scene.transfer_function.reads_gradient() { "tf2d" } else { "tf1d" };
    let shader = if scene.shading.is_some() { "lit" } else { "unlit" };
    format!("voxels/{classifier}/{shader}")
}
