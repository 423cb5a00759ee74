//! Settings of the integrators, with their defaults.

use super::{Colors, Emission, Exact, Jitter, JitterKind, Lattice, March, Method, Order, SampleRule, VolumeInfo};
use crate::spec::{
    ColorsName, EmissionName, IntegrateSpec, JitterKindName, JitterSpec, LatticeName, MarchSpec, OrderName, RuleName,
    Spec,
};

pub(super) fn resolve(spec: &Spec, volume: &VolumeInfo) -> Method {
    match &spec.pipeline.integrate {
        None => Method::Exact(exact(None)),
        Some(IntegrateSpec::Exact(settings)) => Method::Exact(exact(settings.tolerance)),
        Some(IntegrateSpec::March(settings)) => Method::March(march(settings, volume)),
        Some(IntegrateSpec::Reference) => Method::Reference,
    }
}

/// One step of an 8-bit channel, unless told.
fn exact(tolerance: Option<f64>) -> Exact {
    Exact { tolerance: tolerance.unwrap_or(1.0 / 255.0) }
}

fn march(spec: &MarchSpec, volume: &VolumeInfo) -> March {
    March {
        step_mm: spec.step_mm.unwrap_or(spec.step_voxels.unwrap_or(0.5) * volume.smallest_spacing_mm()),
        rule: match spec.rule {
            Some(RuleName::Left) => SampleRule::Left,
            None | Some(RuleName::Midpoint) => SampleRule::Midpoint,
            Some(RuleName::Trapezoid) => SampleRule::Trapezoid,
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
        termination_transmittance: spec.termination_transmittance.unwrap_or(0.0),
    }
}

fn jitter(spec: &JitterSpec) -> Jitter {
    let kind = match spec.kind {
        None | Some(JitterKindName::White) => JitterKind::White,
        Some(JitterKindName::LowDiscrepancy) => JitterKind::LowDiscrepancy,
    };
    Jitter { seed: spec.seed.unwrap_or(0), kind }
}
