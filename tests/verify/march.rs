//! A plain march in f64, with one switch for each mistake.

use glam::DVec3;
use pellucid::scene::{Ray, Scene};
use pellucid::verify::{chord_mm, interpolate};
use pellucid::volume::Volume;

/// A march of second order, as long as nothing is switched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reference {
    /// Place of the sample in its interval, as a share of it.
    pub(super) place: f64,
    pub(super) skip_first: bool,
    pub(super) skip_last: bool,
    /// Opacity of this length whatever the step, mm.
    pub(super) opacity_of_mm: Option<f64>,
    /// Colour that is multiplied by opacity is multiplied again.
    pub(super) twice_weighted: bool,
    /// The field is read this far from where it is.
    pub(super) shift_voxels: f64,
    /// Colour and transmittance are kept in whole steps of one part in 2^bits - 1.
    pub(super) bits: Option<i32>,
}

impl Reference {
    /// Every pixel.
    pub(super) fn render(&self, volume: &Volume, scene: &Scene, step_mm: f64) -> Vec<[f64; 4]> {
        self.render_through(volume, scene, step_mm, 0.5)
    }

    /// Every pixel, by rays through this share of it across and down.
    pub(super) fn render_through(&self, volume: &Volume, scene: &Scene, step_mm: f64, share: f64) -> Vec<[f64; 4]> {
        let [width, height] = scene.camera.size();
        let ray = |i: usize| scene.camera.ray((i % width) as f64 + share, (i / width) as f64 + share);
        (0..width * height).map(|i| self.trace(volume, scene, &ray(i), step_mm)).collect()
    }

    fn trace(&self, volume: &Volume, scene: &Scene, ray: &Ray, step_mm: f64) -> [f64; 4] {
        let Some([from_mm, to_mm]) = chord_mm(volume.grid(), ray) else { return [0.0; 4] };
        let intervals = ((to_mm - from_mm) / step_mm).ceil().max(1.0) as usize;
        let h = (to_mm - from_mm) / intervals as f64;
        let shift_mm = volume.grid().index_to_lps_mm().transform_vector3(DVec3::splat(self.shift_voxels));
        let (mut color, mut transmittance) = ([0.0; 3], 1.0);
        for i in usize::from(self.skip_first)..intervals - usize::from(self.skip_last && intervals > 1) {
            let point = ray.origin_mm + (from_mm + (i as f64 + self.place) * h) * ray.direction + shift_mm;
            let optics = scene.transfer_function.evaluate(interpolate(volume, point), 0.0);
            let depth = optics.extinction_per_mm * self.opacity_of_mm.unwrap_or(h);
            let alpha = -(-depth).exp_m1();
            for (sum, q) in color.iter_mut().zip(optics.emission_per_mm) {
                let mut added = if depth > 0.0 { q / optics.extinction_per_mm * alpha } else { q * h };
                if self.twice_weighted {
                    added *= alpha;
                }
                *sum = self.kept(*sum + transmittance * added);
            }
            transmittance = self.kept(transmittance - transmittance * alpha);
        }
        let [r, g, b] = color;
        [r, g, b, 1.0 - transmittance]
    }

    fn kept(&self, x: f64) -> f64 {
        self.bits.map_or(x, |bits| {
            let largest = f64::from(bits).exp2() - 1.0;
            (x * largest).round() / largest
        })
    }
}
