//! Transmittance towards lights.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::Oracle;

/// What is taken as the transmittance towards a light at a point.
#[derive(Debug, Clone)]
pub(super) enum Occlusion {
    /// As defined: traced at the lattice points, and interpolated.
    Interpolated(Lights),
    /// As it is: traced from the point itself.
    Traced,
}

/// Lights with the transmittances towards them that are known so far.
#[derive(Debug, Clone)]
pub(super) struct Lights {
    /// Unit vectors towards the lights, LPS.
    pub(super) directions: Vec<DVec3>,
    /// By light and linear voxel index. Whoever computes one gets the same number, so that sharing changes nothing.
    known: Arc<Mutex<HashMap<(usize, usize), f64>>>,
}

impl Lights {
    /// Lights of which nothing is known yet.
    pub(super) fn new(directions: Vec<DVec3>) -> Self {
        Lights { directions, known: Arc::default() }
    }

    /// T from a lattice point towards a light.
    pub(super) fn transmittance(&self, oracle: &Oracle<'_>, light: usize, voxel: [usize; 3]) -> f64 {
        let key = (light, oracle.volume.grid().flatten(voxel));
        // The lock is not held while a ray is traced.
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner).get(&key).copied();
        known.unwrap_or_else(|| {
            let found = oracle.transmittance_from(voxel, self.directions[light]);
            self.known.lock().unwrap_or_else(PoisonError::into_inner).insert(key, found);
            found
        })
    }
}
