//! How a picture was made, written next to it as JSON.
//!
//! A sidecar is made to be handed on with its picture: it holds hashes in place of the scan, and neither the path of the
//! scan nor anything that a scanner wrote about the patient.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use super::{Certificate, Clipped, StageTime, digest, measure};
use crate::error::{Error, Fault, Result};
use crate::integrate::Rendered;
use crate::io::{Scan, whole_file};
use crate::plan::{self, Bound, Method, Plan};
use crate::spec::Spec;
use crate::study::Choice;
use crate::volume::Volume;

/// What the sidecar says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sidecar {
    /// The program.
    pub tool: Tool,
    /// SHA-256 of the pipeline's file and of each preset file it names, by what it is called there.
    pub inputs_sha256: Vec<InputHash>,
    /// The pipeline as written, with overrides, less the paths of the scan and of the picture.
    pub pipeline: Value,
    /// What was done, every option resolved.
    pub plan: Value,
    /// The scan.
    pub volume: VolumeRecord,
    /// The labels of the mask, where it has an effect.
    pub labels: Option<LabelsRecord>,
    /// The picture.
    pub picture: PictureRecord,
    /// How the integral was computed.
    pub method: MethodRecord,
    /// What was measured to choose the method, where the pipeline leaves it to measurements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<Choice>,
    /// The error found by the oracle, where the pipeline asks for that.
    pub certificate: Option<Certificate>,
    /// Voxels outside the window of values.
    pub clipped: Clipped,
    /// Seconds per stage.
    pub stages: Vec<StageTime>,
    /// Most memory held, where the system says.
    pub peak_memory_bytes: Option<u64>,
    /// Threads that computed; the picture does not depend on them.
    pub threads: usize,
    /// What a careful user should know.
    pub warnings: Vec<String>,
}

/// The program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Tool {
    /// `pellucid`.
    pub name: &'static str,
    /// Its version.
    pub version: &'static str,
    /// Architecture and operating system.
    pub platform: String,
}

/// Hash of a file that was written by an author.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct InputHash {
    /// `pipeline`, or the name of a preset.
    pub name: String,
    /// SHA-256 of its text.
    pub sha256: String,
}

/// The scan, without anything that could name the patient.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VolumeRecord {
    /// SHA-256 of the values.
    pub values_sha256: String,
    /// Voxels along i, j and k.
    pub dims: [usize; 3],
    /// Voxel index to LPS mm, three rows of four numbers.
    pub index_to_lps_mm: [[f64; 4]; 3],
    /// Distance of each slice from the first along k, mm, where they are uneven; else the affine says it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slice_positions_mm: Option<Vec<f64>>,
    /// Smallest and largest value.
    pub value_range: [f64; 2],
}

/// The labels of a mask.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LabelsRecord {
    /// SHA-256 of the labels, hashed as the values of a volume are.
    pub values_sha256: String,
    /// How many voxels have each label that occurs.
    pub voxels: BTreeMap<u16, u64>,
}

/// The picture.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PictureRecord {
    /// Name of its file, without the folder.
    pub file: String,
    /// Width and height.
    pub size: [usize; 2],
    /// SHA-256 of the linear premultiplied RGBA pixels before encoding, row by row from the top left, 32-bit floats in
    /// little-endian order.
    pub pixels_sha256: String,
}

/// How the integral was computed, with the errors of a channel of a pixel, linear and premultiplied.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodRecord {
    /// `exact`, `march` or `reference`.
    pub name: &'static str,
    /// The kernel.
    pub kernel: String,
    /// Error asked for.
    pub tolerance: Option<f64>,
    /// Largest bound on the error of a pixel.
    pub error_bound: Option<f64>,
    /// Whether all of that bound is proven, or a part of it estimated.
    pub bound: Option<Bound>,
    /// Places where the transfer function was evaluated, or pieces integrated.
    pub samples: u64,
    /// Rays that met the volume.
    pub rays: u64,
}

/// What a run has made by the time it writes its sidecar.
pub(super) struct Made<'a> {
    pub(super) volume: VolumeRecord,
    pub(super) labels: Option<LabelsRecord>,
    pub(super) choice: Option<Choice>,
    pub(super) clipped: Clipped,
    pub(super) rendered: &'a Rendered,
    pub(super) pixels_sha256: String,
    pub(super) certificate: Option<Certificate>,
    pub(super) stages: Vec<StageTime>,
}

impl Sidecar {
    /// The record of a picture.
    pub(super) fn new(spec: &Spec, scan: &Scan, plan: &Plan, made: Made<'_>) -> Self {
        Sidecar {
            tool: Tool::this(),
            inputs_sha256: input_hashes(spec),
            pipeline: without(
                serde_json::json!(spec.pipeline),
                &[&["volume", "source"], &["effects", "mask", "source"], &["output"]],
            ),
            plan: without(plan::plan_json(plan), &[&["output", "path"]]),
            volume: made.volume,
            labels: made.labels,
            picture: PictureRecord::new(&plan.output.path, plan.scene.camera.size(), made.pixels_sha256),
            method: MethodRecord::new(plan, made.rendered),
            choice: made.choice,
            certificate: made.certificate,
            clipped: made.clipped,
            stages: made.stages,
            peak_memory_bytes: measure::peak_memory_bytes(),
            threads: rayon::current_num_threads(),
            warnings: scan.warnings.iter().chain(&plan.warnings).cloned().collect(),
        }
    }

    /// Writes the sidecar as `<picture>.json` and gives its path.
    ///
    /// # Errors
    /// `Fault::Output` if it cannot be written.
    pub(super) fn write_beside(&self, picture: &Path) -> Result<PathBuf> {
        write_json_beside(self, picture)
    }
}

/// Writes a record as `<picture>.json` and gives its path.
pub(super) fn write_json_beside(record: &impl Serialize, picture: &Path) -> Result<PathBuf> {
    let mut name = picture.as_os_str().to_owned();
    name.push(".json");
    let path = PathBuf::from(name);
    let text = serde_json::to_string_pretty(record)
        .map_err(|cause| Error::new(Fault::Internal, "the sidecar has no JSON form").at(&path).caused_by(cause))?;
    whole_file::write(&path, |file| std::io::Write::write_all(file, format!("{text}\n").as_bytes()))?;
    Ok(path)
}

impl PictureRecord {
    /// The record of a picture of this size at this path.
    pub(super) fn new(path: &Path, size: [usize; 2], pixels_sha256: String) -> Self {
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        PictureRecord { file, size, pixels_sha256 }
    }
}

impl Tool {
    /// This build on this machine.
    pub(super) fn this() -> Self {
        Tool {
            name: env!("CARGO_PKG_NAME"),
            version: env!("CARGO_PKG_VERSION"),
            platform: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
        }
    }
}

impl From<&Volume> for VolumeRecord {
    fn from(volume: &Volume) -> Self {
        VolumeRecord {
            values_sha256: volume.values_sha256(),
            dims: volume.grid().dims(),
            index_to_lps_mm: volume.grid().index_to_lps_mm_rows(),
            slice_positions_mm: volume.slice_positions_mm(),
            value_range: volume.value_range(),
        }
    }
}

impl MethodRecord {
    fn new(plan: &Plan, rendered: &Rendered) -> Self {
        let name = match plan.method {
            Method::Exact(_) => "exact",
            Method::March(_) => "march",
            Method::Reference => "reference",
        };
        let statistics = &rendered.statistics;
        MethodRecord {
            name,
            kernel: statistics.kernel.clone(),
            tolerance: plan.tolerance(),
            error_bound: statistics.error_bound,
            bound: statistics.bound,
            samples: statistics.samples,
            rays: statistics.rays,
        }
    }
}

fn input_hashes(spec: &Spec) -> Vec<InputHash> {
    let hash = |name: &str, text: &str| InputHash { name: name.to_string(), sha256: digest::of_text(text) };
    let presets = spec.presets().map(|loaded| hash(&loaded.preset.name, &loaded.text));
    std::iter::once(hash("pipeline", spec.text())).chain(presets).collect()
}

/// The value without what stands at these key paths: the names of folders may be those of patients.
pub(super) fn without(mut value: Value, key_paths: &[&[&str]]) -> Value {
    for key_path in key_paths {
        let Some((last, parents)) = key_path.split_last() else { continue };
        let parent = parents.iter().try_fold(&mut value, |value, key| value.get_mut(key));
        if let Some(Value::Object(entries)) = parent {
            entries.remove(*last);
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_may_name_a_patient_is_taken_out_and_the_rest_stays() {
        let pipeline = json!({ "volume": { "source": "scans/DOE^JANE", "series": "largest" }, "output": "x.png" });
        let kept = without(pipeline, &[&["volume", "source"], &["output"], &["absent", "key"]]);
        assert_eq!(kept, json!({ "volume": { "series": "largest" } }));
    }
}
