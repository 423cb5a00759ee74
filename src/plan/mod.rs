//! What will be done: a spec and the metadata of a volume, resolved until no option is left open.
//!
//! [`Plan::new`] is where every default is decided. It first resolves what is pictured (layers, light, camera), then
//! takes the union of what that reads of the volume ([`Demand`]), and lists what is therefore computed, in order, and
//! what is not, and why. [`explain`] prints it. Nothing below this module reads a [`Spec`].

mod camera;
mod explain;
mod integrator;
mod layers;
mod light;
mod method;
mod model;
mod output;
mod stages;
mod volume_info;
mod warnings;

pub use explain::{explain, explain_json};
pub use layers::Layer;
pub use method::{
    Colors, Emission, Exact, Jitter, JitterKind, Lattice, March, Method, Order, Reflection, SampleRule, Table,
};
pub use output::{Format, Output};
pub use stages::{Omission, Stage};
pub use volume_info::{Storage, VolumeInfo};

use std::path::Path;

use crate::demand::Demand;
use crate::error::Result;
use crate::scene::Scene;
use crate::spec::Spec;
use crate::transfer::TransferFunction;

/// What will be done, for one volume; the same for any number of threads.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What is pictured.
    pub scene: Scene,
    /// How the volume rendering integral is computed.
    pub method: Method,
    /// The layers whose sum is the scene's transfer function, in the order written; for classification.
    pub layers: Vec<Layer>,
    /// What the stages together read of the volume.
    pub demand: Demand,
    /// The file to write.
    pub output: Output,
    /// How many random pixels the oracle recomputes.
    pub certify: Option<usize>,
    /// What is computed, in order.
    pub stages: Vec<Stage>,
    /// What is not computed, and why.
    pub not_computed: Vec<Omission>,
    /// What a careful user should know.
    pub warnings: Vec<String>,
}

impl Plan {
    /// Resolves a spec for a volume whose values are [interpreted](Spec::interpret); `output` is a picture's path in
    /// place of the spec's, relative to the working directory.
    ///
    /// # Errors
    /// `Fault::Spec` for what only the volume shows to be impossible, such as a preset in HU for values that are not,
    /// and for a picture whose suffix names no format.
    pub fn new(spec: &Spec, volume: &VolumeInfo, output: Option<&Path>) -> Result<Self> {
        let output = Output::resolve(spec, output)?;
        let [window, gradient_range] = layers::domain(&spec.pipeline);
        let light = light::resolve(spec);
        let layers = layers::resolve(spec, volume, gradient_range[1], light.emission_scale)?;
        let terms = layers.iter().flat_map(|layer| layer.terms.iter().cloned()).collect();
        let scene = Scene {
            model: model::resolve(spec),
            transfer_function: TransferFunction::new(window, gradient_range[1], terms)?,
            shading: light.shading,
            camera: camera::resolve(spec, &volume.grid)?,
            background: light.background,
        };
        let method = integrator::resolve(spec, &volume.grid);
        let demand = Demand {
            gradient: scene.shading.is_some(),
            gradient_magnitude: scene.transfer_function.reads_gradient(),
            macrocells: matches!(method, Method::March(_)),
        };
        let mut plan = Plan {
            scene,
            method,
            layers,
            demand,
            output,
            certify: spec.pipeline.certify.map(|pixels| pixels as usize),
            stages: Vec::new(),
            not_computed: Vec::new(),
            warnings: Vec::new(),
        };
        plan.stages = stages::computed(&plan, volume);
        plan.not_computed = stages::not_computed(&plan, spec);
        plan.warnings = warnings::of(&plan, spec, volume);
        Ok(plan)
    }

    /// Bytes in memory, estimated: the sum over the stages.
    pub fn memory_bytes(&self) -> u64 {
        self.stages.iter().map(|stage| stage.bytes).sum()
    }
}
