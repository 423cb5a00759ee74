//! A piece of a passage as method B integrates it: pointwise, shaded if the scene is.

use glam::DVec3;

use super::collocation::{Integrand, Stretch};
use super::fields::{Fields, Piece};
use super::patches::{Channels, Patches};
use super::shaded::ShadedRay;

/// A piece, with what is needed to evaluate it at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct LitPiece<'a> {
    pub(super) fields: &'a Fields,
    pub(super) patches: &'a Patches,
    pub(super) piece: Piece<'a>,
    pub(super) shaded: Option<&'a ShadedRay<'a>>,
}

impl LitPiece<'_> {
    /// The shading and the gradient at a point; `None` if the scene is not shaded.
    fn shading_at(&self, t: f64) -> Option<(&ShadedRay<'_>, DVec3)> {
        let gradient = self.fields.gradient.as_ref()?.map(|g| g.at(t));
        Some((self.shaded?, DVec3::from_array(gradient)))
    }
}

impl Integrand for LitPiece<'_> {
    fn optics(&self, t: f64) -> Channels {
        let unshaded = self.fields.optics(self.patches, &self.piece, t);
        match self.shading_at(t) {
            Some((shaded, gradient)) => shaded.shade(unshaded, gradient),
            None => unshaded,
        }
    }

    fn resolved_by(&self, step: &Stretch) -> bool {
        match (self.shading_at(step.from), self.shading_at(step.from + step.width)) {
            (Some((shaded, a)), Some((_, b))) => shaded.is_gentle_between(a, b),
            _ => true,
        }
    }
}
