//! Compositing of a batch of samples.
//!
//! With `x = σΔ` an interval absorbs the share `A = 1 − e^{−x}` of the light from behind and adds `L = q Δ A/x`, which is
//! `A q/σ`, and `qΔ` where nothing absorbs. `A` and `L` are computed in f32, accurate relative to themselves. The opacities of
//! a batch are combined by `a ∘ b = a + b − a b` in a tree, accurate relative to themselves too, and what the batch adds is
//! summed in a tree; both trees are the same at every level of instructions. Batches are summed in f64, with transmittance
//! updated as `T −= T A`: in f32, intervals of opacity 1e-8 would leave `T` at 1 however many there are, and a small step would
//! turn the volume transparent.

use crate::classify::Rgbs;
use crate::field::SAMPLES;
use crate::integrate::tiles::Radiance;
use crate::math::each;
use crate::plan::{Colors, Emission, March, Order, SampleRule};
use crate::scene::Haze;
use crate::simd::Lanes;

/// Emission in red, green and blue, and extinction of the samples of a batch, in the order they are visited; 0 behind the last.
pub(super) type Run = [[f32; SAMPLES]; 4];

/// Below this transmittance the largest f32 adds nothing to a pixel.
const NOTHING_LEFT: f64 = f32::MIN_POSITIVE as f64 * f32::MIN_POSITIVE as f64 * f32::EPSILON as f64;

/// Nothing.
pub(super) const EMPTY: Run = [[0.0; SAMPLES]; 4];

/// Light gathered along a ray so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Light {
    /// Linear RGB, premultiplied.
    pub(super) color: [f64; 3],
    /// Of what has been visited.
    pub(super) transmittance: f64,
    /// A front-to-back ray stops below this.
    stop_below: f64,
    /// The sample before, for rules that read two.
    previous: Option<Rgbs<f32>>,
    /// Composites a stretch by what it adds and its opacity.
    stretch: fn(&mut Light, [f64; 3], f64),
}

impl Light {
    /// Before the first sample.
    pub(super) fn new(settings: &March) -> Self {
        let stop_below = match settings.order {
            Order::FrontToBack => settings.termination_transmittance.max(NOTHING_LEFT),
            Order::BackToFront => 0.0,
        };
        let stretch = match settings.order {
            Order::FrontToBack => FrontToBack::composite,
            Order::BackToFront => BackToFront::composite,
        };
        Light { color: [0.0; 3], transmittance: 1.0, stop_below, previous: None, stretch }
    }

    /// Composites a stretch of haze alone, in closed form.
    pub(super) fn cross(&mut self, haze: &Haze, length_mm: f64) {
        let (added, opacity) = haze.slab(length_mm);
        (self.stretch)(self, added, opacity);
    }

    /// Composites something thin, front to back: what it adds, premultiplied, and its opacity.
    #[inline(always)]
    pub(super) fn pass(&mut self, added: [f64; 3], opacity: f64) {
        FrontToBack::composite(self, added, opacity);
    }

    /// What reaches the eye, after so many samples.
    #[inline(always)]
    pub(super) fn radiance(&self, samples: u64) -> Radiance {
        Radiance { color: self.color, transmittance: self.transmittance, samples, error_bound: 0.0 }
    }

    /// Whether the next interval shows something even if its sample is nothing: half of the one before.
    #[inline(always)]
    pub(super) fn lingers(&self) -> bool {
        self.previous.is_some_and(|before| before != [0.0; 4])
    }

    /// Passes a sample that is nothing, behind one that was nothing too.
    #[inline(always)]
    pub(super) fn rest(&mut self) {
        self.previous = Some([0.0; 4]);
    }

    /// The first sample of a batch that a ray does not come to, having stopped where its transmittance fell below the limit; given
    /// the opacity before each.
    #[inline(always)]
    fn end(&self, before: &[f32; SAMPLES]) -> usize {
        if self.stop_below <= NOTHING_LEFT {
            return SAMPLES;
        }
        let is_past = |&k: &usize| self.transmittance * (1.0 - f64::from(before[k])) < self.stop_below;
        (1..SAMPLES).find(is_past).unwrap_or(SAMPLES)
    }

    /// True when a ray need not go on.
    #[inline(always)]
    pub(super) fn is_spent(&self) -> bool {
        self.transmittance < self.stop_below
    }
}

/// Composites the samples of a batch, so many of them, each of which stands for its own length, mm.
pub(super) type Fold = fn(&mut Light, &Run, &[f32; SAMPLES], usize);

/// The fold that these settings ask for.
pub(super) fn fold(settings: &March) -> Fold {
    match settings.rule {
        SampleRule::Left | SampleRule::Midpoint | SampleRule::WholeSteps => by_order::<OnePoint>(settings),
        SampleRule::Trapezoid => by_order::<TwoPoints>(settings),
    }
}

/// The fold of most pictures, with the registers of a level.
#[inline(always)]
pub(super) fn fold_plain<L: Lanes>(light: &mut Light, run: &Run, delta_mm: &[f32; SAMPLES], samples: usize) {
    fold_batch::<L, OnePoint, FrontToBack, Associated, PerLength>(light, run, delta_mm, samples);
}

fn by_order<R: Rule>(settings: &March) -> Fold {
    match settings.order {
        Order::FrontToBack => by_colors::<R, FrontToBack>(settings),
        Order::BackToFront => by_colors::<R, BackToFront>(settings),
    }
}

fn by_colors<R: Rule, D: Direction>(settings: &March) -> Fold {
    if settings.table.is_some() {
        return fold_batch::<f32, R, D, Associated, PerStep>;
    }
    match (settings.colors, settings.emission) {
        (Colors::Associated, Emission::PerLength) => fold_batch::<f32, R, D, Associated, PerLength>,
        (Colors::Associated, Emission::PerSample) => fold_batch::<f32, R, D, Associated, PerSample>,
        (Colors::Straight, Emission::PerLength) => fold_batch::<f32, R, D, Straight, PerLength>,
        (Colors::Straight, Emission::PerSample) => fold_batch::<f32, R, D, Straight, PerSample>,
    }
}

#[inline(always)]
fn fold_batch<L: Lanes, R: Rule, D: Direction, K: Coloring, E: Measure>(
    light: &mut Light,
    run: &Run,
    delta_mm: &[f32; SAMPLES],
    samples: usize,
) {
    let means = D::from_the_eye(R::means(&mut light.previous, run, samples));
    let [delta_mm] = D::from_the_eye([*delta_mm]);
    let mut opacities = [0.0; SAMPLES];
    let mut added = [[0.0; SAMPLES]; 3];
    for at in (0..SAMPLES).step_by(L::LANES) {
        let (extinction, delta) = (L::load(&means[3][at..]), L::load(&delta_mm[at..]));
        let depth = extinction * delta;
        let weight = E::weight(depth, delta);
        E::opacity(extinction, depth).store(&mut opacities[at..]);
        for c in 0..3 {
            (L::load(&means[c][at..]) * weight).store(&mut added[c][at..]);
        }
    }
    let (before, mut opacity) = L::accumulated(&opacities);
    let end = light.end(&before);
    if end < SAMPLES {
        opacity = before[end];
    }
    for at in (0..SAMPLES).step_by(L::LANES) {
        let (share, own) = (L::ONE - L::load(&before[at..]), L::load(&opacities[at..]));
        for channel in &mut added {
            K::contribution(L::load(&channel[at..]), own, share).store(&mut channel[at..]);
        }
    }
    for channel in &mut added {
        channel[end..].fill(0.0);
    }
    let [red, green, blue] = &added;
    let added = [f64::from(L::sum(red)), f64::from(L::sum(green)), f64::from(L::sum(blue))];
    D::composite(light, added, f64::from(opacity));
}

/// What stands for an interval.
trait Rule {
    /// Per sample, the mean over its interval.
    fn means(previous: &mut Option<Rgbs<f32>>, run: &Run, samples: usize) -> Run;
}

struct OnePoint;
struct TwoPoints;

impl Rule for OnePoint {
    #[inline(always)]
    fn means(_: &mut Option<Rgbs<f32>>, run: &Run, _: usize) -> Run {
        *run
    }
}

impl Rule for TwoPoints {
    #[inline(always)]
    fn means(previous: &mut Option<Rgbs<f32>>, run: &Run, samples: usize) -> Run {
        let mut means = EMPTY;
        for (c, (means, run)) in means.iter_mut().zip(run).enumerate() {
            // The first sample of all closes no interval.
            means[0] = previous.map_or(0.0, |before| 0.5 * (before[c] + run[0]));
            for k in 1..samples {
                means[k] = 0.5 * (run[k - 1] + run[k]);
            }
        }
        *previous = Some(each(|c| run[c][samples - 1]));
        means
    }
}

/// What a sample's emission is multiplied by.
trait Measure {
    fn weight<L: Lanes>(depth: L, delta_mm: L) -> L;

    /// The share absorbed by an interval of this optical depth.
    #[inline(always)]
    fn opacity<L: Lanes>(_extinction: L, depth: L) -> L {
        depth.absorbed()
    }
}

struct PerLength;
struct PerSample;
/// Samples of a table that is made for one length of step: premultiplied colour and opacity of a step, not per mm.
struct PerStep;

impl Measure for PerStep {
    #[inline(always)]
    fn weight<L: Lanes>(_depth: L, _delta_mm: L) -> L {
        L::ONE
    }

    #[inline(always)]
    fn opacity<L: Lanes>(of_a_step: L, _depth: L) -> L {
        of_a_step
    }
}

impl Measure for PerLength {
    #[inline(always)]
    fn weight<L: Lanes>(depth: L, delta_mm: L) -> L {
        delta_mm * depth.mean_transmittance()
    }
}

impl Measure for PerSample {
    #[inline(always)]
    fn weight<L: Lanes>(_depth: L, _delta_mm: L) -> L {
        L::ONE
    }
}

/// What colour is composited.
trait Coloring {
    /// `share` of the light `added` by an interval of this opacity.
    fn contribution<L: Lanes>(added: L, opacity: L, share: L) -> L;
}

struct Associated;
struct Straight;

impl Coloring for Associated {
    #[inline(always)]
    fn contribution<L: Lanes>(added: L, _opacity: L, share: L) -> L {
        share * added
    }
}

impl Coloring for Straight {
    #[inline(always)]
    fn contribution<L: Lanes>(added: L, opacity: L, share: L) -> L {
        // What emits without absorbing has no straight colour.
        L::select(L::ZERO.lt(opacity), share * opacity * (added / opacity), share * added)
    }
}

/// From which end a ray is composited.
trait Direction {
    /// Numbers in the order they are visited, as the eye meets them.
    fn from_the_eye<const N: usize>(numbers: [[f32; SAMPLES]; N]) -> [[f32; SAMPLES]; N];

    /// Composites what has this opacity and adds this.
    fn composite(light: &mut Light, added: [f64; 3], opacity: f64);
}

struct FrontToBack;
struct BackToFront;

impl Direction for FrontToBack {
    #[inline(always)]
    fn from_the_eye<const N: usize>(numbers: [[f32; SAMPLES]; N]) -> [[f32; SAMPLES]; N] {
        numbers
    }

    #[inline(always)]
    fn composite(light: &mut Light, added: [f64; 3], opacity: f64) {
        light.color = each(|c| light.color[c] + light.transmittance * added[c]);
        light.transmittance -= light.transmittance * opacity;
    }
}

impl Direction for BackToFront {
    #[inline(always)]
    fn from_the_eye<const N: usize>(mut numbers: [[f32; SAMPLES]; N]) -> [[f32; SAMPLES]; N] {
        numbers.iter_mut().for_each(|all| all.reverse());
        numbers
    }

    #[inline(always)]
    fn composite(light: &mut Light, added: [f64; 3], opacity: f64) {
        light.color = each(|c| light.color[c] - light.color[c] * opacity + added[c]);
        light.transmittance -= light.transmittance * opacity;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Lattice, Reflection};

    const SETTINGS: March = March {
        step_mm: 1.0,
        rule: SampleRule::Midpoint,
        order: Order::FrontToBack,
        colors: Colors::Associated,
        emission: Emission::PerLength,
        lattice: Lattice::PerRay,
        bisections: 0,
        jitter: None,
        termination_transmittance: 0.0,
        table: None,
        reflection: Reflection::BlinnPhong,
    };

    fn folded(settings: &March, samples: &[Rgbs<f32>], delta_mm: f32) -> Light {
        let mut light = Light::new(settings);
        for batch in samples.chunks(SAMPLES) {
            if light.is_spent() {
                break;
            }
            let mut run = EMPTY;
            for (k, sample) in batch.iter().enumerate() {
                for c in 0..4 {
                    run[c][k] = sample[c];
                }
            }
            fold(settings)(&mut light, &run, &[delta_mm; SAMPLES], batch.len());
        }
        light
    }

    #[test]
    fn emission_without_absorption_adds_up() {
        let light = folded(&SETTINGS, &[[0.25, 0.0, 0.0, 0.0]; 8], 0.5);
        assert_eq!((light.color[0], light.transmittance), (1.0, 1.0), "q L, and nothing absorbed");
        let faint = folded(&SETTINGS, &[[0.25, 0.0, 0.0, 1e-42]; 8], 0.5);
        assert_eq!(faint.color[0], 1.0, "an extinction whose square vanishes");
    }

    #[test]
    fn many_thin_intervals_absorb() {
        for (count, opacity) in [(100_000, 1e-5f32), (1_000_000, 1e-8)] {
            let light = folded(&SETTINGS, &vec![[opacity, 0.0, 0.0, opacity]; count], 1.0);
            let expected = -(-f64::from(opacity) * count as f64).exp_m1();
            let apart = (1.0 - light.transmittance) / expected - 1.0;
            assert!(apart.abs() < 1e-6, "{count} of opacity {opacity:e}: {apart:e} from {expected}, relatively");
            let sum = light.color[0] + light.transmittance;
            assert!((sum - 1.0).abs() < 1e-6, "what is absorbed is emitted again: {sum}");
        }
    }

    #[test]
    fn an_enormous_extinction_is_opaque_and_no_nan() {
        let light = folded(&SETTINGS, &[[1e30, 0.0, 0.0, 1e30], [5.0, 0.0, 0.0, 1e30]], 10.0);
        assert_eq!((light.color[0], light.transmittance), (1.0, 0.0));
    }

    #[test]
    fn emission_per_sample_ignores_the_length() {
        let settings = March { emission: Emission::PerSample, ..SETTINGS };
        for delta in [0.1, 1.0] {
            assert_eq!(folded(&settings, &[[0.25, 0.0, 0.0, 0.0]; 4], delta).color[0], 1.0, "step {delta}");
        }
    }

    #[test]
    fn the_trapezoid_reads_both_ends() {
        let settings = March { rule: SampleRule::Trapezoid, ..SETTINGS };
        let light = folded(&settings, &[[0.0; 4], [1.0, 0.0, 0.0, 0.0], [0.0; 4]], 1.0);
        assert_eq!(light.color[0], 1.0, "two halves; the first sample closes no interval");
    }

    #[test]
    fn a_spent_ray_stops() {
        let settings = March { termination_transmittance: 0.01, ..SETTINGS };
        let light = folded(&settings, &[[0.0, 0.0, 0.0, 1.0]; 100], 1.0);
        assert!(light.is_spent());
        // e⁻⁴ is above the limit, e⁻⁵ below.
        let expected = (-5.0f64).exp();
        assert!((light.transmittance - expected).abs() < 1e-7, "found {}", light.transmittance);
    }
}
