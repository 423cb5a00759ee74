//! Compositing of a run of samples.
//!
//! With `x = σΔ` an interval absorbs the share `A = 1 − e^{−x}` of the light from behind and adds `L = q Δ A/x`, which is
//! `A q/σ`, and `qΔ` where nothing absorbs. Transmittance is updated as `T −= T A`: a stored `1 − A` rounds to 1 for the
//! opacities of small steps, and the volume would never become opaque.

use crate::classify::Rgbs;
use crate::math::{absorbed_f32, mean_transmittance_f32};
use crate::plan::{Colors, Emission, March, Order, SampleRule};

/// Light gathered along a ray so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Light {
    /// Linear RGB, premultiplied.
    pub(super) color: [f32; 3],
    /// Of what has been visited.
    pub(super) transmittance: f32,
    /// A front-to-back ray stops below this.
    stop_below: f32,
    /// The sample before, for rules that read two.
    previous: Option<Rgbs<f32>>,
}

impl Light {
    /// Before the first sample.
    pub(super) fn new(settings: &March) -> Self {
        let stop_below = match settings.order {
            Order::FrontToBack => settings.termination_transmittance as f32,
            Order::BackToFront => 0.0,
        };
        Light { color: [0.0; 3], transmittance: 1.0, stop_below, previous: None }
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
        SampleRule::Left | SampleRule::Midpoint => by_order::<OnePoint>(settings),
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
    match (settings.colors, settings.emission) {
        (Colors::Associated, Emission::PerLength) => fold_run::<R, D, Associated, PerLength>,
        (Colors::Associated, Emission::PerSample) => fold_run::<R, D, Associated, PerSample>,
        (Colors::Straight, Emission::PerLength) => fold_run::<R, D, Straight, PerLength>,
        (Colors::Straight, Emission::PerSample) => fold_run::<R, D, Straight, PerSample>,
    }
}

fn fold_run<R: Rule, D: Direction, K: Coloring, E: Measure>(light: &mut Light, run: &[Rgbs<f32>], delta_mm: f32) {
    for &sample in run {
        let Some([r, g, b, extinction]) = R::mean(&mut light.previous, sample) else { continue };
        let depth = extinction * delta_mm;
        let weight = E::weight(depth, delta_mm);
        let added = [r * weight, g * weight, b * weight];
        D::composite::<K>(light, added, absorbed_f32(depth));
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
}

struct PerLength;
struct PerSample;

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
    fn contribution(added: [f32; 3], opacity: f32, share: f32) -> [f32; 3];
}

struct Associated;
struct Straight;

impl Coloring for Associated {
    #[inline(always)]
    fn contribution(added: [f32; 3], _opacity: f32, share: f32) -> [f32; 3] {
        added.map(|x| share * x)
    }
}

impl Coloring for Straight {
    #[inline(always)]
    fn contribution(added: [f32; 3], opacity: f32, share: f32) -> [f32; 3] {
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
    fn composite<K: Coloring>(light: &mut Light, added: [f32; 3], opacity: f32);
}

struct FrontToBack;
struct BackToFront;

impl Direction for FrontToBack {
    #[inline(always)]
    fn composite<K: Coloring>(light: &mut Light, added: [f32; 3], opacity: f32) {
        let more = K::contribution(added, opacity, light.transmittance);
        for c in 0..3 {
            light.color[c] += more[c];
        }
        light.transmittance -= light.transmittance * opacity;
    }
}

impl Direction for BackToFront {
    #[inline(always)]
    fn composite<K: Coloring>(light: &mut Light, added: [f32; 3], opacity: f32) {
        let more = K::contribution(added, opacity, 1.0);
        for c in 0..3 {
            light.color[c] += more[c] - light.color[c] * opacity;
        }
        light.transmittance -= light.transmittance * opacity;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Lattice;

    const SETTINGS: March = March {
        step_mm: 1.0,
        rule: SampleRule::Midpoint,
        order: Order::FrontToBack,
        colors: Colors::Associated,
        emission: Emission::PerLength,
        lattice: Lattice::PerRay,
        jitter: None,
        termination_transmittance: 0.0,
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
    fn a_hundred_thousand_thin_intervals_absorb() {
        let samples = vec![[0.0, 0.0, 0.0, 1e-3]; 100_000];
        let light = folded(&SETTINGS, &samples, 1e-2);
        let expected = (-1.0f64).exp();
        assert!((f64::from(light.transmittance) - expected).abs() < 1e-4, "found {}", light.transmittance);
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
        let expected = (-5.0f32).exp();
        assert!((light.transmittance - expected).abs() < 1e-6, "stops after 5: found {}", light.transmittance);
    }
}
