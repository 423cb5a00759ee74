//! What absorbs and emits along a ray.

use super::by_place::ByPlace;
use super::composite::{EMPTY, Run};
use crate::classify::Rgbs;
use crate::field::{Batch, GradientUnits, Magnitude, Position, Spacing, Trilinear, Voxel};
use crate::integrate::shade::{Course, Shader, Spot};
use crate::scene::Haze;
use crate::simd::Lanes;

/// What absorbs and emits. It reads of the volume what it needs, and nothing else; chosen by type, once per frame.
pub(in super::super) trait Medium: Sync {
    /// What is constant along a ray.
    type Aim: Default + Send;
    /// Whether it reads the offsets of a batch.
    const BY_LANES: bool;

    /// Computes what is constant along a ray.
    fn aim(&self, course: &Course, aim: &mut Self::Aim);

    /// Shaded emission and extinction of a batch, 1/mm, none of them negative and 0 behind the last sample; `None` if there is
    /// nothing.
    fn run<L: Lanes>(&self, aim: &Self::Aim, batch: &Batch<'_>, distance_mm: impl Fn(usize) -> f64) -> Option<Run>;

    /// What is there where nothing absorbs or emits of itself.
    #[inline(always)]
    fn space(&self) -> Rgbs<f32> {
        [0.0; 4]
    }

    /// The medium that is there, if it fills the space around the volume too.
    #[inline(always)]
    fn haze(&self) -> Option<&Haze> {
        None
    }
}

/// A medium that is sampled at one position at a time.
pub(in super::super) trait Pointwise: Sync {
    /// What is constant along a ray.
    type Aim: Default + Send;

    /// Computes what is constant along a ray.
    fn aim(&self, course: &Course, aim: &mut Self::Aim);

    /// Shaded emission and extinction at a position, this far from the ray's origin, 1/mm, none of them negative.
    fn sample(&self, aim: &Self::Aim, position: Position, distance_mm: f64) -> Rgbs<f32>;

    /// What is there where nothing absorbs or emits of itself.
    #[inline(always)]
    fn space(&self) -> Rgbs<f32> {
        [0.0; 4]
    }

    /// The medium that is there, if it fills the space around the volume too.
    #[inline(always)]
    fn haze(&self) -> Option<&Haze> {
        None
    }
}

/// A medium, one sample after the other.
pub(in super::super) struct OneByOne<'a, M>(pub(in super::super) &'a M);

impl<M: Pointwise> Medium for OneByOne<'_, M> {
    type Aim = M::Aim;
    const BY_LANES: bool = false;

    fn aim(&self, course: &Course, aim: &mut M::Aim) {
        self.0.aim(course, aim);
    }

    #[inline(always)]
    fn run<L: Lanes>(&self, aim: &M::Aim, batch: &Batch<'_>, distance_mm: impl Fn(usize) -> f64) -> Option<Run> {
        let mut run = EMPTY;
        let mut any = false;
        for k in 0..batch.samples {
            let sample = self.0.sample(aim, batch.position(k), distance_mm(k));
            any |= sample != [0.0; 4];
            for c in 0..4 {
                run[c][k] = sample[c];
            }
        }
        any.then_some(run)
    }

    #[inline(always)]
    fn space(&self) -> Rgbs<f32> {
        self.0.space()
    }

    #[inline(always)]
    fn haze(&self) -> Option<&Haze> {
        self.0.haze()
    }
}

/// A scalar field, classified and shaded at each sample.
pub(in super::super) struct Classified<'a, V, K, C, S> {
    pub(in super::super) field: Trilinear<'a, V, K>,
    /// The gradient magnitude, HU/mm; there if the transfer function reads it.
    pub(in super::super) magnitude: Option<Magnitude<'a>>,
    pub(in super::super) units: GradientUnits,
    pub(in super::super) classifier: &'a C,
    pub(in super::super) shader: &'a S,
}

impl<V: Voxel, K: Spacing, C: ByPlace, S: Shader> Pointwise for Classified<'_, V, K, C, S> {
    type Aim = S::Aim;

    fn aim(&self, course: &Course, aim: &mut S::Aim) {
        self.shader.aim(course, aim);
    }

    #[inline(always)]
    fn sample(&self, aim: &S::Aim, position: Position, distance_mm: f64) -> Rgbs<f32> {
        let cell = self.field.cell(position);
        let magnitude = match &self.magnitude {
            Some(magnitude) if C::READS_GRADIENT => magnitude.value(&cell),
            _ => 0.0,
        };
        let optics = self.classifier.classify_in(&cell, self.field.value(&cell), magnitude);
        // Rounding may leave a trace below 0 at the foot of a ramp.
        let optics = optics.map(|x| if x > 0.0 { x } else { 0.0 });
        if !S::SHADES {
            return optics;
        }
        if optics == [0.0; 4] {
            return self.shader.space();
        }
        let gradient = || self.units.per_mm(self.shader.gradient_per_index(aim, &self.field, position, &cell));
        self.shader.shade(aim, optics, &Spot { cell, distance_mm }, gradient)
    }

    #[inline(always)]
    fn space(&self) -> Rgbs<f32> {
        self.shader.space()
    }

    #[inline(always)]
    fn haze(&self) -> Option<&Haze> {
        self.shader.haze()
    }
}
