//! Levoy's shading along a piece, enclosed between linear functions with a proven error.
//!
//! Where the interpolated gradient `g(u)` keeps away from 0, its direction `n = g/|g|` is smooth, and over a piece with
//! parameter `u ∈ [0, 1]`, with `G = max|g′|`, `M = max|g″|`, `ρ = min|g|` and `a = G/ρ`:
//!
//! ```text
//! |n′| ≤ a,     |n″| ≤ (2/√3) a² + M/ρ
//! ```
//!
//! (`n′ = P g′/|g|` with the projection `P` across `n`; differentiating once more and maximising over the direction of `g′`
//! gives the constant.) From these follow bounds on the second derivative of `w(|g|) · d(n·l)` and of `w(|g|) · d(n·h)^p`,
//! and a function with `|f″| ≤ K` is within `K/8` of the line through its ends. All maxima and minima come from Bernstein
//! coefficients, so they hold for the whole piece. Cuts at the roots of `g·l`, cubics too, keep the kinks of `d` out of the
//! pieces. Where `g` may vanish, the factors' ranges bound the error instead.

use glam::DVec3;

use crate::math::bernstein::{Cubic, restrict, value};
use crate::math::{Real, each};
use crate::scene::Shading;

use super::cells::Segment;
use super::piece::{Integral, LinearFactors, Optics};
use super::splits::Splits;

/// How emission is shaded, and what else there is along a ray; chosen by type.
pub(super) trait Shader<R: Real> {
    /// What it keeps of a segment.
    type Cell;

    /// Prepares a segment; `gradient` gives the gradient along it, HU/mm.
    fn cell(&self, segment: &Segment, gradient: impl FnOnce() -> [Cubic<R>; 3]) -> Self::Cell;
    /// Cuts the segment at kinks.
    fn cut(&self, cell: &Self::Cell, splits: &mut Splits<R>);
    /// The integral over the part `[from, to]` of the segment, of this length, which lies between cuts; `M` must be `N + 1`.
    fn integrate<const N: usize, const M: usize>(
        &self,
        optics: &Optics<R, N>,
        length_mm: R,
        cell: &Self::Cell,
        part: [R; 2],
    ) -> Integral<R>;

    /// What a stretch does to light on which the transfer function shows nothing; `None` for nothing.
    #[inline(always)]
    fn space(&self, _length_mm: R) -> Option<Integral<R>> {
        None
    }

    /// Distance from a ray's origin up to which such stretches do something; `None` if they do nothing anywhere.
    #[inline(always)]
    fn space_end_mm(&self) -> Option<f64> {
        None
    }
}

/// Emission as it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unlit;

impl<R: Real> Shader<R> for Unlit {
    type Cell = ();

    #[inline(always)]
    fn cell(&self, _: &Segment, _: impl FnOnce() -> [Cubic<R>; 3]) {}
    #[inline(always)]
    fn cut(&self, (): &(), _: &mut Splits<R>) {}
    #[inline(always)]
    fn integrate<const N: usize, const M: usize>(
        &self,
        optics: &Optics<R, N>,
        length_mm: R,
        (): &(),
        _: [R; 2],
    ) -> Integral<R> {
        optics.integrate(length_mm)
    }
}

/// Shading of [`Shading`] on one ray.
#[derive(Debug, Clone)]
pub(super) struct Lit<R> {
    ambient: R,
    diffuse: R,
    specular: R,
    shininess: R,
    two_sided: bool,
    /// g₀², (HU/mm)².
    soft_square: R,
    lights: Vec<RayLight<R>>,
    largest_color: R,
}

/// A light as one ray sees it.
#[derive(Debug, Clone, Copy)]
struct RayLight<R> {
    towards: [R; 3],
    half: [R; 3],
    color: [R; 3],
}

impl<R: Real> Lit<R> {
    /// The shading on a ray of this direction, of colours up to `largest_color`.
    pub(super) fn new(shading: &Shading, direction: DVec3, largest_color: f64) -> Self {
        let vector = |v: DVec3| v.to_array().map(R::from_f64);
        let lights = shading.directions(direction).map(|(towards, half, color)| RayLight {
            towards: vector(towards),
            half: vector(half),
            color: color.map(R::from_f64),
        });
        Lit {
            ambient: R::from_f64(shading.ambient),
            diffuse: R::from_f64(shading.diffuse),
            specular: R::from_f64(shading.specular),
            shininess: R::from_f64(shading.shininess),
            two_sided: shading.two_sided,
            soft_square: R::from_f64(shading.soft_gradient_per_mm * shading.soft_gradient_per_mm),
            lights: lights.collect(),
            largest_color: R::from_f64(largest_color),
        }
    }

    /// How much of a light reaches the eye from a gradient: `w d(n·l)` and `w d(n·h)^p`. `facing` is the sign of `n·l` on
    /// the piece: at its ends, where `n·l` may be 0, it says from which side.
    #[inline]
    fn light(&self, light: &RayLight<R>, g: &[R; 3], facing: bool) -> [R; 2] {
        let square = dot(g, g);
        if square == R::ZERO || !(facing || self.two_sided) {
            return [R::ZERO; 2];
        }
        let fade = square / (square + self.soft_square);
        let inverse = R::ONE / square.sqrt();
        // n = −g/|g|.
        let (lambert, shine) = (-dot(g, &light.towards) * inverse, -dot(g, &light.half) * inverse);
        let clamp = |x: R| if self.two_sided { x.abs() } else { x.max(R::ZERO) };
        let gloss = if self.specular == R::ZERO { R::ZERO } else { clamp(shine).min(R::ONE).powf(self.shininess) };
        [fade * clamp(lambert), fade * gloss]
    }
}

#[inline(always)]
fn dot<R: Real>(a: &[R; 3], b: &[R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn along_light<R: Real>(g: &[Cubic<R>; 3], l: &[R; 3]) -> Cubic<R> {
    each(|k| g[0][k] * l[0] + g[1][k] * l[1] + g[2][k] * l[2])
}

/// How much of a light reaches the eye along a piece: the diffuse and the specular term without their strengths and the
/// light's colour, at the front and the back, and their largest distances from the lines between.
#[derive(Debug, Clone, Copy)]
pub(super) struct LightTerms<R> {
    pub(super) lambert: [R; 2],
    pub(super) gloss: [R; 2],
    pub(super) lambert_error: R,
    pub(super) gloss_error: R,
}

impl<R: Real> Lit<R> {
    /// The terms of a light over a piece along which this is the gradient, and how it varies.
    #[inline(always)]
    fn terms(&self, light: &RayLight<R>, g: &[Cubic<R>; 3], bounds: &Variation<R>) -> LightTerms<R> {
        let at = |k: usize| [g[0][k], g[1][k], g[2][k]];
        // The normal is against the gradient.
        let facing = value(&along_light(g, &light.towards), R::from_f64(0.5)) < R::ZERO;
        let [front, back] = [self.light(light, &at(0), facing), self.light(light, &at(3), facing)];
        let mut terms = LightTerms {
            lambert: [front[0], back[0]],
            gloss: [front[1], back[1]],
            lambert_error: R::ZERO,
            gloss_error: R::ZERO,
        };
        if facing || self.two_sided {
            let cosines = |v: &[R; 3]| [0, 3].map(|k| bounds.cosine(&at(k), v, self.two_sided));
            terms.lambert_error = bounds.of_power(cosines(&light.towards), R::ONE, true);
            if self.specular > R::ZERO {
                terms.gloss_error = bounds.of_power(cosines(&light.half), self.shininess, false);
            }
        }
        terms
    }

    /// The diffuse and the specular term of each light over the part `[from, to]` of a segment: enclosed between lines,
    /// with the strengths by which they count in each channel.
    pub(super) fn each_light(
        &self,
        g: &[Cubic<R>; 3],
        [from, to]: [R; 2],
        mut see: impl FnMut(usize, &LightTerms<R>, [R; 3], [R; 3]),
    ) {
        let g: [Cubic<R>; 3] = each(|a| restrict(&g[a], from, to));
        let bounds = Variation::of(&g, self.soft_square);
        for (index, light) in self.lights.iter().enumerate() {
            let strength = |x: R| each(|c| x * light.color[c]);
            see(index, &self.terms(light, &g, &bounds), strength(self.diffuse), strength(self.specular));
        }
    }

    /// Cuts a segment where a light passes from one side of the surface to the other.
    pub(super) fn cut(&self, g: &[Cubic<R>; 3], splits: &mut Splits<R>) {
        for light in &self.lights {
            splits.cut_at(&along_light(g, &light.towards), &[R::ZERO]);
        }
    }

    /// Factors over the part `[from, to]` of a segment, which lies between cuts.
    #[inline(always)]
    fn factors(&self, g: &[Cubic<R>; 3], from: R, to: R) -> LinearFactors<R> {
        let g: [Cubic<R>; 3] = each(|a| restrict(&g[a], from, to));
        let bounds = Variation::of(&g, self.soft_square);
        let mut result = LinearFactors {
            reflected: [[self.ambient; 3]; 2],
            highlight: [[R::ZERO; 3]; 2],
            reflected_error: R::ZERO,
            highlight_error: R::ZERO,
        };
        for light in &self.lights {
            let terms = self.terms(light, &g, &bounds);
            for end in 0..2 {
                for c in 0..3 {
                    result.reflected[end][c] += self.diffuse * light.color[c] * terms.lambert[end];
                    result.highlight[end][c] += self.specular * light.color[c] * terms.gloss[end];
                }
            }
            let brightest = light.color[0].max(light.color[1]).max(light.color[2]);
            result.reflected_error += self.diffuse * brightest * terms.lambert_error;
            result.highlight_error += self.specular * brightest * terms.gloss_error;
        }
        result
    }
}

impl<R: Real> Shader<R> for Lit<R> {
    type Cell = [Cubic<R>; 3];

    #[inline(always)]
    fn cell(&self, _: &Segment, gradient: impl FnOnce() -> [Cubic<R>; 3]) -> [Cubic<R>; 3] {
        gradient()
    }

    #[inline(always)]
    fn cut(&self, g: &[Cubic<R>; 3], splits: &mut Splits<R>) {
        self.cut(g, splits);
    }

    #[inline(always)]
    fn integrate<const N: usize, const M: usize>(
        &self,
        optics: &Optics<R, N>,
        length_mm: R,
        g: &[Cubic<R>; 3],
        [from, to]: [R; 2],
    ) -> Integral<R> {
        optics.integrate_shaded::<M>(length_mm, &self.factors(g, from, to), self.largest_color)
    }
}

/// How much the gradient's direction and fade can vary over a piece.
#[derive(Debug, Clone, Copy)]
struct Variation<R> {
    /// False if the gradient may vanish: then nothing else holds but `fade`.
    smooth: bool,
    /// `a = max|g′| / min|g|`: bounds |n′|.
    turn: R,
    /// Bounds |n″|.
    bend: R,
    /// Bounds of `w` and of its first and second derivative.
    fade: [R; 3],
}

impl<R: Real> Variation<R> {
    #[inline(always)]
    fn of(g: &[Cubic<R>; 3], soft_square: R) -> Self {
        let number = R::from_f64;
        let at = |k: usize| [g[0][k], g[1][k], g[2][k]];
        let norm = |v: [R; 3]| dot(&v, &v).sqrt();
        let minus = |a: [R; 3], b: [R; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let d: [[R; 3]; 3] = each(|k| minus(at(k + 1), at(k)));
        let first = number(3.0) * norm(d[0]).max(norm(d[1])).max(norm(d[2]));
        let second = number(6.0) * norm(minus(d[1], d[0])).max(norm(minus(d[2], d[1])));
        let most = (0..4).fold(R::ZERO, |m, k| m.max(norm(at(k))));
        // |g| is at least its component along any direction: take that of the mean of the ends.
        let ends: [R; 3] = each(|a| g[a][0] + g[a][3]);
        let along = norm(ends);
        let least = (0..4).fold(most, |m, k| m.min(dot(&at(k), &ends) / along));
        let s = soft_square;
        let most_fade = if most > R::ZERO { most * most / (most * most + s) } else { R::ZERO };
        // A comparison with NaN, from a vanishing mean, is false.
        let smooth = least > number(1e-3) * most;
        if !smooth {
            return Variation { smooth: false, turn: R::ZERO, bend: R::ZERO, fade: [most_fade, R::ZERO, R::ZERO] };
        }
        let (turn, wiggle) = (first / least, second / least);
        // w = ρ²/(ρ²+s): dw/dρ = 2ρs/(ρ²+s)²,  d²w/dρ² = 2s(s−3ρ²)/(ρ²+s)³.
        let denominator = least * least + s;
        let slope = number(2.0) * most * s / (denominator * denominator);
        let curvature = number(2.0) * s * s.max(number(3.0) * most * most) / (denominator * denominator * denominator);
        let fade = [most_fade, slope * first, curvature * first * first + slope * (first * turn + second)];
        Variation { smooth: true, turn, bend: number(1.154_700_6) * turn * turn + wiggle, fade }
    }

    /// `d(n·v)` at an end.
    #[inline]
    fn cosine(&self, g: &[R; 3], v: &[R; 3], two_sided: bool) -> R {
        let square = dot(g, g);
        if square == R::ZERO {
            return R::ZERO;
        }
        let x = -dot(g, v) / square.sqrt();
        if two_sided { x.abs() } else { x.max(R::ZERO) }
    }

    /// Largest distance of `w x^p` from the line through its ends, given the cosine `x` at both ends; `is_cut` where pieces end at
    /// the kink that `x` has at 0.
    #[inline]
    fn of_power(&self, cosines: [R; 2], p: R, is_cut: bool) -> R {
        let number = R::from_f64;
        let (low, high) = (cosines[0].min(cosines[1]), cosines[0].max(cosines[1]));
        if !self.smooth {
            return self.fade[0];
        }
        // No point is further than half the piece from an end.
        let reach = number(0.5) * self.turn;
        let (low, high) = ((low - reach).max(R::ZERO), (high + reach).min(R::ONE));
        let crude = self.fade[0];
        // |x′| is at most |n′| times the sine.
        let speed = self.turn * (R::ONE - low * low).max(R::ZERO).sqrt();
        let [w0, w1, w2] = self.fade;
        let two = number(2.0);
        // One power serves the function and its derivatives; x^p has no bounded second derivative at 0 for 1 < p < 2, nor for p = 1
        // where it is not cut.
        let (f0, f1, f2) = if p == R::ONE {
            (high, R::ONE, (is_cut || low > R::ZERO).then_some(R::ZERO))
        } else if p < two {
            let power = high.powf(p - R::ONE);
            (power * high, p * power, None)
        } else {
            let power = high.powf(p - two);
            (power * high * high, p * power * high, Some(p * (p - R::ONE) * power))
        };
        // A function with |f′| ≤ L is within L/2 of the line through its ends.
        let first = w1 * f0 + w0 * f1 * speed;
        let crude = crude.min(number(0.5) * first);
        let Some(f2) = f2 else { return crude };
        let second = w2 * f0 + two * w1 * f1 * speed + w0 * (f2 * speed * speed + f1 * self.bend);
        crude.min(number(0.125) * second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Light;

    fn shading(two_sided: bool, soft: f64, shininess: f64) -> Shading {
        Shading {
            ambient: 0.1,
            diffuse: 0.7,
            specular: 0.3,
            shininess: if soft > 30.0 { 20.0 } else { shininess },
            two_sided,
            soft_gradient_per_mm: soft,
            lights: vec![
                Light::Headlight { color: [1.0, 0.9, 0.8] },
                Light::Directional { towards: DVec3::new(0.3, -0.5, 0.8).normalize(), color: [0.2, 0.3, 0.9] },
            ],
        }
    }

    /// Pseudo-random numbers in [-1, 1].
    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[test]
    fn the_true_factors_are_within_the_enclosure() {
        let mut seed = 7;
        let mut tightest = 0.0f64;
        for case in 0..4000 {
            let definition = shading(case % 2 == 0, [0.0, 20.0, 40.0][case % 3], [1.0, 1.5, 2.0][case / 6 % 3]);
            let direction = DVec3::new(random(&mut seed), random(&mut seed), random(&mut seed)).normalize();
            let lit = Lit::<f64>::new(&definition, direction, 1.0);
            // From nearly straight to wild.
            let spread = 10f64.powf(1.5 * random(&mut seed) - 0.5) * 100.0;
            let base: [f64; 3] = std::array::from_fn(|_| 100.0 * random(&mut seed));
            let g: [Cubic<f64>; 3] =
                std::array::from_fn(|a| std::array::from_fn(|_| base[a] + spread * random(&mut seed)));
            let mut splits = Splits::default();
            splits.restart(1.0);
            lit.cut(&g, &mut splits);
            let positions = splits.sorted().to_vec();
            for pair in positions.windows(2).filter(|p| p[1] - p[0] > 1e-9) {
                let f = lit.factors(&g, pair[0], pair[1]);
                for i in 1..20 {
                    let t = f64::from(i) / 20.0;
                    let u = pair[0] + t * (pair[1] - pair[0]);
                    let point = DVec3::from_array(std::array::from_fn(|a| value(&g[a], u)));
                    let (reflected, highlight) = definition.factors(point, direction);
                    for c in 0..3 {
                        let linear = |ends: &[[f64; 3]; 2]| ends[0][c] + t * (ends[1][c] - ends[0][c]);
                        let off = (linear(&f.reflected) - reflected[c]).abs();
                        let shine_off = (linear(&f.highlight) - highlight[c]).abs();
                        assert!(
                            off <= f.reflected_error + 1e-12,
                            "case {case}: diffuse off by {off}, bound {}",
                            f.reflected_error
                        );
                        assert!(
                            shine_off <= f.highlight_error + 1e-12,
                            "case {case}: specular off by {shine_off}, bound {}",
                            f.highlight_error
                        );
                        tightest = tightest.max(off / f.reflected_error);
                    }
                }
            }
        }
        assert!(tightest > 0.2, "a bound that is never approached says little: {tightest}");
    }
}
