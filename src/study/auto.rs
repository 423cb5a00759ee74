//! The method where a pipeline leaves it to measurements.
//!
//! Settings are tried on small pictures of the same view, of two sizes: what a frame costs before its first ray, and what a
//! ray costs, are told apart by them, and give the seconds of the whole picture. Errors are those of random pixels of the
//! larger one, held against the oracle. They are a sample of the picture's rays and bound nothing, unlike the tolerance
//! of the exact integrator: so a setting without that bound is within a tolerance only if the sample's errors are within
//! half of it. Which setting is chosen depends on the machine and on what else it does.

use std::collections::HashMap;
use std::time::Duration;

use serde::Serialize;

use super::choose::{Candidate, Chosen, Target, choose};
use super::clock::Deadline;
use super::errors::share_unseen;
use super::ladder::{Family, Rung, exact, ladder};
use super::trial::{Trial, reason_to_leave_out};
use super::truth::Truth;
use crate::error::{Error, Fault, Result};
use crate::integrate::Rendered;
use crate::scene::Scene;
use crate::volume::Volume;

/// Most time for all measurements, and the share of it that the oracle takes.
const MOST_TIME: Duration = Duration::from_secs(6);
const ORACLE_SHARE: f64 = 0.4;

/// Most pixels of the larger of the two pictures; the other has a quarter.
const MOST_PIXELS: f64 = 16_384.0;

/// Most pixels that the oracle computes.
const MOST_SAMPLES: usize = 1000;

/// Chance that what is said about the pixels that were not sampled is wrong.
const RISK: f64 = 0.05;

/// A method that was chosen, and why.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// The setting, whose method is resolved.
    #[serde(flatten)]
    pub rung: Rung,
    /// What was wanted.
    pub wanted: Target,
    /// Why this one, in a sentence.
    pub because: String,
    /// Whether it is as wanted; if not, nothing that was measured is.
    pub met: bool,
    /// How many random pixels were held against the oracle.
    pub pixels: usize,
    /// What was measured, with the seconds that the whole picture is expected to take.
    pub candidates: Vec<Candidate>,
}

/// Measures settings on the scene and chooses among them.
///
/// # Errors
/// `Fault::Unsupported` where no setting can render the scene, and those of the integrators.
pub fn choose_method(volume: &Volume, scene: &Scene, wanted: Target, progress: &dyn Fn(&str)) -> Result<Choice> {
    let deadline = Deadline::after(MOST_TIME);
    let [small, large] = [0.25, 1.0].map(|share| of_at_most(scene, share * MOST_PIXELS));
    progress("the oracle");
    let truth = Truth::measure(volume, &large, MOST_SAMPLES, deadline.share(ORACLE_SHARE));
    let mut candidates = Vec::new();
    let mut spent: HashMap<Family, f64> = HashMap::new();
    for rung in rungs(volume, wanted) {
        let expected = spent.get(&rung.family).map_or(0.0, |seconds| seconds * rung.family.growth());
        if !candidates.is_empty() && !deadline.allows(expected) {
            continue;
        }
        progress(&rung.setting);
        let trials = [&small, &large].map(|scene| quicker_of_two(&Trial::new(volume, scene, rung.method)));
        let [(_, small_seconds), (rendered, large_seconds)] = match trials {
            [Ok(small), Ok(large)] => [small, large],
            [Err(error), _] | [_, Err(error)] => {
                tracing::debug!(setting = rung.setting, reason = reason_to_leave_out(error)?, "not tried");
                continue;
            }
        };
        spent.insert(rung.family, 2.0 * (small_seconds + large_seconds));
        let measured = [(pixels(&small), small_seconds), (pixels(&large), large_seconds)];
        let seconds = seconds_of(pixels(scene), measured);
        let largest_error = truth.errors_of(&rendered.image).largest;
        candidates.push(Candidate { rung, seconds, largest_error });
    }
    let chosen = choose(&candidates, wanted).ok_or_else(|| {
        Error::new(Fault::Unsupported, "no setting of integrate: auto can render this").element("integrate.auto")
    })?;
    let because = because(&chosen, wanted, candidates.len(), truth.len());
    let (rung, met) = (chosen.rung().clone(), !matches!(chosen, Chosen::Quickest(_)));
    Ok(Choice { rung, wanted, because, met, pixels: truth.len(), candidates })
}

/// The picture and its seconds, without what disturbed only one of two runs.
fn quicker_of_two(trial: &Trial<'_>) -> Result<(Rendered, f64)> {
    let (rendered, first) = trial.run()?;
    Ok((rendered, trial.run()?.1.min(first)))
}

/// The ladder; for a tolerance, the exact integrator at that tolerance comes first, since it is sure to keep it.
fn rungs(volume: &Volume, wanted: Target) -> Vec<Rung> {
    let ladder = ladder(volume.grid().spacing_mm().min_element());
    let asked = match wanted {
        Target::Tolerance(tolerance) => Some(exact(tolerance)),
        Target::Seconds(_) => None,
    };
    let others = ladder.into_iter().filter(|rung| asked.as_ref().is_none_or(|asked| asked.method != rung.method));
    asked.clone().into_iter().chain(others).collect()
}

/// The same view in a picture of at most so many pixels.
fn of_at_most(scene: &Scene, most: f64) -> Scene {
    let shrink = (most / pixels(scene) as f64).sqrt().min(1.0);
    let size = scene.camera.size().map(|n| ((n as f64 * shrink) as usize).max(1));
    Scene { camera: scene.camera.with_size(size), ..scene.clone() }
}

fn pixels(scene: &Scene) -> usize {
    scene.camera.size().iter().product()
}

/// Seconds of a picture of `pixels` by those of two smaller ones: so much per frame and so much per pixel, neither below 0.
fn seconds_of(pixels: usize, [(small, small_seconds), (large, large_seconds)]: [(usize, f64); 2]) -> f64 {
    if large <= small {
        return large_seconds * pixels as f64 / large.max(1) as f64;
    }
    let per_pixel = (large_seconds - small_seconds) / (large - small) as f64;
    let per_pixel = per_pixel.clamp(0.0, large_seconds / large as f64);
    large_seconds + per_pixel * pixels.saturating_sub(large) as f64
}

fn because(chosen: &Chosen<'_>, wanted: Target, settings: usize, pixels: usize) -> String {
    let numbers = |c: &Candidate| format!("largest error {:.1e}, about {:.2} s", c.largest_error, c.seconds);
    match (chosen, wanted) {
        (Chosen::Meets(c), Target::Tolerance(most)) if c.room(most) < most => format!(
            "the quickest of {settings} settings measured that kept half of {most:.3e} on {pixels} random pixels, so at {:.0} % \
             confidence fewer than {:.2} % of all are above that half (no bound is proven): {}",
            100.0 * (1.0 - RISK),
            100.0 * share_unseen(pixels, RISK),
            numbers(c)
        ),
        (Chosen::Meets(c), Target::Tolerance(most)) => format!(
            "the quickest of {settings} settings measured, within {most:.3e} at every pixel by its bound; on {pixels} random \
             pixels: {}",
            numbers(c)
        ),
        (Chosen::Meets(c), Target::Seconds(most)) => format!(
            "the most accurate of {settings} settings measured within {most:.3} s, on {pixels} random pixels: {}",
            numbers(c)
        ),
        (Chosen::Proven(_), _) => {
            format!(
                "none of {settings} settings measured kept the tolerance on {pixels} random pixels; this one proves it"
            )
        }
        (Chosen::Quickest(c), _) => {
            format!("none of {settings} settings measured is within the time; this is the quickest: {}", numbers(c))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_and_its_pixels_are_told_apart() {
        // Half a second per frame, a millisecond per pixel.
        let found = seconds_of(10_000, [(100, 0.6), (400, 0.9)]);
        assert!((found - 10.5).abs() < 1e-9, "found {found}, expected 10.5");
        assert_eq!(seconds_of(400, [(100, 0.6), (400, 0.9)]), 0.9, "the larger picture is the whole one");
    }

    #[test]
    fn what_a_march_kept_on_a_sample_is_said_with_what_follows_for_all_pixels() {
        let said = |rung: Rung| {
            let candidate = Candidate { rung, seconds: 0.5, largest_error: 1e-3 };
            because(&Chosen::Meets(&candidate), Target::Tolerance(4e-3), 7, 1000)
        };
        let march = said(ladder(1.0)[0].clone());
        assert!(march.contains("half of 4.000e-3") && march.contains("fewer than 0.30 %"), "found {march}");
        let proven = said(exact(1e-3));
        assert!(proven.contains("every pixel by its bound"), "found {proven}");
    }

    #[test]
    fn a_disturbed_measurement_gives_neither_less_than_was_measured_nor_more_than_a_share_for_each_pixel() {
        assert_eq!(seconds_of(4000, [(100, 2.0), (400, 1.0)]), 1.0, "the smaller took longer: no time per pixel");
        assert_eq!(seconds_of(4000, [(100, 0.0), (400, 1.0)]), 10.0, "no more than in proportion");
        assert_eq!(seconds_of(2, [(1, 1.0), (1, 1.0)]), 2.0, "two pictures of one size");
    }
}
