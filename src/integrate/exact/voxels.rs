//! Media given at the voxels: emission and extinction are cubics along a segment, in one piece, since there is no knot.

use rayon::prelude::*;

use crate::field::Corners;
use crate::integrate::Schedule;
use crate::integrate::texels::Texels;
use crate::math::bernstein::{Cubic, restrict};
use crate::math::each;
use crate::scene::{Ray, Scene};
use crate::volume::Volume;

use super::cells::{Domain, Segment};
use super::lattice::along;
use super::medium::Medium;
use super::piece::{Integral, Optics};
use super::ray::{Brightest, Frame};
use super::shade::{Shader, Unlit};
use super::splits::Splits;
use super::{Direct, Tracer};

/// A medium given at the voxels. In f64 alone: nothing is evaluated along a segment that f32 would make cheaper.
#[derive(Debug, Clone)]
struct AtVoxels<T> {
    corners: Corners,
    texels: T,
}

/// Traces rays through a medium given at the voxels; shading is in the texels already.
pub(super) fn tracer<'a, T: Texels<f64> + 'a>(
    schedule: Schedule,
    volume: &'a Volume,
    scene: &'a Scene,
    texels: T,
    tolerance: f64,
    name: String,
) -> Box<dyn Tracer + 'a> {
    let (domain, brightest) = (Domain::new(volume, scene), brightest(&texels));
    let frame = Frame { domain, tolerance, brightest, ends_early: schedule.early_termination };
    let medium = AtVoxels { corners: Corners::new(volume.grid().dims()), texels };
    let trace = move |ray: &Ray| frame.trace(ray, &medium, &Unlit, &mut Splits::default());
    Box::new(Direct { trace, name })
}

/// Bounds over all voxels, which hold between them: what is interpolated lies between its corners, and so does the ratio of
/// two interpolants.
fn brightest(texels: &impl Texels<f64>) -> Brightest {
    let dark = Brightest { color: 0.0, emission_per_mm: 0.0, per_absorbed: 0.0, per_mm: 0.0, extinction_per_mm: 0.0 };
    let of_voxel = |voxel| {
        let [r, g, b, extinction_per_mm] = texels.optics(voxel);
        let per_mm = r.max(g).max(b);
        let color = if per_mm > 0.0 { per_mm / extinction_per_mm } else { 0.0 };
        Brightest { color, emission_per_mm: per_mm, per_absorbed: color, per_mm, extinction_per_mm }
    };
    let larger = |a: Brightest, b: Brightest| Brightest {
        color: a.color.max(b.color),
        emission_per_mm: a.emission_per_mm.max(b.emission_per_mm),
        per_absorbed: a.per_absorbed.max(b.per_absorbed),
        per_mm: a.per_mm.max(b.per_mm),
        extinction_per_mm: a.extinction_per_mm.max(b.extinction_per_mm),
    };
    (0..texels.len()).into_par_iter().map(of_voxel).reduce(|| dark, larger)
}

impl<T: Texels<f64>> Medium<f64> for AtVoxels<T> {
    type Fields = Optics<f64, 4>;

    #[inline]
    fn fields(&self, segment: &Segment) -> Option<Optics<f64, 4>> {
        let voxels = self.corners.of(segment.cell);
        let optics: [[f64; 4]; 8] = each(|c| self.texels.optics(voxels[c]));
        if optics == [[0.0; 4]; 8] {
            return None;
        }
        let channel = |c: usize| along(&each(|corner| optics[corner][c]), segment);
        Some(Optics { emission: each(channel), extinction: channel(3) })
    }

    /// None: there is no value to have one. Whatever is shaded was shaded at the voxels.
    fn gradient(&self, _: &Optics<f64, 4>, _: &Segment) -> [Cubic<f64>; 3] {
        [[0.0; 4]; 3]
    }

    fn cut(&self, _: &Optics<f64, 4>, _: &mut Splits<f64>) {}

    #[inline]
    fn integrate<S: Shader<f64>>(
        &self,
        fields: &Optics<f64, 4>,
        [from, to]: [f64; 2],
        length_mm: f64,
        shader: &S,
        shading: &S::Cell,
    ) -> Option<Integral<f64>> {
        let part = |channel: &Cubic<f64>| restrict(channel, from, to);
        let optics = Optics { emission: each(|c| part(&fields.emission[c])), extinction: part(&fields.extinction) };
        Some(shader.integrate::<4, 5>(&optics, length_mm, shading, [from, to]))
    }
}
