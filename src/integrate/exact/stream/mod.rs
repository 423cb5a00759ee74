//! The fast kernel: many cells of many rays side by side, in vector registers.
//!
//! What a cell does to light does not depend on the light that reaches it. So rays, which take a seat once they have come to where
//! something may show (`arrivals`), are worked off in rounds of a few hundred cells, in four steps. They `walk`, a lane each, leaping
//! over blocks in which nothing shows; `look` reads the corners of the cells that they pass, drops those in which nothing shows
//! and makes the cubics of the others, without gaps between them; `pieces`, or `shaded` where there is light, cuts those at the
//! knots, and where one piece would miss too much, and integrates; and `front` composites the results front to back, again a
//! ray per lane, within each ray's budget. A cell whose proven error is still more than the budget allows, or whose cuts rounding
//! might have misplaced, is integrated again in f64 by the twin of this kernel.
//!
//! A lane does the same whatever its neighbours do, and the same at each level, so a picture has the same bits on every
//! processor, for any number of threads and any order of tiles.

mod arrivals;
mod axis;
mod crossing;
mod front;
mod function;
mod known;
mod levels;
mod light;
mod lit;
mod look;
mod nodes;
mod parts;
mod pieces;
mod queue;
mod seats;
mod shaded;
mod shares;
mod voxels;
mod walk;

use std::any::Any;
use std::cell::RefCell;

use glam::DVec3;

use super::Tracer;
use super::budget::Budget;
use super::medium::Medium;
use super::ray::{Frame, Front, Traced};
use super::shade::{Lit, Unlit};
use super::splits::Splits;
use crate::field::{Chords, Voxel};
use crate::integrate::occupancy::Occupancy;
use crate::plan::Bound;
use crate::scene::{Clip, Ray, Rays};
use crate::simd::{Kernel, Lanes, Level, Pairs};
use crate::volume::Grid;
use arrivals::Arrivals;
use crossing::Beginnings;
use front::Fronts;
use known::{Halved, Whole};
use light::Seen;
use lit::{Allowance, Scenery, lit};
use look::look;
use queue::{Passed, ROOM, Results, Shown};
use seats::Walks;
use walk::{AHEAD, RAYS};

pub(super) use function::{Function, OfValue, OfValueAndMagnitude};
pub(super) use light::Lighting;
pub(super) use look::{Fields, Read};
pub(super) use shaded::{DEVIATIONS, Estimate};
pub(super) use voxels::Voxels;

/// The fast kernel for one transfer function of `F` fields.
pub(super) struct Stream<'a, V, T, D, const F: usize> {
    pub(super) level: Level,
    pub(super) frame: Frame<'a>,
    pub(super) grid: &'a Grid,
    pub(super) clip: &'a Clip,
    pub(super) voxels: Voxels<'a, V>,
    pub(super) occupancy: Occupancy,
    pub(super) function: T,
    pub(super) lighting: Option<Lighting>,
    /// Shares of the tolerance, if what shading misses is estimated.
    pub(super) estimate: Option<Estimate>,
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
        let mut found = None;
        self.trace_all(&[*ray].into_iter().collect(), &mut |_, traced| found = Some(traced));
        found
    }

    fn trace_all(&self, rays: &Rays, ended: &mut dyn FnMut(usize, Traced)) {
        thread_local! {
            static KEPT: RefCell<Option<Box<dyn Any>>> = RefCell::default();
        }
        KEPT.with_borrow_mut(|kept| {
            // Rays may have been traced by functions of another number of fields before.
            if !kept.as_ref().is_some_and(|kept| kept.is::<Scratch<F>>()) {
                *kept = Some(Box::new(Scratch::<F>::new()));
            }
            if let Some(scratch) = kept.as_mut().and_then(|kept| kept.downcast_mut()) {
                self.level.run(Rounds { stream: self, rays, ended, scratch });
            }
        });
    }

    fn bound(&self) -> Bound {
        self.estimate.map_or(Bound::Proven, |_| Bound::Estimated)
    }

    fn kernel(&self) -> &str {
        &self.name
    }
}

/// What a thread keeps between tiles.
struct Scratch<const F: usize> {
    chords: Chords,
    passed: Passed,
    /// Cells whose fields stay in one interval, those that cross one knot, and others that may cross some.
    whole: Shown<F>,
    halved: Shown<F>,
    cut: Shown<F>,
    beginnings: Beginnings<F>,
    gradients: shaded::Gradients,
    unfinished: shaded::Waiting<F>,
    results: Results,
    splits: Splits<f64>,
}

impl<const F: usize> Scratch<F> {
    fn new() -> Self {
        Scratch {
            chords: Chords::default(),
            passed: Passed::new(),
            whole: Shown::new(),
            halved: Shown::new(),
            cut: Shown::new(),
            beginnings: Beginnings::new(),
            gradients: [[[0.0; ROOM]; 4]; 3],
            unfinished: shaded::Waiting::new(),
            results: Results::new(),
            splits: Splits::default(),
        }
    }
}

/// Rays to trace, and where their light goes.
struct Rounds<'r, 'a, V, T, D, const F: usize> {
    stream: &'r Stream<'a, V, T, D, F>,
    rays: &'r Rays,
    ended: &'r mut dyn FnMut(usize, Traced),
    scratch: &'r mut Scratch<F>,
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
        let Rounds { stream, rays, ended, scratch } = self;
        let Scratch { chords, passed, whole, halved, cut, beginnings, gradients, unfinished, results, splits } =
            scratch;
        chords.of(stream.grid, stream.clip, rays);
        let mut arrivals = Arrivals::new(stream.grid, chords, rays);
        let mut walks = Walks::<RAYS>::new(stream.voxels.dims());
        let mut fronts = Fronts::new(&stream.frame);
        // Who sits where, and looks where.
        let mut seated: [Option<(usize, DVec3)>; RAYS] = [None; RAYS];
        let harm_per_mm = stream.frame.harm_per_mm() as f32;
        let mut seen = Seen::new();
        let mut corners = [[L::ZERO; 8]; AHEAD];
        let shares = Budget::of_pieces(stream.frame.tolerance);
        let allowed = pieces::Allowed::new(shares, stream.grid.longest_chord_mm());
        let mut allowance = Allowance::new(shares);
        loop {
            // A bit for each seat.
            let mut free = fronts.ended::<L>(&walks);
            while free != 0 {
                let seat = free.trailing_zeros() as usize % RAYS;
                free &= free - 1;
                let ray = &mut seated[seat];
                if let Some((number, _)) = *ray {
                    ended(number, fronts.take(seat));
                    walks.leave(seat);
                    *ray = None;
                }
                while ray.is_none() {
                    let Some((number, place)) = arrivals.next::<L>(&stream.occupancy) else { break };
                    if arrivals.walks.is_over(place) {
                        ended(number, Front::new(stream.frame.tolerance).ended(0.0));
                        continue;
                    }
                    walks.take(seat, &arrivals.walks, place);
                    fronts.enter(seat);
                    let next = rays.get(number);
                    if let Some(lighting) = &stream.lighting {
                        seen.enter(seat, &next, &lighting.shading);
                    }
                    *ray = Some((number, next.direction));
                }
            }
            if seated.iter().all(Option::is_none) {
                return;
            }
            results.clear();
            whole.clear();
            halved.clear();
            cut.clear();
            walks.pass::<L>(
                &stream.occupancy,
                #[inline(always)]
                |lines, steps, first| {
                    look::<L, V, F>(
                        lines,
                        steps,
                        first,
                        &stream.voxels,
                        &mut corners,
                        &stream.function,
                        stream.lighting.is_some(),
                        passed,
                        whole,
                        halved,
                        cut,
                        results,
                    )
                },
            );
            if let Some(lighting) = &stream.lighting {
                for (seat, _) in seated.iter().enumerate().filter(|(_, ray)| ray.is_some()) {
                    let light = fronts.get(seat);
                    let left = light.left(walks.done(seat));
                    allowance.share(seat, light.transmittance, walks.per_length_mm(seat), left, stream.estimate);
                }
                let (voxels, seen, allowance) = (&stream.voxels, &seen, &allowance);
                let scenery = Scenery { voxels, lighting, seen, allowance, harm_per_mm };
                if stream.estimate.is_none() {
                    for shown in [&whole, &halved, &cut] {
                        lit::<L, V, F>(shown, &stream.function, &scenery, results);
                    }
                } else {
                    let scenery = shaded::Scenery::<V> { voxels, lighting, seen, allowance, harm_per_mm };
                    let function = &stream.function;
                    shaded::known::<L, V, Whole, F, 1>(whole, function, &scenery, cut, unfinished, results);
                    shaded::known::<L, V, Halved, F, 2>(halved, function, &scenery, cut, unfinished, results);
                    shaded::cut::<L, V, F>(cut, function, &scenery, beginnings, gradients, unfinished, results);
                    shaded::halved::<L, V, F>(function, &scenery, unfinished, results);
                }
            } else {
                let function = &stream.function;
                pieces::known::<L, Whole, F, 1>(whole, function, &allowed, cut, results);
                pieces::known::<L, Halved, F, 2>(halved, function, &allowed, cut, results);
                pieces::cut::<L, F>(cut, function, harm_per_mm, &allowed, beginnings, results);
            }
            fronts.composite::<L>(passed, results, stream.estimate.is_some(), &walks, |seat, slot, light| {
                let Some((_, direction)) = seated[seat] else { unreachable!("cells belong to rays") };
                let cell = stream.voxels.cell(passed.base[slot]);
                stream.again(&walks, seat, cell, direction, light, splits);
            });
        }
    }
}

impl<V, T, D, const F: usize> Stream<'_, V, T, D, F>
where
    D: Medium<f64>,
{
    /// Integrates a cell with its twin.
    #[inline(never)]
    fn again(
        &self,
        walks: &Walks,
        seat: usize,
        cell: [i32; 3],
        direction: DVec3,
        light: &mut Front,
        splits: &mut Splits<f64>,
    ) {
        let segment = walks.segment(seat, cell);
        let fraction = |at_mm: f64| walks.fraction(seat, at_mm);
        match &self.lighting {
            None => self.frame.pass(&segment, fraction, &self.double, &Unlit, splits, light),
            Some(lighting) => {
                let lit = Lit::<f64>::new(&lighting.shading, direction, self.frame.brightest.color);
                self.frame.pass(&segment, fraction, &self.double, &lit, splits, light);
            }
        }
    }
}
