//! The fast kernel: many cells of many rays side by side, in vector registers.
//!
//! What a cell does to light does not depend on the light that reaches it. So rays are worked off in rounds of a few hundred
//! cells, in four steps: rays `walk` through the blocks in which something can show and write down the cells they
//! pass; `look` reads the corners of as many cells as a register has lanes, drops those in which nothing shows and makes the
//! cubics of the others; `pieces` cuts those at the knots and integrates; and `front` composites the results ray by ray,
//! front to back, within each ray's budget. A cell whose proven error is more than the budget allows, or whose cuts rounding
//! might have misplaced, is integrated again in f64 by the twin of this kernel.
//!
//! A lane does the same whatever its neighbours do, and the same at each level, so a picture has the same bits on every
//! processor, for any number of threads and any order of tiles.

mod axis;
mod front;
mod function;
mod look;
mod pieces;
mod queue;
mod voxels;
mod walk;

use std::cell::RefCell;

use super::Tracer;
use super::medium::Medium;
use super::ray::{Frame, Front, Traced};
use super::shade::Unlit;
use super::splits::Splits;
use crate::field::{Chord, Voxel};
use crate::integrate::occupancy::Occupancy;
use crate::scene::{Clip, Ray};
use crate::simd::{Kernel, Lanes, Level, Pairs};
use crate::volume::Grid;
use front::{InFlight, composite};
use look::look;
use queue::{CELLS, Passed, Results, Shown};
use walk::Walk;

pub(super) use function::{Function, OfValue, OfValueAndMagnitude};
pub(super) use look::{Fields, Read};
pub(super) use voxels::Voxels;

/// Rays in flight at a time.
const RAYS: usize = 16;

/// Cells that a ray writes down in a round.
const CELLS_PER_RAY: usize = CELLS / RAYS;

/// The fast kernel for one transfer function of `F` fields.
pub(super) struct Stream<'a, V, T, D, const F: usize> {
    pub(super) level: Level,
    pub(super) frame: Frame<'a>,
    pub(super) grid: &'a Grid,
    pub(super) clip: &'a Clip,
    pub(super) voxels: Voxels<'a, V>,
    pub(super) occupancy: Occupancy,
    pub(super) function: T,
    /// The twin in f64.
    pub(super) double: D,
    pub(super) name: String,
}

impl<V, T, D, const F: usize> Tracer for Stream<'_, V, T, D, F>
where
    V: Voxel + Pairs,
    T: Function<F>,
    D: Medium<f64>,
    Read: Fields<F>,
{
    fn trace(&self, ray: &Ray) -> Option<Traced> {
        let mut traced = [None];
        self.trace_all(std::slice::from_ref(ray), &mut traced);
        traced[0]
    }

    fn trace_all(&self, rays: &[Ray], traced: &mut [Option<Traced>]) {
        thread_local! {
            static SPLITS: RefCell<Splits<f64>> = RefCell::default();
        }
        SPLITS.with_borrow_mut(|splits| self.level.run(Rounds { stream: self, rays, traced, splits }));
    }

    fn kernel(&self) -> &str {
        &self.name
    }
}

/// Rays to trace, and where their light goes.
struct Rounds<'r, 'a, V, T, D, const F: usize> {
    stream: &'r Stream<'a, V, T, D, F>,
    rays: &'r [Ray],
    traced: &'r mut [Option<Traced>],
    splits: &'r mut Splits<f64>,
}

impl<V, T, D, const F: usize> Kernel for Rounds<'_, '_, V, T, D, F>
where
    V: Voxel + Pairs,
    T: Function<F>,
    D: Medium<f64>,
    Read: Fields<F>,
{
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Rounds { stream, rays, traced, splits } = self;
        let [nx, ny, _] = stream.voxels.dims();
        let strides = [nx as i32, (nx * ny) as i32];
        let mut passed = Passed::new();
        let (mut whole, mut cut) = (Shown::<F>::new(), Shown::<F>::new());
        let mut results = Results::new();
        let mut flying: [Option<InFlight>; RAYS] = [const { None }; RAYS];
        let mut waiting = rays.iter().enumerate();
        let harm_per_mm = stream.frame.harm_per_mm() as f32;
        loop {
            for seat in &mut flying {
                if let Some(ended) = seat.take_if(|ray| ray.traced.is_some()) {
                    traced[ended.number] = ended.traced;
                }
                while seat.is_none() {
                    let Some((number, ray)) = waiting.next() else { break };
                    *seat = stream.entering(ray, number);
                }
            }
            if flying.iter().all(Option::is_none) {
                return;
            }
            passed.count = 0;
            for (seat, ray) in flying.iter_mut().enumerate() {
                if let Some(ray) = ray {
                    ray.walk.pass(&stream.occupancy, seat as u8, CELLS_PER_RAY, strides, &mut passed);
                }
            }
            results.clear(passed.count);
            look::<L, V, F>(&passed, &stream.voxels, &stream.function, &mut whole, &mut cut);
            pieces::whole::<L, F>(&whole, &stream.function, &mut results);
            pieces::cut::<L, F>(&cut, &stream.function, harm_per_mm, &mut results);
            composite(
                &passed,
                &results,
                &mut flying,
                #[inline(always)]
                |transmittance, rest_mm| stream.frame.of_rest(transmittance, rest_mm),
                |walk, light, slot| stream.again(walk, light, &passed, slot, splits),
            );
        }
    }
}

impl<V, T, D, const F: usize> Stream<'_, V, T, D, F>
where
    D: Medium<f64>,
{
    /// A ray where it enters the volume; `None` if it misses it.
    fn entering(&self, ray: &Ray, number: usize) -> Option<InFlight>
    where
        V: Voxel + Pairs,
    {
        let mut chord = Chord::new(self.grid, self.clip, *ray)?;
        let (low, high) = self.grid.index_bounds();
        chord.entry_index = chord.entry_index.clamp(low, high);
        let walk = Walk::new(&chord, self.voxels.dims());
        Some(InFlight { walk, light: Front::new(self.frame.tolerance), number, traced: None })
    }

    /// Integrates a cell with its twin.
    #[inline(never)]
    fn again(&self, walk: &Walk, light: &mut Front, passed: &Passed, slot: usize, splits: &mut Splits<f64>) {
        let cell = [0, 1, 2].map(|a: usize| passed.cell[a][slot]);
        let segment = walk.segment(cell, passed.span_mm[slot]);
        let fraction = |at_mm: f64| walk.fraction(at_mm);
        self.frame.pass(&segment, fraction, &self.double, &Unlit, splits, light);
    }
}
