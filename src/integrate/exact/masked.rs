//! Transfer functions by the class of the nearest voxel.

use crate::math::Real;
use crate::math::bernstein::Cubic;

use super::cells::Segment;
use super::medium::Medium;
use super::nearest::{Nearest, Parts};
use super::piece::Integral;
use super::shade::Shader;
use super::splits::Splits;

/// A medium for each class. A segment is cut where the class changes, and each piece has that of its middle.
#[derive(Debug, Clone)]
pub(super) struct Masked<'a, M> {
    /// By class; all media have the same fields.
    pub(super) media: Vec<M>,
    pub(super) nearest: Nearest<'a>,
}

/// The fields along a segment, and the classes along it.
pub(super) struct MaskedFields<F> {
    fields: F,
    parts: Parts,
}

impl<F> MaskedFields<F> {
    /// The fields, whatever the class.
    pub(super) fn within_class(&self) -> &F {
        &self.fields
    }

    /// The class at a place of the segment.
    pub(super) fn class_at(&self, place: f64) -> usize {
        self.parts.class_at(place)
    }
}

impl<R: Real, M: Medium<R>> Medium<R> for Masked<'_, M> {
    type Fields = MaskedFields<M::Fields>;

    fn fields(&self, segment: &Segment) -> Option<MaskedFields<M::Fields>> {
        let parts = self.nearest.parts(segment);
        let fields = parts.iter().find_map(|(_, class)| self.media[class].fields(segment))?;
        Some(MaskedFields { fields, parts })
    }

    fn gradient(&self, MaskedFields { fields, .. }: &MaskedFields<M::Fields>, segment: &Segment) -> [Cubic<R>; 3] {
        // All media read the same lattice.
        self.media[0].gradient(fields, segment)
    }

    fn cut(&self, MaskedFields { fields, parts }: &MaskedFields<M::Fields>, splits: &mut Splits<R>) {
        for ([_, end], class) in parts.iter() {
            if end < 1.0 {
                splits.add(R::from_f64(end));
            }
            // Knots of one class cut the others' parts too, which costs pieces and nothing else.
            self.media[class].cut(fields, splits);
        }
    }

    fn integrate<S: Shader<R>>(
        &self,
        MaskedFields { fields, parts }: &MaskedFields<M::Fields>,
        part: [R; 2],
        length_mm: R,
        shader: &S,
        shading: &S::Cell,
    ) -> Option<Integral<R>> {
        let class = parts.class_at(0.5 * (part[0].to_f64() + part[1].to_f64()));
        self.media[class].integrate(fields, part, length_mm, shader, shading)
    }
}
