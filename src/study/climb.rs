//! The ladder, measured: every setting once, from coarse to fine, and then in turns as often as time allows.

use std::collections::HashMap;

use serde::Serialize;

use super::clock::{Deadline, median};
use super::errors::Errors;
use super::ladder::{Family, Rung};
use super::trial::{Trial, reason_to_leave_out};
use super::truth::Truth;
use crate::error::Result;
use crate::image::Image;
use crate::plan::Method;
use crate::scene::Scene;
use crate::volume::Volume;

/// Most times that a setting is measured.
const MOST_REPEATS: usize = 9;

/// What a setting took and how far from the truth it was.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measurement {
    /// The setting.
    #[serde(flatten)]
    pub rung: Rung,
    /// Median seconds of a picture.
    pub seconds: f64,
    /// How often it was measured.
    pub repeats: usize,
    /// Places where the transfer function was evaluated, or pieces integrated.
    pub samples: u64,
    /// Errors of the sampled pixels.
    pub errors: Errors,
    /// Largest bound that the method proved, where it proves one.
    pub error_bound: Option<f64>,
}

/// What was not measured.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// The setting or the choice.
    pub what: String,
    /// Why.
    pub why: String,
}

/// What came out.
pub(super) struct Climb {
    pub(super) measured: Vec<Measurement>,
    pub(super) left_out: Vec<LeftOut>,
    /// The picture of the smallest tolerance, the best stand-in for the truth where every pixel is needed.
    pub(super) finest: Option<(Rung, Image)>,
}

/// Measures the settings until the deadline; one that is unlikely to be done by then is left out, and the finer ones of its
/// family with it.
pub(super) fn climb(
    (volume, scene): (&Volume, &Scene),
    rungs: Vec<Rung>,
    truth: &Truth,
    deadline: Deadline,
    progress: &dyn Fn(&str),
) -> Result<Climb> {
    let mut climb = Climb { measured: Vec::new(), left_out: Vec::new(), finest: None };
    let mut expected: HashMap<Family, f64> = HashMap::new();
    for rung in rungs {
        let seconds = expected.get(&rung.family).copied().unwrap_or(0.0);
        if seconds > 0.0 && !deadline.allows(seconds) {
            let why = format!("it would take about {seconds:.1} s, and there was no time left");
            climb.left_out.push(LeftOut { what: rung.setting, why });
            continue;
        }
        progress(&rung.setting);
        match Trial::new(volume, scene, rung.method).run() {
            Err(error) => {
                climb.left_out.push(LeftOut { what: rung.setting, why: reason_to_leave_out(error)? });
            }
            Ok((rendered, seconds)) => {
                expected.insert(rung.family, seconds * rung.family.growth());
                if is_finer(&rung, climb.finest.as_ref().map(|(rung, _)| rung)) {
                    climb.finest = Some((rung.clone(), rendered.image.clone()));
                }
                climb.measured.push(Measurement {
                    seconds,
                    repeats: 1,
                    samples: rendered.statistics.samples,
                    errors: truth.errors_of(&rendered.image),
                    error_bound: rendered.statistics.error_bound,
                    rung,
                });
            }
        }
    }
    repeat((volume, scene), &mut climb.measured, deadline, progress)?;
    Ok(climb)
}

/// Measures in turns, so that a machine that is busy for a while is so for all.
fn repeat(
    (volume, scene): (&Volume, &Scene),
    measured: &mut [Measurement],
    deadline: Deadline,
    progress: &dyn Fn(&str),
) -> Result<()> {
    let mut seconds: Vec<Vec<f64>> = measured.iter().map(|m| vec![m.seconds]).collect();
    for _ in 1..MOST_REPEATS {
        for (m, seconds) in measured.iter().zip(&mut seconds).filter(|(m, _)| deadline.allows(m.seconds)) {
            progress(&m.rung.setting);
            seconds.push(Trial::new(volume, scene, m.rung.method).run()?.1);
        }
    }
    for (m, seconds) in measured.iter_mut().zip(&seconds) {
        (m.seconds, m.repeats) = (median(seconds), seconds.len());
    }
    Ok(())
}

fn is_finer(rung: &Rung, than: Option<&Rung>) -> bool {
    let tolerance = |rung: &Rung| match rung.method {
        Method::Exact(exact) => exact.tolerance,
        _ => f64::INFINITY,
    };
    tolerance(rung) < than.map_or(f64::INFINITY, tolerance)
}
