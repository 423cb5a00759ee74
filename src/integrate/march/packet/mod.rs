//! Marching with many rays side by side: the kernel of most pictures, front to back.
//!
//! A tile is marched in three steps. Its rays are cut into pieces of equal steps ([`pieces`]). All pieces look around, as many at once
//! as a register has lanes, and note their runs of samples through blocks in which something may show ([`runs`]). Then the lanes of two
//! registers walk, each along a piece of its own and at a sample of its own ([`walk`], [`place`]); who comes to the end of a run goes on
//! to the next, and who has none left makes room for the next piece. So nearly all lanes take samples that may count, nearly all the
//! time. What a sample adds is summed per lane ([`light`]) or, shaded, by the register of samples in which something shows ([`visible`]).
//!
//! The pieces of a ray are marched in any order and composited in theirs. What a piece adds depends on nothing but the piece, and where
//! a sample is on nothing but its number, so a picture has the same bits on every processor, for any number of threads, and with
//! leaps or without.

mod light;
mod pieces;
mod place;
mod runs;
mod visible;
mod walk;

use super::sampling::Sampling;
use crate::classify::LaneClassifier;
use crate::field::{Chords, GradientUnits, Magnitude, Trilinear, Voxel};
use crate::image::Image;
use crate::integrate::Frame;
use crate::integrate::empty_space::EmptySpace;
use crate::integrate::shade::LaneShader;
use crate::integrate::tiles::{self, Pixels, Radiance, Tally};
use crate::plan::March;
use crate::scene::Rays;
use crate::simd::{self, BATCH, Ints, Lanes, Level, Mask, Pairs};
use crate::volume::Grid;
use light::{Light, interval};
use pieces::Pieces;
use visible::{Halves, Sample, Scenery, Visible};
use walk::Walk;

/// Marches rays side by side.
pub(in super::super) struct Packets<'a, V, C, S> {
    pub(in super::super) field: Trilinear<'a, V>,
    /// The gradient magnitude, HU/mm; there if the transfer function reads it.
    pub(in super::super) magnitude: Option<Magnitude<'a>>,
    pub(in super::super) units: GradientUnits,
    pub(in super::super) classifier: &'a C,
    pub(in super::super) shader: &'a S,
    /// `None` to take every sample.
    pub(in super::super) empty_space: Option<&'a EmptySpace>,
    /// The registers that it runs with.
    pub(in super::super) level: Level,
}

/// Whether these settings ask for what packets do: front to back, one sample for an interval, and not too many of them.
pub(in super::super) fn suits(settings: &March, grid: &Grid) -> bool {
    settings.is_plain() && grid.longest_chord_mm() < pieces::MOST_SAMPLES * settings.step_mm
}

/// What is kept between tiles.
struct Scratch {
    /// The tile's pixels, neighbours together: their numbers, and where they are.
    order: Vec<(usize, [usize; 2])>,
    rays: Rays,
    chords: Chords,
    pieces: Pieces,
    /// Of each piece.
    lights: Vec<Radiance>,
    /// Rays that meet the volume, by their numbers in the tile, and each one's first piece.
    met: Vec<(usize, usize)>,
    halves: Halves,
    visible: Visible,
}

impl Scratch {
    fn new(lights: usize) -> Box<Self> {
        Box::new(Scratch {
            order: Vec::new(),
            rays: Rays::default(),
            chords: Chords::default(),
            pieces: Pieces::new(),
            lights: Vec::new(),
            met: Vec::new(),
            halves: Halves::new(lights),
            visible: Visible::new(),
        })
    }
}

impl<V: Voxel + Pairs, C: LaneClassifier, S: LaneShader> Packets<'_, V, C, S> {
    /// Renders every pixel of a frame.
    pub(in super::super) fn render(&self, frame: &Frame<'_>, settings: &March) -> (Image, Tally) {
        let sampling = Sampling::new(frame, settings);
        let stop_below = settings.termination_transmittance.max(f64::from(f32::MIN_POSITIVE));
        let nothing_kept = || Scratch::new(self.shader.lights());
        tiles::render_together(frame, nothing_kept, |scratch, pixels, ended| {
            let tile = Tile { kernel: self, sampling: &sampling, frame, pixels, stop_below: stop_below as f32 };
            self.level.run(Flight { tile, scratch: &mut *scratch });
            let Scratch { lights, met, .. } = &**scratch;
            for (k, &(n, first)) in met.iter().enumerate() {
                let behind = met.get(k + 1).map_or(lights.len(), |&(_, first)| first);
                ended(n, composited(&lights[first..behind], stop_below));
            }
        })
    }
}

/// The pieces of a ray, front to back.
fn composited(pieces: &[Radiance], stop_below: f64) -> Radiance {
    let mut all = Radiance { transmittance: 1.0, ..Radiance::default() };
    for piece in pieces {
        if all.transmittance < stop_below {
            break;
        }
        for c in 0..3 {
            all.color[c] += all.transmittance * piece.color[c];
        }
        all.transmittance *= piece.transmittance;
        all.samples += piece.samples;
    }
    all
}

/// Some pixels, and what is seen through them.
struct Tile<'t, 'a, V, C, S> {
    kernel: &'t Packets<'a, V, C, S>,
    sampling: &'t Sampling<'a>,
    frame: &'t Frame<'t>,
    pixels: Pixels,
    stop_below: f32,
}

impl<V: Voxel + Pairs, C: LaneClassifier, S: LaneShader> Tile<'_, '_, V, C, S> {
    /// Cuts all rays into pieces.
    #[inline(always)]
    fn cut(&self, scratch: &mut Scratch) {
        let Scratch { order, rays, chords, pieces, lights, met, halves, .. } = scratch;
        self.pixels.neighbours_first(order);
        rays.through(&self.frame.scene.camera, order.iter().map(|&(_, pixel)| pixel));
        let (grid, dims) = (self.frame.volume.grid(), self.kernel.field.dims());
        chords.of(grid, &self.frame.scene.effects.clip, rays);
        pieces.clear();
        met.clear();
        halves.clear();
        for (k, &(n, pixel)) in order.iter().enumerate() {
            let ray = rays.get(k);
            let Some((chord, stretches)) = self.sampling.along_chord(ray, pixel, || chords.get(k)) else { continue };
            met.push((n, pieces.count));
            for stretch in stretches.iter().filter(|stretch| stretch.samples > 0) {
                // Lanes are for pieces of some length; most single samples at the border show nothing.
                let is_empty = |space: &EmptySpace| !space.is_active(pieces::corner(&chord, stretch, dims));
                if stretch.samples == 1 && self.kernel.empty_space.is_some_and(is_empty) {
                    continue;
                }
                pieces.add(&chord, stretch, dims);
                for (light, half) in self.kernel.shader.half_vectors(ray.direction).enumerate() {
                    halves.add(light, half);
                }
            }
        }
        pieces.finish(dims);
        lights.clear();
        lights.resize(pieces.count, Radiance { transmittance: 1.0, ..Radiance::default() });
    }
}

/// A tile on its way.
struct Flight<'t, 'a, V, C, S> {
    tile: Tile<'t, 'a, V, C, S>,
    scratch: &'t mut Scratch,
}

impl<V: Voxel + Pairs, C: LaneClassifier, S: LaneShader> simd::Kernel for Flight<'_, '_, V, C, S> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        // Shading, between samples, gives one group's reads time to arrive if there is another.
        if S::SHADES { self.fly::<L, MOST_GROUPS>() } else { self.fly::<L, 1>() }
    }
}

impl<V: Voxel + Pairs, C: LaneClassifier, S: LaneShader> Flight<'_, '_, V, C, S> {
    /// Marches the tile, `GROUPS` registers full of rays in turns.
    #[inline(always)]
    fn fly<L: Lanes, const GROUPS: usize>(self) {
        let Flight { tile, scratch } = self;
        tile.cut(scratch);
        let Scratch { pieces, lights, halves, visible, .. } = scratch;
        let kernel = tile.kernel;
        runs::find::<L>(pieces, kernel.empty_space);
        let mut groups = [(); GROUPS].map(
            #[inline(always)]
            |()| Group::<L> { walk: Walk::new(), light: Light::new() },
        );
        let Packets { field, units, shader, .. } = kernel;
        let scenery = Scenery { field, units, shader: *shader, halves };
        if S::SHADES {
            visible.begin(lights.len());
        }
        let mut next = 0;
        loop {
            let mut any = false;
            for group in &mut groups {
                any |= group.attend::<S>(pieces, &mut next, lights);
            }
            if any {
                kernel.sample(&mut groups, visible, L::splat(tile.stop_below));
            }
            if S::SHADES {
                visible.shade::<L, V, S>(&scenery, !any);
            }
            if !any {
                break;
            }
        }
        if S::SHADES {
            visible.put_down(lights);
        }
    }
}

/// Most registers full of rays that are marched in turns: one does not wait for what the other has in hand.
const MOST_GROUPS: usize = 2;

/// As many pieces of rays as a register has lanes, and their light.
struct Group<L: Lanes> {
    walk: Walk<L>,
    light: Light<L>,
}

impl<L: Lanes> Group<L> {
    /// Sees to it that enough lanes have a sample to take; false if none has.
    #[inline(always)]
    fn attend<S: LaneShader>(&mut self, pieces: &Pieces, next: &mut usize, lights: &mut [Radiance]) -> bool {
        let Group { walk, light } = self;
        let active = walk.active();
        // Few idle lanes cost less than looking after them.
        if count::<L>(active) >= L::LANES - L::LANES / 8 {
            return true;
        }
        let idle = <L::Mask as Mask>::ALL.and_not(active);
        let waiting = if *next < pieces.count { idle } else { idle.and(walk.seated()) };
        if !waiting.any() {
            return active.any();
        }
        let ended = walk.go_on(pieces, waiting);
        if ended.any() {
            put_down::<L, S>(walk, light, ended, lights);
            let beginning = walk.seat(pieces, next, ended);
            light.begin(beginning);
        }
        walk.active().any()
    }
}

#[inline(always)]
fn count<L: Lanes>(mask: L::Mask) -> usize {
    mask.bits().count_ones() as usize
}

/// Puts down the light of pieces that have ended; what is shaded comes to its piece as it is shaded.
#[inline(always)]
fn put_down<L: Lanes, S: LaneShader>(walk: &Walk<L>, light: &Light<L>, ended: L::Mask, lights: &mut [Radiance]) {
    let (mut piece, mut taken, mut all) = ([0; BATCH], [0; BATCH], [[0.0; BATCH]; 4]);
    walk.number().store(&mut piece);
    walk.taken().store(&mut taken);
    light.store(&mut all);
    runs::for_each(
        ended,
        #[inline(always)]
        |k| {
            if let Some(light) = lights.get_mut(piece[k] as usize) {
                light.transmittance = all[3][k];
                light.samples = taken[k] as u64;
                if !S::SHADES {
                    light.color = [all[0][k], all[1][k], all[2][k]];
                }
            }
        },
    );
}

impl<V: Voxel + Pairs, C: LaneClassifier, S: LaneShader> Packets<'_, V, C, S> {
    /// Takes a sample in all lanes that have one.
    #[inline(always)]
    fn sample<L: Lanes, const GROUPS: usize>(
        &self,
        groups: &mut [Group<L>; GROUPS],
        visible: &mut Visible,
        stop_below: L,
    ) {
        let mut places = [([L::Ints::splat(0); 3], [L::ZERO; 3]); GROUPS];
        let mut values = [L::ZERO; GROUPS];
        for (g, group) in groups.iter().enumerate() {
            places[g] = group.walk.place();
            let (corner, fraction) = places[g];
            values[g] = self.field.values(&self.field.cells_at::<L>(corner, fraction));
        }
        for (g, group) in groups.iter_mut().enumerate() {
            let Group { walk, light } = group;
            let active = walk.active();
            walk.advance(active);
            let (corner, fraction) = places[g];
            let optics = self.classifier.classify_lanes(
                values[g],
                #[inline(always)]
                || match &self.magnitude {
                    Some(magnitude) => magnitude.values(&self.field.cells_at::<L>(corner, fraction)),
                    None => L::ZERO,
                },
            );
            let Some(mut optics) = optics else { continue };
            for component in &mut optics {
                // Rounding may leave a trace below 0 at the foot of a ramp.
                *component = component.max(L::ZERO);
            }
            let [red, green, blue, extinction] = optics;
            let lit = active.and(L::ZERO.lt(extinction + (red + (green + blue))));
            if !lit.any() {
                continue;
            }
            let (opacity, weight) = interval(extinction, walk.delta_mm());
            let weight = weight * light.transmittance();
            let share = [red * weight, green * weight, blue * weight];
            if S::SHADES {
                let [red, green, blue] = share;
                let share = [red, green, blue, extinction * weight];
                visible.add(lit, &Sample { share, corner, fraction, piece: walk.number() });
            } else {
                light.add(lit, share);
            }
            light.absorb(lit, opacity);
            let spent = lit.and(light.transmittance().lt(stop_below));
            if spent.any() {
                walk.stop(spent);
            }
        }
    }
}
