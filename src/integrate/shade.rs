//! Shading of a sample by its gradient: the definition of [`Shading`] in f32.

use glam::DVec3;

use crate::classify::Rgbs;
use crate::field::{Cell, Position, Spacing, Trilinear, Voxel};
use crate::math::{Number, Power};
use crate::scene::{Haze, Light, Shading};
use crate::simd::{BATCH, Lanes};

/// Shades a sample. Chosen by type, once per frame.
pub(super) trait Shader: Sync {
    /// Whether it does anything at all.
    const SHADES: bool;
    /// Name in kernel names.
    const NAME: &'static str;
    /// What is constant along a ray.
    type Aim: Default + Send;

    /// Computes what is constant along a ray.
    fn aim(&self, course: &Course, aim: &mut Self::Aim);

    /// The gradient that it shades by, in stored units per index step.
    #[inline(always)]
    fn gradient_per_index<V: Voxel, K: Spacing>(
        &self,
        _aim: &Self::Aim,
        field: &Trilinear<'_, V, K>,
        _position: Position,
        cell: &Cell,
    ) -> [f32; 3] {
        field.gradient_per_index(cell)
    }

    /// What is there to be seen of a sample; `gradient` gives the gradient there, HU/mm.
    fn shade(&self, aim: &Self::Aim, sample: Rgbs<f32>, spot: &Spot, gradient: impl FnOnce() -> [f32; 3]) -> Rgbs<f32>;

    /// What is there where the transfer function shows nothing.
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

/// Shades many samples at a time, each as [`Shader::shade`] does.
pub(super) trait LaneShader: Shader {
    /// What is there to be seen of samples, given the gradients there, HU/mm; 0 of what is nothing.
    fn shade_lanes<L: Lanes>(&self, aim: &Self::Aim, samples: Rgbs<L>, gradient_per_mm: [L; 3]) -> Rgbs<L>;

    /// Number of lights.
    fn lights(&self) -> usize;

    /// The half vector of each light for a ray of this direction.
    fn half_vectors(&self, direction: DVec3) -> impl Iterator<Item = [f32; 3]>;

    /// Factors of the emission and of the extinction at gradients in HU/mm, given the half vectors of each light, by its number.
    fn reflect<L: Lanes>(&self, gradient_per_mm: [L; 3], half: impl Fn(usize) -> [L; 3]) -> ([L; 3], [L; 3]);
}

/// What is known of a ray before its samples are taken.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub(super) direction: DVec3,
    /// From the volume's border, where the ray's only sample is held, to the place beyond that it stands for, as a difference of
    /// continuous indices; 0 if that is inside, and where there are more samples.
    pub(super) beyond_voxels: DVec3,
}

impl Course {
    /// A ray whose samples are all inside.
    pub(super) fn inside(direction: DVec3) -> Self {
        Course { direction, beyond_voxels: DVec3::ZERO }
    }
}

/// Where a sample is.
pub(super) struct Spot {
    pub(super) cell: Cell,
    /// From the ray's origin.
    pub(super) distance_mm: f64,
}

/// Emission and absorption alone.
pub(super) struct Unlit;

impl Shader for Unlit {
    const SHADES: bool = false;
    const NAME: &'static str = "unlit";
    type Aim = ();

    fn aim(&self, _course: &Course, _aim: &mut ()) {}

    #[inline(always)]
    fn shade(&self, _: &(), sample: Rgbs<f32>, _: &Spot, _: impl FnOnce() -> [f32; 3]) -> Rgbs<f32> {
        sample
    }
}

/// Levoy's gradient shading with the Blinn-Phong reflection.
pub(super) struct Lit<'a> {
    definition: &'a Shading,
    ambient: f32,
    shininess: f32,
    /// The shininess, if it is a power by squares and roots.
    power: Option<Power>,
    two_sided: bool,
    soft_square: f32,
    lamps: Vec<Lamp>,
}

/// A light, for all rays.
struct Lamp {
    /// The unit vector towards it; `None` where that is the half vector.
    towards: Option<[f32; 3]>,
    /// `diffuse · color` and `specular · color`.
    diffuse: [f32; 3],
    specular: [f32; 3],
}

/// A light as seen along one ray.
pub(super) struct Beam {
    towards: [f32; 3],
    half: [f32; 3],
    /// `diffuse · color` and `specular · color`.
    diffuse: [f32; 3],
    specular: [f32; 3],
}

impl<'a> Lit<'a> {
    pub(super) fn new(definition: &'a Shading) -> Self {
        Lit {
            definition,
            ambient: definition.ambient as f32,
            shininess: definition.shininess as f32,
            power: Power::new(definition.shininess as f32),
            two_sided: definition.two_sided,
            soft_square: (definition.soft_gradient_per_mm * definition.soft_gradient_per_mm) as f32,
            lamps: definition.lights.iter().map(|light| Lamp::new(definition, light)).collect(),
        }
    }

    /// `d(x)` of the definition. At most 1: rounding may lift the cosine of two unit vectors above it.
    #[inline(always)]
    fn facing(&self, cosine: f32) -> f32 {
        let lit = if self.two_sided { cosine.abs() } else { cosine.max(0.0) };
        lit.min(1.0)
    }

    #[inline(always)]
    fn gloss(&self, shine: f32) -> f32 {
        match self.power {
            Some(power) => power.of(shine),
            None => shine.powf(self.shininess),
        }
    }

    /// [`Lit::gloss`] of many.
    #[inline(always)]
    fn glosses<L: Lanes>(&self, shine: L) -> L {
        if let Some(power) = self.power {
            return power.of(shine);
        }
        let mut all = [0.0; BATCH];
        shine.store(&mut all);
        for x in &mut all[..L::LANES] {
            *x = x.powf(self.shininess);
        }
        L::load(&all)
    }

    /// [`Lit::facing`] of many.
    #[inline(always)]
    fn facings<L: Lanes>(&self, cosine: L) -> L {
        let lit = if self.two_sided { cosine.abs() } else { cosine.max(L::ZERO) };
        lit.min(L::ONE)
    }

    /// [`Lit::factors`] of many gradients, operation by operation.
    #[inline(always)]
    fn factors_of<L: Lanes>(&self, gradient_per_mm: [L; 3], half: impl Fn(usize) -> [L; 3]) -> ([L; 3], [L; 3]) {
        let (mut reflected, mut highlight) = ([L::splat(self.ambient); 3], [L::ZERO; 3]);
        let square = dot(gradient_per_mm, gradient_per_mm);
        let is_there = L::ZERO.lt(square);
        let fade = square / (square + L::splat(self.soft_square));
        let toward_normal = -L::ONE / square.sqrt();
        for (number, lamp) in self.lamps.iter().enumerate() {
            let shine = self.facings(dot(gradient_per_mm, half(number)) * toward_normal);
            let lit = match lamp.towards {
                Some(towards) => self.facings(dot(gradient_per_mm, splats(towards)) * toward_normal),
                None => shine,
            };
            let gloss = L::select(L::ZERO.lt(lit), self.glosses(shine), L::ZERO);
            // Where there is no gradient these are no numbers.
            let lit = L::select(is_there, fade * lit, L::ZERO);
            let gloss = L::select(is_there, fade * gloss, L::ZERO);
            for c in 0..3 {
                reflected[c] = lit.mul_plus(L::splat(lamp.diffuse[c]), reflected[c]);
                highlight[c] = gloss.mul_plus(L::splat(lamp.specular[c]), highlight[c]);
            }
        }
        (reflected, highlight)
    }

    /// Factors of the emission and of the extinction at a gradient in HU/mm, with the terms of each light, given by its
    /// index, multiplied by a share of its own.
    #[inline(always)]
    pub(super) fn factors(
        &self,
        aim: &[Beam],
        gradient_per_mm: [f32; 3],
        share: impl Fn(usize) -> f32,
    ) -> ([f32; 3], [f32; 3]) {
        let mut reflected = [self.ambient; 3];
        let mut highlight = [0.0; 3];
        let square = dot(gradient_per_mm, gradient_per_mm);
        if square > 0.0 {
            let fade = square / (square + self.soft_square);
            let toward_normal = -1.0 / square.sqrt();
            for (light, beam) in aim.iter().enumerate() {
                let fade = fade * share(light);
                let lit = self.facing(dot(gradient_per_mm, beam.towards) * toward_normal);
                let shine = self.facing(dot(gradient_per_mm, beam.half) * toward_normal);
                let gloss = if lit > 0.0 { self.gloss(shine) } else { 0.0 };
                for c in 0..3 {
                    reflected[c] = (fade * lit).mul_plus(beam.diffuse[c], reflected[c]);
                    highlight[c] = (fade * gloss).mul_plus(beam.specular[c], highlight[c]);
                }
            }
        }
        (reflected, highlight)
    }
}

impl Shader for Lit<'_> {
    const SHADES: bool = true;
    const NAME: &'static str = "lit";
    type Aim = Vec<Beam>;

    fn aim(&self, course: &Course, aim: &mut Vec<Beam>) {
        aim.clear();
        aim.extend(self.definition.directions(course.direction).map(|(towards, half, color)| Beam {
            towards: towards.as_vec3().to_array(),
            half: half.as_vec3().to_array(),
            diffuse: color.map(|c| (c * self.definition.diffuse) as f32),
            specular: color.map(|c| (c * self.definition.specular) as f32),
        }));
    }

    #[inline(always)]
    fn shade(
        &self,
        aim: &Vec<Beam>,
        [r, g, b, extinction]: Rgbs<f32>,
        _: &Spot,
        gradient: impl FnOnce() -> [f32; 3],
    ) -> Rgbs<f32> {
        let (reflected, highlight) = self.factors(aim, gradient(), |_| 1.0);
        let shaded = |q: f32, c: usize| q.mul_plus(reflected[c], extinction * highlight[c]);
        [shaded(r, 0), shaded(g, 1), shaded(b, 2), extinction]
    }
}

impl LaneShader for Unlit {
    #[inline(always)]
    fn shade_lanes<L: Lanes>(&self, (): &(), samples: Rgbs<L>, _: [L; 3]) -> Rgbs<L> {
        samples
    }

    fn lights(&self) -> usize {
        0
    }

    fn half_vectors(&self, _direction: DVec3) -> impl Iterator<Item = [f32; 3]> {
        std::iter::empty()
    }

    #[inline(always)]
    fn reflect<L: Lanes>(&self, _: [L; 3], _: impl Fn(usize) -> [L; 3]) -> ([L; 3], [L; 3]) {
        ([L::ONE; 3], [L::ZERO; 3])
    }
}

impl LaneShader for Lit<'_> {
    #[inline(always)]
    fn shade_lanes<L: Lanes>(
        &self,
        aim: &Vec<Beam>,
        [r, g, b, extinction]: Rgbs<L>,
        gradient_per_mm: [L; 3],
    ) -> Rgbs<L> {
        let (reflected, highlight) = self.factors_of(
            gradient_per_mm,
            #[inline(always)]
            |light| splats(aim[light].half),
        );
        [
            r.mul_plus(reflected[0], extinction * highlight[0]),
            g.mul_plus(reflected[1], extinction * highlight[1]),
            b.mul_plus(reflected[2], extinction * highlight[2]),
            extinction,
        ]
    }

    fn lights(&self) -> usize {
        self.lamps.len()
    }

    fn half_vectors(&self, direction: DVec3) -> impl Iterator<Item = [f32; 3]> {
        self.definition.directions(direction).map(|(_, half, _)| half.as_vec3().to_array())
    }

    #[inline(always)]
    fn reflect<L: Lanes>(&self, gradient_per_mm: [L; 3], half: impl Fn(usize) -> [L; 3]) -> ([L; 3], [L; 3]) {
        self.factors_of(gradient_per_mm, half)
    }
}

impl Lamp {
    fn new(shading: &Shading, light: &Light) -> Self {
        let (towards, color) = match *light {
            Light::Headlight { color } => (None, color),
            Light::Directional { towards, color } => (Some(towards.as_vec3().to_array()), color),
        };
        Lamp {
            towards,
            diffuse: color.map(|c| (c * shading.diffuse) as f32),
            specular: color.map(|c| (c * shading.specular) as f32),
        }
    }
}

#[inline(always)]
fn splats<L: Lanes>([x, y, z]: [f32; 3]) -> [L; 3] {
    [L::splat(x), L::splat(y), L::splat(z)]
}

#[inline(always)]
fn dot<N: Number>([ax, ay, az]: [N; 3], [bx, by, bz]: [N; 3]) -> N {
    az.mul_plus(bz, ay.mul_plus(by, ax * bx))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPOT: Spot = Spot { cell: Cell { corner: [0; 3], fraction: [0.0; 3] }, distance_mm: 0.0 };

    fn shading(two_sided: bool, soft_gradient_per_mm: f64) -> Shading {
        Shading {
            ambient: 0.15,
            diffuse: 0.7,
            specular: 0.4,
            shininess: 17.5,
            two_sided,
            soft_gradient_per_mm,
            lights: vec![
                Light::Headlight { color: [0.9, 0.8, 0.7] },
                Light::Directional { towards: DVec3::new(0.48, -0.6, 0.64), color: [0.1, 0.5, 1.0] },
            ],
        }
    }

    #[test]
    fn it_equals_the_definition() {
        for (two_sided, soft) in [(false, 0.0), (true, 0.0), (false, 80.0), (true, 80.0)] {
            let definition = shading(two_sided, soft);
            let lit = Lit::new(&definition);
            let mut aim = Vec::new();
            for i in 0..3000 {
                let u = |k: f64| (f64::from(i) * k).fract() - 0.5;
                let direction = DVec3::new(u(0.271), u(0.828), u(0.577)).normalize();
                let gradient = DVec3::new(u(0.618), u(0.414), u(0.732)) * 400.0 * u(0.05).abs();
                let sample = [0.5, 0.25, 0.125, 0.75];
                lit.aim(&Course::inside(direction), &mut aim);
                let found = lit.shade(&aim, sample, &SPOT, || gradient.as_vec3().to_array());
                let (reflected, highlight) = definition.factors(gradient, direction);
                for c in 0..3 {
                    let expected = f64::from(sample[c]) * reflected[c] + 0.75 * highlight[c];
                    let apart = (f64::from(found[c]) - expected).abs();
                    assert!(apart < 1e-5, "ray {i}, channel {c}: found {}, expected {expected}", found[c]);
                }
                assert_eq!(found[3], 0.75, "shading leaves extinction alone");
            }
        }
    }

    #[test]
    fn no_gradient_leaves_the_ambient_term() {
        let definition = shading(true, 0.0);
        let lit = Lit::new(&definition);
        let mut aim = Vec::new();
        lit.aim(&Course::inside(DVec3::X), &mut aim);
        assert_eq!(lit.shade(&aim, [1.0, 1.0, 1.0, 5.0], &SPOT, || [0.0; 3]), [0.15, 0.15, 0.15, 5.0]);
    }
}
