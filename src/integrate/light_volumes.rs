//! Light volumes: the transmittance towards each directional light at the lattice points.
//!
//! A lattice point's transmittance is computed when a ray first reads it, to rounding in f64, and kept in f32. What no ray
//! reads, in air and deep inside what is opaque, is never computed. Whichever thread is first, the number is the same, so
//! that the picture depends on neither threads nor tiles.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::exact::{TowardLight, toward_light};
use crate::scene::Scene;
use crate::volume::Volume;

/// Largest error of a stored transmittance: half the last bit of an f32 just below 1, and what an opaque ray leaves out.
pub(super) const STORED_ERROR: f64 = 3.0e-8;

/// A transmittance that nobody has read yet. Those that are known are stored with their sign bit set, 0 too.
const UNKNOWN: u32 = 0;
const SIGN: u32 = 1 << 31;

/// What gets through to lattice points from each light, as far as it is known; x fastest. Shared by all views of a scene.
#[derive(Clone)]
pub(super) struct Transmittances(Arc<[(DVec3, Vec<AtomicU32>)]>);

impl Transmittances {
    /// Transmittances towards the lights that a scene's effects read, of which nothing is known yet.
    pub(super) fn unknown(volume: &Volume, scene: &Scene) -> Self {
        let voxels = volume.grid().voxel_count();
        let unknown = || (0..voxels).into_par_iter().map(|_| AtomicU32::new(UNKNOWN)).collect();
        Transmittances(scene.occluded_directions().into_iter().map(|towards| (towards, unknown())).collect())
    }
}

/// Transmittances towards the lights that a scene's effects read.
pub(super) struct LightVolumes<'a> {
    dims: [usize; 3],
    /// Each with the transmittances towards it.
    lights: Transmittances,
    toward_light: TowardLight<'a>,
}

impl<'a> LightVolumes<'a> {
    /// Light volumes of which as much is known as is in `lights`, which must be those of this volume and scene.
    pub(super) fn new(volume: &'a Volume, scene: &'a Scene, lights: &Transmittances) -> Self {
        LightVolumes { dims: volume.grid().dims(), lights: lights.clone(), toward_light: toward_light(volume, scene) }
    }

    /// Number of lights.
    pub(super) fn len(&self) -> usize {
        self.lights.0.len()
    }

    /// Which light lies in a direction.
    pub(super) fn light(&self, towards: DVec3) -> Option<usize> {
        self.lights.0.iter().position(|(direction, _)| *direction == towards)
    }

    /// Transmittances towards a light at the corners of a cell; corner `c` is the upper one along axis `a` if bit `a` of `c`
    /// is set.
    #[inline]
    pub(super) fn corners(&self, light: usize, cell: [usize; 3]) -> [f32; 8] {
        std::array::from_fn(|c| self.at(light, std::array::from_fn(|a| (cell[a] + (c >> a & 1)).min(self.dims[a] - 1))))
    }

    #[inline]
    fn at(&self, light: usize, voxel: [usize; 3]) -> f32 {
        let [i, j, k] = voxel;
        let (towards, known) = &self.lights.0[light];
        let slot = &known[i + self.dims[0] * (j + self.dims[1] * k)];
        // Nothing else is published with it, so that no order is needed.
        match slot.load(Ordering::Relaxed) {
            UNKNOWN => {
                let found = (self.toward_light)(voxel, *towards) as f32;
                slot.store(found.to_bits() | SIGN, Ordering::Relaxed);
                found
            }
            bits => f32::from_bits(bits & !SIGN),
        }
    }
}
