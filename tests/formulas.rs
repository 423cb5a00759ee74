//! Volumes by formula: their values, what interpolation makes of them, and the mistakes of authors.

use std::path::Path;

use pellucid::spec::Spec;
use pellucid::{Error, Volume, pipeline};

mod mistakes;
mod spheres;
mod values;

/// The volume of a pipeline with this under `volume: { analytic: … }`.
fn made(analytic: &str) -> Result<Volume, Error> {
    let text = format!(
        "version: 1\nvolume:\n  analytic: {analytic}\neffects: {{ project: {{ show: maximum, window_hu: [0, 1] }} }}\n"
    );
    let spec = Spec::from_text(&text, Path::new("scene.yaml"), &[])?;
    pipeline::load(&spec, &pipeline::Options::default()).map(|scan| scan.volume)
}

fn volume(analytic: &str) -> Volume {
    made(analytic).unwrap_or_else(|error| panic!("{analytic}: {error}"))
}
