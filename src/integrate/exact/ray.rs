//! One ray, cell by cell and piece by piece, within its budget.

use crate::math::Real;
use crate::scene::{Ray, Scene};
use crate::transfer::TransferFunction;

use super::budget::Budget;
use super::cells::{Domain, Segment};
use super::medium::Medium;
use super::shade::Shader;
use super::splits::Splits;
use super::stream::DEVIATIONS;

/// A piece is not halved below this fraction of a segment; what it then costs is charged to the bound.
const SMALLEST_PIECE: f64 = 1.0 / 65536.0;

/// What a cut at a jump that rounding has misplaced may cost, over the tolerance, before the ray is traced in f64.
const OF_A_CUT: f64 = 0.01;

/// What a ray brings.
#[derive(Debug, Clone, Copy)]
pub struct Traced {
    /// Light towards the eye from the volume, linear RGB.
    pub radiance: [f64; 3],
    /// What is left of light from behind the volume.
    pub transmittance: f64,
    /// What is absorbed of it, `1 − transmittance`, with all its digits however small it is.
    pub opacity: f64,
    /// Bound on the error of a channel of `radiance` and of `transmittance`, rounding estimated; proven, but for what
    /// [`Precision::Estimated`](super::Precision::Estimated) estimates.
    pub bound: f64,
    /// Pieces integrated, those rejected included.
    pub pieces: u64,
}

/// What all rays of a frame share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<'a> {
    pub(super) domain: Domain<'a>,
    pub(super) tolerance: f64,
    pub(super) brightest: Brightest,
    /// Whether a ray ends as soon as its budget allows for all that may follow.
    pub(super) ends_early: bool,
}

/// Bounds on the light that the rest of a ray may bring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Brightest {
    /// Of emission over extinction before shading; infinite if something emits without absorbing.
    pub(super) color: f64,
    /// Of emission before shading, 1/mm.
    pub(super) emission_per_mm: f64,
    /// Of shaded emission over extinction; infinite if something emits without absorbing.
    pub(super) per_absorbed: f64,
    /// Of shaded emission, 1/mm.
    pub(super) per_mm: f64,
    /// Of extinction, 1/mm.
    pub(super) extinction_per_mm: f64,
}

impl Brightest {
    /// Bounds for a scene.
    pub(super) fn of(scene: &Scene) -> Self {
        let (mut color, mut emission, mut extinction) = (0.0f64, 0.0f64, 0.0f64);
        for optics in scene.transfer_functions().flat_map(TransferFunction::corners) {
            let q = optics.emission_per_mm.into_iter().fold(0.0, f64::max);
            emission = emission.max(q);
            extinction = extinction.max(optics.extinction_per_mm);
            color = color.max(optics.largest_color());
        }
        let (reflected, highlight) = scene.shading.as_ref().map_or((1.0, 0.0), |s| s.largest_factors());
        let unshaded = Brightest {
            color,
            emission_per_mm: emission,
            per_absorbed: color,
            per_mm: emission,
            extinction_per_mm: extinction,
        };
        unshaded.shaded(reflected, highlight)
    }

    /// The same where shading multiplies emission and extinction by factors up to these.
    pub(super) fn shaded(self, reflected: f64, highlight: f64) -> Self {
        // A product of ∞ and 0 would be NaN.
        let per_absorbed = if reflected > 0.0 { self.color * reflected } else { 0.0 };
        Brightest {
            per_absorbed: per_absorbed + highlight,
            per_mm: self.emission_per_mm * reflected + self.extinction_per_mm * highlight,
            ..self
        }
    }

    /// The same where some of it may look like fog of this colour instead.
    pub(super) fn fogged(self, color: f64) -> Self {
        Brightest {
            per_absorbed: self.per_absorbed.max(color),
            per_mm: self.per_mm.max(self.extinction_per_mm * color),
            ..self
        }
    }

    /// The same in a medium that adds this extinction, in a colour up to this.
    pub(super) fn in_haze(self, extinction_per_mm: f64, color: f64) -> Self {
        Brightest {
            per_absorbed: self.per_absorbed.max(color),
            per_mm: self.per_mm + extinction_per_mm * color,
            extinction_per_mm: self.extinction_per_mm + extinction_per_mm,
            ..self
        }
    }

    /// Bound on the error of a channel if a ray is cut short at a transmittance, `rest_mm` before its end.
    fn of_rest(&self, transmittance: f64, rest_mm: f64) -> f64 {
        transmittance * self.per_absorbed.min(self.per_mm * rest_mm).max(1.0)
    }
}

impl Frame<'_> {
    /// Traces one ray.
    pub(super) fn trace<R: Real, M: Medium<R>, S: Shader<R>>(
        &self,
        ray: &Ray,
        medium: &M,
        shader: &S,
        splits: &mut Splits<R>,
    ) -> Option<Traced> {
        let mut light = Front::new(self.tolerance);
        let space = |length_mm: f64| shader.space(R::from_f64(length_mm));
        let Some(inside) = self.domain.inside(ray) else {
            light.cross(space(shader.space_end_mm()?));
            return Some(light.ended(0.0));
        };
        let end_mm = shader.space_end_mm().unwrap_or(inside.exit_mm());
        light.cross(space(inside.enter_mm()));
        for segment in self.domain.segments(inside) {
            let Some(fields) = medium.fields(&segment) else {
                light.cross(space(segment.length_mm));
                continue;
            };
            self.pass_fields(
                &segment,
                &fields,
                |mm| (mm - inside.enter_mm()) / inside.length_mm(),
                medium,
                shader,
                splits,
                &mut light,
            );
            let rest = self.brightest.of_rest(light.transmittance, end_mm - segment.exit_mm);
            if self.ends_early && light.budget.may_end(rest) {
                return Some(light.ended(rest));
            }
        }
        light.cross(space(end_mm - inside.exit_mm()));
        Some(light.ended(0.0))
    }

    /// Passes a segment; `fraction` gives the part of the ray in front of a distance from its origin, mm.
    pub(super) fn pass<R: Real, M: Medium<R>, S: Shader<R>>(
        &self,
        segment: &Segment,
        fraction: impl Fn(f64) -> f64,
        medium: &M,
        shader: &S,
        splits: &mut Splits<R>,
        light: &mut Front,
    ) {
        if let Some(fields) = medium.fields(segment) {
            self.pass_fields(segment, &fields, fraction, medium, shader, splits, light);
        }
    }

    #[expect(clippy::too_many_arguments, reason = "a segment, what is on it, and who integrates it")]
    #[inline(always)]
    fn pass_fields<R: Real, M: Medium<R>, S: Shader<R>>(
        &self,
        segment: &Segment,
        fields: &M::Fields,
        fraction: impl Fn(f64) -> f64,
        medium: &M,
        shader: &S,
        splits: &mut Splits<R>,
        light: &mut Front,
    ) {
        let shading = shader.cell(segment, || medium.gradient(fields, segment));
        splits.restart(R::from_f64(self.harm_per_mm() * segment.length_mm));
        medium.cut(fields, splits);
        shader.cut(&shading, splits);
        splits.sorted();
        let front_mm = segment.exit_mm - segment.length_mm;
        for i in 1..splits.len() {
            let ends = [splits.get(i - 1), splits.get(i)];
            light.pass(ends, |part| {
                let length_mm = R::from_f64(segment.length_mm) * (part[1] - part[0]);
                let integral = medium.integrate(fields, part, length_mm, shader, &shading);
                let integral = integral.or_else(|| shader.space(length_mm))?;
                Some((integral, fraction(front_mm + part[1].to_f64() * segment.length_mm)))
            });
        }
    }

    /// What one mm of a misplaced cut may cost, over what it may.
    pub(super) fn harm_per_mm(&self) -> f64 {
        self.brightest.per_mm.max(self.brightest.extinction_per_mm) / (OF_A_CUT * self.tolerance)
    }
}

/// Light and error gathered so far, front to back.
#[derive(Debug)]
pub(super) struct Front {
    pub(super) radiance: [f64; 3],
    pub(super) transmittance: f64,
    pub(super) opacity: f64,
    pub(super) budget: Budget,
    /// Of errors that are estimated.
    pub(super) variance: f64,
    pub(super) pieces: u64,
}

impl Front {
    #[inline(always)]
    pub(super) fn new(tolerance: f64) -> Self {
        Front {
            radiance: [0.0; 3],
            transmittance: 1.0,
            opacity: 0.0,
            budget: Budget::new(tolerance),
            variance: 0.0,
            pieces: 0,
        }
    }

    /// What the budget still allows up to a fraction of the ray, without absorbing any further.
    pub(super) fn left(&self, fraction: f64) -> f64 {
        self.budget.left(self.transmittance, fraction)
    }

    /// Passes a stretch whose integral has a closed form.
    #[inline(always)]
    fn cross<R: Real>(&mut self, stretch: Option<super::piece::Integral<R>>) {
        let Some(integral) = stretch else { return };
        let t = self.transmittance;
        for (sum, &x) in self.radiance.iter_mut().zip(&integral.radiance) {
            *sum += t * x.to_f64();
        }
        self.opacity += t * integral.absorbed.to_f64();
        self.transmittance = t - t * integral.absorbed.to_f64();
        self.budget.spend(t * integral.error.to_f64());
    }

    /// Passes the part of a segment between two cuts, in as few pieces as the budget allows. `integrate` gives the integral
    /// over a piece and the fraction of the ray that its end leaves behind, or `None` if nothing happens on it.
    #[inline(always)]
    fn pass<R: Real>(
        &mut self,
        [start, end]: [R; 2],
        integrate: impl Fn([R; 2]) -> Option<(super::piece::Integral<R>, f64)>,
    ) {
        let (mut from, mut to) = (start, end);
        while from < end {
            let Some((integral, fraction)) = integrate([from, to]) else { return };
            self.pieces += 1;
            let t = self.transmittance;
            let next = t - t * integral.absorbed.to_f64();
            let error = t * integral.error.to_f64();
            let left = self.budget.left(next, fraction);
            let length = to - from;
            if error > left && length.to_f64() > SMALLEST_PIECE {
                // The error falls with the cube of the length, what is allowed with the length.
                let shrink = (0.9 * (left / error).max(0.0).sqrt()).clamp(0.05, 0.5);
                to = from + length * R::from_f64(shrink);
                continue;
            }
            for (sum, &x) in self.radiance.iter_mut().zip(&integral.radiance) {
                *sum += t * x.to_f64();
            }
            self.opacity += t * integral.absorbed.to_f64();
            self.transmittance = next;
            self.budget.spend(error);
            from = to;
            // The next piece probably fares like this one, but is not left a sliver.
            let grown = length * R::from_f64(1.5);
            to = if end - from <= grown { end } else { from + grown };
        }
    }

    pub(super) fn ended(&self, rest: f64) -> Traced {
        Traced {
            radiance: self.radiance,
            transmittance: self.transmittance,
            opacity: self.opacity,
            bound: self.budget.bound(rest) + DEVIATIONS * self.variance.sqrt(),
            pieces: self.pieces,
        }
    }
}
