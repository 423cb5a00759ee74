//! What each choice costs: two pictures that differ in nothing else, rendered in turns.

use rayon::ThreadPool;
use serde::Serialize;

use super::climb::LeftOut;
use super::clock::{Deadline, median};
use super::errors::Errors;
use super::trial::{Trial, reason_to_leave_out};
use super::truth::Truth;
use super::variants;
use crate::error::Result;
use crate::image::Image;
use crate::integrate::Schedule;
use crate::plan::{Exact, ExactKernel, Jitter, JitterKind, March, Method, SampleRule};
use crate::scene::{ClassifyAt, Model, Scene};
use crate::volume::Volume;

/// How choices are rendered: each that both can do, by both.
const MARCH: &str = "march at 1/2 voxel";
const EXACT: &str = "exact";

/// Most rounds of the two.
const MOST_ROUNDS: usize = 9;

/// Pixels of the oracle for a scene that is not the one under study.
const VARIANT_PIXELS: usize = 200;

/// The share of a choice's time that its oracle takes.
const ORACLE_SHARE: f64 = 0.4;

/// What a choice costs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cost {
    /// The choice, such as `shading`.
    pub choice: String,
    /// How everything else was rendered.
    pub by: String,
    /// Median seconds without it and with it.
    pub seconds: [f64; 2],
    /// Median over the rounds of its time with it by that without it.
    pub time_ratio: f64,
    /// Rounds.
    pub rounds: usize,
    /// Errors without it and with it, each against the truth about its own scene.
    pub errors: [Errors; 2],
}

/// One side of a choice.
struct Side<'a> {
    volume: &'a Volume,
    scene: Scene,
    method: Method,
    schedule: Schedule,
    threads: Option<&'a ThreadPool>,
}

/// A choice, without it and with it.
struct Choice<'a> {
    name: &'static str,
    by: &'static str,
    sides: [Side<'a>; 2],
}

/// Measures all choices that apply to the scene; `volume_f32` is the volume with its samples as floats, where they are not.
pub(super) fn costs(
    (volume, scene): (&Volume, &Scene),
    volume_f32: Option<&Volume>,
    (tolerance, one_thread): (f64, &ThreadPool),
    truth: &Truth,
    deadline: Deadline,
    progress: &dyn Fn(&str),
) -> Result<(Vec<Cost>, Vec<LeftOut>)> {
    let choices = choices((volume, scene), volume_f32, tolerance, one_thread)?;
    let (mut costs, mut left_out) = (Vec::new(), Vec::new());
    let count = choices.len();
    for (place, choice) in choices.into_iter().enumerate() {
        let what = format!("{}, {}", choice.name, choice.by);
        if deadline.left().is_zero() {
            left_out.push(LeftOut { what, why: "there was no time left".to_owned() });
            continue;
        }
        progress(&what);
        let deadline = deadline.share(1.0 / (count - place) as f64);
        match cost(&choice, (scene, truth), deadline) {
            Ok(cost) => costs.push(cost),
            Err(error) => left_out.push(LeftOut { what, why: reason_to_leave_out(error)? }),
        }
    }
    Ok((costs, left_out))
}

fn choices<'a>(
    (volume, scene): (&'a Volume, &Scene),
    volume_f32: Option<&'a Volume>,
    tolerance: f64,
    one_thread: &'a ThreadPool,
) -> Result<Vec<Choice<'a>>> {
    let march = March::plain(SampleRule::Midpoint, 0.5 * volume.grid().spacing_mm().min_element());
    let side =
        |method: Method| Side { volume, scene: scene.clone(), method, schedule: Schedule::default(), threads: None };
    let methods = [(MARCH, Method::March(march)), (EXACT, variants::exact(tolerance))];
    let mut choices = of_the_march(march, side);
    choices.extend(of_the_exact((volume, scene), tolerance, side));
    for (by, method) in methods {
        let mut add = |name, without, with| choices.push(Choice { name, by, sides: [without, with] });
        if let Some([unlit, lit]) = variants::by_shading(volume, scene) {
            add("shading", Side { scene: unlit, ..side(method) }, Side { scene: lit, ..side(method) });
        }
        if let Some([one, two]) = variants::by_dimensions(volume, scene)? {
            let name = "2D instead of 1D transfer function";
            add(name, Side { scene: one, ..side(method) }, Side { scene: two, ..side(method) });
        }
        if let Some(volume_f32) = volume_f32 {
            add("f32 instead of 16-bit samples", side(method), Side { volume: volume_f32, ..side(method) });
        }
        let half = variants::at_half_size(scene);
        add("twice the width and height", Side { scene: half, ..side(method) }, side(method));
        let single = Side { threads: Some(one_thread), ..side(method) };
        add("all threads instead of one", single, side(method));
    }
    // Last, since classifying all voxels takes longer than all else where there are many.
    if scene.effects.classify == ClassifyAt::Samples && volume.rgba_encoding().is_none() {
        for (by, method) in methods {
            let at_voxels = Side { scene: variants::classified_at_voxels(scene), ..side(method) };
            choices.push(Choice { name: "classification before interpolation", by, sides: [side(method), at_voxels] });
        }
    }
    Ok(choices)
}

/// What only the march can do with or without.
fn of_the_march<'a>(march: March, side: impl Fn(Method) -> Side<'a>) -> Vec<Choice<'a>> {
    let marching = |march: March| side(Method::March(march));
    let choice = |name, without, with| Choice { name, by: MARCH, sides: [without, with] };
    let jittered = March { jitter: Some(Jitter { seed: 0, kind: JitterKind::White }), ..march };
    let terminated = March { termination_transmittance: 1.0 / 255.0, ..march };
    let plodding = Schedule { empty_space_skipping: false, ..Schedule::default() };
    vec![
        choice("jitter", marching(march), marching(jittered)),
        choice("early termination at 1/255", marching(march), marching(terminated)),
        choice("empty-space skipping", Side { schedule: plodding, ..marching(march) }, marching(march)),
    ]
}

/// What the exact integrator passes over: its bound holds with and without.
fn of_the_exact<'a>(
    (volume, scene): (&Volume, &Scene),
    tolerance: f64,
    side: impl Fn(Method) -> Side<'a>,
) -> Vec<Choice<'a>> {
    let method = variants::exact(tolerance);
    let choice =
        |name, without| Choice { name, by: EXACT, sides: [Side { schedule: without, ..side(method) }, side(method)] };
    let to_the_end = Schedule { early_termination: false, ..Schedule::default() };
    let plodding = Schedule { empty_space_skipping: false, ..Schedule::default() };
    let has_macrocells =
        matches!(ExactKernel::of(scene, volume, &Exact::within(tolerance)), ExactKernel::InRegisters(_));
    let ends = (scene.model == Model::Light).then(|| choice("early termination within the bound", to_the_end));
    let skips = has_macrocells.then(|| choice("empty-space skipping", plodding));
    ends.into_iter().chain(skips).collect()
}

/// Renders both sides in turns, the first of a round first in the next one last, and at least once.
fn cost(choice: &Choice<'_>, (scene, truth): (&Scene, &Truth), deadline: Deadline) -> Result<Cost> {
    let trials = choice.sides.each_ref().map(|side| Trial {
        schedule: side.schedule,
        threads: side.threads,
        ..Trial::new(side.volume, &side.scene, side.method)
    });
    let mut seconds: [Vec<f64>; 2] = Default::default();
    let mut pictures: [Option<Image>; 2] = [None, None];
    let oracle_time = deadline.share(ORACLE_SHARE);
    let truths = choice.sides.each_ref().map(|side| {
        let own = || Truth::measure(side.volume, &side.scene, VARIANT_PIXELS, oracle_time.share(0.5));
        (side.scene != *scene).then(own)
    });
    for round in 0..MOST_ROUNDS {
        if round > 0 && !deadline.allows(median(&seconds[0]) + median(&seconds[1])) {
            break;
        }
        for turn in 0..2 {
            let place = (round + turn) % 2;
            let (rendered, took) = trials[place].run()?;
            seconds[place].push(took);
            pictures[place].get_or_insert(rendered.image);
        }
    }
    let errors = [0, 1].map(|place| {
        let truth = truths[place].as_ref().unwrap_or(truth);
        pictures[place].as_ref().map_or_else(|| Errors::of(Vec::new()), |picture| truth.errors_of(picture))
    });
    let ratios: Vec<f64> = seconds[0].iter().zip(&seconds[1]).map(|(without, with)| with / without).collect();
    Ok(Cost {
        choice: choice.name.to_owned(),
        by: choice.by.to_owned(),
        seconds: seconds.each_ref().map(|seconds| median(seconds)),
        time_ratio: median(&ratios),
        rounds: ratios.len(),
        errors,
    })
}
