//! Every kernel against a march in f64 that is written out from the definitions.

use glam::DVec3;
use pellucid::plan::{Emission, Lattice, March, SampleRule};
use pellucid::scene::{Projection, Ray, Scene, Shading};
use pellucid::simd::Level;
use pellucid::volume::Volume;

use super::scenes::{MARCH, apart, blobs_f32, blobs_i16, marched, oblique, scene, tissue_1d, tissue_2d, two_lights};

/// The march that the settings ask for, front to back, in f64.
pub(crate) fn march(volume: &Volume, scene: &Scene, settings: &March) -> Vec<[f64; 4]> {
    let [width, height] = scene.camera.size();
    let field = Field { volume };
    (0..width * height)
        .map(|i| {
            let ray = scene.camera.pixel_ray(i % width, i / width);
            let Some([entry, exit]) = field.chord(ray) else { return [0.0; 4] };
            let cuts = cuts(volume, scene, settings, ray, [entry, exit]);
            let optics = |s: f64| field.optics(scene, ray, s);
            let (mut color, mut depth) = ([0.0; 3], 0.0f64);
            for ends in cuts.windows(2) {
                let [a, b] = [ends[0], ends[1]];
                let q = match settings.rule {
                    SampleRule::Left => optics(a),
                    SampleRule::Midpoint => optics(0.5 * (a + b)),
                    SampleRule::WholeSteps if b - a < 0.999_999 * settings.step_mm => [0.0; 4],
                    SampleRule::WholeSteps => optics(b),
                    SampleRule::Trapezoid => {
                        let (q, r) = (optics(a), optics(b));
                        std::array::from_fn(|c| 0.5 * (q[c] + r[c]))
                    }
                };
                let delta = b - a;
                let x = q[3] * delta;
                for c in 0..3 {
                    color[c] += (-depth).exp()
                        * match settings.emission {
                            Emission::PerSample => q[c],
                            Emission::PerLength if x > 1e-12 => q[c] / q[3] * -(-x).exp_m1(),
                            Emission::PerLength => q[c] * delta,
                        };
                }
                depth += x;
            }
            [color[0], color[1], color[2], -(-depth).exp_m1()]
        })
        .collect()
}

fn cuts(volume: &Volume, scene: &Scene, settings: &March, ray: Ray, [entry, exit]: [f64; 2]) -> Vec<f64> {
    let mut cuts = vec![entry];
    match settings.lattice {
        Lattice::PerRay => {
            cuts.extend((1..).map(|i| entry + f64::from(i) * settings.step_mm).take_while(|s| *s < exit))
        }
        Lattice::ViewPlanes => {
            let forward = scene.camera.forward();
            let depth = |s: f64| {
                (ray.origin_mm + s * ray.direction - volume.grid().center_mm()).dot(forward) / settings.step_mm
            };
            let first = depth(entry).floor() as i32 + 1;
            let slope = depth(1.0) - depth(0.0);
            cuts.extend((first..).map(|i| (f64::from(i) - depth(0.0)) / slope).take_while(|s| *s < exit));
        }
    }
    cuts.push(exit);
    cuts
}

struct Field<'a> {
    volume: &'a Volume,
}

impl Field<'_> {
    fn chord(&self, ray: Ray) -> Option<[f64; 2]> {
        let grid = self.volume.grid();
        let origin = grid.lps_mm_to_index().transform_point3(ray.origin_mm);
        let direction = grid.lps_mm_to_index().transform_vector3(ray.direction);
        let (low, high) = grid.index_bounds();
        let (a, b) = ((low - origin) / direction, (high - origin) / direction);
        let (entry, exit) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
        (exit > entry).then_some([entry, exit])
    }

    /// Shaded `[q_r, q_g, q_b, σ]`.
    fn optics(&self, scene: &Scene, ray: Ray, s: f64) -> [f64; 4] {
        let at = self.volume.grid().lps_mm_to_index().transform_point3(ray.origin_mm + s * ray.direction);
        let value = self.interpolate(at, |p| self.volume.value(p));
        let magnitude = self.interpolate(at, |p| self.gradient(p).length());
        let optics = scene.transfer_function.evaluate(value, magnitude);
        let sigma = optics.extinction_per_mm;
        let Some(shading) = &scene.shading else {
            let [r, g, b] = optics.emission_per_mm;
            return [r, g, b, sigma];
        };
        let gradient = DVec3::new(
            self.interpolate(at, |p| self.gradient(p).x),
            self.interpolate(at, |p| self.gradient(p).y),
            self.interpolate(at, |p| self.gradient(p).z),
        );
        let (reflected, highlight) = shading.factors(gradient, ray.direction);
        let shaded = |c: usize| optics.emission_per_mm[c] * reflected[c] + sigma * highlight[c];
        [shaded(0), shaded(1), shaded(2), sigma]
    }

    fn interpolate(&self, at: DVec3, voxel: impl Fn([usize; 3]) -> f64) -> f64 {
        let dims = self.volume.grid().dims();
        let base: [usize; 3] = std::array::from_fn(|a| (at[a].max(0.0) as usize).min(dims[a].max(2) - 2));
        let mut sum = 0.0;
        for corner in 0..8 {
            let p: [usize; 3] = std::array::from_fn(|a| (base[a] + (corner >> a & 1)).min(dims[a] - 1));
            let weight: f64 = (0..3)
                .map(|a| {
                    let u = (at[a] - base[a] as f64).clamp(0.0, 1.0);
                    if corner >> a & 1 == 1 { u } else { 1.0 - u }
                })
                .product();
            sum += weight * voxel(p);
        }
        sum
    }

    /// Gradient at a voxel, HU/mm.
    fn gradient(&self, p: [usize; 3]) -> DVec3 {
        let dims = self.volume.grid().dims();
        let per_index = DVec3::from_array(std::array::from_fn(|a| {
            let (mut low, mut high) = (p, p);
            low[a] = p[a].saturating_sub(1);
            high[a] = (p[a] + 1).min(dims[a] - 1);
            (self.volume.value(high) - self.volume.value(low)) / (high[a] - low[a]).max(1) as f64
        }));
        self.volume.grid().gradient_to_per_mm() * per_index
    }
}

#[test]
fn every_kernel_equals_the_naive_march() {
    for (volume, voxel) in [(blobs_i16(), "i16"), (blobs_f32(), "f32")] {
        for (transfer_function, classifier) in [(tissue_1d(), "tf1d"), (tissue_2d(), "tf2d")] {
            for (shading, shader) in [(None, "unlit"), (Some(two_lights()), "lit")] {
                let scene = scene(&volume, transfer_function.clone(), shading);
                let found = marched(&volume, &scene, MARCH);
                assert_eq!(found.statistics.kernel, format!("march/{voxel}/{classifier}/{shader}/{}", Level::widest()));
                let expected = march(&volume, &scene, &MARCH);
                let worst = apart(found.image.pixels(), &expected);
                assert!(worst < 1e-5, "{}: {worst:e} from the naive march", found.statistics.kernel);
                let brightest = expected.iter().map(|p| p[3]).fold(0.0, f64::max);
                assert!(brightest > 0.5, "the scene shows something: alpha up to {brightest}");
            }
        }
    }
}

#[test]
fn every_rule_lattice_and_emission_equals_the_naive_march() {
    let volume = blobs_i16();
    let mut scene = scene(&volume, tissue_1d(), None);
    let parallel = oblique(volume.grid(), Projection::Parallel { height_mm: 25.0 });
    for camera in [scene.camera, parallel] {
        scene.camera = camera;
        for rule in [SampleRule::Left, SampleRule::Midpoint, SampleRule::Trapezoid] {
            for lattice in [Lattice::PerRay, Lattice::ViewPlanes] {
                for emission in [Emission::PerLength, Emission::PerSample] {
                    for step_mm in [0.4, 50.0] {
                        let settings = March { rule, lattice, emission, step_mm, ..MARCH };
                        let found = marched(&volume, &scene, settings);
                        let worst = apart(found.image.pixels(), &march(&volume, &scene, &settings));
                        assert!(worst < 1e-5, "{settings:?}: {worst:e} from the naive march");
                    }
                }
            }
        }
    }
}

#[test]
fn one_sided_lights_equal_the_naive_march() {
    let volume = blobs_i16();
    let shading = Shading { two_sided: false, soft_gradient_per_mm: 0.0, ..two_lights() };
    let scene = scene(&volume, tissue_1d(), Some(shading));
    let found = marched(&volume, &scene, MARCH);
    let worst = apart(found.image.pixels(), &march(&volume, &scene, &MARCH));
    assert!(worst < 1e-5, "{worst:e} from the naive march");
}
