//! One of the two pictures that are compared.

use std::path::Path;

use pellucid::Result;
use pellucid::image::Image;
use pellucid::io::picture;
use pellucid::pipeline;
use pellucid::spec::Spec;

use crate::cli::Global;
use crate::cli::progress::Bar;

/// Where a picture comes from.
pub(super) enum Side<'a> {
    /// From a file.
    File(&'a Path),
    /// From a pipeline.
    Pipeline(&'a Path),
}

impl<'a> Side<'a> {
    /// A pipeline if the name ends in `.yaml` or `.yml`.
    pub(super) fn of(path: &'a Path) -> Self {
        let suffix = path.extension().map(|suffix| suffix.to_string_lossy().to_lowercase());
        match suffix.as_deref() {
            Some("yaml" | "yml") => Side::Pipeline(path),
            _ => Side::File(path),
        }
    }

    /// The picture, read or rendered; `overrides` are for pipelines.
    pub(super) fn picture(&self, overrides: &[String], global: &Global) -> Result<Image> {
        match self {
            Side::File(path) => Ok(picture::read(path)?.image),
            Side::Pipeline(path) => {
                let bar = Bar::new(global.quiet);
                let rendered = pipeline::picture(&Spec::load(path, overrides)?, &|event| bar.hear(event));
                bar.clear();
                Ok(rendered?.image)
            }
        }
    }
}
