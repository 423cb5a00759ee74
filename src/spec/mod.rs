//! What may be written in YAML: pipelines and presets, with their places for error messages.
//!
//! A [`Spec`] is a pipeline file as its author wrote it, checked as far as that is possible without the scan: every
//! option that was left out is still `None`. [`crate::plan`] resolves it against a volume; nothing below the plan reads
//! a `Spec`.

mod camera;
mod color;
mod effects;
mod integrate;
mod pipeline;
mod preset;
mod widget;

pub use camera::{CameraSpec, Fit, ProjectionName, ViewName};
pub use color::Color;
pub use effects::{EffectsSpec, LightSpec, ShadingSpec};
pub use integrate::{
    ColorsName, EmissionName, ExactSpec, IntegrateSpec, JitterKindName, JitterSpec, LatticeName, MarchSpec, OrderName,
    RuleName,
};
pub use pipeline::{
    BackgroundSpec, Bits, GradientSpec, ImageSpec, LayerSpec, NormaliseSpec, PhantomHead, PhantomSpec, Pipeline,
    Series, ValuesName, VolumeSpec,
};
pub use preset::{Preset, Tissue};
pub use widget::{
    ContourSpec, EllipseSpec, EmissionSpec, GaussianSpec, PointSpec, RectangleSpec, TrapezoidSpec, TriangleSpec, Widget,
};
