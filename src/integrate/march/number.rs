//! One number of the samples along a ray, shown as a grey.

use super::blocks::Blocks;
use super::gather::{FirstMaximum, Gather, Integral, Largest};
use super::lattice::Stretch;
use super::probe::{Extinction, Probe, Stored};
use super::sampling::Sampling;
use crate::classify::{Baked, Classifier, bake};
use crate::error::Result;
use crate::field::Chord;
use crate::field::{GradientUnits, Macrocells, Pace, Position, Trilinear, Voxel};
use crate::integrate::empty_space::{EmptySpace, Leap};
use crate::integrate::shown::Shown;
use crate::integrate::tiles::{self, Radiance};
use crate::integrate::{Frame, Rendered, Statistics};
use crate::plan::{March, SampleRule};
use crate::scene::{ValueModel, ValueOf};
use crate::volume::Samples;

/// Samples that are probed together before they are gathered.
const RUN: usize = 16;

/// Renders one number of what lies along each ray.
pub(in super::super) fn show_number(frame: &Frame<'_>, settings: &March, model: &ValueModel) -> Result<Rendered> {
    match frame.volume.samples() {
        Samples::I16(voxels) => by_number(frame, settings, model, voxels),
        Samples::F32(voxels) => by_number(frame, settings, model, voxels),
        Samples::Rgba8(_) | Samples::Rgba16(_) => unreachable!("colours have no values, and are refused"),
    }
}

fn by_number<V: Voxel>(frame: &Frame<'_>, settings: &March, model: &ValueModel, voxels: &[V]) -> Result<Rendered> {
    let field = Trilinear::new(voxels, frame.volume.grid().dims())?;
    let rescale = frame.volume.rescale();
    let sign = if rescale.slope < 0.0 { -1.0 } else { 1.0 };
    let survey = frame.survey;
    let blocks = || frame.schedule.empty_space_skipping.then(|| survey.blocks.get_or_init(|| Blocks::new(&field)));
    let value = |stored: f64, _: f64| rescale.value(stored);
    let of = Of { frame, settings, model, name: format!("march/{}/{}/f32", V::NAME, model.of.name()) };
    Ok(match model.of {
        ValueOf::Maximum => of.render(Stored(field), Largest { sign, blocks: blocks() }, value),
        ValueOf::Minimum => of.render(Stored(field), Largest { sign: -sign, blocks: blocks() }, value),
        ValueOf::LocalMaximum { threshold } => {
            let gather = FirstMaximum {
                sign,
                threshold: rescale.stored(threshold) as f32,
                fall: (model.smallest_fall() / rescale.slope.abs()) as f32,
                blocks: blocks(),
            };
            of.render(Stored(field), gather, value)
        }
        ValueOf::Mean => of.integrate(Stored(field), None, |total, length_mm| rescale.value(total / length_mm)),
        ValueOf::Sum => {
            let sum = |total: f64, length_mm: f64| rescale.slope * total + rescale.intercept * length_mm;
            of.integrate(Stored(field), None, sum)
        }
        ValueOf::OpticalDepth => match bake(&frame.scene.transfer_function, rescale) {
            Baked::OneD(classifier) => optical_depth(of, field, "tf1d", &classifier)?,
            Baked::TwoD(classifier) => optical_depth(of, field, "tf2d", &classifier)?,
        },
    })
}

fn optical_depth<V: Voxel, C: Classifier<f32>>(
    of: Of<'_>,
    field: Trilinear<'_, V>,
    classifier_name: &str,
    classifier: &C,
) -> Result<Rendered> {
    let (frame, grid) = (of.frame, of.frame.volume.grid());
    let units = GradientUnits::new(grid, frame.volume.rescale());
    let passes_over = frame.schedule.empty_space_skipping;
    let shown = || Shown::new::<{ Macrocells::LOG2_CELLS }, _, _, _>(&field, &units, classifier, passes_over);
    let Shown { magnitudes, empty_space } = frame.survey.shown.get_or_init(shown);
    let magnitude = magnitudes.as_ref().map(|m| m.field(grid.dims())).transpose()?;
    let name = format!("march/{}/{classifier_name}/{}/f32", V::NAME, of.model.of.name());
    let probe = Extinction { field, magnitude, classifier };
    Ok(Of { name, ..of }.integrate(probe, empty_space.as_ref(), |total, _| total))
}

/// What is shown, and how.
struct Of<'a> {
    frame: &'a Frame<'a>,
    settings: &'a March,
    model: &'a ValueModel,
    name: String,
}

impl Of<'_> {
    /// Renders an integral; `number` makes it of the integral and the length of the ray, mm.
    fn integrate<P: Probe>(
        self,
        probe: P,
        empty_space: Option<&EmptySpace>,
        number: impl Fn(f64, f64) -> f64 + Sync,
    ) -> Rendered {
        match self.settings.rule {
            SampleRule::Trapezoid => self.render(probe, Integral::<true> { empty_space }, number),
            SampleRule::Left | SampleRule::Midpoint | SampleRule::WholeSteps => {
                self.render(probe, Integral::<false> { empty_space }, number)
            }
        }
    }

    fn render<P: Probe, G: Gather>(self, probe: P, gather: G, number: impl Fn(f64, f64) -> f64 + Sync) -> Rendered {
        let Of { frame, settings, model, name } = self;
        let (sampling, camera) = (Sampling::front_to_back(frame, settings), &frame.scene.camera);
        let walker = Walker { probe, gather };
        let (image, tally) = tiles::render(
            frame,
            || (),
            |(), column, row| {
                let ray = camera.pixel_ray(column, row);
                let (chord, stretches) = sampling.along(ray, [column, row])?;
                let (mut gathered, mut samples) = (walker.gather.start(), 0);
                for stretch in stretches {
                    if stretch.samples > 0 && !walker.gather.is_settled(&gathered) {
                        walker.walk(&mut gathered, &mut samples, &chord, &stretch);
                    }
                }
                let length_mm = match settings.rule {
                    // What is left of the ray counts for nothing.
                    SampleRule::WholeSteps => stretches[0].samples as f64 * stretches[0].delta_mm,
                    SampleRule::Left | SampleRule::Midpoint | SampleRule::Trapezoid => chord.length_mm,
                };
                let light = model.light(number(walker.gather.number(&gathered), length_mm));
                Some(Radiance { color: [light; 3], transmittance: 0.0, samples, error_bound: 0.0 })
            },
        );
        let statistics =
            Statistics { samples: tally.samples, error_bound: None, bound: None, rays: tally.rays, kernel: name };
        Rendered { image, statistics }
    }
}

struct Walker<P, G> {
    probe: P,
    gather: G,
}

impl<P: Probe, G: Gather> Walker<P, G> {
    /// Visits the samples of a stretch, passing over those that do not matter.
    fn walk(&self, gathered: &mut G::Gathered, samples: &mut u64, chord: &Chord, stretch: &Stretch) {
        let dims = self.probe.dims();
        let first = Position::new(chord.index_at(stretch.first_mm), dims);
        let last = Position::new(chord.index_at(stretch.last_mm), dims);
        let pace = Pace::new(first.step_to(last, stretch.samples - 1));
        let mut visited = 0;
        while visited < stretch.samples && !self.gather.is_settled(gathered) {
            let left = stretch.samples - visited;
            let leap = self.gather.leap(gathered, first.advanced(pace.step, visited), &pace);
            let leap = leap.unwrap_or(Leap { active: true, samples: left });
            if !leap.active {
                self.gather.pass(gathered, stretch.delta_mm);
                visited += leap.samples.min(left);
                continue;
            }
            let mut run = [0.0; RUN];
            let run = &mut run[..RUN.min(leap.samples).min(left)];
            for (i, out) in run.iter_mut().enumerate() {
                *out = self.probe.at(&first.advanced(pace.step, visited + i).even_cell());
            }
            self.gather.take(gathered, run, stretch.delta_mm);
            *samples += run.len() as u64;
            visited += run.len();
        }
    }
}
