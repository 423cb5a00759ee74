//! What holds of any picture, whatever computes it.

use glam::DVec3;

use super::manufactured::{SIDE_MM, function, looking, oblique, rays, sampled, smooth, trilinear, wave, with_knot};
use super::report::Check;
use super::{Integrator, chord_mm, interpolate, largest_difference, subjects};
use crate::error::Result;
use crate::plan::{Colors, March, Order, SampleRule};
use crate::scene::Scene;
use crate::transfer::{Optics, TransferFunction};
use crate::volume::Volume;

/// Difference that 512 steps across the cube and rounding in f32 may make to a march of second order.
pub const MARCHING: f64 = 4e-5;

/// The step, mm.
const STEP_MM: f64 = SIDE_MM / 512.0;

/// Pixels along a side.
const SIZE: usize = 12;

/// Identities of the volume rendering integral, each to within `allowed`.
///
/// # Errors
/// Whatever the integrator says.
pub fn checks(name: &str, allowed: f64, integrator: &Integrator<'_>) -> Result<Vec<Check>> {
    let volume = sampled(wave, 5)?;
    let see = |function: TransferFunction| integrator(&volume, &oblique(function, SIZE)?, STEP_MM);
    let depths = along_rays(|o| o.extinction_per_mm)?;
    let absorbed: Vec<_> = depths.iter().map(|tau| [0.0, 0.0, 0.0, -(-tau).exp_m1()]).collect();
    let color = [0.875, 0.5, 0.125];
    let colored: Vec<_> = absorbed.iter().map(|[.., a]| [color[0] * a, color[1] * a, color[2] * a, *a]).collect();
    let emitted = along_rays(|o| o.emission_per_mm[1])?;
    let glowing: Vec<_> = emitted.iter().map(|q| [0.0, *q, 0.0, 0.0]).collect();
    let off = |found: Vec<[f64; 4]>, expected: &[[f64; 4]]| largest_difference(&found, expected);
    let black = changed(|o| Optics { emission_per_mm: [0.0; 3], ..o })?;
    let uniform = changed(|o| Optics::colored(o.extinction_per_mm, color))?;
    let glow = changed(|o| Optics { extinction_per_mm: 0.0, emission_per_mm: [0.0, o.emission_per_mm[1], 0.0] })?;
    Ok(vec![
        Check::error(name, "absorption only: T = exp(-∫σ)", allowed, off(see(black)?, &absorbed)),
        Check::error(name, "one colour c: C = c (1 - T)", allowed, off(see(uniform)?, &colored)),
        // Up to 1.5 units of light, which nothing absorbs.
        Check::error(name, "emission only: C = ∫q", 2.0 * allowed, off(see(glow)?, &glowing)),
        Check::error(name, "T(a, c) = T(a, b) T(b, c)", 3.0 * allowed, cut_in_two(integrator)?),
    ])
}

/// The smooth transfer function with its optics changed at both ends.
fn changed(change: impl Fn(Optics) -> Optics) -> Result<TransferFunction> {
    let smooth = smooth()?;
    let [low, high] = smooth.window();
    function(&[low, high].map(|value| (value, change(smooth.evaluate(value, 0.0)))))
}

/// An integral along each ray of the picture, for optics linear in the value.
fn along_rays(integrand: impl Fn(Optics) -> f64) -> Result<Vec<f64>> {
    let (volume, function) = (sampled(wave, 5)?, smooth()?);
    let scene = oblique(smooth()?, SIZE)?;
    let at = |point_mm: DVec3| integrand(function.evaluate(interpolate(&volume, point_mm), 0.0));
    let along = |ray: crate::scene::Ray| {
        let Some([from_mm, to_mm]) = chord_mm(volume.grid(), &ray) else { return 0.0 };
        let mut cuts = vec![from_mm, to_mm];
        for axis in 0..3 {
            let face = |i: usize| (i as f64 * SIDE_MM / 4.0 - ray.origin_mm[axis]) / ray.direction[axis];
            cuts.extend((0..5).map(face).filter(|mm| from_mm < *mm && *mm < to_mm));
        }
        cuts.sort_by(f64::total_cmp);
        // The value is a cubic between faces, for which two nodes are exact.
        let part = |ends: &[f64]| {
            let (half, middle) = (0.5 * (ends[1] - ends[0]), 0.5 * (ends[0] + ends[1]));
            let node = half / 3.0_f64.sqrt();
            half * [middle - node, middle + node].map(|mm| at(ray.origin_mm + mm * ray.direction)).iter().sum::<f64>()
        };
        cuts.windows(2).map(part).sum()
    };
    Ok(rays(&scene).map(along).collect())
}

/// How far the transmittance of whole rays is from the product of those of their halves, before and behind the middle of the
/// cube. A half before it is seen from the middle, looking back.
fn cut_in_two(integrator: &Integrator<'_>) -> Result<f64> {
    let volume = sampled(trilinear, 2)?;
    let direction = DVec3::new(0.48, 0.6, 0.64);
    let transmittances = |from_mm: f64, direction: DVec3| -> Result<Vec<f64>> {
        let scene = looking(with_knot()?, from_mm, direction, 12.0, SIZE)?;
        Ok(integrator(&volume, &scene, STEP_MM)?.iter().map(|[.., alpha]| 1.0 - alpha).collect())
    };
    let whole = transmittances(-20.0, direction)?;
    let behind = transmittances(0.0, direction)?;
    // Looking back, right is left.
    let before = transmittances(0.0, -direction)?;
    let mirrored = |i: usize| i / SIZE * SIZE + (SIZE - 1 - i % SIZE);
    let rgba = |t: f64| [0.0, 0.0, 0.0, 1.0 - t];
    let found: Vec<_> = (0..whole.len()).map(|i| rgba(behind[i] * before[mirrored(i)])).collect();
    Ok(largest_difference(&found, &whole.into_iter().map(rgba).collect::<Vec<_>>()))
}

/// Variants of the march that may differ by rounding only.
pub(super) fn of_marching_variants() -> Result<Vec<Check>> {
    let volume = sampled(wave, 5)?;
    let scene = oblique(with_knot()?, SIZE)?;
    let mut checks = Vec::new();
    for (rule, name) in [(SampleRule::Midpoint, "march/midpoint"), (SampleRule::Trapezoid, "march/trapezoid")] {
        let plain = picture(&volume, &scene, rule, |_| ())?;
        let straight = picture(&volume, &scene, rule, |march| march.colors = Colors::Straight)?;
        let reversed = picture(&volume, &scene, rule, |march| march.order = Order::BackToFront)?;
        let apart = largest_difference(&straight, &plain);
        checks.push(Check::error(name, "associated colours = straight colours", MARCHING, apart));
        let apart = largest_difference(&reversed, &plain);
        checks.push(Check::error(name, "front to back = back to front", MARCHING, apart));
    }
    Ok(checks)
}

fn picture(
    volume: &Volume,
    scene: &Scene,
    rule: SampleRule,
    change: impl Fn(&mut crate::plan::March),
) -> Result<Vec<[f64; 4]>> {
    let mut settings = March::plain(rule, STEP_MM);
    change(&mut settings);
    subjects::marched(volume, scene, settings)
}
