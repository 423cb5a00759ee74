//! Samples in which something shows, on their way to be shaded: registers full of them, whichever rays they are of.
//!
//! How much of a sample's light reaches the eye is known before it is shaded, since shading leaves extinction alone. So gradients are read
//! where something shows and nowhere else, and what a sample adds comes to its ray in the order in which the ray took its samples.

use super::GROUPS;
use crate::field::{GradientUnits, Trilinear, Voxel};
use crate::integrate::shade::LaneShader;
use crate::integrate::tiles::Radiance;
use crate::simd::{BATCH, Ints, Lanes, Mask, Pairs};

/// Room for what waits, fewer than a register's lanes, for what a turn adds, and a register behind.
const ROOM: usize = (GROUPS + 2) * BATCH;

/// Samples that wait.
pub(super) struct Visible {
    count: usize,
    /// What reaches the eye of emission in red, green and blue, and of extinction, if it were reflected whole.
    share: [[f32; ROOM]; 4],
    corner: [[i32; ROOM]; 3],
    fraction: [[f32; ROOM]; 3],
    /// The piece of a ray, by its number.
    piece: [i32; ROOM],
}

/// The half vectors of lights, by the number of a piece.
pub(super) struct Halves {
    of_light: Vec<Vec<[f32; 4]>>,
}

impl Halves {
    pub(super) fn new(lights: usize) -> Self {
        Halves { of_light: (0..lights).map(|_| Default::default()).collect() }
    }

    pub(super) fn clear(&mut self) {
        self.of_light.iter_mut().for_each(Vec::clear);
    }

    /// Adds that of the next piece.
    #[inline(always)]
    pub(super) fn add(&mut self, light: usize, [x, y, z]: [f32; 3]) {
        self.of_light[light].push([x, y, z, 0.0]);
    }

    /// Those of these pieces.
    #[inline(always)]
    fn of<L: Lanes>(&self, light: usize, piece: L::Ints) -> [L; 3] {
        L::vectors(&self.of_light[light], piece)
    }
}

/// What shading reads.
pub(super) struct Scenery<'t, 'a, V, S> {
    pub(super) field: &'t Trilinear<'a, V>,
    pub(super) units: &'t GradientUnits,
    pub(super) shader: &'t S,
    pub(super) halves: &'t Halves,
}

impl Visible {
    pub(super) fn new() -> Self {
        Visible {
            count: 0,
            share: [[0.0; ROOM]; 4],
            corner: [[0; ROOM]; 3],
            fraction: [[0.0; ROOM]; 3],
            piece: [0; ROOM],
        }
    }

    /// Adds a sample of each of these lanes.
    #[inline(always)]
    pub(super) fn add<L: Lanes>(
        &mut self,
        lanes: L::Mask,
        share: [L; 4],
        (corner, fraction): ([L::Ints; 3], [L; 3]),
        piece: L::Ints,
    ) {
        let at = self.count;
        for c in 0..4 {
            share[c].compress(lanes).store(&mut self.share[c][at..]);
        }
        for a in 0..3 {
            corner[a].compress(lanes).store(&mut self.corner[a][at..]);
            fraction[a].compress(lanes).store(&mut self.fraction[a][at..]);
        }
        piece.compress(lanes).store(&mut self.piece[at..]);
        self.count += lanes.bits().count_ones() as usize;
    }

    /// Shades registers full of samples; of those that are left, all if asked to.
    #[inline(always)]
    pub(super) fn shade<L: Lanes, V: Voxel + Pairs, S: LaneShader>(
        &mut self,
        scenery: &Scenery<'_, '_, V, S>,
        lights: &mut [Radiance],
        all: bool,
    ) {
        let least = if all { 1 } else { L::LANES };
        let mut from = 0;
        while self.count - from >= least {
            let count = (self.count - from).min(L::LANES);
            self.shade_some::<L, V, S>(scenery, lights, from, count);
            from += count;
        }
        if from == 0 {
            return;
        }
        // What is left is less than a register.
        self.count -= from;
        for c in 0..4 {
            L::load(&self.share[c][from..]).store(&mut self.share[c]);
        }
        for a in 0..3 {
            L::Ints::load(&self.corner[a][from..]).store(&mut self.corner[a]);
            L::load(&self.fraction[a][from..]).store(&mut self.fraction[a]);
        }
        L::Ints::load(&self.piece[from..]).store(&mut self.piece);
    }

    #[inline(always)]
    fn shade_some<L: Lanes, V: Voxel + Pairs, S: LaneShader>(
        &self,
        scenery: &Scenery<'_, '_, V, S>,
        lights: &mut [Radiance],
        from: usize,
        count: usize,
    ) {
        let (mut corner, mut fraction) = ([L::Ints::splat(0); 3], [L::ZERO; 3]);
        for a in 0..3 {
            corner[a] = L::Ints::load(&self.corner[a][from..]);
            fraction[a] = L::load(&self.fraction[a][from..]);
        }
        let field = scenery.field;
        let cells = field.cells_at::<L>(corner, fraction);
        let gradients = if <L::Mask as Mask>::ALL.and_not(field.are_inside(&cells)).any() {
            field.gradients_at_border(&cells)
        } else {
            field.gradients(&cells, &field.lines(&cells))
        };
        let piece = L::Ints::load(&self.piece[from..]);
        let (reflected, highlight) = scenery.shader.reflect(
            scenery.units.per_mm(gradients),
            #[inline(always)]
            |light| scenery.halves.of::<L>(light, piece),
        );
        let extinction = L::load(&self.share[3][from..]);
        let mut added = [[0.0; BATCH]; 3];
        for c in 0..3 {
            let emission = L::load(&self.share[c][from..]);
            emission.mul_plus(reflected[c], extinction * highlight[c]).store(&mut added[c]);
        }
        for k in 0..count {
            let color = &mut lights[self.piece[from + k] as usize].color;
            for c in 0..3 {
                color[c] += f64::from(added[c][k]);
            }
        }
    }
}
