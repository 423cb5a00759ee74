//! Rays computed by `golden.py` to 30 digits, in other arithmetic and by other methods.

use glam::DVec3;
use pellucid::oracle::Oracle;
use pellucid::scene::{Light, Ray, Scene, Shading};
use pellucid::transfer::{Curve, Knot, Optics, Term, TransferFunction, Weight};
use pellucid::volume::{Quantity, Rescale, Samples, Volume};
use serde::Deserialize;

use crate::support::scenes::{difference, grid, scene};

/// Rounding in f64. The largest error that was measured is 1.2e-15; other mathematical libraries may round otherwise.
const TOLERANCE: f64 = 1e-14;

#[derive(Deserialize)]
struct Golden {
    name: String,
    dims: [usize; 3],
    stored: Vec<i16>,
    slope: f64,
    intercept: f64,
    matrix: [[f64; 3]; 3],
    translation: [f64; 3],
    window: [f64; 2],
    gradient_range: f64,
    terms: Vec<GoldenTerm>,
    shading: Option<GoldenShading>,
    origin: [f64; 3],
    direction: [f64; 3],
    rgba: [String; 4],
}

#[derive(Deserialize)]
struct GoldenTerm {
    knots: Vec<[f64; 5]>,
    weight: Option<Vec<[f64; 2]>>,
}

#[derive(Deserialize)]
struct GoldenShading {
    ambient: f64,
    diffuse: f64,
    specular: f64,
    shininess: f64,
    two_sided: bool,
    soft_gradient: f64,
    lights: Vec<GoldenLight>,
}

#[derive(Deserialize)]
struct GoldenLight {
    towards: Option<[f64; 3]>,
    color: [f64; 3],
}

impl Golden {
    fn volume(&self) -> Volume {
        let rescale = Rescale { slope: self.slope, intercept: self.intercept };
        let grid = grid(self.dims, self.matrix, self.translation);
        Volume::new(grid, Samples::I16(self.stored.clone()), rescale, Quantity::Hu).unwrap()
    }

    fn scene(&self) -> Scene {
        let terms = self.terms.iter().map(|term| {
            let knots = term.knots.iter().map(|&[value, extinction_per_mm, r, g, b]| Knot {
                value,
                optics: Optics { extinction_per_mm, emission_per_mm: [r, g, b] },
            });
            let weight = term.weight.clone().map(|w| Weight::new(w).unwrap());
            Term { curve: Curve::new(knots.collect()).unwrap(), weight }
        });
        let function = TransferFunction::new(self.window, self.gradient_range, terms.collect()).unwrap();
        let mut scene = scene(function);
        scene.shading = self.shading.as_ref().map(GoldenShading::shading);
        scene
    }

    fn ray(&self) -> Ray {
        // As written: the exact direction is part of the case.
        Ray { origin_mm: self.origin.into(), direction: self.direction.into() }
    }

    fn expected(&self) -> [f64; 4] {
        self.rgba.clone().map(|x| x.parse().expect("a number"))
    }
}

impl GoldenShading {
    fn shading(&self) -> Shading {
        let light = |light: &GoldenLight| match light.towards {
            None => Light::Headlight { color: light.color },
            Some(towards) => Light::Directional { towards: DVec3::from_array(towards), color: light.color },
        };
        Shading {
            ambient: self.ambient,
            diffuse: self.diffuse,
            specular: self.specular,
            shininess: self.shininess,
            two_sided: self.two_sided,
            soft_gradient_per_mm: self.soft_gradient,
            lights: self.lights.iter().map(light).collect(),
        }
    }
}

fn cases() -> Vec<Golden> {
    serde_json::from_str(include_str!("golden.json")).expect("golden.json is as golden.py writes it")
}

fn assert_all_agree(found: impl Fn(&Oracle, &Ray) -> [f64; 4]) {
    let cases = cases();
    assert!(cases.len() >= 36, "found {} cases", cases.len());
    let mut failures = String::new();
    for case in &cases {
        let (volume, scene) = (case.volume(), case.scene());
        let (found, expected) = (found(&Oracle::new(&volume, &scene), &case.ray()), case.expected());
        let error = difference(found, expected);
        if error > TOLERANCE {
            failures += &format!("\n{}: error {error:.1e}, found {found:?}, expected {expected:?}", case.name);
        }
    }
    assert!(failures.is_empty(), "beyond {TOLERANCE:e}:{failures}");
}

#[test]
fn the_oracle_agrees_with_golden_rays() {
    assert_all_agree(|oracle, ray| oracle.radiance(ray));
}

#[test]
fn collocation_agrees_with_golden_rays() {
    assert_all_agree(|oracle, ray| oracle.segment_by_collocation(ray, 0.0, f64::INFINITY).rgba());
}

#[test]
fn the_comparison_notices_a_knot_moved_by_a_millionth() {
    let mut case = cases().into_iter().find(|c| c.name == "one cell, two tissues").expect("the case");
    case.terms[1].knots[1][0] += 1e-6;
    let (volume, scene) = (case.volume(), case.scene());
    let error = difference(Oracle::new(&volume, &scene).radiance(&case.ray()), case.expected());
    assert!(error > TOLERANCE, "a shifted transfer function must be seen: error {error:e}");
}
