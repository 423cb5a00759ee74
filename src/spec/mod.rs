//! What may be written in YAML: pipelines and presets, with their places for error messages.
//!
//! A [`Spec`] is a pipeline file as its author wrote it, checked as far as that is possible without the scan: every
//! option that was left out is still `None`. [`crate::plan`] resolves it against a volume; nothing below the plan reads
//! a `Spec`.
//!
//! Text becomes a tree of values with places, overrides (`--set`) change the tree, and a deserializer that knows the key
//! path of everything it reads gives it types. So every error, also one found later on by a check or by the plan, names
//! file, line, column and key path, or the override that is to blame.

mod analytic;
mod camera;
mod check;
mod clean;
mod color;
mod complaint;
mod effects;
mod integrate;
mod library;
mod overrides;
mod per_axis;
mod pipeline;
mod preset;
mod reference;
mod schema;
mod source;
mod stack;
mod suggest;
mod tree;
mod typed;
mod views;
mod widget;

pub use analytic::{AnalyticSpec, FieldSpec, MarschnerLobbSpec, RampSpec, SphereSpec, TorusSpec};
pub use camera::{CameraSpec, Fit, ProjectionName, ViewName};
pub use clean::CleanSpec;
pub use color::Color;
pub use effects::{
    ClassifyAtName, ClipBoxSpec, ClipPlaneSpec, ClipSpec, DepthCueSpec, EffectsSpec, ExpFogSpec, FogSpec, HazeSpec,
    LabelSpec, LightSpec, LinearFogSpec, MaskPhantom, MaskSpec, OtherLabels, ProjectSpec, ProjectionOf, RangeSpec,
    ScatteringSpec, ShadingSpec, ShadowsSpec, SurfaceSpec, TransportName, TrimSpec,
};
pub use integrate::{
    AutoSpec, BoundName, ColorsName, CompatibilityName, EmissionName, ExactSpec, IntegrateSpec, JitterKindName,
    JitterSpec, LatticeName, MarchSpec, OrderName, ReflectionName, RuleName, TableSpec,
};
pub use library::{BUILT_IN_PRESETS, LoadedPreset, built_in_preset, load_preset, parse_preset};
pub use per_axis::PerAxis;
pub use pipeline::{
    AttenuationSpec, BackgroundSpec, Bits, ColorEncodingName, GradientSpec, ImageSpec, LayerSpec, NormaliseSpec,
    PhantomBody, PhantomRings, PhantomSpec, Pipeline, Series, SlicesName, ValuesName, VolumeSpec,
};
pub use preset::{Preset, Tissue};
pub use reference::{LabelRange, ReferenceTissues};
pub use schema::{pipeline_schema, preset_schema, stack_schema};
pub use stack::{AlphaName, Document, Stack, StackImageSpec, StackSpec};
pub use views::{TurntableSpec, ViewsSpec};
pub use widget::{
    ContourSpec, EllipseSpec, EmissionSpec, GaussianSpec, PointSpec, RectangleSpec, TrapezoidSpec, TriangleSpec, Widget,
};

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use crate::error::{Error, Fault, Result};
use crate::volume::{ColorEncoding, Quantity, Rescale, RgbaEncoding, Volume};
use source::Source;

/// A pipeline with the presets it names, checked as far as that is possible without the scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Spec {
    /// The pipeline as written, overrides applied.
    pub pipeline: Pipeline,
    presets: Vec<Option<LoadedPreset>>,
    /// By the label whose own look they are.
    label_presets: BTreeMap<String, LoadedPreset>,
    source: Source,
}

/// Where a volume comes from, with paths resolved.
#[derive(Debug, Clone, PartialEq)]
pub enum VolumeSource {
    /// A file or folder.
    File {
        /// Its path, relative to the working directory.
        path: PathBuf,
        /// Which series of a folder.
        series: Option<Series>,
        /// Whether the distance between slices may change.
        slices: Option<SlicesName>,
    },
    /// A volume made by rule.
    Phantom(PhantomSpec),
    /// A formula.
    Analytic(AnalyticSpec),
}

impl Spec {
    /// Reads a pipeline file and the presets it names, with `overrides` of the form `key.path=value` in their order.
    ///
    /// # Errors
    /// `Fault::Spec`, with file, line, column and key path, or naming the override that is to blame.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self> {
        Self::from_source(Source::read(path, overrides)?)
    }

    /// The same from text; `path` is for messages and for what is relative to the file.
    ///
    /// # Errors
    /// As [`Spec::load`].
    pub fn from_text(text: &str, path: &Path, overrides: &[String]) -> Result<Self> {
        Self::from_source(Source::parse(text.to_owned(), path, overrides)?)
    }

    /// A pipeline of a scan and the names of presets, as a command line gives them; paths are relative to the working
    /// directory.
    ///
    /// # Errors
    /// As [`Spec::load`], and `Fault::Spec` for a path that is not Unicode.
    pub fn of_presets(scan: &Path, presets: &[String], overrides: &[String]) -> Result<Self> {
        let scan = scan
            .to_str()
            .ok_or_else(|| Error::new(Fault::Spec, "the path of the scan is not Unicode").found(format!("{scan:?}")))?;
        // What is valid JSON is valid YAML, so that no character of a path or a name is more than itself.
        let layers: Vec<_> = presets.iter().map(|name| serde_json::json!({ "preset": name })).collect();
        let pipeline = serde_json::json!({ "version": 1, "volume": { "source": scan }, "transfer_function": layers });
        Self::from_text(&pipeline.to_string(), Path::new("the command line"), overrides)
    }

    fn from_source(source: Source) -> Result<Self> {
        let pipeline: Pipeline = source.typed()?;
        check::check_pipeline(&source, &pipeline)?;
        let find = |(i, layer): (usize, &LayerSpec)| {
            let key_path = format!("transfer_function.{i}.preset");
            layer.preset.as_ref().map(|name| library::find(name, &source, &key_path)).transpose()
        };
        let presets = pipeline.transfer_function.iter().enumerate().map(find).collect::<Result<_>>()?;
        let label_presets = Self::load_label_presets(&pipeline, &source)?;
        Ok(Spec { pipeline, presets, label_presets, source })
    }

    fn load_label_presets(pipeline: &Pipeline, source: &Source) -> Result<BTreeMap<String, LoadedPreset>> {
        let labels = pipeline.effects.iter().flat_map(|effects| &effects.mask).flat_map(|mask| &mask.labels);
        let named = labels.filter_map(|(label, look)| match look {
            LabelSpec::Own(LayerSpec { preset: Some(name), .. }) => Some((label, name)),
            _ => None,
        });
        let find = |(label, name): (&String, &String)| {
            let key_path = format!("effects.mask.labels.{label}.preset");
            Ok((label.clone(), library::find(name, source, &key_path)?))
        };
        named.map(find).collect()
    }

    /// The pipeline's file.
    pub fn path(&self) -> &Path {
        self.source.path()
    }

    /// The pipeline's text as it is in the file, without overrides; for hashes.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// The layers of the transfer function, each with its preset if it has one.
    pub fn layers(&self) -> impl Iterator<Item = (&LayerSpec, Option<&LoadedPreset>)> {
        self.pipeline.transfer_function.iter().zip(self.presets.iter().map(Option::as_ref))
    }

    /// The preset that a label of the mask looks like, if it has one.
    pub fn label_preset(&self, label: &str) -> Option<&LoadedPreset> {
        self.label_presets.get(label)
    }

    /// All presets that the pipeline names, those of the layers first.
    pub fn presets(&self) -> impl Iterator<Item = &LoadedPreset> {
        self.presets.iter().flatten().chain(self.label_presets.values())
    }

    /// The file of the mask's labels, relative to the working directory, if there is a mask from a file.
    pub fn labels_path(&self) -> Option<PathBuf> {
        let mask = self.pipeline.effects.as_ref()?.mask.as_ref()?;
        mask.source.as_deref().map(|path| self.source.resolve("effects.mask.source", path))
    }

    /// Where the volume comes from.
    pub fn volume_source(&self) -> VolumeSource {
        let volume = &self.pipeline.volume;
        match (&volume.phantom, &volume.analytic, &volume.source) {
            (Some(phantom), ..) => VolumeSource::Phantom(phantom.clone()),
            (None, Some(analytic), _) => VolumeSource::Analytic(analytic.clone()),
            (None, None, source) => VolumeSource::File {
                path: self.source.resolve("volume.source", source.as_deref().unwrap_or(Path::new(""))),
                series: volume.series.clone(),
                slices: volume.slices,
            },
        }
    }

    /// The picture's path, if the pipeline names one, relative to the working directory.
    pub fn output(&self) -> Option<PathBuf> {
        self.pipeline.output.as_deref().map(|path| without_detours(&self.source.resolve("output", path)))
    }

    /// The volume with its values understood as the pipeline says, by `values` and `shift_hu`, or its colours, by
    /// `opacity_length_mm` and `color_encoding`.
    pub fn interpret(&self, volume: Volume) -> Volume {
        let spec = &self.pipeline.volume;
        let volume = match (spec.values, spec.shift_hu) {
            (Some(ValuesName::Arbitrary), _) => volume.with_quantity(Quantity::Arbitrary),
            (Some(ValuesName::Hu), _) | (None, Some(_)) => volume.with_quantity(Quantity::Hu),
            (None, None) => volume,
        };
        if let Some(understood) = volume.rgba_encoding() {
            let color = spec.color_encoding.map_or(understood.color, |name| match name {
                ColorEncodingName::Srgb => ColorEncoding::Srgb,
                ColorEncodingName::Linear => ColorEncoding::Linear,
            });
            let opacity_length_mm = spec.opacity_length_mm.unwrap_or(understood.opacity_length_mm);
            return volume.with_rgba_encoding(RgbaEncoding { opacity_length_mm, color });
        }
        let Rescale { slope, intercept } = volume.rescale();
        volume.with_rescale(Rescale { slope, intercept: intercept + spec.shift_hu.unwrap_or(0.0) })
    }

    /// An error about what is written at a key path such as `camera.position_mm`, with its place.
    pub fn error(&self, key_path: &str, what: impl Into<String>) -> Error {
        self.source.error(key_path, what)
    }

    /// An error of what was made by the words at a key path, with their place in addition.
    pub fn located(&self, key_path: &str, error: Error) -> Error {
        self.source.located(key_path, error)
    }
}

/// A path as a person would write it: `pipelines/../out` is `out`. Only for a folder that the path names itself, so that
/// it stays the same place unless that folder is a link.
fn without_detours(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        let after_a_name = matches!(plain.components().next_back(), Some(Component::Normal(_)));
        if part == Component::ParentDir && after_a_name {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_detour_is_left_out_of_a_path() {
        for (written, plain) in [
            ("pipelines/../out/a.png", "out/a.png"),
            ("../out/a.png", "../out/a.png"),
            ("a/b/../../../c.png", "../c.png"),
            ("/a/../c.png", "/c.png"),
        ] {
            assert_eq!(without_detours(Path::new(written)), PathBuf::from(plain), "for {written}");
        }
    }
}
