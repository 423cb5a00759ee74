//! Samples in which something shows, on their way to be shaded: registers full of them, whichever rays they are of.
//!
//! How much of a sample's light reaches the eye is known before it is shaded, since shading leaves extinction alone. So gradients are read
//! where something shows and nowhere else, and what a sample adds comes to its ray in the order in which the ray took its samples.

use super::MOST_GROUPS;
use crate::field::{GradientUnits, Trilinear, Voxel};
use crate::integrate::shade::LaneShader;
use crate::integrate::tiles::Radiance;
use crate::simd::{BATCH, Ints, Joining, Lanes, Mask, Pairs};

/// Registers full of samples, or nearly: a turn fills no more than one of each group, and one more waits.
const REGISTERS: usize = (MOST_GROUPS + 1).next_power_of_two();

/// Samples that wait.
pub(super) struct Visible {
    /// In turns; number `at` is being filled, and before it are those that are full.
    registers: Box<[Samples; REGISTERS]>,
    at: usize,
    full: usize,
    /// How many samples number `at` has.
    waiting: usize,
    /// What samples have added so far, by the number of the piece: linear RGB, and nothing.
    colors: Vec<[f64; 4]>,
}

/// Samples in memory, as many as a register has lanes; rows begin where lines of the cache do.
#[derive(Clone, Copy, Default)]
#[repr(align(64))]
struct Samples {
    share: [[f32; BATCH]; 4],
    corner: [[i32; BATCH]; 3],
    fraction: [[f32; BATCH]; 3],
    piece: [i32; BATCH],
}

/// Samples in registers.
pub(super) struct Sample<L: Lanes> {
    /// What reaches the eye of emission in red, green and blue, and of extinction, if it were reflected whole.
    pub(super) share: [L; 4],
    /// The lower corner of the cell, and where in the cell: 0 to 1.
    pub(super) corner: [L::Ints; 3],
    pub(super) fraction: [L; 3],
    /// The piece of a ray, by its number.
    pub(super) piece: L::Ints,
}

impl<L: Lanes> Sample<L> {
    #[inline(always)]
    fn load(from: &Samples) -> Self {
        let mut sample = Sample {
            share: [L::ZERO; 4],
            corner: [L::Ints::splat(0); 3],
            fraction: [L::ZERO; 3],
            piece: L::Ints::load(&from.piece),
        };
        for c in 0..4 {
            sample.share[c] = L::load(&from.share[c]);
        }
        for a in 0..3 {
            sample.corner[a] = L::Ints::load(&from.corner[a]);
            sample.fraction[a] = L::load(&from.fraction[a]);
        }
        sample
    }

    /// Joins those that wait.
    #[inline(always)]
    fn join(&self, joining: &Joining<L>, waiting: &mut Samples) {
        for c in 0..4 {
            joining.join(self.share[c], &mut waiting.share[c]);
        }
        for a in 0..3 {
            joining.join_ints(self.corner[a], &mut waiting.corner[a]);
            joining.join(self.fraction[a], &mut waiting.fraction[a]);
        }
        joining.join_ints(self.piece, &mut waiting.piece);
    }

    /// Puts those for which there was no room to the front.
    #[inline(always)]
    fn put(&self, joining: &Joining<L>, front: &mut Samples) {
        for c in 0..4 {
            joining.put(self.share[c], &mut front.share[c]);
        }
        for a in 0..3 {
            joining.put_ints(self.corner[a], &mut front.corner[a]);
            joining.put(self.fraction[a], &mut front.fraction[a]);
        }
        joining.put_ints(self.piece, &mut front.piece);
    }
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
        Visible { registers: Box::new([Samples::default(); REGISTERS]), at: 0, full: 0, waiting: 0, colors: Vec::new() }
    }

    /// Begins so many pieces.
    pub(super) fn begin(&mut self, pieces: usize) {
        self.colors.clear();
        self.colors.resize(pieces, [0.0; 4]);
    }

    /// What all samples have added to their pieces.
    pub(super) fn put_down(&self, lights: &mut [Radiance]) {
        for (light, &[red, green, blue, _]) in lights.iter_mut().zip(&self.colors) {
            light.color = [red, green, blue];
        }
    }

    /// Adds a sample of each of these lanes.
    #[inline(always)]
    pub(super) fn add<L: Lanes>(&mut self, lanes: L::Mask, sample: &Sample<L>) {
        let joining = Joining::<L>::new(self.waiting, lanes);
        sample.join(&joining, &mut self.registers[self.at % REGISTERS]);
        self.waiting += joining.chosen();
        if self.waiting >= L::LANES {
            self.waiting -= L::LANES;
            self.full += 1;
            self.at += 1;
            sample.put(&joining, &mut self.registers[self.at % REGISTERS]);
        }
    }

    /// Shades registers full of samples; of those that are left, all if asked to.
    #[inline(always)]
    pub(super) fn shade<L: Lanes, V: Voxel + Pairs, S: LaneShader>(
        &mut self,
        scenery: &Scenery<'_, '_, V, S>,
        all: bool,
    ) {
        let first = self.at - self.full;
        let last = self.at + usize::from(all && self.waiting > 0);
        for at in first..last {
            let count = if at < self.at { L::LANES } else { self.waiting };
            self.shade_register::<L, V, S>(scenery, at % REGISTERS, count);
        }
        self.full = 0;
        if all {
            (self.at, self.waiting) = (0, 0);
        }
    }

    /// Shades the first `count` samples of a register.
    #[inline(always)]
    fn shade_register<L: Lanes, V: Voxel + Pairs, S: LaneShader>(
        &mut self,
        scenery: &Scenery<'_, '_, V, S>,
        register: usize,
        count: usize,
    ) {
        let Sample { share, corner, fraction, piece } = Sample::<L>::load(&self.registers[register]);
        let field = scenery.field;
        let cells = field.cells_at::<L>(corner, fraction);
        let gradients = if <L::Mask as Mask>::ALL.and_not(field.are_inside(&cells)).any() {
            field.gradients_at_border(&cells)
        } else {
            field.gradients(&cells)
        };
        let (reflected, highlight) = scenery.shader.reflect(
            scenery.units.per_mm(gradients),
            #[inline(always)]
            |light| scenery.halves.of::<L>(light, piece),
        );
        let mut added = [L::ZERO; 4];
        for c in 0..3 {
            added[c] = share[c].mul_plus(reflected[c], share[3] * highlight[c]);
        }
        let mut colors = [[0.0; 4]; BATCH];
        L::store_vectors(added, &mut colors);
        for (added, &piece) in colors[..count].iter().zip(&self.registers[register].piece) {
            let color = &mut self.colors[piece as usize];
            for c in 0..4 {
                color[c] += f64::from(added[c]);
            }
        }
    }
}
