//! A scalar field, classified and shaded many samples at a time.

use super::composite::{EMPTY, Run};
use super::medium::Medium;
use crate::classify::LaneClassifier;
use crate::field::{Batch, Cells, GradientUnits, Magnitude, Trilinear, Voxel};
use crate::integrate::shade::{Course, LaneShader};
use crate::simd::{Lanes, Pairs};

/// What [`Classified`](super::Classified) is, to the bit, on even slices and with one transfer function everywhere.
pub(in super::super) struct ByLanes<'a, V, C, S> {
    pub(in super::super) field: Trilinear<'a, V>,
    /// The gradient magnitude, HU/mm; there if the transfer function reads it.
    pub(in super::super) magnitude: Option<Magnitude<'a>>,
    pub(in super::super) units: GradientUnits,
    pub(in super::super) classifier: &'a C,
    pub(in super::super) shader: &'a S,
}

impl<V: Voxel + Pairs, C: LaneClassifier, S: LaneShader> Medium for ByLanes<'_, V, C, S> {
    type Aim = S::Aim;
    const BY_LANES: bool = true;

    fn aim(&self, course: &Course, aim: &mut S::Aim) {
        self.shader.aim(course, aim);
    }

    #[inline(always)]
    fn run<L: Lanes>(&self, aim: &S::Aim, batch: &Batch<'_>, _: impl Fn(usize) -> f64) -> Option<Run> {
        let mut run = EMPTY;
        let mut any = false;
        let inside = S::SHADES && !self.field.meets_border(batch);
        for at in (0..batch.samples).step_by(L::LANES) {
            let cells = self.field.cells::<L>(batch, at);
            let gradients =
                || if inside { self.field.gradients(&cells) } else { self.field.gradients_at_border(&cells) };
            let samples = self.shaded(aim, &cells, self.field.values(&cells), gradients);
            if let Some(samples) = samples {
                any = true;
                for c in 0..4 {
                    samples[c].store(&mut run[c][at..]);
                }
            }
        }
        if any && batch.samples < Batch::MOST {
            run.iter_mut().for_each(|all| all[batch.samples..].fill(0.0));
        }
        any.then_some(run)
    }
}

impl<V: Voxel + Pairs, C: LaneClassifier, S: LaneShader> ByLanes<'_, V, C, S> {
    /// Emission and extinction where these values are; `None` if there is nothing in any lane.
    #[inline(always)]
    fn shaded<L: Lanes>(
        &self,
        aim: &S::Aim,
        cells: &Cells<L>,
        values: L,
        gradients_per_index: impl FnOnce() -> [L; 3],
    ) -> Option<[L; 4]> {
        let magnitude = || self.magnitude.as_ref().map_or(L::ZERO, |magnitude| magnitude.values(cells));
        let mut optics = self.classifier.classify_lanes(values, magnitude)?;
        for component in &mut optics {
            // Rounding may leave a trace below 0 at the foot of a ramp.
            *component = component.max(L::ZERO);
        }
        Some(if S::SHADES {
            self.shader.shade_lanes(aim, optics, self.units.per_mm(gradients_per_index()))
        } else {
            optics
        })
    }
}
