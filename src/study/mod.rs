//! What accuracy costs in time: settings measured on one scene, against the oracle.
//!
//! [`study`] renders a scene by a [`ladder()`] of settings and by pairs that differ in one choice. The oracle's pixels are the
//! costly part: they are computed once for all settings, by a share of the time. Of each picture the errors on these pixels
//! are kept, and the median of the seconds that it took; settings take turns, so that whatever else the machine does
//! falls on all of them.
//!
//! [`choose_method`] does the same in small, where a pipeline leaves the method to measurements. The choice itself,
//! [`choose()`], is a function of the numbers alone.
//!
//! Errors are those of a channel of a pixel, linear and premultiplied. Seconds are wall-clock time of a frame with all that
//! it needs but the volume in memory.

mod auto;
mod choose;
mod climb;
mod clock;
mod costs;
mod errors;
mod front;
mod ladder;
mod peers;
mod report;
mod trial;
mod truth;
mod variants;

use std::time::Duration;

use serde::Serialize;

pub use auto::{Choice, choose_method};
pub use choose::{Candidate, Chosen, Target, choose};
pub use climb::{LeftOut, Measurement};
pub use costs::Cost;
pub use errors::{Errors, difference, share_unseen};
pub use front::pareto_front;
pub use ladder::{Family, Rung, exact, ladder};
pub use peers::{Peer, PeerMeasurement};
pub use report::Report;

use crate::error::Result;
use crate::image::{Image, figure};
use crate::plan::{Exact, Method};
use crate::scene::Scene;
use crate::volume::Volume;
use clock::Deadline;
use trial::{Trial, one_thread};
use truth::Truth;

/// Shares of the time: the oracle's of all of it, then that of the ladder and that of the choices of what is left.
const ORACLE_SHARE: f64 = 0.25;
const LADDER_SHARE: f64 = 0.6;

/// Share that other programs take of what the ladder leaves, each.
const PEER_SHARE: f64 = 0.4;

/// How much is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Time for all of it. The first picture of each kind is finished however long it takes.
    pub time: Duration,
    /// The error that one wants to stay below: a line in the chart, full scale of the maps, and the tolerance of `exact` where
    /// choices are measured. Above 0 and below 1.
    pub tolerance: f64,
    /// Most pixels that the oracle computes.
    pub pixels: usize,
    /// Whether a copy of the volume with samples of 32 bits fits into memory.
    pub room_for_f32: bool,
}

/// Told what is measured now, and the share of the time that is over, 0 to 1.
pub type Progress<'a> = &'a (dyn Fn(&str, f64) + Sync);

/// What was measured.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Study {
    /// Width and height of the pictures.
    pub size: [usize; 2],
    /// Threads that rendered.
    pub threads: usize,
    /// The error that one wants to stay below.
    pub tolerance: f64,
    /// How many pixels were held against the oracle.
    pub oracle_pixels: usize,
    /// The settings, in the order of the ladder.
    pub settings: Vec<Measurement>,
    /// Other programs.
    pub peers: Vec<PeerMeasurement>,
    /// Indices of the settings that no other beats in both time and largest error, by time.
    pub front: Vec<usize>,
    /// What each choice costs.
    pub costs: Vec<Cost>,
    /// What was not measured, and why.
    pub left_out: Vec<LeftOut>,
    /// Errors of all pixels of three settings.
    #[serde(skip)]
    pub maps: Vec<ErrorMap>,
}

/// Where in the picture the errors of a setting are.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorMap {
    /// The setting.
    pub rung: Rung,
    /// In place of the oracle, which would take too long for every pixel: the exact integrator at this tolerance.
    pub against: f64,
    /// The map, with a bar that says which colour is how much.
    pub figure: Image,
}

/// Measures the ladder, other programs and the choices on a scene.
///
/// # Errors
/// Those of the integrators, but for settings that do not apply to the scene: these are left out. Those of other programs.
pub fn study(
    volume: &Volume,
    scene: &Scene,
    settings: &Settings,
    peers: &mut [Box<dyn Peer>],
    progress: Progress<'_>,
) -> Result<Study> {
    let deadline = Deadline::after(settings.time);
    let tell = |what: &str| {
        let left = deadline.left().as_secs_f64() / settings.time.as_secs_f64().max(1e-9);
        progress(what, 1.0 - left.clamp(0.0, 1.0));
    };
    tell("the oracle");
    let truth = Truth::measure(volume, scene, settings.pixels, deadline.share(ORACLE_SHARE));
    let mut rungs = ladder(volume.grid().spacing_mm().min_element());
    let asked = exact(settings.tolerance);
    if rungs.iter().all(|rung| rung.method != asked.method) {
        rungs.insert(0, asked);
    }
    let climbed = climb::climb((volume, scene), rungs, &truth, deadline.share(LADDER_SHARE), &tell)?;
    let mut left_out = climbed.left_out;
    let mut of_peers = Vec::new();
    for peer in peers {
        let spacing_mm = volume.grid().spacing_mm().min_element();
        let (measured, too_late) =
            peers::measure(peer.as_mut(), spacing_mm, &truth, deadline.share(PEER_SHARE), &tell)?;
        of_peers.extend(measured);
        left_out.extend(too_late);
    }
    let points: Vec<[f64; 2]> = climbed.measured.iter().map(|m| [m.seconds, m.errors.largest]).collect();
    let volume_f32 = if settings.room_for_f32 { variants::as_f32(volume)? } else { None };
    let single = one_thread()?;
    let by = (settings.tolerance, &single);
    let (costs, too_late) = costs::costs((volume, scene), volume_f32.as_ref(), by, &truth, deadline, &tell)?;
    left_out.extend(too_late);
    tell("maps of errors");
    let maps = maps((volume, scene), &climbed.measured, climbed.finest, settings.tolerance)?;
    Ok(Study {
        size: scene.camera.size(),
        threads: rayon::current_num_threads(),
        tolerance: settings.tolerance,
        oracle_pixels: truth.len(),
        front: pareto_front(&points),
        settings: climbed.measured,
        peers: of_peers,
        costs,
        left_out,
        maps,
    })
}

/// Maps of a coarse march, of the most accurate one, and of the exact integrator, as far as they were measured.
fn maps(
    (volume, scene): (&Volume, &Scene),
    measured: &[Measurement],
    finest: Option<(Rung, Image)>,
    tolerance: f64,
) -> Result<Vec<ErrorMap>> {
    let Some((finest, truth)) = finest else { return Ok(Vec::new()) };
    let Method::Exact(Exact { tolerance: against, .. }) = finest.method else { return Ok(Vec::new()) };
    let marches = || measured.iter().filter(|m| m.rung.family == Family::Midpoint);
    let one_voxel = marches().nth(2).or(marches().next_back());
    let best = marches().min_by(|a, b| a.errors.largest.total_cmp(&b.errors.largest));
    let asked = measured.iter().find(|m| m.rung.method == variants::exact(tolerance));
    let mut rungs: Vec<&Rung> = [one_voxel, best, asked].into_iter().flatten().map(|m| &m.rung).collect();
    rungs.dedup();
    let map = |rung: &Rung| {
        let (rendered, _) = Trial::new(volume, scene, rung.method).run()?;
        let figure = figure::difference_map(&truth, &rendered.image, tolerance);
        Ok(ErrorMap { rung: rung.clone(), against, figure })
    };
    rungs.into_iter().map(map).collect()
}
