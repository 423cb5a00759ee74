//! Light at the nodes of a piece, and an estimate of what lies between them.
//!
//! The integral of a piece without shading, `∫ q e^{−τ}`, has a proven error. Gauss's rule with five nodes splits it: the share
//! of node `i` is its weight times `q(u_i) e^{−τ(u_i)}`, over the sum of all. Each share is then shaded as the gradient at
//! its node asks for (`shares`), so that where the shading is the same along a piece nothing is lost. What is lost elsewhere grows with
//! how far the normal turns between the nodes; it has either sign, and nothing to do with what is lost in other pieces. So
//! standard deviations are estimated, and their squares add up along a ray.

use super::light::{LIGHTS, Lighting, Lights, dot, power};
use crate::math::each;
use crate::math::powers::{self, Powers};
use crate::simd::{Lanes, Mask};

/// Nodes of a piece.
pub(super) const NODES: usize = 5;

/// Gauss's nodes in `[0, 1]`, and their weights.
pub(super) const PLACES: [f64; NODES] =
    [0.046_910_077_030_668, 0.230_765_344_947_158_5, 0.5, 0.769_234_655_052_841_5, 0.953_089_922_969_332];
pub(super) const WEIGHTS: [f64; NODES] = [
    0.118_463_442_528_094_54,
    0.239_314_335_249_683_2,
    0.284_444_444_444_444_4,
    0.239_314_335_249_683_2,
    0.118_463_442_528_094_54,
];

/// Standard deviations of what the rule misses, measured on cells of noisy lattices, to which the tests below hold them. With the
/// turn of the normal from node to node, `s = Σ 1 − cos`, Lambert's term misses `a s + b s²`, and more where a light changes sides,
/// over the cosines on both; a highlight of exponent `p` misses `c p s²`, but no more than its size allows. Two-sided, all are up
/// to half as large again.
const OF_TURN: f64 = 0.002;
const OF_TURN_SQUARED: f64 = 0.004;
const OF_KINK: f64 = 0.012;
const OF_GLOSS: f64 = 0.003;
const LARGEST_OF_GLOSS: f64 = 0.03;

/// The light on a piece, at its nodes.
#[derive(Clone, Copy)]
pub(super) struct AtNodes<'l, L> {
    pub(super) lighting: &'l Lighting,
    /// The diffuse term of each light without its colour, by node.
    pub(super) lambert: [[L; NODES]; LIGHTS],
    /// The specular one.
    pub(super) gloss: [[L; NODES]; LIGHTS],
    /// Standard deviation of what the nodes miss, for a piece that absorbs all light and for colours up to 1.
    pub(super) deviation: L,
}

impl Lighting {
    /// The light on the pieces `[from, to]` of cells along which this is the gradient, HU/mm.
    #[inline(always)]
    pub(super) fn at_nodes<L: Lanes>(
        &self,
        gradient: &[Powers<L>; 3],
        lights: &Lights<L>,
        [from, to]: [L; 2],
    ) -> AtNodes<'_, L> {
        let number = L::from_f64;
        let length = to - from;
        let (mut normals, mut fades) = ([[L::ZERO; 3]; NODES], [L::ONE; NODES]);
        let (mut turn, mut vanished) = (L::ZERO, L::ZERO.lt(L::ZERO));
        for i in 0..NODES {
            let u = length.mul_plus(number(PLACES[i]), from);
            let g: [L; 3] = each(
                #[inline(always)]
                |a| powers::value(&gradient[a], u),
            );
            let square = dot(&g, &g);
            let vanishes = square.le(L::ZERO);
            // The normal is against the gradient.
            let inverse = L::select(vanishes, L::ZERO, -(L::ONE / square.sqrt()));
            normals[i] = [g[0] * inverse, g[1] * inverse, g[2] * inverse];
            if self.soft_square != 0.0 {
                fades[i] = L::select(vanishes, L::ZERO, square / (square + number(self.soft_square)));
            }
            if i > 0 {
                // Where the gradient vanishes at both there is no normal to turn.
                let by = L::ONE - dot(&normals[i - 1], &normals[i]);
                turn += L::select(vanishes.and(vanished), L::ZERO, by);
            }
            vanished = vanishes;
        }
        let both = if self.two_sided { 1.5 } else { 1.0 };
        let of_lambert = both * self.diffuse;
        let of_gloss = both * self.specular;
        let square = turn * turn;
        let of_gloss = number(OF_GLOSS * f64::from(self.shininess) * of_gloss) * square;
        let of_gloss = of_gloss.min(number(LARGEST_OF_GLOSS * both * self.specular));
        let smooth = turn.mul_plus(number(OF_TURN * of_lambert), of_gloss);
        let smooth = square.mul_plus(number(OF_TURN_SQUARED * of_lambert), smooth);
        let [mut lambert, mut gloss] = [[[L::ZERO; NODES]; LIGHTS]; 2];
        let mut deviation = L::ZERO;
        // One by one: a loop of unknown length would leave all of them in memory.
        if let Some(color) = self.colors.first() {
            let kink;
            (lambert[0], gloss[0], kink) = self.of_light(&normals, &fades, &lights.towards[0], &lights.half[0]);
            let more = kink.mul_plus(number(OF_KINK * of_lambert), smooth);
            deviation = more.mul_plus(number(brightest(color)), deviation);
        }
        if let Some(color) = self.colors.get(1) {
            let kink;
            (lambert[1], gloss[1], kink) = self.of_light(&normals, &fades, &lights.towards[1], &lights.half[1]);
            let more = kink.mul_plus(number(OF_KINK * of_lambert), smooth);
            deviation = more.mul_plus(number(brightest(color)), deviation);
        }
        AtNodes { lighting: self, lambert, gloss, deviation }
    }

    /// The diffuse and the specular term of a light at nodes, and by how much the cosine changes between nodes on two sides of it.
    #[inline(always)]
    fn of_light<L: Lanes>(
        &self,
        normals: &[[L; 3]; NODES],
        fades: &[L; NODES],
        towards: &[L; 3],
        half: &[L; 3],
    ) -> ([L; NODES], [L; NODES], L) {
        let number = L::from_f64;
        let (mut lambert, mut gloss) = ([L::ZERO; NODES], [L::ZERO; NODES]);
        let (mut facings, mut shines) = ([L::ZERO; NODES], [L::ZERO; NODES]);
        let (mut kink, mut before) = (L::ZERO, L::ZERO);
        for i in 0..NODES {
            let cosine = dot(&normals[i], towards);
            let shine = if self.are_at_the_eye { cosine } else { dot(&normals[i], half) };
            (facings[i], shines[i]) = if self.two_sided {
                (cosine.abs(), shine.abs().min(L::ONE))
            } else {
                (cosine.max(L::ZERO), shine.max(L::ZERO).min(L::ONE))
            };
            lambert[i] = number(self.diffuse) * (fades[i] * facings[i]);
            if i > 0 {
                // Between nodes on two sides of a light lies a kink.
                let changes = (before * cosine).lt(L::ZERO);
                kink += L::select(changes, (before - cosine).abs(), L::ZERO);
            }
            before = cosine;
        }
        if self.specular != 0.0 {
            let glosses = power(shines, self.shininess);
            for i in 0..NODES {
                let shine = number(self.specular) * (fades[i] * glosses[i]);
                gloss[i] = L::select(L::ZERO.lt(facings[i]), shine, L::ZERO);
            }
        }
        (lambert, gloss, kink)
    }
}

pub(super) fn brightest(color: &[f32; 3]) -> f64 {
    f64::from(color[0].max(color[1]).max(color[2]))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::light::Finish;
    use super::*;
    use crate::integrate::exact::linear::{Linear, drift};
    use crate::integrate::exact::piece::{Integral, Optics};
    use crate::math::bernstein::{Cubic, trilinear_along, value};
    use crate::scene::{Light, Shading};

    fn shading(diffuse: f64, specular: f64, shininess: f64, two_sided: bool) -> Shading {
        let lights = vec![Light::Directional { towards: DVec3::new(0.36, -0.48, 0.8), color: [1.0; 3] }];
        Shading { ambient: 0.0, diffuse, specular, shininess, two_sided, soft_gradient_per_mm: 0.0, lights }
    }

    const RAY: DVec3 = DVec3::new(0.0, 0.6, -0.8);

    fn lights(shading: &Shading) -> Lights<f32> {
        let (towards, half, _) = shading.directions(RAY).next().expect("it has a light");
        let single = |v: DVec3| v.to_array().map(|x| x as f32);
        Lights { towards: [single(towards); LIGHTS], half: [single(half); LIGHTS] }
    }

    /// Numbers from -1 to 1 (SplitMix64).
    fn random() -> impl FnMut() -> f64 {
        let mut state = 7u64;
        move || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
        }
    }

    /// Along a random chord of a cell in a lattice of noise on a slope: its gradient by central differences.
    fn gradient_along(random: &mut impl FnMut() -> f64, noise: f64) -> [Cubic<f64>; 3] {
        let slope = DVec3::new(random(), random(), random()).normalize();
        let samples: Vec<f64> = (0..64).map(|_| noise * (random() + random() + random())).collect();
        let at = |[i, j, k]: [usize; 3]| samples[i + 4 * (j + 4 * k)];
        let ends = [[random(), random()], [random(), random()]].map(|end| end.map(|x| 0.5 + 0.5 * x));
        let ([from, to], axis) = ([0.0, 1.0], 2 - (4.0 * (0.5 + 0.5 * random())) as usize % 3);
        let place = |x: f64, [u, v]: [f64; 2]| {
            let mut place = [u; 3];
            place[axis] = x;
            place[(axis + 1) % 3] = v;
            place
        };
        let (from, to) = (place(from, ends[0]), place(to, ends[1]));
        each(|a| {
            let corners: [f64; 8] = each(|c| {
                let corner = [1 + (c & 1), 1 + (c >> 1 & 1), 1 + (c >> 2)];
                let (mut below, mut above) = (corner, corner);
                below[a] -= 1;
                above[a] += 1;
                slope[a] + 0.5 * (at(above) - at(below))
            });
            trilinear_along(&corners, from, to)
        })
    }

    /// Root mean squares, over many gradients, of what the nodes of a thin piece miss and of what they are estimated to miss.
    fn missed_and_estimated(shading: &Shading, noise: f64) -> [f64; 2] {
        let lighting = Lighting::new(shading, 1.0).expect("a light that lanes can have");
        let (mut random, mut squares, count) = (random(), [0.0; 2], 4000);
        let thin = Optics { emission: [[1e-4_f32; 4]; 3], extinction: [1e-4; 4] };
        for _ in 0..count {
            let g = gradient_along(&mut random, noise);
            let single = |a: usize| powers::of(&g[a].map(|x| x as f32));
            let light = lighting.at_nodes(&[single(0), single(1), single(2)], &lights(shading), [0.0, 1.0]);
            let integral: Integral<f32> = light.finish::<4, 5>(&thin, 1.0);
            let found = f64::from(integral.radiance[0] / integral.absorbed);
            let steps = 1000;
            let at = |k: usize| DVec3::from_array(g.map(|g| value(&g, (k as f64 + 0.5) / f64::from(steps))));
            let truth = (0..steps as usize).map(|k| {
                let (reflected, highlight) = shading.factors(at(k), RAY);
                reflected[0] + highlight[0]
            });
            let missed = found - truth.sum::<f64>() / f64::from(steps);
            squares[0] += missed * missed;
            squares[1] += f64::from(light.deviation).powi(2);
        }
        squares.map(|sum| (sum / f64::from(count)).sqrt())
    }

    #[test]
    fn what_is_missed_is_about_what_is_estimated() {
        for two_sided in [false, true] {
            for (diffuse, specular, shininess) in
                [(1.0, 0.0, 2.0), (0.7, 0.2, 10.0), (0.0, 1.0, 10.0), (0.0, 1.0, 40.0)]
            {
                let shading = shading(diffuse, specular, shininess, two_sided);
                for noise in [0.1, 0.2, 0.4] {
                    let [missed, estimated] = missed_and_estimated(&shading, noise);
                    let name = format!("{diffuse} {specular} {shininess} two-sided {two_sided}, noise {noise}");
                    assert!(missed < 1.6 * estimated, "{name}: {missed:e} missed, {estimated:e} estimated");
                    assert!(estimated < 20.0 * missed, "{name}: {missed:e} missed, {estimated:e} estimated");
                }
            }
        }
    }

    #[test]
    fn a_gradient_that_keeps_its_direction_loses_nothing_at_any_depth() {
        let shading = shading(0.7, 0.2, 10.0, true);
        let lighting = Lighting::new(&shading, 1.0).expect("a light that lanes can have");
        let along = DVec3::new(1.0, -2.0, 0.5);
        let g = [0, 1, 2].map(|a| powers::of(&[1.0f32, 3.0, 2.0, 5.0].map(|x| x * along[a] as f32)));
        let light = lighting.at_nodes(&g, &lights(&shading), [0.0, 1.0]);
        assert!(light.deviation < 1e-6, "found {}", light.deviation);
        let (reflected, highlight) = shading.factors(along, RAY);
        for scale in [1e-3f32, 1.0, 30.0] {
            let extinction = [0.2, 0.9, 0.4, 1.5].map(|x| x * scale);
            let emission = [[0.2, 0.1, 0.4, 0.1], [0.0, 0.3, 0.3, 1.4], [0.1, 0.45, 0.2, 0.75]];
            let optics = Optics { emission: emission.map(|q| q.map(|x: f32| x * scale)), extinction };
            let (lit, unlit): (Integral<f32>, _) = (light.finish::<4, 5>(&optics, 2.0), optics.integrate(2.0));
            for c in 0..3 {
                let expected = f64::from(unlit.radiance[c]) * reflected[c] + f64::from(unlit.absorbed) * highlight[c];
                let found = f64::from(lit.radiance[c]);
                assert!((found - expected).abs() < 2e-6, "scale {scale}, channel {c}: {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn what_follows_one_value_is_shared_out_as_its_polynomials_are() {
        for (two_sided, noise) in [(false, 0.3), (true, 0.1), (true, 1.0)] {
            let shading = shading(0.7, 0.2, 10.0, two_sided);
            let lighting = Lighting::new(&shading, 1.0).expect("a light that lanes can have");
            let mut random = random();
            for n in 0..1000 {
                let g = gradient_along(&mut random, noise);
                let single = |a: usize| powers::of(&g[a].map(|x| x as f32));
                let light = lighting.at_nodes(&[single(0), single(1), single(2)], &lights(&shading), [0.0, 1.0]);
                let mut some = || (0.5 + 0.5 * random()) as f32;
                let (low, slope) = ([some(), some(), 0.0, some()], [some(), 0.0, some(), some()]);
                let (drift, largest_drift) = drift(&low, &slope);
                let distance = [some(), some(), some(), some()];
                let linear = Linear { distance, low, slope, drift, largest_drift };
                let length_mm = [1e-3, 1.0, 30.0][n % 3];
                let found = light.finish_linear(&linear, length_mm);
                let expected = light.finish::<4, 5>(&linear.optics(), length_mm);
                let apart = |a: f32, b: f32| (a - b).abs() > 1e-5 * expected.absorbed;
                let differs = (0..3).any(|c| apart(found.radiance[c], expected.radiance[c]));
                let what = format!("{found:?}, expected {expected:?}");
                assert!(!differs && !apart(found.absorbed, expected.absorbed), "{what}");
                assert!((found.error - expected.error).abs() <= 1e-4 * expected.error + 1e-6, "{what}");
            }
        }
    }
}
