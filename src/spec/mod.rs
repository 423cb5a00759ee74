//! What may be written in YAML: pipelines and presets, with their places for error messages.
//!
//! A [`Spec`] is a pipeline file as its author wrote it, checked as far as that is possible without the scan: every
//! option that was left out is still `None`. [`crate::plan`] resolves it against a volume; nothing below the plan reads
//! a `Spec`.
//!
//! Text becomes a tree of values with places, overrides (`--set`) change the tree, and a deserializer that knows the key
//! path of everything it reads gives it types. So every error, also one found later on by a check or by the plan, names
//! file, line, column and key path, or the override that is to blame.

mod camera;
mod check;
mod color;
mod complaint;
mod effects;
mod integrate;
mod library;
mod overrides;
mod pipeline;
mod preset;
mod schema;
mod source;
mod suggest;
mod tree;
mod typed;
mod widget;

pub use camera::{CameraSpec, Fit, ProjectionName, ViewName};
pub use color::Color;
pub use effects::{EffectsSpec, LightSpec, ProjectSpec, ProjectionOf, ShadingSpec, SurfaceSpec};
pub use integrate::{
    ColorsName, CompatibilityName, EmissionName, ExactSpec, IntegrateSpec, JitterKindName, JitterSpec, LatticeName,
    MarchSpec, OrderName, ReflectionName, RuleName, TableSpec,
};
pub use library::{BUILT_IN_PRESETS, LoadedPreset, built_in_preset, load_preset};
pub use pipeline::{
    BackgroundSpec, Bits, GradientSpec, ImageSpec, LayerSpec, NormaliseSpec, PhantomHead, PhantomSpec, Pipeline,
    Series, ValuesName, VolumeSpec,
};
pub use preset::{Preset, Tissue};
pub use schema::{pipeline_schema, preset_schema};
pub use widget::{
    ContourSpec, EllipseSpec, EmissionSpec, GaussianSpec, PointSpec, RectangleSpec, TrapezoidSpec, TriangleSpec, Widget,
};

use std::path::{Component, Path, PathBuf};

use crate::error::{Error, Result};
use crate::volume::{Quantity, Rescale, Volume};
use source::Source;

/// A pipeline with the presets it names, checked as far as that is possible without the scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Spec {
    /// The pipeline as written, overrides applied.
    pub pipeline: Pipeline,
    presets: Vec<Option<LoadedPreset>>,
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
    },
    /// A volume made by rule.
    Phantom(PhantomSpec),
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

    fn from_source(source: Source) -> Result<Self> {
        let pipeline: Pipeline = source.typed()?;
        check::check_pipeline(&source, &pipeline)?;
        let find = |(i, layer): (usize, &LayerSpec)| {
            let key_path = format!("transfer_function.{i}.preset");
            layer.preset.as_ref().map(|name| library::find(name, &source, &key_path)).transpose()
        };
        let presets = pipeline.transfer_function.iter().enumerate().map(find).collect::<Result<_>>()?;
        Ok(Spec { pipeline, presets, source })
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

    /// Where the volume comes from.
    pub fn volume_source(&self) -> VolumeSource {
        let volume = &self.pipeline.volume;
        match (&volume.phantom, &volume.source) {
            (Some(phantom), _) => VolumeSource::Phantom(phantom.clone()),
            (None, source) => VolumeSource::File {
                path: self.source.resolve("volume.source", source.as_deref().unwrap_or(Path::new(""))),
                series: volume.series.clone(),
            },
        }
    }

    /// The picture's path, if the pipeline names one, relative to the working directory.
    pub fn output(&self) -> Option<PathBuf> {
        self.pipeline.output.as_deref().map(|path| without_detours(&self.source.resolve("output", path)))
    }

    /// The volume with its values understood as the pipeline says: `values` and `shift_hu`.
    pub fn interpret(&self, volume: Volume) -> Volume {
        let spec = &self.pipeline.volume;
        let volume = match (spec.values, spec.shift_hu) {
            (Some(ValuesName::Arbitrary), _) => volume.with_quantity(Quantity::Arbitrary),
            (Some(ValuesName::Hu), _) | (None, Some(_)) => volume.with_quantity(Quantity::Hu),
            (None, None) => volume,
        };
        let Rescale { slope, intercept } = volume.rescale();
        volume.with_rescale(Rescale { slope, intercept: intercept + spec.shift_hu.unwrap_or(0.0) })
    }

    /// An error about what is written at a key path such as `camera.position_mm`, with its place.
    pub fn error(&self, key_path: &str, what: impl Into<String>) -> Error {
        self.source.error(key_path, what)
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
