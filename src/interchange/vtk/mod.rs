//! The scene of a plan as VTK renders it: a folder with a script in Python and the numbers that it reads.
//!
//! Nothing of a pipeline is interpreted again: the camera, the lights and the grid are those of the plan, the transfer
//! function is a table of the definition, and the gradient magnitude is our own, as a second channel of the volume. VTK
//! corrects the opacities of a 1D transfer function for the step; those of a 2D one the script corrects.
//!
//! Projections and surfaces are blend modes of VTK's mappers: see `blend`. What is clipped along the voxels' axes in a
//! scene of light is VTK's cropping, in voxels; all else that is clipped are its clipping planes, of which it has eight.

mod blend;
mod frame;
mod frames;
mod scene;

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Fault, Result};
use crate::field::gradient_magnitudes;
use crate::io::{npy, whole_file};
use crate::plan::{Method, Plan, Table};
use crate::volume::Volume;

use blend::Blend;
use frame::Frame;

pub use frames::{Frames, Mapper};

/// The script, the same for every scene.
pub const SCRIPT: &str = include_str!("render.py");

/// What to do where there is no VTK.
pub const REMEDY: &str = "name a Python that has vtk and numpy with --python; README.md says how to make one";

/// Entries of the table where the plan has none: VTK's textures are of powers of two, 1024 at least.
const TABLE: Table = Table { values: 4096, gradients: 1024, uncorrected_opacity: 1e-4 };

/// Distance between samples in voxels where the plan has none.
const STEP_VOXELS: f64 = 0.5;

/// Writes `render.py`, `scene.json` and arrays into a folder, made if it is not there; returns the script's path.
///
/// # Errors
/// `Fault::Unsupported` for what VTK has no equal of: a sheared grid or uneven slices, colours in place of values, effects
/// of light, masks, classification at the voxels, local maxima and optical depths, more than eight clipping planes, light
/// from what does not absorb; `Fault::Output` if a file cannot be written.
pub fn export(folder: &Path, volume: &Volume, plan: &Plan) -> Result<PathBuf> {
    scene::check(volume, &plan.scene)?;
    let frame = Frame::new(volume.grid())?;
    let (step_mm, table) = match &plan.method {
        Method::March(march) => (march.step_mm, march.table.unwrap_or(TABLE)),
        _ => (STEP_VOXELS * volume.grid().spacing_mm().min_element(), TABLE),
    };
    fs::create_dir_all(folder).map_err(|cause| {
        Error::new(Fault::Output, "the folder for VTK could not be made").at(folder).caused_by(cause)
    })?;
    let [nx, ny, nz] = volume.grid().dims();
    let mut gradient = None;
    if scene::reads_gradient(&plan.scene) {
        let magnitudes = gradient_magnitudes(volume)?;
        let ends = magnitudes.iter().fold([f32::INFINITY, 0.0], |[low, high], &m| [low.min(m), high.max(m)]);
        npy::write(&folder.join("gradient_magnitude.npy"), &[nz, ny, nx], &frame.ordered(&magnitudes))?;
        gradient = Some(ends.map(f64::from));
    }
    let blend = Blend::new(&plan.scene, volume, table, gradient)?;
    let entries: Vec<f32> = blend.entries.iter().flatten().map(|&x| x as f32).collect();
    npy::write(&folder.join("transfer_function.npy"), &[blend.size[0], blend.size[1], 4], &entries)?;
    let values: Vec<f32> =
        (0..volume.grid().voxel_count()).map(|i| volume.rescale().value(volume.samples().stored(i)) as f32).collect();
    npy::write(&folder.join("volume.npy"), &[nz, ny, nx], &frame.ordered(&values))?;

    let scene = scene::json(volume, plan, &frame, step_mm, blend.json)?;
    let text = serde_json::to_string_pretty(&scene)
        .map_err(|cause| Error::new(Fault::Internal, "the scene has no JSON form").caused_by(cause))?;
    write_text(&folder.join("scene.json"), &text)?;
    let script = folder.join("render.py");
    write_text(&script, SCRIPT)?;
    Ok(script)
}

fn write_text(path: &Path, text: &str) -> Result<()> {
    use std::io::Write;
    whole_file::write(path, |file| file.write_all(text.as_bytes()))
}
