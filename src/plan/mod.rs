//! What will be done: a spec and the metadata of a volume, resolved until no option is left open.
//!
//! [`Plan::new`] is where every default is decided. It first resolves what is pictured (layers, light, camera), then
//! takes the union of what that reads of the volume ([`Demand`]), and lists what is therefore computed, in order, and
//! what is not, and why. [`explain`] prints it. Nothing below this module reads a [`Spec`].

mod camera;
mod classification;
mod clip;
mod colors;
mod crop;
mod effects;
mod exact_kernel;
mod explain;
mod integrator;
mod layers;
mod light;
mod mask;
mod method;
mod model;
mod output;
mod stack;
mod stages;
mod volume_info;
mod voxels;
mod warnings;
mod widgets;
mod work;

pub use classification::{Classification, CleanStep, Tissue};
pub use crop::Crop;
use effects::{Resolved, Surroundings};
pub use exact_kernel::{ExactKernel, MOST_LIGHTS, Stored, shades_in_registers};
pub use explain::{explain, explain_json, plan_json};
pub use integrator::Chosen;
pub use layers::{Layer, preset_terms};
pub use mask::LabelClasses;
pub use method::{
    Bound, Colors, Emission, Exact, Jitter, JitterKind, Lattice, March, Method, Order, Reflection, SampleRule, Table,
};
pub use output::{Format, Output};
pub use stack::StackPlan;
pub use stages::{Omission, Stage};
pub use volume_info::{LabelInfo, Storage, VolumeInfo};
pub use widgets::{LayerWidgets, WidgetWeight, widgets};
pub use work::Work;

use std::path::Path;

use crate::demand::Demand;
use crate::error::Result;
use crate::scene::{Effects, Scene, Shading};
use crate::spec::{Spec, ViewsSpec};
use crate::transfer::TransferFunction;
use crate::volume::{Grid, RgbaEncoding};

/// What will be done, for one volume; the same for any number of threads.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What is pictured.
    pub scene: Scene,
    /// How the volume rendering integral is computed.
    pub method: Method,
    /// Why this method, where the pipeline leaves it to measurements and they were made.
    pub chosen: Option<Chosen>,
    /// Which of its kernels runs, if the method is exact.
    pub exact_kernel: Option<ExactKernel>,
    /// The layers whose sum is the scene's transfer function, in the order written; for classification.
    pub layers: Vec<Layer>,
    /// How the volume's colours are understood; `None` for a volume of values.
    pub colors: Option<RgbaEncoding>,
    /// Which class of the scene's mask the voxels of each label have; `None` without a mask.
    pub label_classes: Option<LabelClasses>,
    /// What the stages together read of the volume.
    pub demand: Demand,
    /// Which of the pipeline's views it is, counted from 0, and how many there are.
    pub view: [usize; 2],
    /// The file to write.
    pub output: Output,
    /// How many random pixels the oracle recomputes.
    pub certify: Option<usize>,
    /// Most bytes held while the scan was read.
    pub reading_bytes: u64,
    /// The lattice of the volume.
    pub grid: Grid,
    /// What is computed, in order.
    pub stages: Vec<Stage>,
    /// What is not computed, and why.
    pub not_computed: Vec<Omission>,
    /// What a careful user should know.
    pub warnings: Vec<String>,
}

impl Plan {
    /// Resolves a spec for a volume whose values are [interpreted](Spec::interpret), of several views for the first; `output` is a
    /// picture's path in place of the spec's, relative to the working directory.
    ///
    /// # Errors
    /// `Fault::Spec` for what only the volume shows to be impossible, such as a preset in HU for values that are not,
    /// and for a picture whose suffix names no format.
    pub fn new(spec: &Spec, volume: &VolumeInfo, output: Option<&Path>) -> Result<Self> {
        Plan::with((spec, 0), volume, output, integrator::resolve(spec, volume), None)
    }

    /// The same by a method that measurements have chosen (`integrate: auto`).
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn measured(
        spec: &Spec,
        volume: &VolumeInfo,
        output: Option<&Path>,
        method: Method,
        chosen: Chosen,
    ) -> Result<Self> {
        Plan::with((spec, 0), volume, output, method, Some(chosen))
    }

    /// The same for another of the pipeline's views, counted from 0.
    ///
    /// # Errors
    /// As [`Plan::new`].
    pub fn of_view(&self, spec: &Spec, volume: &VolumeInfo, output: Option<&Path>, view: usize) -> Result<Self> {
        Plan::with((spec, view), volume, output, self.method, self.chosen.clone())
    }

    fn with(
        (spec, view): (&Spec, usize),
        volume: &VolumeInfo,
        output: Option<&Path>,
        method: Method,
        chosen: Option<Chosen>,
    ) -> Result<Self> {
        let views = spec.pipeline.views.as_ref().map_or(1, ViewsSpec::count);
        let output = Output::resolve(spec, output)?.of_view(view, views);
        let colors = colors::resolve(spec, volume)?;
        let [window, gradient_range] = layers::domain(&spec.pipeline);
        let light = light::resolve(spec);
        let layers = layers::resolve(spec, volume, gradient_range[1], light.scales)?;
        let terms = layers.iter().flat_map(|layer| layer.terms.iter().cloned()).collect();
        let mask = mask::resolve(spec, volume, (window, gradient_range[1]), light.scales)?;
        let (mask, label_classes) = mask.map(|m| (m.mask, m.classes)).unzip();
        let camera = camera::resolve(spec, &volume.grid, view)?;
        let surroundings = Surroundings {
            grid: &volume.grid,
            camera: &camera,
            shading: light.shading.as_ref(),
            background: light.background,
        };
        let Resolved { effects, omitted, warnings } = effects::resolve(spec, &surroundings)?;
        let scene = Scene {
            model: model::resolve(spec),
            transfer_function: TransferFunction::new(window, gradient_range[1], terms)?,
            shading: light.shading,
            camera,
            background: light.background,
            effects: Effects { mask, ..effects },
        };
        let exact_kernel = match &method {
            Method::Exact(settings) => Some(ExactKernel::of(&scene, volume, settings)),
            Method::March(_) | Method::Reference => None,
        };
        let demand = Demand {
            gradient: scene.shading.as_ref().is_some_and(Shading::is_lit),
            gradient_magnitude: scene.transfer_functions().any(TransferFunction::reads_gradient),
            macrocells: match method {
                Method::March(_) => model::skips_blocks(&scene.model) && volume.uneven_slices_mm.is_none(),
                Method::Exact(_) => matches!(exact_kernel, Some(ExactKernel::InRegisters(_))),
                Method::Reference => false,
            },
            visibility: !scene.occluded_directions().is_empty(),
        };
        let mut plan = Plan {
            scene,
            method,
            chosen,
            exact_kernel,
            layers,
            colors,
            label_classes,
            demand,
            view: [view, views],
            output,
            certify: spec.pipeline.certify.map(|pixels| pixels as usize),
            reading_bytes: volume.reading_bytes,
            grid: volume.grid,
            stages: Vec::new(),
            not_computed: Vec::new(),
            warnings: Vec::new(),
        };
        plan.stages = stages::computed(&plan, volume);
        plan.not_computed = stages::not_computed(&plan, spec, volume);
        plan.not_computed.extend(omitted);
        plan.warnings = warnings::of(&plan, spec, volume);
        plan.warnings.extend(warnings);
        Ok(plan)
    }

    /// The error that was asked for, where one was.
    pub fn tolerance(&self) -> Option<f64> {
        match (&self.method, &self.chosen) {
            (_, Some(Chosen { tolerance: Some(tolerance), .. })) => Some(*tolerance),
            (Method::Exact(exact), _) => Some(exact.tolerance),
            (Method::March(_) | Method::Reference, _) => None,
        }
    }

    /// What the bound on the error will be, where there is one; what it was is in the statistics of the picture.
    pub fn bound(&self) -> Option<Bound> {
        self.exact_kernel.map(ExactKernel::bound)
    }

    /// How much there is to do, by looking at thousands of rays: for those who ask, as rendering does not.
    pub fn work(&self) -> Work {
        work::expected(&self.scene, &self.method, &self.grid)
    }

    /// Bytes on the heap at peak, estimated; the program, its threads' stacks and what threads keep take some 10 MB beside it.
    pub fn memory_bytes(&self) -> u64 {
        self.peak().1
    }

    /// What is going on when most memory is held, and how many bytes that is: while the scan is read; while it is
    /// rendered, from volume and fields into pixels; or while these are encoded, when the fields are gone unless more views follow.
    pub fn peak(&self) -> (&'static str, u64) {
        let of = |names: &[&str]| -> u64 {
            self.stages.iter().filter(|stage| names.contains(&stage.name)).map(|stage| stage.bytes).sum()
        };
        let rendering = of(&["volume", "mask", "field", "classify", "light", "integrate"]);
        let [_, views] = self.view;
        // What the next view needs, too, is kept.
        let kept = if views > 1 { of(&["field", "classify", "light"]) } else { 0 };
        let writing = of(&["volume", "mask", "integrate", "image"]) + kept;
        let phases = [("reading the scan", self.reading_bytes), ("rendering", rendering), ("writing", writing)];
        phases.into_iter().max_by_key(|(_, bytes)| *bytes).unwrap_or_default()
    }

    /// Bytes of the samples.
    pub fn volume_bytes(&self) -> u64 {
        self.stages.iter().filter(|stage| stage.name == "volume").map(|stage| stage.bytes).sum()
    }
}
