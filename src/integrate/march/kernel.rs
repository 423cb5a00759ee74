//! The loop over the samples of a ray.

use super::composite::{self, Fold, Light};
use super::lattice::Stretch;
use super::medium::Medium;
use super::sampling::Sampling;
use crate::field::Chord;
use crate::field::{Pace, Position};
use crate::image::Image;
use crate::integrate::Frame;
use crate::integrate::empty_space::{EmptySpace, Leap};
use crate::integrate::tiles::{self, Tally};
use crate::plan::{March, Order};
use crate::scene::Haze;

/// Samples that are evaluated together before they are composited.
const RUN: usize = 16;

/// Marches through a medium.
pub(in super::super) struct Kernel<'a, M> {
    pub(in super::super) medium: &'a M,
    /// `None` to take every sample.
    pub(in super::super) empty_space: Option<EmptySpace>,
}

impl<M: Medium> Kernel<'_, M> {
    /// Renders every pixel of a frame.
    pub(in super::super) fn render(&self, frame: &Frame<'_>, settings: &March) -> (Image, Tally) {
        let (dims, camera) = (frame.volume.grid().dims(), &frame.scene.camera);
        let fold = composite::fold(settings);
        let sampling = Sampling::new(frame, settings);
        tiles::render(frame, M::Aim::default, |aim, column, row| {
            let ray = camera.pixel_ray(column, row);
            let mut light = Light::new(settings);
            let Some((chord, stretches)) = sampling.along(ray, [column, row]) else {
                let haze = self.medium.haze()?;
                light.cross(haze, haze.end_mm);
                return Some(light.radiance(0));
            };
            self.medium.aim(ray.direction, aim);
            let mut walk = Walk { light, samples: 0, fold };
            let [before_mm, behind_mm] = around(self.medium.haze(), &chord, settings.order);
            walk.cross(self.medium.haze(), before_mm);
            for stretch in stretches {
                if stretch.samples > 0 && !walk.light.is_spent() {
                    self.walk(&mut walk, aim, dims, &chord, &stretch);
                }
            }
            walk.cross(self.medium.haze(), behind_mm);
            Some(walk.light.radiance(walk.samples))
        })
    }

    /// Visits the samples of a stretch, leaping over empty space.
    fn walk(&self, walk: &mut Walk, aim: &M::Aim, dims: [usize; 3], chord: &Chord, stretch: &Stretch) {
        let first = Position::new(chord.index_at(stretch.first_mm), dims);
        let last = Position::new(chord.index_at(stretch.last_mm), dims);
        let pace = Pace::new(first.step_to(last, stretch.samples - 1));
        let delta_mm = stretch.delta_mm as f32;
        let spacing_mm = (stretch.last_mm - stretch.first_mm) / stretch.samples.saturating_sub(1).max(1) as f64;
        let distance_mm = |sample: usize| chord.entry_mm + stretch.first_mm + sample as f64 * spacing_mm;
        let mut visited = 0;
        while visited < stretch.samples {
            let position = first.advanced(pace.step, visited);
            let left = stretch.samples - visited;
            let leap = match &self.empty_space {
                Some(space) => space.leap(position, &pace),
                None => Leap { active: true, samples: left },
            };
            let samples = leap.samples.min(left);
            let from = visited;
            visited += samples;
            if leap.active {
                self.walk_active(walk, aim, position, &pace, samples, delta_mm, |i| distance_mm(from + i));
                if walk.light.is_spent() {
                    return;
                }
            } else {
                // One empty sample stands for all: it closes the interval before it, and the others add 0.
                (walk.fold)(&mut walk.light, &[self.medium.space()], delta_mm);
                walk.cross(self.medium.haze(), (samples - 1) as f64 * stretch.delta_mm);
            }
        }
    }

    #[expect(clippy::too_many_arguments, reason = "each is in a register")]
    fn walk_active(
        &self,
        walk: &mut Walk,
        aim: &M::Aim,
        first: Position,
        pace: &Pace,
        samples: usize,
        delta_mm: f32,
        distance_mm: impl Fn(usize) -> f64,
    ) {
        let mut visited = 0;
        while visited < samples && !walk.light.is_spent() {
            let mut run = [[0.0; 4]; RUN];
            let run = &mut run[..RUN.min(samples - visited)];
            for (i, out) in run.iter_mut().enumerate() {
                *out = self.medium.sample(aim, first.advanced(pace.step, visited + i), distance_mm(visited + i));
            }
            (walk.fold)(&mut walk.light, run, delta_mm);
            walk.samples += run.len() as u64;
            visited += run.len();
        }
    }
}

/// A ray on its way.
struct Walk {
    light: Light,
    samples: u64,
    fold: Fold,
}

impl Walk {
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
