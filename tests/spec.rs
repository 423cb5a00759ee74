//! What may be written: defaults, overrides, and every error of an author with its message and place.

use std::path::Path;

use pellucid::spec::Spec;
use pellucid::{Error, Fault};

mod cuts;
mod defaults;
mod effects;
mod mistakes;
mod overrides;
mod presets;
mod schema;
mod show;
mod stack;

/// The shortest pipeline.
const SHORT: &str = "version: 1
volume: { phantom: head }
transfer_function:
  - preset: bone
";

fn read(text: &str) -> pellucid::Result<Spec> {
    Spec::from_text(text, Path::new("scene.yaml"), &[])
}

/// The error of a text that must not pass.
fn mistake(text: &str) -> Error {
    match read(text) {
        Ok(spec) => panic!("this passed:\n{text}\n{:#?}", spec.pipeline),
        Err(error) => {
            assert_eq!(error.fault(), Fault::Spec, "{error}");
            error
        }
    }
}
