//! From a stack of pictures to one.

use std::path::PathBuf;

use serde::Serialize;
use serde_json::Value;

use super::measure::Stopwatch;
use super::sidecar::{InputHash, PictureRecord, Tool, without, write_json_beside};
use super::{Event, Options, Progress, StageTime, digest, encode, prepare_folder};
use crate::error::{Error, Fault, Result};
use crate::image::over;
use crate::io::png;
use crate::plan::StackPlan;
use crate::scene::Background;
use crate::spec::StackSpec;

/// What composites.
const KERNEL: &str = "over/f64";

/// How a picture was composited, written next to it as JSON. It names no file but the picture: folders may be named after
/// patients.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StackSidecar {
    /// The program.
    pub tool: Tool,
    /// SHA-256 of the pipeline's file, and of the pixels of each layer, the first in front: linear, premultiplied.
    pub inputs_sha256: Vec<InputHash>,
    /// The stack as written, with overrides, less the paths.
    pub pipeline: Value,
    /// What was done, every option resolved.
    pub plan: Value,
    /// The picture.
    pub picture: PictureRecord,
    /// The kernel.
    pub kernel: &'static str,
    /// Seconds per stage.
    pub stages: Vec<StageTime>,
}

/// A composited picture on disk.
#[derive(Debug, Clone)]
pub struct StackOutcome {
    /// The picture.
    pub picture: PathBuf,
    /// The sidecar next to it.
    pub sidecar_path: PathBuf,
    /// What the sidecar says.
    pub sidecar: StackSidecar,
}

/// Composites a stack of pictures and writes the result with its sidecar, each whole or not at all.
///
/// # Errors
/// Those of reading and writing pictures, and `Fault::Input` for layers of different sizes.
pub fn composite(spec: &StackSpec, options: &Options, progress: Progress<'_>) -> Result<StackOutcome> {
    let mut stopwatch = Stopwatch::start(progress);
    let plan = stopwatch.time("plan", || StackPlan::new(spec, options.output.as_deref()))?;
    prepare_folder(&plan.output.path)?;
    let mut inputs_sha256 = vec![InputHash { name: "pipeline".to_string(), sha256: digest::of_text(spec.text()) }];
    let stack = stopwatch.time("composite", || stacked(&plan, &mut inputs_sha256, progress))?;
    let image = stack.image(match plan.background {
        Background::Transparent => None,
        Background::Color(rgb) => Some(rgb),
    });
    let pixels_sha256 = digest::of_pixels(&image);
    stopwatch.time("encode", || encode(&image, &plan.output, &super::texts(KERNEL, &pixels_sha256)))?;
    let sidecar = StackSidecar {
        tool: Tool::this(),
        inputs_sha256,
        pipeline: without(serde_json::json!(spec.stack), &[&["layers"], &["output"]]),
        plan: without(plan.explain_json(), &[&["layers"], &["output", "path"]]),
        picture: PictureRecord::new(&plan.output.path, stack.size(), pixels_sha256),
        kernel: KERNEL,
        stages: stopwatch.finish(),
    };
    let sidecar_path = write_json_beside(&sidecar, &plan.output.path)?;
    Ok(StackOutcome { picture: plan.output.path, sidecar_path, sidecar })
}

/// All layers, read one at a time, the first in front.
fn stacked(plan: &StackPlan, hashes: &mut Vec<InputHash>, progress: Progress<'_>) -> Result<over::Stack> {
    let mut stack: Option<over::Stack> = None;
    for (index, path) in plan.layers.iter().enumerate() {
        let layer = png::read_as(path, plan.association)?.image;
        let size = [layer.width(), layer.height()];
        let stack = stack.get_or_insert_with(|| {
            progress(Event::Rays(size[0] * size[1] * plan.layers.len()));
            over::Stack::new(size[0], size[1])
        });
        if size != stack.size() {
            let text = |[width, height]: [usize; 2]| format!("{width} x {height}");
            return Err(Error::new(Fault::Input, "the layers are not of one size")
                .at(path)
                .found(text(size))
                .expected(format!("{}, the size of the first layer", text(stack.size()))));
        }
        stack.add_behind(&layer);
        hashes.push(InputHash { name: format!("layer {}", index + 1), sha256: digest::of_pixels(&layer) });
        progress(Event::Pixels(size[0] * size[1]));
    }
    // The spec has seen to it that there is one.
    Ok(stack.unwrap_or_else(|| over::Stack::new(0, 0)))
}
