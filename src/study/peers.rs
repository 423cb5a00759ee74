//! Other programs on the same scene, by the steps of the ladder.

use serde::Serialize;

use super::climb::LeftOut;
use super::clock::{Deadline, median};
use super::errors::Errors;
use super::ladder::STEPS;
use super::truth::Truth;
use crate::error::Result;
use crate::image::Image;

/// Most times that a step is measured.
const MOST_REPEATS: usize = 5;

/// How many times as long the next finer step may take, rather too much than too little.
const GROWTH: f64 = 2.2;

/// Another program that marches through the scene.
pub trait Peer {
    /// What charts and tables call it.
    fn name(&self) -> String;

    /// Its picture, linear and premultiplied, by samples this far apart, and the seconds of the frame without set-up.
    ///
    /// # Errors
    /// Those of the program.
    fn render(&mut self, step_mm: f64) -> Result<(Image, f64)>;
}

/// What a program took by a step, and how far from the truth it was.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PeerMeasurement {
    /// The program.
    pub peer: String,
    /// Distance between samples in units of the smallest spacing, as it is written.
    pub step_voxels: String,
    /// Median seconds of a frame.
    pub seconds: f64,
    /// How often it was measured.
    pub repeats: usize,
    /// Errors of the sampled pixels.
    pub errors: Errors,
}

/// Measures a program by steps from coarse to fine until the deadline, the coarsest in any case, and then all in turns.
pub(super) fn measure(
    peer: &mut dyn Peer,
    smallest_spacing_mm: f64,
    truth: &Truth,
    deadline: Deadline,
    progress: &dyn Fn(&str),
) -> Result<(Vec<PeerMeasurement>, Vec<LeftOut>)> {
    let name = peer.name();
    let (mut measured, mut times, mut left_out) = (Vec::new(), Vec::<Vec<f64>>::new(), Vec::new());
    for (written, voxels) in STEPS {
        let expected = times.last().map_or(0.0, |times| GROWTH * times[0]);
        let what = format!("{name}, step {written}");
        if expected > 0.0 && !deadline.allows(expected) {
            let why = format!("it would take about {expected:.1} s, and there was no time left");
            left_out.push(LeftOut { what, why });
            continue;
        }
        progress(&what);
        let (image, seconds) = peer.render(voxels * smallest_spacing_mm)?;
        let errors = truth.errors_of(&image);
        times.push(vec![seconds]);
        measured.push((
            voxels,
            PeerMeasurement { peer: name.clone(), step_voxels: written.to_owned(), seconds, repeats: 1, errors },
        ));
    }
    for _ in 1..MOST_REPEATS {
        for ((voxels, _), times) in measured.iter().zip(&mut times).filter(|(_, times)| deadline.allows(times[0])) {
            times.push(peer.render(voxels * smallest_spacing_mm)?.1);
        }
    }
    let with_medians = measured.into_iter().zip(times).map(|((_, m), times)| PeerMeasurement {
        seconds: median(&times),
        repeats: times.len(),
        ..m
    });
    Ok((with_medians.collect(), left_out))
}
