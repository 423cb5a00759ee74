//! Levoy's shading in lanes: the enclosure of [`shade`](crate::integrate::exact::shade), formula by formula.

use super::axis::Axis;
use super::walk::RAYS;
use crate::integrate::exact::linear::Linear;
use crate::integrate::exact::piece::{Integral, LinearFactors, Optics};
use crate::math::bernstein::{Cubic, value};
use crate::math::each;
use crate::plan::{MOST_LIGHTS, shades_in_registers};
use crate::scene::{Light, Ray, Shading};
use crate::simd::{Lanes, Mask};

/// Lights of a scene that lanes can have; scenes with more are integrated by the twin.
pub(super) const LIGHTS: usize = MOST_LIGHTS;

/// What happens to a piece once its emission and extinction are known.
pub(in crate::integrate::exact) trait Finish<L: Lanes> {
    /// The integral over a piece; `M` must be `N + 1`.
    fn finish<const N: usize, const M: usize>(&self, optics: &Optics<L, N>, length_mm: L) -> Integral<L>;

    /// The same where all follow one value.
    #[inline(always)]
    fn finish_linear(&self, linear: &Linear<L>, length_mm: L) -> Integral<L> {
        self.finish::<4, 5>(&linear.optics(), length_mm)
    }
}

/// Emission as it is.
#[derive(Clone, Copy)]
pub(super) struct AsItIs;

impl<L: Lanes> Finish<L> for AsItIs {
    #[inline(always)]
    fn finish<const N: usize, const M: usize>(&self, optics: &Optics<L, N>, length_mm: L) -> Integral<L> {
        optics.integrate(length_mm)
    }

    #[inline(always)]
    fn finish_linear(&self, linear: &Linear<L>, length_mm: L) -> Integral<L> {
        linear.integrate(length_mm)
    }
}

/// Emission with factors between lines.
#[derive(Clone, Copy)]
pub(super) struct Shaded<L> {
    factors: LinearFactors<L>,
    largest_color: L,
}

impl<L: Lanes> Finish<L> for Shaded<L> {
    #[inline(always)]
    fn finish<const N: usize, const M: usize>(&self, optics: &Optics<L, N>, length_mm: L) -> Integral<L> {
        optics.integrate_shaded::<M>(length_mm, &self.factors, self.largest_color)
    }
}

/// The shading of a frame, as far as it is the same for all rays.
#[derive(Debug, Clone)]
pub(in crate::integrate::exact) struct Lighting {
    pub(super) shading: Shading,
    pub(super) ambient: f64,
    pub(super) diffuse: f64,
    pub(super) specular: f64,
    pub(super) shininess: u32,
    pub(super) two_sided: bool,
    pub(super) soft_square: f64,
    pub(super) largest_color: f64,
    pub(super) colors: Vec<[f32; 3]>,
    /// Whether all lights are at the eye, where the half vector is the one towards them.
    pub(super) are_at_the_eye: bool,
    /// Bounds the factor of emission.
    pub(super) largest_reflected: f64,
    /// Where `g·l` is 0 a light passes from one side to the other.
    pub(super) side: Axis,
}

impl Lighting {
    /// `None` for a shading that lanes cannot have. `largest_color` bounds the colours that are shaded.
    pub(in crate::integrate::exact) fn new(shading: &Shading, largest_color: f64) -> Option<Self> {
        let some_direction = glam::DVec3::X;
        shades_in_registers(shading).then(|| Lighting {
            shading: shading.clone(),
            ambient: shading.ambient,
            diffuse: shading.diffuse,
            specular: shading.specular,
            // Whole, or of no highlight.
            shininess: shading.shininess.max(2.0) as u32,
            two_sided: shading.two_sided,
            soft_square: shading.soft_gradient_per_mm * shading.soft_gradient_per_mm,
            largest_color,
            colors: shading.directions(some_direction).map(|(_, _, color)| color.map(|c| c as f32)).collect(),
            are_at_the_eye: shading.lights.iter().all(|light| matches!(light, Light::Headlight { .. })),
            largest_reflected: shading.largest_factors().0,
            side: Axis::at(0.0),
        })
    }

    pub(super) fn lights(&self) -> usize {
        self.colors.len()
    }
}

/// The lights as the rays in flight see them: by light, component and seat.
#[derive(Debug, Clone)]
pub(super) struct Seen {
    pub(super) towards: [[[f32; RAYS]; 3]; LIGHTS],
    pub(super) half: [[[f32; RAYS]; 3]; LIGHTS],
}

impl Seen {
    pub(super) fn new() -> Self {
        Seen { towards: [[[0.0; RAYS]; 3]; LIGHTS], half: [[[0.0; RAYS]; 3]; LIGHTS] }
    }

    /// Seats a ray.
    pub(super) fn enter(&mut self, seat: usize, ray: &Ray, shading: &Shading) {
        for (light, (towards, half, _)) in shading.directions(ray.direction).enumerate() {
            for a in 0..3 {
                self.towards[light][a][seat] = towards[a] as f32;
                self.half[light][a][seat] = half[a] as f32;
            }
        }
    }

    /// The lights as rays see them, by their seats.
    #[inline(always)]
    pub(super) fn lights<L: Lanes>(&self, lighting: &Lighting, seat: L::Ints) -> Lights<L> {
        let none = [L::ZERO; 3];
        let [mut towards, mut half] = [[none; LIGHTS]; 2];
        // One by one: a loop of unknown length would leave them in memory.
        let has_second = lighting.lights() > 1;
        towards[0] = vectors(&self.towards[0], seat);
        if has_second {
            towards[1] = vectors(&self.towards[1], seat);
        }
        if !lighting.are_at_the_eye {
            half[0] = vectors(&self.half[0], seat);
            if has_second {
                half[1] = vectors(&self.half[1], seat);
            }
        }
        Lights { towards, half }
    }
}

/// The vectors of these seats.
#[inline(always)]
fn vectors<L: Lanes>(of_seat: &[[f32; RAYS]; 3], seat: L::Ints) -> [L; 3] {
    [L::pick32(&of_seat[0], seat), L::pick32(&of_seat[1], seat), L::pick32(&of_seat[2], seat)]
}

/// The lights as the rays of some lanes see them.
#[derive(Clone, Copy)]
pub(super) struct Lights<L> {
    pub(super) towards: [[L; 3]; LIGHTS],
    pub(super) half: [[L; 3]; LIGHTS],
}

#[inline(always)]
pub(super) fn dot<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[2].mul_plus(b[2], a[1].mul_plus(b[1], a[0] * b[0]))
}

#[inline(always)]
fn minus<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn norm<L: Lanes>(a: &[L; 3]) -> L {
    dot(a, a).sqrt()
}

#[inline(always)]
fn at<L: Lanes>(g: &[Cubic<L>; 3], k: usize) -> [L; 3] {
    [g[0][k], g[1][k], g[2][k]]
}

/// `g·l` along a cell.
#[inline(always)]
pub(super) fn along_light<L: Lanes>(g: &[Cubic<L>; 3], l: &[L; 3]) -> Cubic<L> {
    each(
        #[inline(always)]
        |k| dot(&at(g, k), l),
    )
}

/// Numbers to a whole power, by squaring.
#[inline(always)]
pub(super) fn power<L: Lanes, const N: usize>(x: [L; N], exponent: u32) -> [L; N] {
    let (mut results, mut squares, mut rest) = ([L::ONE; N], x, exponent);
    loop {
        if rest & 1 == 1 {
            for (result, &square) in results.iter_mut().zip(&squares) {
                *result = *result * square;
            }
        }
        rest >>= 1;
        if rest == 0 {
            return results;
        }
        for square in &mut squares {
            *square = *square * *square;
        }
    }
}

/// How much the gradient's direction and fade can vary over pieces: see the twin.
struct Variation<L: Lanes> {
    smooth: L::Mask,
    turn: L,
    bend: L,
    fade: [L; 3],
}

impl<L: Lanes> Variation<L> {
    #[inline(always)]
    fn of(g: &[Cubic<L>; 3], soft_square: f64) -> Self {
        let number = L::from_f64;
        let points = [at(g, 0), at(g, 1), at(g, 2), at(g, 3)];
        let (d0, d1, d2) =
            (minus(&points[1], &points[0]), minus(&points[2], &points[1]), minus(&points[3], &points[2]));
        let first = number(3.0) * norm(&d0).max(norm(&d1)).max(norm(&d2));
        let second = number(6.0) * norm(&minus(&d1, &d0)).max(norm(&minus(&d2, &d1)));
        let mut most = L::ZERO;
        for point in &points {
            most = most.max(norm(point));
        }
        // |g| is at least its component along any direction: take that of the mean of the ends.
        let ends = [g[0][0] + g[0][3], g[1][0] + g[1][3], g[2][0] + g[2][3]];
        let along = L::ONE / norm(&ends);
        let mut least = most;
        for point in &points {
            least = least.min(dot(point, &ends) * along);
        }
        // A comparison with NaN, from a vanishing mean, is false.
        let smooth = (number(1e-3) * most).lt(least);
        let per_least = L::ONE / L::select(smooth, least, L::ONE);
        let (turn, wiggle) = (first * per_least, second * per_least);
        let bend = number(1.154_700_6) * turn * turn + wiggle;
        if soft_square == 0.0 {
            return Variation { smooth, turn, bend, fade: [L::ONE, L::ZERO, L::ZERO] };
        }
        let s = number(soft_square);
        let most_fade = most * most / (most * most + s);
        let low = L::select(smooth, least, most);
        let per_denominator = L::ONE / (low * low + s);
        let slope = number(2.0) * most * s * per_denominator * per_denominator;
        let curvature = number(2.0) * s * s.max(number(3.0) * most * most);
        let curvature = curvature * per_denominator * per_denominator * per_denominator;
        let bent = curvature * first * first + slope * (first * turn + second);
        Variation { smooth, turn, bend, fade: [most_fade, slope * first, bent] }
    }

    /// Largest distance of `w x^p` from the line through its ends, given the cosine `x` at both ends; `p` is 1, or whole and
    /// at least 2.
    #[inline(always)]
    fn of_power(&self, [front, back]: [L; 2], p: u32) -> L {
        let number = L::from_f64;
        let [w0, w1, w2] = self.fade;
        // No point is further than half the piece from an end.
        let reach = number(0.5) * self.turn;
        let (low, high) = ((front.min(back) - reach).max(L::ZERO), (front.max(back) + reach).min(L::ONE));
        // |x′| is at most |n′| times the sine.
        let speed = self.turn * (L::ONE - low * low).max(L::ZERO).sqrt();
        let exponent = f64::from(p);
        let (f0, f1, f2) = if p == 1 {
            (high, L::ONE, L::ZERO)
        } else {
            let [power] = power([high], p - 2);
            (power * high * high, number(exponent) * power * high, number(exponent * (exponent - 1.0)) * power)
        };
        // A function with |f′| ≤ L is within L/2 of the line through its ends, one with |f″| ≤ K within K/8.
        let first = w1 * f0 + w0 * f1 * speed;
        let second = w2 * f0 + number(2.0) * w1 * f1 * speed + w0 * (f2 * speed * speed + f1 * self.bend);
        let bound = w0.min(number(0.5) * first).min(number(0.125) * second);
        L::select(self.smooth, bound, w0)
    }
}

impl Lighting {
    /// Factors over pieces along which these are the gradients, HU/mm, and which no light changes sides on.
    #[inline(always)]
    pub(super) fn shaded<L: Lanes>(&self, g: &[Cubic<L>; 3], lights: &Lights<L>) -> Shaded<L> {
        let number = L::from_f64;
        let bounds = Variation::of(g, self.soft_square);
        let ends = [at(g, 0), at(g, 3)];
        let mut inverse = [L::ZERO; 2];
        let mut fade = [L::ZERO; 2];
        for end in 0..2 {
            let square = dot(&ends[end], &ends[end]);
            let vanishes = square.le(L::ZERO);
            inverse[end] = L::select(vanishes, L::ZERO, L::ONE / square.sqrt());
            fade[end] = L::ONE;
            if self.soft_square != 0.0 {
                fade[end] = L::select(vanishes, L::ZERO, square / (square + number(self.soft_square)));
            }
        }
        let mut factors = LinearFactors {
            reflected: [[number(self.ambient); 3]; 2],
            highlight: [[L::ZERO; 3]; 2],
            reflected_error: L::ZERO,
            highlight_error: L::ZERO,
        };
        for (n, color) in self.colors.iter().enumerate().take(LIGHTS) {
            let (towards, half) = (&lights.towards[n], &lights.half[n]);
            // The normal is against the gradient.
            let faces = value(&along_light(g, towards), number(0.5)).lt(L::ZERO);
            let seen = if self.two_sided { <L::Mask as Mask>::ALL } else { faces };
            let (mut cosines, mut shines) = ([L::ZERO; 2], [L::ZERO; 2]);
            for end in 0..2 {
                let cosine = -dot(&ends[end], towards) * inverse[end];
                let shine = -dot(&ends[end], half) * inverse[end];
                (cosines[end], shines[end]) = if self.two_sided {
                    (cosine.abs(), shine.abs())
                } else {
                    (cosine.max(L::ZERO), shine.max(L::ZERO))
                };
                let lambert = L::select(seen, fade[end] * cosines[end], L::ZERO);
                for c in 0..3 {
                    factors.reflected[end][c] += number(self.diffuse * f64::from(color[c])) * lambert;
                }
                if self.specular != 0.0 {
                    let [gloss] = power([shines[end].min(L::ONE)], self.shininess);
                    let gloss = L::select(seen, fade[end] * gloss, L::ZERO);
                    for c in 0..3 {
                        factors.highlight[end][c] += number(self.specular * f64::from(color[c])) * gloss;
                    }
                }
            }
            let brightest = f64::from(color[0].max(color[1]).max(color[2]));
            let error = number(self.diffuse * brightest) * bounds.of_power(cosines, 1);
            factors.reflected_error += L::select(seen, error, L::ZERO);
            if self.specular != 0.0 {
                let error = number(self.specular * brightest) * bounds.of_power(shines, self.shininess);
                factors.highlight_error += L::select(seen, error, L::ZERO);
            }
        }
        Shaded { factors, largest_color: number(self.largest_color) }
    }
}
