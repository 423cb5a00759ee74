//! The kernel of scenes with effects of light.

use crate::integrate::light_volumes::LightVolumes;
use crate::scene::{Ray, Scene};

use super::super::medium::Medium;
use super::super::ray::{Frame, Traced};
use super::super::splits::Splits;
use super::super::{Tracer, ray::Brightest};
use super::Atmosphere;

/// A kernel for one type of medium, in f64.
pub(in super::super) struct Kernel<'a, M> {
    pub(in super::super) frame: Frame<'a>,
    pub(in super::super) scene: &'a Scene,
    pub(in super::super) medium: M,
    pub(in super::super) lights: LightVolumes<'a>,
    pub(in super::super) name: String,
}

impl<M: Medium<f64>> Tracer for Kernel<'_, M> {
    fn trace(&self, ray: &Ray) -> Option<Traced> {
        let of_function: Brightest = self.frame.brightest;
        let atmosphere = Atmosphere::new(self.scene, ray, &self.lights, of_function.color);
        let (near_mm, length_mm) =
            self.frame.domain.inside(ray).map_or((0.0, 0.0), |inside| (inside.enter_mm(), inside.length_mm()));
        let (brightest, stored_error) = atmosphere.bounds(self.scene, of_function, near_mm, length_mm);
        // What stored transmittances cost no shorter piece can win back.
        let tolerance = (self.frame.tolerance - stored_error).max(0.5 * self.frame.tolerance);
        let frame = Frame { brightest, tolerance, ..self.frame };
        let traced = frame.trace(ray, &self.medium, &atmosphere, &mut Splits::default())?;
        Some(Traced { bound: traced.bound + stored_error, ..traced })
    }

    fn kernel(&self) -> &str {
        &self.name
    }
}
