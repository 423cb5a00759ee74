//! A stack of pictures, resolved.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::error::Result;
use crate::image::over::Association;
use crate::scene::Background;
use crate::spec::{AlphaName, Bits, StackSpec};

use super::{Output, light};

/// What will be done with a stack of pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct StackPlan {
    /// The pictures, the first in front; relative to the working directory.
    pub layers: Vec<PathBuf>,
    /// Whether the colours in them are multiplied by their alpha.
    pub association: Association,
    /// Light behind the last one.
    pub background: Background,
    /// The file to write.
    pub output: Output,
}

impl StackPlan {
    /// Resolves a stack; `output` is a picture's path in place of the stack's, relative to the working directory.
    ///
    /// # Errors
    /// `Fault::Spec` for a picture whose suffix names no format.
    pub fn new(spec: &StackSpec, output: Option<&Path>) -> Result<Self> {
        let image = spec.stack.image.clone().unwrap_or_default();
        let path = output.map(Path::to_path_buf).or_else(|| spec.output());
        let path = path.unwrap_or_else(|| spec.path().with_extension("png"));
        Ok(StackPlan {
            layers: spec.layers(),
            association: match spec.stack.alpha {
                None | Some(AlphaName::Straight) => Association::Straight,
                Some(AlphaName::Associated) => Association::Associated,
            },
            background: light::background(image.background),
            output: Output::at(path, image.bits.unwrap_or(Bits::Eight))?,
        })
    }

    /// The plan in words.
    pub fn explain(&self) -> String {
        let names: Vec<String> = self.layers.iter().map(|path| path.display().to_string()).collect();
        let behind = match self.background {
            Background::Transparent => "nothing: the picture keeps its alpha".to_owned(),
            Background::Color([r, g, b]) => format!("linear RGB ({r:.3}, {g:.3}, {b:.3})"),
        };
        format!(
            "layers     {}, {} alpha\nintegrate  over: front to back in f64\nbehind     {behind}\nimage      {}\noutput     {}\n",
            names.join(" over "),
            self.association_name(),
            self.output.format.describe(),
            self.output.path.display()
        )
    }

    /// The same as JSON.
    pub fn explain_json(&self) -> Value {
        json!({
            "layers": self.layers,
            "alpha": self.association_name(),
            "background": match self.background {
                Background::Transparent => json!("transparent"),
                Background::Color(rgb) => json!(rgb),
            },
            "output": { "path": self.output.path, "format": self.output.format }
        })
    }

    fn association_name(&self) -> &'static str {
        match self.association {
            Association::Straight => "straight",
            Association::Associated => "associated",
        }
    }
}
