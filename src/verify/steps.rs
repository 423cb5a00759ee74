//! Refinement of the step, against the oracle.

use super::manufactured::{SIDE_MM, oblique, sampled, smooth, trilinear, with_knot};
use super::report::{Check, Expected};
use super::{Integrator, largest_difference};
use crate::error::Result;
use crate::oracle::Oracle;
use crate::scene::Scene;
use crate::volume::Volume;

/// Orders of convergence that are expected of an integrator with a fixed step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orders {
    /// In one cell, under a transfer function without knots; to within 0.1.
    pub smooth: f64,
    /// Lowest and highest with a knot: at most 2, and erratic beyond it.
    pub with_knot: [f64; 2],
    /// Lowest and highest across faces of cells: at most 2, and erratic beyond it.
    pub across_faces: [f64; 2],
}

impl Orders {
    /// Of a rule of second order or less: knots and faces do not matter.
    pub const fn plain(order: f64) -> Self {
        let about = [order - 0.25, order + 0.25];
        Orders { smooth: order, with_knot: about, across_faces: about }
    }
}

/// Pixels along a side.
const SIZE: usize = 16;

/// Steps across the cube where errors are well above rounding in f32.
const COARSE: [f64; 5] = [8.0, 16.0, 32.0, 64.0, 128.0];

/// Steps across the cube where all that is left is rounding.
const FINEST: f64 = 1024.0;

/// Largest error of the finest step; f32 accumulates 1024 roundings of 6e-8, 15 bits as many of 3e-5.
const FLOOR: f64 = 1e-5;

/// The order in the step, in one cell, with a knot and across faces; and for second order and above, the error at a step so
/// fine that only rounding is left.
///
/// # Errors
/// Whatever the integrator says.
pub fn checks(name: &str, orders: Orders, integrator: &Integrator<'_>) -> Result<Vec<Check>> {
    let cell = sampled(trilinear, 2)?;
    let cells = sampled(super::manufactured::wave, 5)?;
    let range = |[low, high]: [f64; 2]| Expected::Order { low, high };
    let mut checks = Vec::new();
    for (check, volume, function, expected) in [
        ("order in the step, smooth", &cell, smooth()?, Expected::order(orders.smooth, 0.1)),
        ("order in the step, with a knot", &cell, with_knot()?, range(orders.with_knot)),
        ("order in the step, across faces", &cells, smooth()?, range(orders.across_faces)),
    ] {
        let errors = errors(volume, &oblique(function, SIZE)?, &COARSE, integrator)?;
        checks.push(Check::order(name, check, expected, errors));
    }
    if orders.smooth >= 2.0 {
        let finest = errors(&cell, &oblique(smooth()?, SIZE)?, &[FINEST], integrator)?;
        checks.push(Check::error(name, "error at 1/1024 of the cube", FLOOR, finest[0][1]));
    }
    Ok(checks)
}

/// Pairs of step (mm) and largest error.
fn errors(volume: &Volume, scene: &Scene, per_side: &[f64], integrator: &Integrator<'_>) -> Result<Vec<[f64; 2]>> {
    let truth = Oracle::new(volume, scene).render(|_| ());
    let error = |n: &f64| {
        let step_mm = SIDE_MM / n;
        Ok([step_mm, largest_difference(&integrator(volume, scene, step_mm)?, &truth)])
    };
    per_side.iter().map(error).collect()
}
