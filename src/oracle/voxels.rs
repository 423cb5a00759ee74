//! Media given at the lattice points: RGBA volumes, and transfer functions evaluated there. σ and q at the corners of a
//! cell, interpolated, are cubics along a passage.

use super::bernstein::Bernstein;
use super::cell::{Cell, along};
use super::collocation::{Integrand, Stretch};
use super::panel::Panel;
use super::patches::Channels;
use super::path::Passage;
use crate::scene::{ClassifyAt, Scene};
use crate::volume::Volume;

/// True if σ and q are given at the lattice points.
pub(super) fn are_given(volume: &Volume, scene: &Scene) -> bool {
    volume.rgba_encoding().is_some() || scene.effects.classify == ClassifyAt::Voxels
}

/// σ and q along a passage.
pub(super) fn panel(volume: &Volume, scene: &Scene, passage: &Passage) -> Panel<4> {
    let cell = Cell::new(volume, passage.cell);
    let corners: [Channels; 8] = match volume.rgba_encoding() {
        Some(_) => cell.corners().map(|voxel| rgba(volume, voxel)),
        None => classified(volume, scene, &cell),
    };
    let channels = std::array::from_fn(|c| along(&corners.map(|corner| corner[c]), passage));
    Panel { channels, length_mm: passage.length_mm }
}

fn rgba(volume: &Volume, voxel: [usize; 3]) -> Channels {
    let [r, g, b, extinction] = volume.optics_per_mm(voxel).unwrap_or_default();
    [extinction, r, g, b]
}

/// The transfer function and the shading at the corners of a cell.
fn classified(volume: &Volume, scene: &Scene, cell: &Cell<'_>) -> [Channels; 8] {
    let (values, gradients) = (cell.values(), cell.gradients_per_mm());
    std::array::from_fn(|c| {
        let optics = scene.transfer_function.evaluate(values[c], gradients[c].length());
        let (reflected, highlight) = match &scene.shading {
            Some(shading) => {
                let index = cell.corners()[c].map(|i| i as f64);
                let point_mm = volume.grid().index_to_lps_mm().transform_point3(index.into());
                shading.factors(gradients[c], scene.camera.direction_to(point_mm))
            }
            None => ([1.0; 3], [0.0; 3]),
        };
        let extinction = optics.extinction_per_mm;
        let lit = |c: usize| optics.emission_per_mm[c] * reflected[c] + extinction * highlight[c];
        [extinction, lit(0), lit(1), lit(2)]
    })
}

/// For method B: the same, pointwise.
impl Integrand for Panel<4> {
    fn optics(&self, t: f64) -> Channels {
        self.channels.map(|Bernstein(c)| Bernstein(c).at(t))
    }

    fn resolved_by(&self, _: &Stretch) -> bool {
        true
    }
}
