//! Level surfaces between the samples of a ray.
//!
//! Samples lie at both ends of each interval. Where one end is inside a level and the other is not, the crossing is where
//! the line through both takes the level, after as many bisections as the settings ask for. Two crossings within one
//! interval are not seen: that is the error of the method. Colour is shaded by the gradient there, as the definition says.

use super::lattice::Stretch;
use super::sampling::Sampling;
use crate::error::Result;
use crate::field::Chord;
use crate::field::{GradientUnits, Macrocells, Pace, Position, Trilinear, Voxel};
use crate::integrate::empty_space::{EmptySpace, Leap};
use crate::integrate::tiles::{self, Radiance};
use crate::integrate::{Frame, Rendered, Statistics};
use crate::plan::March;
use crate::scene::{Ray, Scene, Surface};
use crate::volume::Samples;

/// Renders level surfaces.
pub(in super::super) fn show_surfaces(frame: &Frame<'_>, settings: &March, surfaces: &[Surface]) -> Result<Rendered> {
    match frame.volume.samples() {
        Samples::I16(voxels) => show(frame, settings, surfaces, voxels),
        Samples::F32(voxels) => show(frame, settings, surfaces, voxels),
        Samples::Rgba8(_) | Samples::Rgba16(_) => unreachable!("colours have no values, and are refused"),
    }
}

fn show<V: Voxel>(frame: &Frame<'_>, settings: &March, surfaces: &[Surface], voxels: &[V]) -> Result<Rendered> {
    let (grid, camera, rescale) = (frame.volume.grid(), &frame.scene.camera, frame.volume.rescale());
    let field = Trilinear::new(voxels, grid.dims())?;
    let levels: Vec<f64> = surfaces.iter().map(|surface| rescale.stored(surface.value)).collect();
    let without_levels = frame.schedule.empty_space_skipping.then(|| {
        let crossed = |[low, high]: [f32; 2]| levels.iter().any(|&l| f64::from(low) <= l && l <= f64::from(high));
        let by_values = || EmptySpace::by_values(&Macrocells::new(&field), crossed);
        frame.survey.empty_space.get_or_init(by_values)
    });
    let kernel = Kernel {
        field,
        units: GradientUnits::new(grid, rescale),
        sign: rescale.slope.signum(),
        levels,
        surfaces,
        scene: frame.scene,
        bisections: settings.bisections,
        stop_below: settings.termination_transmittance,
        without_levels,
    };
    let sampling = Sampling::of_ends(frame, settings);
    let (image, tally) = tiles::render(frame, Vec::new, |crossings, column, row| {
        let ray = camera.pixel_ray(column, row);
        let (chord, stretches) = sampling.along(ray, [column, row])?;
        let mut walk = Walk { ray, chord, before: None, color: [0.0; 3], transmittance: 1.0, samples: 0, crossings };
        for stretch in stretches {
            if stretch.samples > 0 {
                kernel.walk(&mut walk, &stretch);
            }
        }
        let Walk { color, transmittance, samples, .. } = walk;
        Some(Radiance { color, transmittance, samples, error_bound: 0.0 })
    });
    let kernel = format!("march/{}/surfaces/f32", V::NAME);
    let statistics = Statistics { samples: tally.samples, error_bound: None, bound: None, rays: tally.rays, kernel };
    Ok(Rendered { image, statistics })
}

struct Kernel<'a, V> {
    field: Trilinear<'a, V>,
    units: GradientUnits,
    /// -1 where values fall as stored numbers rise, else 1.
    sign: f64,
    /// Stored values, one per surface.
    levels: Vec<f64>,
    surfaces: &'a [Surface],
    scene: &'a Scene,
    bisections: u32,
    /// A ray stops below this transmittance.
    stop_below: f64,
    /// Blocks of cells that no level crosses; `None` to take every sample.
    without_levels: Option<&'a EmptySpace>,
}

/// A sample: its place, mm from the entry, and its stored value.
type Sample = (f64, f64);

/// A ray on its way.
struct Walk<'c> {
    ray: Ray,
    chord: Chord,
    before: Option<Sample>,
    color: [f64; 3],
    transmittance: f64,
    samples: u64,
    /// Crossings of one interval: place and surface; kept between rays.
    crossings: &'c mut Vec<(f64, usize)>,
}

impl<V: Voxel> Kernel<'_, V> {
    /// Visits the samples of a stretch. Of those in blocks that no level crosses the first and the last are enough: no
    /// state changes between them, but it may have changed before, and may change behind.
    fn walk(&self, walk: &mut Walk<'_>, stretch: &Stretch) {
        let dims = self.field.dims();
        let first = Position::new(walk.chord.index_at(stretch.first_mm), dims);
        let last = Position::new(walk.chord.index_at(stretch.last_mm), dims);
        let intervals = stretch.samples - 1;
        let pace = Pace::new(first.step_to(last, intervals));
        let spacing_mm = (stretch.last_mm - stretch.first_mm) / intervals.max(1) as f64;
        let visit = |walk: &mut Walk<'_>, i: usize| {
            let stored = f64::from(self.field.value(&first.advanced(pace.step, i).even_cell()));
            walk.samples += 1;
            self.reach(walk, (stretch.first_mm + i as f64 * spacing_mm, stored));
        };
        let mut visited = 0;
        while visited < stretch.samples && !self.is_spent(walk) {
            let left = stretch.samples - visited;
            let leap = match self.without_levels {
                Some(space) => space.leap(first.advanced(pace.step, visited), &pace),
                None => Leap { active: true, samples: left },
            };
            let end = visited + leap.samples.min(left);
            if leap.active {
                while visited < end && !self.is_spent(walk) {
                    visit(walk, visited);
                    visited += 1;
                }
            } else {
                visit(walk, visited);
                if end - visited > 1 && !self.is_spent(walk) {
                    visit(walk, end - 1);
                }
                visited = end;
            }
        }
    }

    fn is_spent(&self, walk: &Walk<'_>) -> bool {
        walk.transmittance == 0.0 || walk.transmittance < self.stop_below
    }

    fn is_inside(&self, stored: f64, level: f64) -> bool {
        self.sign * stored >= self.sign * level
    }

    /// Goes on to a sample, and composites the surfaces crossed on the way.
    fn reach(&self, walk: &mut Walk<'_>, sample: Sample) {
        let Some(before) = walk.before.replace(sample) else { return };
        walk.crossings.clear();
        for (n, &level) in self.levels.iter().enumerate() {
            if self.is_inside(before.1, level) != self.is_inside(sample.1, level) {
                walk.crossings.push((self.crossing(&walk.chord, before, sample, level), n));
            }
        }
        walk.crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        for i in 0..walk.crossings.len() {
            let (at_mm, n) = walk.crossings[i];
            self.composite(walk, at_mm, &self.surfaces[n]);
        }
    }

    /// Where the value takes the level between two samples, one inside and one outside.
    fn crossing(&self, chord: &Chord, mut from: Sample, mut to: Sample, level: f64) -> f64 {
        for _ in 0..self.bisections {
            let middle_mm = 0.5 * (from.0 + to.0);
            let cell = Position::new(chord.index_at(middle_mm), self.field.dims()).even_cell();
            let middle = (middle_mm, f64::from(self.field.value(&cell)));
            if self.is_inside(middle.1, level) == self.is_inside(from.1, level) {
                from = middle;
            } else {
                to = middle;
            }
        }
        // Never 0/0: one of the two is inside and the other is not.
        from.0 + (to.0 - from.0) * ((level - from.1) / (to.1 - from.1))
    }

    fn composite(&self, walk: &mut Walk<'_>, at_mm: f64, &Surface { opacity, color, .. }: &Surface) {
        // Nobody reads the gradient of what is not lit.
        let gradient = self.scene.shading.as_ref().map_or([0.0; 3], |_| {
            let cell = Position::new(walk.chord.index_at(at_mm), self.field.dims()).even_cell();
            self.units.per_mm(self.field.gradient_per_index(&cell)).map(f64::from)
        });
        // Between surfaces nothing absorbs, so that they cast no shadows.
        let from_origin_mm = walk.chord.entry_mm + at_mm;
        let (reflected, highlight) = self.scene.factors(&walk.ray, from_origin_mm, gradient.into(), |_| 1.0);
        for c in 0..3 {
            walk.color[c] += walk.transmittance * opacity * (color[c] * reflected[c] + highlight[c]);
        }
        walk.transmittance -= walk.transmittance * opacity;
    }
}
