//! The method, where a pipeline leaves it to measurements (`integrate: auto`).

use super::measure::Stopwatch;
use super::{Options, memory};
use crate::error::Result;
use crate::plan::{Chosen, Plan, VolumeInfo};
use crate::spec::{AutoSpec, IntegrateSpec, Spec};
use crate::study::{Choice, Target, choose_method};
use crate::volume::Volume;

/// One step of an 8-bit channel.
const DEFAULT_TOLERANCE: f64 = 1.0 / 255.0;

/// What a pipeline wants of the method, if it names none.
pub(super) fn wanted(spec: &Spec) -> Option<Target> {
    let Some(IntegrateSpec::Auto(AutoSpec { tolerance, budget_ms })) = &spec.pipeline.integrate else { return None };
    Some(match budget_ms {
        Some(ms) => Target::Seconds(1e-3 * ms),
        None => Target::Tolerance(tolerance.unwrap_or(DEFAULT_TOLERANCE)),
    })
}

/// The plan by the method that measurements choose, and what they were; the plan as it is where the pipeline names a method.
/// `volume` has its classes, if the plan has a mask.
pub(super) fn settled(
    (spec, info): (&Spec, &VolumeInfo),
    volume: &Volume,
    plan: Plan,
    options: &Options,
    stopwatch: &mut Stopwatch<'_>,
) -> Result<(Plan, Option<Choice>)> {
    let Some(wanted) = wanted(spec) else { return Ok((plan, None)) };
    stopwatch.time("choose", || {
        let choice = choose_method(volume, &plan.scene, wanted, &|setting| tracing::info!(setting, "measured"))?;
        let tolerance = match wanted {
            Target::Tolerance(tolerance) => Some(tolerance),
            Target::Seconds(_) => None,
        };
        let because = format!("{}: {}", choice.rung.setting, choice.because);
        let chosen = Chosen { because, tolerance };
        let mut plan = Plan::measured(spec, info, options.output.as_deref(), choice.rung.method, chosen)?;
        plan.warnings.push(format!(
            "integrate: auto chose by times measured on this machine; for the same picture elsewhere, write integrate: {}",
            choice.rung.setting
        ));
        if !choice.met {
            plan.warnings.push("no setting is within integrate.auto.budget_ms; the quickest was taken".to_owned());
        }
        memory::check(&plan, options)?;
        Ok((plan, Some(choice)))
    })
}
