//! A piece of a passage as method B integrates it: pointwise, with shading and the effects of light.

use glam::DVec3;

use super::collocation::{Integrand, Stretch};
use super::fields::{Fields, Piece};
use super::lit_passage::LitPassage;
use super::patches::{Channels, Patches};

/// A piece, with what is needed to evaluate it at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct LitPiece<'a> {
    pub(super) fields: &'a Fields,
    pub(super) patches: &'a Patches,
    pub(super) piece: Piece<'a>,
    pub(super) passage: &'a LitPassage<'a>,
}

impl LitPiece<'_> {
    /// 0 where nobody reads it.
    fn gradient_at(&self, t: f64) -> DVec3 {
        self.fields.gradient.as_ref().map_or(DVec3::ZERO, |g| g.map(|component| component.at(t)).into())
    }
}

impl Integrand for LitPiece<'_> {
    fn optics(&self, t: f64) -> Channels {
        self.passage.light(t, self.fields.optics(self.patches, &self.piece, t), self.gradient_at(t))
    }

    fn resolved_by(&self, step: &Stretch) -> bool {
        let [a, b] = [step.from, step.from + step.width];
        self.passage.is_gentle_between([a, b], [self.gradient_at(a), self.gradient_at(b)])
    }
}
