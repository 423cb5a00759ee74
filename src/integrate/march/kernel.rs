//! The loop over the samples of a ray.

use super::composite::{self, Fold, Light};
use super::lattice::{Cuts, Stretch};
use crate::classify::{Classifier, Rgbs};
use crate::field::{GradientUnits, Pace, Position, Trilinear, Voxel};
use crate::image::Image;
use crate::integrate::Frame;
use crate::integrate::chord::Chord;
use crate::integrate::empty_space::{EmptySpace, Leap};
use crate::integrate::shade::Shader;
use crate::integrate::tiles::{self, Radiance, Tally};
use crate::plan::March;

/// Samples that are evaluated together before they are composited.
const RUN: usize = 16;

/// What a sample reads, by type.
pub(in super::super) struct Kernel<'a, V, C, S> {
    pub(in super::super) field: Trilinear<'a, V>,
    /// The gradient magnitude, HU/mm; there if the transfer function reads it.
    pub(in super::super) magnitude: Option<Trilinear<'a, f32>>,
    pub(in super::super) units: GradientUnits,
    pub(in super::super) classifier: &'a C,
    pub(in super::super) shader: &'a S,
    /// `None` to take every sample.
    pub(in super::super) empty_space: Option<EmptySpace>,
}

impl<V: Voxel, C: Classifier<f32>, S: Shader> Kernel<'_, V, C, S> {
    /// Renders every pixel of a frame.
    pub(in super::super) fn render(&self, frame: &Frame<'_>, settings: &March) -> (Image, Tally) {
        let (grid, camera) = (frame.volume.grid(), &frame.scene.camera);
        let fold = composite::fold(settings);
        // View planes stand still when the camera moves along its line of sight.
        let anchor_mm = grid.center_mm();
        tiles::render(frame, S::Aim::default, |aim, column, row| {
            let ray = camera.pixel_ray(column, row);
            let chord = Chord::new(grid, ray)?;
            let cuts = Cuts::new(settings, &chord, ray, camera.forward(), anchor_mm, [column, row]);
            self.shader.aim(ray.direction, aim);
            let mut walk = Walk { light: Light::new(settings), samples: 0, fold };
            for stretch in cuts.stretches(settings.rule, settings.order) {
                if stretch.samples > 0 && !walk.light.is_spent() {
                    self.walk(&mut walk, aim, &chord, &stretch);
                }
            }
            let Light { color, transmittance, .. } = walk.light;
            Some(Radiance { color, transmittance, samples: walk.samples, error_bound: 0.0 })
        })
    }

    /// Visits the samples of a stretch, leaping over empty space.
    fn walk(&self, walk: &mut Walk, aim: &S::Aim, chord: &Chord, stretch: &Stretch) {
        let dims = self.field.dims();
        let first = Position::new(chord.index_at(stretch.first_mm), dims);
        let last = Position::new(chord.index_at(stretch.last_mm), dims);
        let pace = Pace::new(first.step_to(last, stretch.samples - 1));
        let delta_mm = stretch.delta_mm as f32;
        let mut visited = 0;
        while visited < stretch.samples {
            let position = first.advanced(pace.step, visited);
            let left = stretch.samples - visited;
            let leap = match &self.empty_space {
                Some(space) => space.leap(position, &pace),
                None => Leap { active: true, samples: left },
            };
            let samples = leap.samples.min(left);
            visited += samples;
            if leap.active {
                self.walk_active(walk, aim, position, &pace, samples, delta_mm);
                if walk.light.is_spent() {
                    return;
                }
            } else {
                // One empty sample stands for all: it closes the interval before it, and the others add 0.
                (walk.fold)(&mut walk.light, &[[0.0; 4]], delta_mm);
            }
        }
    }

    fn walk_active(&self, walk: &mut Walk, aim: &S::Aim, first: Position, pace: &Pace, samples: usize, delta_mm: f32) {
        let mut visited = 0;
        while visited < samples && !walk.light.is_spent() {
            let mut run = [[0.0; 4]; RUN];
            let run = &mut run[..RUN.min(samples - visited)];
            for (i, out) in run.iter_mut().enumerate() {
                *out = self.sample(aim, first.advanced(pace.step, visited + i));
            }
            (walk.fold)(&mut walk.light, run, delta_mm);
            walk.samples += run.len() as u64;
            visited += run.len();
        }
    }

    /// Shaded emission and extinction at a position.
    #[inline(always)]
    fn sample(&self, aim: &S::Aim, position: Position) -> Rgbs<f32> {
        let cell = position.cell();
        let magnitude = match &self.magnitude {
            Some(magnitude) if C::READS_GRADIENT => magnitude.value(&cell),
            _ => 0.0,
        };
        let optics = self.classifier.classify(self.field.value(&cell), magnitude);
        // Rounding may leave a trace below 0 at the foot of a ramp.
        let optics = optics.map(|x| if x > 0.0 { x } else { 0.0 });
        if !S::READS_GRADIENT || optics == [0.0; 4] {
            return optics;
        }
        let gradient = self.shader.gradient_per_index(&self.field, position, &cell);
        self.shader.shade(aim, optics, self.units.per_mm(gradient))
    }
}

/// A ray on its way.
struct Walk {
    light: Light,
    samples: u64,
    fold: Fold,
}
