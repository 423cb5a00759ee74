//! Compositing of a run of samples.
//!
//! With `x = σΔ` an interval absorbs the share `A = 1 − e^{−x}` of the light from behind and adds `L = q Δ A/x`, which is
//! `A q/σ`, and `qΔ` where nothing absorbs. `A` and `L` are computed in f32, accurate relative to themselves, but summed
//! in f64, with transmittance updated as `T −= T A`: in f32, intervals of opacity 1e-8 would leave `T` at 1 however many
//! there are, and a small step would turn the volume transparent.

use crate::classify::Rgbs;
use crate::integrate::tiles::Radiance;
use crate::math::{absorbed_f32, mean_transmittance_f32};
use crate::plan::{Colors, Emission, March, Order, SampleRule};
use crate::scene::Haze;

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
            Order::FrontToBack => settings.termination_transmittance,
            Order::BackToFront => 0.0,
        };
        let stretch = match settings.order {
            Order::FrontToBack => FrontToBack::composite::<Associated>,
            Order::BackToFront => BackToFront::composite::<Associated>,
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
        FrontToBack::composite::<Associated>(self, added, opacity);
    }

    /// What reaches the eye, after so many samples.
    #[inline(always)]
    pub(super) fn radiance(&self, samples: u64) -> Radiance {
        Radiance { color: self.color, transmittance: self.transmittance, samples, error_bound: 0.0 }
    }

    /// True when a ray need not go on.
    #[inline(always)]
    pub(super) fn is_spent(&self) -> bool {
        self.transmittance < self.stop_below
    }
}

/// Composites samples in the order they are visited; each stands for `delta_mm`. Stops when the light is spent.
pub(super) type Fold = fn(&mut Light, &[Rgbs<f32>], f32);

/// The fold that these settings ask for.
pub(super) fn fold(settings: &March) -> Fold {
    match settings.rule {
        SampleRule::Left | SampleRule::Midpoint | SampleRule::WholeSteps => by_order::<OnePoint>(settings),
        SampleRule::Trapezoid => by_order::<TwoPoints>(settings),
    }
}

fn by_order<R: Rule>(settings: &March) -> Fold {
    match settings.order {
        Order::FrontToBack => by_colors::<R, FrontToBack>(settings),
        Order::BackToFront => by_colors::<R, BackToFront>(settings),
    }
}

fn by_colors<R: Rule, D: Direction>(settings: &March) -> Fold {
    if settings.table.is_some() {
        return fold_run::<R, D, Associated, PerStep>;
    }
    match (settings.colors, settings.emission) {
        (Colors::Associated, Emission::PerLength) => fold_run::<R, D, Associated, PerLength>,
        (Colors::Associated, Emission::PerSample) => fold_run::<R, D, Associated, PerSample>,
        (Colors::Straight, Emission::PerLength) => fold_run::<R, D, Straight, PerLength>,
        (Colors::Straight, Emission::PerSample) => fold_run::<R, D, Straight, PerSample>,
    }
}

fn fold_run<R: Rule, D: Direction, K: Coloring, E: Measure>(light: &mut Light, run: &[Rgbs<f32>], delta_mm: f32) {
    for &sample in run {
        let Some(mean) = R::mean(&mut light.previous, sample) else { continue };
        if mean == [0.0; 4] {
            continue;
        }
        let [r, g, b, extinction] = mean;
        let depth = extinction * delta_mm;
        let weight = E::weight(depth, delta_mm);
        let added = [r, g, b].map(|q| f64::from(q * weight));
        D::composite::<K>(light, added, f64::from(E::opacity(extinction, depth)));
        if light.is_spent() {
            return;
        }
    }
}

/// What stands for an interval.
trait Rule {
    fn mean(previous: &mut Option<Rgbs<f32>>, sample: Rgbs<f32>) -> Option<Rgbs<f32>>;
}

struct OnePoint;
struct TwoPoints;

impl Rule for OnePoint {
    #[inline(always)]
    fn mean(_previous: &mut Option<Rgbs<f32>>, sample: Rgbs<f32>) -> Option<Rgbs<f32>> {
        Some(sample)
    }
}

impl Rule for TwoPoints {
    #[inline(always)]
    fn mean(previous: &mut Option<Rgbs<f32>>, sample: Rgbs<f32>) -> Option<Rgbs<f32>> {
        let before = previous.replace(sample)?;
        Some(std::array::from_fn(|c| 0.5 * (before[c] + sample[c])))
    }
}

/// What a sample's emission is multiplied by.
trait Measure {
    fn weight(depth: f32, delta_mm: f32) -> f32;

    /// The share absorbed by an interval of this optical depth.
    #[inline(always)]
    fn opacity(_extinction: f32, depth: f32) -> f32 {
        absorbed_f32(depth)
    }
}

struct PerLength;
struct PerSample;
/// Samples of a table that is made for one length of step: premultiplied colour and opacity of a step, not per mm.
struct PerStep;

impl Measure for PerStep {
    #[inline(always)]
    fn weight(_depth: f32, _delta_mm: f32) -> f32 {
        1.0
    }

    #[inline(always)]
    fn opacity(of_a_step: f32, _depth: f32) -> f32 {
        of_a_step
    }
}

impl Measure for PerLength {
    #[inline(always)]
    fn weight(depth: f32, delta_mm: f32) -> f32 {
        delta_mm * mean_transmittance_f32(depth)
    }
}

impl Measure for PerSample {
    #[inline(always)]
    fn weight(_depth: f32, _delta_mm: f32) -> f32 {
        1.0
    }
}

/// What colour is composited.
trait Coloring {
    /// `share` of the light `added` by an interval of this opacity.
    fn contribution(added: [f64; 3], opacity: f64, share: f64) -> [f64; 3];
}

struct Associated;
struct Straight;

impl Coloring for Associated {
    #[inline(always)]
    fn contribution(added: [f64; 3], _opacity: f64, share: f64) -> [f64; 3] {
        added.map(|x| share * x)
    }
}

impl Coloring for Straight {
    #[inline(always)]
    fn contribution(added: [f64; 3], opacity: f64, share: f64) -> [f64; 3] {
        if opacity > 0.0 {
            let straight = added.map(|x| x / opacity);
            straight.map(|x| share * opacity * x)
        } else {
            // What emits without absorbing has no straight colour.
            added.map(|x| share * x)
        }
    }
}

/// From which end a ray is composited.
trait Direction {
    fn composite<K: Coloring>(light: &mut Light, added: [f64; 3], opacity: f64);
}

struct FrontToBack;
struct BackToFront;

impl Direction for FrontToBack {
    #[inline(always)]
    fn composite<K: Coloring>(light: &mut Light, added: [f64; 3], opacity: f64) {
        let more = K::contribution(added, opacity, light.transmittance);
        light.color = std::array::from_fn(|c| light.color[c] + more[c]);
        light.transmittance -= light.transmittance * opacity;
    }
}

impl Direction for BackToFront {
    #[inline(always)]
    fn composite<K: Coloring>(light: &mut Light, added: [f64; 3], opacity: f64) {
        let more = K::contribution(added, opacity, 1.0);
        light.color = std::array::from_fn(|c| light.color[c] - light.color[c] * opacity + more[c]);
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
        fold(settings)(&mut light, samples, delta_mm);
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
        let expected = (-5.0f64).exp();
        assert!((light.transmittance - expected).abs() < 1e-6, "stops after 5: found {}", light.transmittance);
    }
}
