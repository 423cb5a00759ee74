//! Level surfaces at the samples of a ray, for whole steps: as VTK's GPU mapper does it.
//!
//! A surface is composited at the first sample behind it, with the colour of its level and the gradient of the sample. The
//! first sample of a ray says between which levels it begins. At each further one at most one level is crossed; where there
//! are more, the others follow at the next samples.

use super::composite::Light;
use super::lattice::Stretch;
use super::sampling::Sampling;
use crate::classify::Rgbs;
use crate::field::Chord;
use crate::field::{GradientUnits, Macrocells, Pace, Position, Trilinear, Voxel};
use crate::integrate::empty_space::{EmptySpace, Leap};
use crate::integrate::shade::{Course, Shader, Spot};
use crate::integrate::tiles;
use crate::integrate::{Frame, Rendered, Statistics};
use crate::plan::March;
use crate::scene::Surface;

/// Looks for changes of level between samples.
pub(in super::super) struct LevelChanges<'a, V, S> {
    field: Trilinear<'a, V>,
    units: GradientUnits,
    /// -1 where values fall as stored numbers rise, else 1.
    sign: f32,
    /// Stored values times the sign, ascending, with opacity and premultiplied colour.
    levels: Vec<(f32, Rgbs<f32>)>,
    shader: &'a S,
    /// Blocks of cells that no level crosses; `None` to take every sample.
    without_levels: Option<&'a EmptySpace>,
}

/// A ray on its way.
struct Walk {
    light: Light,
    /// Levels that the last sample is known to be above; `None` before the first.
    above: Option<usize>,
    samples: u64,
}

impl<'a, V: Voxel, S: Shader> LevelChanges<'a, V, S> {
    /// Changes of these levels.
    pub(in super::super) fn new(
        frame: &Frame<'a>,
        field: Trilinear<'a, V>,
        surfaces: &[Surface],
        shader: &'a S,
    ) -> Self {
        let rescale = frame.volume.rescale();
        let sign = rescale.slope.signum() as f32;
        let level = |s: &Surface| {
            let [r, g, b] = s.color.map(|c| (c * s.opacity) as f32);
            (sign * rescale.stored(s.value) as f32, [r, g, b, s.opacity as f32])
        };
        let mut levels: Vec<_> = surfaces.iter().map(level).collect();
        levels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let without_levels = frame.schedule.empty_space_skipping.then(|| {
            let crossed = |[low, high]: [f32; 2]| levels.iter().any(|&(l, _)| low <= sign * l && sign * l <= high);
            let by_values = || EmptySpace::by_values(&Macrocells::new(&field), crossed);
            frame.survey.empty_space.get_or_init(by_values)
        });
        let units = GradientUnits::new(frame.volume.grid(), rescale);
        LevelChanges { field, units, sign, levels, shader, without_levels }
    }

    /// Renders every pixel of a frame.
    pub(in super::super) fn render(&self, frame: &Frame<'_>, settings: &March) -> Rendered {
        let (sampling, camera) = (Sampling::front_to_back(frame, settings), &frame.scene.camera);
        let (image, tally) = tiles::render(frame, S::Aim::default, |aim, column, row| {
            let ray = camera.pixel_ray(column, row);
            let (chord, stretches) = sampling.along(ray, [column, row])?;
            // No level is crossed by a ray's only sample, wherever that is.
            self.shader.aim(&Course::inside(ray.direction), aim);
            let mut walk = Walk { light: Light::new(settings), above: None, samples: 0 };
            for stretch in stretches.iter().filter(|stretch| stretch.samples > 0) {
                self.walk(&mut walk, aim, &chord, stretch);
            }
            Some(walk.light.radiance(walk.samples))
        });
        let kernel = format!("march/{}/level-changes/{}/f32", V::NAME, S::NAME);
        let statistics =
            Statistics { samples: tally.samples, error_bound: None, bound: None, rays: tally.rays, kernel };
        Rendered { image, statistics }
    }

    fn walk(&self, walk: &mut Walk, aim: &S::Aim, chord: &Chord, stretch: &Stretch) {
        let dims = self.field.dims();
        let first = Position::new(chord.index_at(stretch.first_mm), dims);
        let last = Position::new(chord.index_at(stretch.last_mm), dims);
        let pace = Pace::new(first.step_to(last, stretch.samples - 1));
        let mut visited = 0;
        while visited < stretch.samples && !walk.light.is_spent() {
            let position = first.advanced(pace.step, visited);
            let from_origin_mm = chord.entry_mm + stretch.first_mm + visited as f64 * stretch.delta_mm;
            let leap = match self.without_levels {
                Some(space) => space.leap(position, &pace),
                None => Leap { active: true, samples: 1 },
            };
            let changed = self.visit(walk, aim, position, from_origin_mm);
            // Where no level is crossed the next samples say what this one does, unless it was still catching up.
            visited += if leap.active || changed { 1 } else { leap.samples };
        }
    }

    /// Takes a sample, and composites the level that is crossed; true if one was.
    #[inline(always)]
    fn visit(&self, walk: &mut Walk, aim: &S::Aim, position: Position, distance_mm: f64) -> bool {
        let cell = position.even_cell();
        let value = self.sign * self.field.value(&cell);
        walk.samples += 1;
        let Some(above) = walk.above else {
            walk.above = Some(self.levels.partition_point(|&(level, _)| level <= value));
            return false;
        };
        let (crossed, now_above) = match (self.levels[..above].last(), self.levels.get(above)) {
            (Some(&(level, surface)), _) if value < level => (surface, above - 1),
            (_, Some(&(level, surface))) if value > level => (surface, above + 1),
            _ => return false,
        };
        walk.above = Some(now_above);
        let gradient = || self.units.per_mm(self.shader.gradient_per_index(aim, &self.field, position, &cell));
        let [r, g, b, opacity] = self.shader.shade(aim, crossed, &Spot { cell, distance_mm }, gradient);
        walk.light.pass([r, g, b].map(f64::from), f64::from(opacity));
        true
    }
}
