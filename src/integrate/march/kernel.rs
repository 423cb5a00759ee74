//! The loop over the samples of a ray.
//!
//! A ray's samples are counted from its first one, and sixteen of them are a batch. Where a sample is, and in which order the
//! light of a batch is summed, depends on nothing but its number: neither on the registers of the machine nor on what is leapt
//! over. What is leapt over is whole batches; of one in which anything may be seen all samples are taken.

use super::composite::{self, EMPTY, Fold, Light};
use super::lattice::Stretch;
use super::medium::Medium;
use super::sampling::Sampling;
use crate::field::{Batch, Chord, Offsets, Pace, Position, SAMPLES, offsets};
use crate::image::Image;
use crate::integrate::Frame;
use crate::integrate::empty_space::EmptySpace;
use crate::integrate::shade::Course;
use crate::integrate::tiles::{self, Radiance, Tally};
use crate::plan::{March, Order};
use crate::scene::Haze;
use crate::simd::{self, Lanes, Level};

/// Marches through a medium.
pub(in super::super) struct Kernel<'a, M> {
    pub(in super::super) medium: &'a M,
    /// `None` to take every sample.
    pub(in super::super) empty_space: Option<&'a EmptySpace>,
    /// The registers that it runs with.
    pub(in super::super) level: Level,
}

impl<M: Medium> Kernel<'_, M> {
    /// Renders every pixel of a frame.
    pub(in super::super) fn render(&self, frame: &Frame<'_>, settings: &March) -> (Image, Tally) {
        let (dims, camera) = (frame.volume.grid().dims(), &frame.scene.camera);
        let fold = (!settings.is_plain()).then(|| composite::fold(settings));
        let sampling = Sampling::new(frame, settings);
        tiles::render(frame, M::Aim::default, |aim, column, row| {
            let ray = camera.pixel_ray(column, row);
            let mut light = Light::new(settings);
            let Some((chord, stretches)) = sampling.along(ray, [column, row]) else {
                let haze = self.medium.haze()?;
                light.cross(haze, haze.end_mm);
                return Some(light.radiance(0));
            };
            let beyond_voxels = stretches[0].beyond_voxels(&chord, dims);
            self.medium.aim(&Course { direction: ray.direction, beyond_voxels }, aim);
            let around_mm = around(self.medium.haze(), &chord, settings.order);
            let walk = Walk { light, samples: 0, fold };
            let way = Way { kernel: self, aim, dims, chord: &chord, stretches: &stretches, around_mm, walk };
            // One number at a time needs no instructions of its own.
            Some(if M::BY_LANES { self.level.run(way) } else { Level::Scalar.run(way) })
        })
    }

    /// Visits the samples of a stretch, and one more of another length behind them.
    #[inline(always)]
    fn walk<L: Lanes>(&self, walk: &mut Walk, aim: &M::Aim, line: &Line<'_>) {
        let mut visited = 0;
        while visited < line.samples() && !walk.light.is_spent() {
            let empty = self.empty_batches(line, visited);
            if empty > 0 {
                self.leap(walk, line, visited, empty);
                visited += empty;
                continue;
            }
            let samples = SAMPLES.min(line.samples() - visited);
            self.visit::<L>(walk, aim, line, visited, samples);
            visited += samples;
        }
    }

    /// How many samples from number `visited` on, the first of a batch, are surely in empty blocks, as whole batches.
    #[inline(always)]
    fn empty_batches(&self, line: &Line<'_>, visited: usize) -> usize {
        let Some(space) = self.empty_space else { return 0 };
        let mut at = visited;
        while at < line.samples() {
            let leap = space.leap(line.position(at), &line.pace);
            if leap.active {
                return (at - visited) / SAMPLES * SAMPLES;
            }
            at += leap.samples.min(line.equal.saturating_sub(at).max(1));
        }
        line.samples() - visited
    }

    /// Passes over samples that are empty.
    #[inline(always)]
    fn leap(&self, walk: &mut Walk, line: &Line<'_>, visited: usize, samples: usize) {
        let haze = self.medium.haze();
        if haze.is_none() && !walk.light.lingers() {
            walk.light.rest();
            return;
        }
        // The first one closes the interval before it, and the others are crossed in closed form.
        let mut run = EMPTY;
        for (all, space) in run.iter_mut().zip(self.medium.space()) {
            all[0] = space;
        }
        let mut delta_mm = [0.0; SAMPLES];
        delta_mm[0] = line.length_mm(visited) as f32;
        walk.composite::<f32>(&run, &delta_mm, 1);
        let last = visited + samples - 1;
        walk.cross(haze, (visited + 1..=last).map(|sample| line.length_mm(sample)).sum());
    }

    /// Takes the samples of a batch.
    #[inline(always)]
    fn visit<L: Lanes>(&self, walk: &mut Walk, aim: &M::Aim, line: &Line<'_>, visited: usize, samples: usize) {
        let first = line.position(visited);
        let (step, whole) = (line.pace.step, visited + SAMPLES <= line.equal);
        let last = line.last.filter(|_| visited + samples == line.samples());
        let mut batch = Batch { first, step, last, offsets: &line.offsets, samples };
        let (placed, mut delta_mm);
        if !whole {
            delta_mm = [0.0; SAMPLES];
            for (k, delta_mm) in delta_mm[..samples].iter_mut().enumerate() {
                *delta_mm = line.length_mm(visited + k) as f32;
            }
            if M::BY_LANES {
                placed = batch.place(&line.offsets);
                batch.offsets = &placed;
            }
        } else {
            delta_mm = [line.delta_mm as f32; SAMPLES];
        }
        walk.samples += samples as u64;
        match self.medium.run::<L>(aim, &batch, |k| line.distance_mm(visited + k)) {
            Some(run) => walk.composite::<L>(&run, &delta_mm, samples),
            None if walk.light.lingers() => walk.composite::<L>(&EMPTY, &delta_mm, samples),
            None => walk.light.rest(),
        }
    }
}

/// The samples of a stretch, and perhaps one more behind them, which stands for another length.
struct Line<'a> {
    chord: &'a Chord,
    first: Position,
    pace: Pace,
    /// Number of equal steps' samples.
    equal: usize,
    delta_mm: f64,
    last: Option<Position>,
    last_delta_mm: f64,
    /// Of equal steps; read by lanes only.
    offsets: Offsets,
    first_mm: f64,
    spacing_mm: f64,
    last_mm: f64,
}

impl<'a> Line<'a> {
    #[inline(always)]
    fn new(chord: &'a Chord, dims: [usize; 3], stretch: &Stretch, behind: Option<&Stretch>, by_lanes: bool) -> Self {
        let first = Position::new(chord.index_at(stretch.first_mm), dims);
        let last = Position::new(chord.index_at(stretch.last_mm), dims);
        let pace = Pace::new(first.step_to(last, stretch.samples - 1));
        let place = |s: &Stretch| Position::new(chord.index_at(s.first_mm), dims).rounded_against(pace.step);
        Line {
            chord,
            first,
            pace,
            equal: stretch.samples,
            delta_mm: stretch.delta_mm,
            last: behind.map(place),
            last_delta_mm: behind.map_or(0.0, |s| s.delta_mm),
            offsets: if by_lanes { offsets(pace.step) } else { Offsets::default() },
            first_mm: stretch.first_mm,
            spacing_mm: (stretch.last_mm - stretch.first_mm) / stretch.samples.saturating_sub(1).max(1) as f64,
            last_mm: behind.map_or(0.0, |s| s.first_mm),
        }
    }

    #[inline(always)]
    fn samples(&self) -> usize {
        self.equal + usize::from(self.last.is_some())
    }

    /// Where a sample is.
    #[inline(always)]
    fn position(&self, sample: usize) -> Position {
        match self.last {
            Some(last) if sample >= self.equal => last,
            _ => {
                let (batch, place) = (sample / SAMPLES * SAMPLES, sample % SAMPLES);
                let first = self.first.advanced(self.pace.step, batch).rounded_against(self.pace.step);
                first.advanced_rounded(self.pace.step, place)
            }
        }
    }

    /// The length that a sample stands for.
    #[inline(always)]
    fn length_mm(&self, sample: usize) -> f64 {
        if sample < self.equal { self.delta_mm } else { self.last_delta_mm }
    }

    /// How far a sample is from the ray's origin.
    #[inline(always)]
    fn distance_mm(&self, sample: usize) -> f64 {
        let from_entry_mm =
            if sample < self.equal { self.first_mm + sample as f64 * self.spacing_mm } else { self.last_mm };
        self.chord.entry_mm + from_entry_mm
    }
}

/// A ray's way through the volume.
struct Way<'a, M: Medium> {
    kernel: &'a Kernel<'a, M>,
    aim: &'a M::Aim,
    dims: [usize; 3],
    chord: &'a Chord,
    stretches: &'a [Stretch; 4],
    around_mm: [f64; 2],
    walk: Walk,
}

impl<M: Medium> simd::Kernel for Way<'_, M> {
    type Output = Radiance;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Radiance {
        let Way { kernel, aim, dims, chord, stretches, around_mm: [before_mm, behind_mm], mut walk } = self;
        let haze = kernel.medium.haze();
        walk.cross(haze, before_mm);
        let mut at = 0;
        while at < stretches.len() && !walk.light.is_spent() {
            let stretch = &stretches[at];
            at += 1;
            if stretch.samples == 0 {
                continue;
            }
            // A single sample behind fills what is left of the last batch.
            let behind = stretches.get(at).filter(|s| s.samples == 1 && !stretch.samples.is_multiple_of(SAMPLES));
            at += usize::from(behind.is_some());
            kernel.walk::<L>(&mut walk, aim, &Line::new(chord, dims, stretch, behind, M::BY_LANES));
        }
        walk.cross(haze, behind_mm);
        walk.light.radiance(walk.samples)
    }
}

/// A ray on its way.
struct Walk {
    light: Light,
    samples: u64,
    /// How batches are composited; `None` for the plain fold.
    fold: Option<Fold>,
}

impl Walk {
    #[inline(always)]
    fn composite<L: Lanes>(&mut self, run: &composite::Run, delta_mm: &[f32; SAMPLES], samples: usize) {
        match self.fold {
            None => composite::fold_plain::<L>(&mut self.light, run, delta_mm, samples),
            Some(fold) => fold(&mut self.light, run, delta_mm, samples),
        }
    }

    /// Passes a stretch in which haze is alone.
    #[inline(always)]
    fn cross(&mut self, haze: Option<&Haze>, length_mm: f64) {
        if let Some(haze) = haze.filter(|_| length_mm > 0.0 && !self.light.is_spent()) {
            self.light.cross(haze, length_mm);
        }
    }
}

/// Lengths of the haze that is passed before the volume and after it, mm.
#[inline(always)]
fn around(haze: Option<&Haze>, chord: &Chord, order: Order) -> [f64; 2] {
    let Some(haze) = haze else { return [0.0; 2] };
    let (near, far) = (chord.entry_mm, haze.end_mm - chord.entry_mm - chord.length_mm);
    match order {
        Order::FrontToBack => [near, far],
        Order::BackToFront => [far, near],
    }
}
