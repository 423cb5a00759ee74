//! Where presets come from: a file, a folder `presets` near the pipeline, or those built in.

use std::path::{Path, PathBuf};

use super::check::check_preset;
use super::preset::Preset;
use super::source::Source;
use super::suggest::did_you_mean;
use crate::error::{Error, Result};

/// The presets built in: name and text of each file of the folder `presets`, so that the binary works alone.
pub const BUILT_IN_PRESETS: &[(&str, &str)] = &[
    ("airways", include_str!("../../presets/airways.yaml")),
    ("bone", include_str!("../../presets/bone.yaml")),
    ("bone-cortical", include_str!("../../presets/bone-cortical.yaml")),
    ("bone-trabecular", include_str!("../../presets/bone-trabecular.yaml")),
    ("bowel-gas", include_str!("../../presets/bowel-gas.yaml")),
    ("brain", include_str!("../../presets/brain.yaml")),
    ("enamel", include_str!("../../presets/enamel.yaml")),
    ("engine", include_str!("../../presets/engine.yaml")),
    ("fat", include_str!("../../presets/fat.yaml")),
    ("heart", include_str!("../../presets/heart.yaml")),
    ("kidneys", include_str!("../../presets/kidneys.yaml")),
    ("liver", include_str!("../../presets/liver.yaml")),
    ("lung", include_str!("../../presets/lung.yaml")),
    ("metal", include_str!("../../presets/metal.yaml")),
    ("muscle", include_str!("../../presets/muscle.yaml")),
    ("skin", include_str!("../../presets/skin.yaml")),
    ("soft-tissue", include_str!("../../presets/soft-tissue.yaml")),
    ("teeth", include_str!("../../presets/teeth.yaml")),
    ("tooth", include_str!("../../presets/tooth.yaml")),
    ("tooth-boundaries", include_str!("../../presets/tooth-boundaries.yaml")),
    ("vessels", include_str!("../../presets/vessels.yaml")),
];

/// A preset with where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedPreset {
    /// The preset.
    pub preset: Preset,
    /// Its file; `presets/NAME.yaml (built in)` for one of [`BUILT_IN_PRESETS`].
    pub path: PathBuf,
    /// The text of the file, for hashes.
    pub text: String,
}

/// Reads a preset file.
///
/// # Errors
/// `Fault::Spec`, with place, for a file that cannot be read or is not a preset.
pub fn load_preset(path: &Path) -> Result<LoadedPreset> {
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    typed(Source::read(path, &[])?, &name)
}

/// The same from text; `path`, whose stem is the preset's name, is for messages.
///
/// # Errors
/// As [`load_preset`].
pub fn parse_preset(text: &str, path: &Path) -> Result<LoadedPreset> {
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    typed(Source::parse(text.to_owned(), path, &[])?, &name)
}

/// A preset that is built in, if there is one of this name.
///
/// # Errors
/// None in a build that passes its tests: those parse every preset.
pub fn built_in_preset(name: &str) -> Option<Result<LoadedPreset>> {
    let (name, text) = BUILT_IN_PRESETS.iter().find(|(known, _)| *known == name)?;
    let path = PathBuf::from(format!("presets/{name}.yaml (built in)"));
    Some(Source::parse((*text).to_owned(), &path, &[]).and_then(|source| typed(source, name)))
}

fn typed(source: Source, name: &str) -> Result<LoadedPreset> {
    let preset: Preset = source.typed()?;
    check_preset(&source, &preset, name)?;
    Ok(LoadedPreset { preset, path: source.path().to_path_buf(), text: source.text().to_owned() })
}

/// Finds the preset that a pipeline calls `name`, for the layer at `key_path`.
pub(super) fn find(name: &str, pipeline: &Source, key_path: &str) -> Result<LoadedPreset> {
    let folder = pipeline.path().parent().unwrap_or(Path::new(""));
    if is_path(name) {
        let path = pipeline.resolve(key_path, Path::new(name));
        if !path.is_file() {
            let error = pipeline.error(key_path, "there is no such preset file").found(path.display().to_string());
            return Err(
                error.remedy("a path is relative to the pipeline's file; a bare name looks in the folders presets")
            );
        }
        return load_preset(&path);
    }
    // Next to the pipeline first, then above it, as in pipelines/skull.yaml with presets/bone.yaml.
    let folders = [folder.join("presets"), folder.join("..").join("presets")];
    if let Some(path) = folders.iter().map(|f| f.join(format!("{name}.yaml"))).find(|path| path.is_file()) {
        return load_preset(&path);
    }
    built_in_preset(name).unwrap_or_else(|| Err(unknown(name, &folders, pipeline, key_path)))
}

fn is_path(name: &str) -> bool {
    name.contains(['/', '\\']) || name.ends_with(".yaml") || name.ends_with(".yml")
}

fn unknown(name: &str, folders: &[PathBuf], pipeline: &Source, key_path: &str) -> Error {
    let mut known: Vec<String> = BUILT_IN_PRESETS.iter().map(|(name, _)| (*name).to_owned()).collect();
    for entry in folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten() {
        let path = entry.path();
        if let (Some(stem), Some("yaml")) = (path.file_stem(), path.extension().and_then(|e| e.to_str())) {
            known.push(stem.to_string_lossy().into_owned());
        }
    }
    known.sort();
    known.dedup();
    let error = pipeline.error(key_path, "there is no such preset").found(name);
    let error = error.expected(format!("one of {}, or a path to a .yaml file", known.join(", ")));
    match did_you_mean(name, known.iter().map(String::as_str)) {
        Some(remedy) => error.remedy(remedy),
        None => error,
    }
}
