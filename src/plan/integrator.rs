//! Settings of the integrators, with their defaults.

use super::{
    Bound, Colors, Emission, Exact, Jitter, JitterKind, Lattice, March, Method, Order, Reflection, SampleRule, Table,
    VolumeInfo,
};
use crate::spec::{
    BoundName, ClassifyAtName, ColorsName, CompatibilityName, EmissionName, ExactSpec, IntegrateSpec, JitterKindName,
    JitterSpec, LatticeName, MarchSpec, OrderName, ReflectionName, RuleName, Spec, TableSpec,
};

/// Why measurements chose a method.
#[derive(Debug, Clone, PartialEq)]
pub struct Chosen {
    /// In a sentence.
    pub because: String,
    /// Error that was asked for, of a channel of a pixel, linear and premultiplied; `None` where a time was.
    pub tolerance: Option<f64>,
}

pub(super) fn resolve(spec: &Spec, volume: &VolumeInfo) -> Method {
    match &spec.pipeline.integrate {
        None => Method::Exact(exact(&ExactSpec::default())),
        Some(IntegrateSpec::Exact(settings)) => Method::Exact(exact(settings)),
        Some(IntegrateSpec::March(settings)) => Method::March(march(spec, settings, volume)),
        Some(IntegrateSpec::Reference) => Method::Reference,
        // What keeps the tolerance for certain, until something has been measured.
        Some(IntegrateSpec::Auto(settings)) => {
            Method::Exact(exact(&ExactSpec { tolerance: settings.tolerance, bound: None }))
        }
    }
}

/// One step of an 8-bit channel, unless told.
fn exact(spec: &ExactSpec) -> Exact {
    let bound = match spec.bound {
        None | Some(BoundName::Estimated) => Bound::Estimated,
        Some(BoundName::Proven) => Bound::Proven,
    };
    Exact { tolerance: spec.tolerance.unwrap_or(1.0 / 255.0), bound }
}

fn march(pipeline: &Spec, spec: &MarchSpec, volume: &VolumeInfo) -> March {
    let vtk = spec.compatibility == Some(CompatibilityName::Vtk);
    March {
        step_mm: spec.step_mm.unwrap_or(spec.step_voxels.unwrap_or(0.5) * volume.smallest_spacing_mm()),
        rule: match spec.rule {
            Some(RuleName::Left) => SampleRule::Left,
            None if vtk => SampleRule::WholeSteps,
            None | Some(RuleName::Midpoint) => SampleRule::Midpoint,
            Some(RuleName::Trapezoid) => SampleRule::Trapezoid,
            Some(RuleName::WholeSteps) => SampleRule::WholeSteps,
        },
        order: match spec.order {
            None | Some(OrderName::FrontToBack) => Order::FrontToBack,
            Some(OrderName::BackToFront) => Order::BackToFront,
        },
        colors: match spec.colors {
            None | Some(ColorsName::Associated) => Colors::Associated,
            Some(ColorsName::Straight) => Colors::Straight,
        },
        emission: match spec.emission {
            None | Some(EmissionName::PerLength) => Emission::PerLength,
            Some(EmissionName::PerSample) => Emission::PerSample,
        },
        lattice: match spec.lattice {
            None | Some(LatticeName::PerRay) => Lattice::PerRay,
            Some(LatticeName::ViewPlanes) => Lattice::ViewPlanes,
        },
        bisections: spec.bisections.unwrap_or(0),
        jitter: spec.jitter.as_ref().map(jitter),
        termination_transmittance: spec.termination_transmittance.unwrap_or(if vtk { VTK_TERMINATION } else { 0.0 }),
        table: match &spec.table {
            // A table is made for steps of one length.
            None if vtk && looks_up(pipeline) && matches!(spec.rule, None | Some(RuleName::WholeSteps)) => {
                Some(table(&TableSpec::default(), vtk))
            }
            None => None,
            Some(written) => Some(table(written, vtk)),
        },
        reflection: match spec.reflection {
            None if vtk => Reflection::VtkPhong,
            None | Some(ReflectionName::BlinnPhong) => Reflection::BlinnPhong,
            Some(ReflectionName::VtkPhong) => Reflection::VtkPhong,
        },
    }
}

/// Whether a march classifies samples by one transfer function, which a table can hold.
fn looks_up(spec: &Spec) -> bool {
    spec.pipeline.effects.as_ref().is_none_or(|effects| {
        effects.project.is_none()
            && effects.surfaces.is_none()
            && effects.mask.is_none()
            && effects.classify != Some(ClassifyAtName::Voxels)
    })
}

/// VTK's GPU mapper stops where the opacity is above 1 - 1/255.
const VTK_TERMINATION: f64 = 1.0 / 255.0;

/// VTK's GPU mapper corrects opacities above this for the step.
const VTK_UNCORRECTED: f64 = 1e-4;

fn table(spec: &TableSpec, vtk: bool) -> Table {
    Table {
        values: spec.values.unwrap_or(4096) as usize,
        gradients: spec.gradients.unwrap_or(1024) as usize,
        uncorrected_opacity: spec.uncorrected_opacity.unwrap_or(if vtk { VTK_UNCORRECTED } else { 0.0 }),
    }
}

fn jitter(spec: &JitterSpec) -> Jitter {
    let kind = match spec.kind {
        None | Some(JitterKindName::White) => JitterKind::White,
        Some(JitterKindName::LowDiscrepancy) => JitterKind::LowDiscrepancy,
    };
    Jitter { seed: spec.seed.unwrap_or(0), kind }
}
