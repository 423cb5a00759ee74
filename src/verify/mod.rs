//! Verification of the integrators by refinement, by the oracle and by identities: `pellucid verify`.
//!
//! A renderer is verified as Etiene et al. do it (*Verifying volume rendering using discretization error analysis*,
//! TVCG 2014): refine one discretisation at a time and see the error fall at the order that theory predicts, in the
//! largest norm, so that no pixel hides behind the others.
//!
//! | refined | expected order |
//! |---|---|
//! | step ([`steps`]) | 1 for the left rule, 2 for midpoint and trapezoid; 4 for Gauss collocation where nothing is bent |
//! | picture ([`pixels`]) | 1 with nearest-neighbour upsampling, 2 with bilinear |
//! | lattice ([`lattices`]) | none for samples of one trilinear field, 2 for any other smooth field |
//!
//! Knots of the transfer function and faces of cells cap every fixed step at order 2; only cutting rays there restores it.
//!
//! Orders say that an integrator converges, not to what; and a first-order rule hides a sample that is left out. So orders
//! are measured against the [oracle](crate::oracle), [`bounds`] hold the exact integrator to the error it promises, and
//! [`identities`] hold for any picture whatever its integrator. All checks take an integrator as a function, so that tests
//! can hand them broken ones. Where a definition itself is a model of something finer, what that costs is measured
//! ([`occlusion`]).

pub mod bounds;
mod fit;
mod gauss;
pub mod identities;
pub mod lattices;
mod manufactured;
pub mod occlusion;
pub mod pixels;
mod rays;
mod report;
pub mod steps;
mod subjects;

use crate::error::Result;
use crate::scene::Scene;
use crate::volume::Volume;

pub use fit::{largest_difference, order};
pub use gauss::{chord_mm, interpolate};
pub use report::{Check, Expected, Report};

/// An integrator with a step in mm: every pixel of a scene's picture, row by row from the top left, linear and
/// premultiplied, without the background. An integrator that needs no step ignores it.
pub type Integrator<'a> = dyn Fn(&Volume, &Scene, f64) -> Result<Vec<[f64; 4]>> + 'a;

/// All that is expected of an integrator with a fixed step: its order where the scene is smooth and where the transfer
/// function has a knot, what refining the lattice changes, and the identities.
///
/// # Errors
/// Whatever the integrator says.
pub fn of_marching(name: &str, orders: steps::Orders, integrator: &Integrator<'_>) -> Result<Vec<Check>> {
    let mut checks = steps::checks(name, orders, integrator)?;
    // A first-order rule is too far from the truth at any step that one would wait for.
    if orders.smooth >= 2.0 {
        checks.extend(lattices::checks(name, lattices::MARCHING, integrator)?);
        checks.extend(identities::checks(name, identities::MARCHING, integrator)?);
    }
    Ok(checks)
}

/// Verifies every integrator there is.
///
/// # Errors
/// Whatever an integrator says; a check that fails is no error but part of the report.
pub fn verify() -> Result<Report> {
    let mut checks = Vec::new();
    for (name, orders, rule) in subjects::RULES {
        checks.extend(of_marching(name, orders, &subjects::march(rule))?);
    }
    let fourth_order = steps::Orders { smooth: 4.0, with_knot: [1.2, 3.0], across_faces: [1.2, 3.0] };
    checks.extend(steps::checks("Gauss collocation", fourth_order, &gauss::render)?);
    checks.extend(identities::of_marching_variants()?);
    for (name, allowed, integrator) in subjects::without_step() {
        checks.extend(lattices::checks(name, allowed, &integrator)?);
        checks.extend(identities::checks(name, allowed, &integrator)?);
    }
    checks.extend(pixels::checks("exact/f64", &subjects::exact_enough)?);
    checks.extend(bounds::checks()?);
    checks.extend(occlusion::checks()?);
    Ok(Report { checks })
}
