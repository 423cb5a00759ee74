//! Tiles of pixels over threads.
//!
//! A pixel's arithmetic depends on nothing but the pixel, and each tile writes rows of its own, so the picture is the same
//! to the bit for any number of threads and any order of tiles.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::Frame;
use crate::image::Image;
use crate::scene::{Background, Camera, Rays};
use crate::simd::{self, Lanes};

/// Pixels per side of a tile: neighbouring rays read the same voxels.
const TILE: usize = 16;

/// Pixels per side of a tile where rays wait for seats that become free: at the end of a tile some stay empty.
const LARGE_TILE: usize = 32;

/// Fewer large tiles for each thread may leave threads idle at the end of a picture.
const ENOUGH_TILES: usize = 64;

/// Pixels of a tile.
pub(super) const TILE_PIXELS: usize = TILE * TILE;

/// Light that reaches the eye along a ray, and what it took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Radiance {
    /// Linear RGB.
    pub(super) color: [f64; 3],
    /// What is let through from behind.
    pub(super) transmittance: f64,
    /// Places where the transfer function was evaluated.
    pub(super) samples: u64,
    /// Bound on the error of a channel; 0 where the method proves none.
    pub(super) error_bound: f64,
}

/// Sums over a picture.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Tally {
    pub(super) samples: u64,
    pub(super) rays: u64,
    /// The largest of a ray.
    pub(super) error_bound: f64,
}

impl Tally {
    fn count(&mut self, light: &Radiance) {
        self.rays += 1;
        self.samples += light.samples;
        self.error_bound = self.error_bound.max(light.error_bound);
    }

    fn plus(self, other: Tally) -> Tally {
        Tally {
            samples: self.samples + other.samples,
            rays: self.rays + other.rays,
            error_bound: self.error_bound.max(other.error_bound),
        }
    }
}

/// A tile: its place, and its rows in the picture.
struct Tile<'p> {
    column: usize,
    row: usize,
    rows: Vec<&'p mut [[f32; 4]]>,
}

impl Tile<'_> {
    fn pixels(&self) -> Pixels {
        Pixels { column: self.column, row: self.row, width: self.rows[0].len(), height: self.rows.len() }
    }
}

/// The pixels of a tile, numbered row by row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pixels {
    column: usize,
    row: usize,
    width: usize,
    height: usize,
}

/// Pixels per side of a block of neighbours.
const NEIGHBOURS: usize = 4;

impl Pixels {
    /// All pixels in the order of their numbers: `[column, row]` of the picture.
    #[inline(always)]
    fn row_by_row(self) -> impl Iterator<Item = [usize; 2]> {
        let Pixels { column, row, width, height } = self;
        (row..row + height).flat_map(move |y| (column..column + width).map(move |x| [x, y]))
    }

    /// Puts down all pixels, neighbours together: their numbers, and `[column, row]` of the picture.
    pub(super) fn neighbours_first(self, order: &mut Vec<(usize, [usize; 2])>) {
        let Pixels { column, row, width, height } = self;
        order.clear();
        for top in (0..height).step_by(NEIGHBOURS) {
            for left in (0..width).step_by(NEIGHBOURS) {
                for y in top..(top + NEIGHBOURS).min(height) {
                    for x in left..(left + NEIGHBOURS).min(width) {
                        order.push((x + width * y, [column + x, row + y]));
                    }
                }
            }
        }
    }
}

/// Traces rays; the function takes the number of each that meets the volume, and its light.
pub(super) type TraceAll<'t> = &'t (dyn Fn(&Rays, &mut dyn FnMut(usize, Radiance)) + Sync);

/// Rays of a tile.
struct Aim<'t> {
    camera: &'t Camera,
    pixels: Pixels,
    rays: &'t mut Rays,
}

impl simd::Kernel for Aim<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.rays.through(self.camera, self.pixels.row_by_row());
    }
}

/// Renders all pixels, the rays of a tile at once.
pub(super) fn render_whole(frame: &Frame<'_>, trace: TraceAll<'_>) -> (Image, Tally) {
    let (camera, background) = (&frame.scene.camera, frame.scene.background);
    let [width, height] = camera.size();
    let of_each_thread = width * height / rayon::current_num_threads();
    let side = if of_each_thread < ENOUGH_TILES * LARGE_TILE * LARGE_TILE { TILE } else { LARGE_TILE };
    render_tiles(frame, side, Rays::default, |rays, tile, tally| {
        let pixels = tile.pixels();
        tile.rows.iter_mut().for_each(|pixels| pixels.fill(over(None, background)));
        frame.schedule.level.run(Aim { camera, pixels, rays });
        trace(rays, &mut |n, light| {
            tally.count(&light);
            tile.rows[n / pixels.width][n % pixels.width] = over(Some(light), background);
        });
    })
}

/// Renders all pixels, those of a tile at once: `trace` gives the light of those, by their number in the tile, whose rays meet
/// the volume, in any order; `scratch` makes what a thread keeps between tiles.
pub(super) fn render_together<W: Send>(
    frame: &Frame<'_>,
    scratch: impl Fn() -> W + Sync + Send,
    trace: impl Fn(&mut W, Pixels, &mut dyn FnMut(usize, Radiance)) + Sync,
) -> (Image, Tally) {
    let background = frame.scene.background;
    render_tiles(frame, TILE, scratch, |scratch, tile, tally| {
        let pixels = tile.pixels();
        tile.rows.iter_mut().for_each(|pixels| pixels.fill(over(None, background)));
        trace(scratch, pixels, &mut |n, light| {
            tally.count(&light);
            tile.rows[n / pixels.width][n % pixels.width] = over(Some(light), background);
        });
    })
}

/// Renders all pixels: `pixel` gives the light along the ray through `(column, row)`, `None` where it misses the volume;
/// `scratch` makes what a thread keeps between pixels.
pub(super) fn render<W: Send>(
    frame: &Frame<'_>,
    scratch: impl Fn() -> W + Sync + Send,
    pixel: impl Fn(&mut W, usize, usize) -> Option<Radiance> + Sync,
) -> (Image, Tally) {
    render_tiles(frame, TILE, scratch, |scratch, tile, tally| {
        for (y, row) in tile.rows.iter_mut().enumerate() {
            for (x, out) in row.iter_mut().enumerate() {
                let light = pixel(scratch, tile.column + x, tile.row + y);
                light.iter().for_each(|l| tally.count(l));
                *out = over(light, frame.scene.background);
            }
        }
    })
}

/// Renders all tiles of `side` pixels: `fill` renders one and counts what it took.
fn render_tiles<W: Send>(
    frame: &Frame<'_>,
    side: usize,
    scratch: impl Fn() -> W + Sync + Send,
    fill: impl Fn(&mut W, &mut Tile<'_>, &mut Tally) + Sync,
) -> (Image, Tally) {
    let [width, height] = frame.scene.camera.size();
    let mut image = Image::transparent(width, height);
    let mut tiles = cut(image.pixels_mut(), width, side);
    if let Some(seed) = frame.schedule.shuffled_tiles {
        shuffle(&mut tiles, seed);
    }
    // Tasks of a tile each: what rayon keeps for a task would be made anew for every tile.
    let kept = Mutex::new(Vec::new());
    let waiting = || kept.lock().unwrap_or_else(PoisonError::into_inner);
    let tally = tiles
        .par_iter_mut()
        .with_max_len(1)
        .map(|tile| {
            let free = waiting().pop();
            let mut scratch = free.unwrap_or_else(&scratch);
            let mut tally = Tally::default();
            fill(&mut scratch, tile, &mut tally);
            waiting().push(scratch);
            (frame.progress)(tile.rows.iter().map(|row| row.len()).sum());
            tally
        })
        .reduce(Tally::default, Tally::plus);
    (image, tally)
}

fn cut(pixels: &mut [[f32; 4]], width: usize, side: usize) -> Vec<Tile<'_>> {
    let mut tiles: Vec<Tile<'_>> = Vec::new();
    for (band, pixels) in pixels.chunks_mut(side * width).enumerate() {
        let first = tiles.len();
        tiles.extend((0..width).step_by(side).map(|column| Tile { column, row: band * side, rows: Vec::new() }));
        for line in pixels.chunks_mut(width) {
            for (tile, part) in tiles[first..].iter_mut().zip(line.chunks_mut(side)) {
                tile.rows.push(part);
            }
        }
    }
    tiles
}

/// Composites over the background: premultiplied colour, and alpha 1 over a colour.
fn over(light: Option<Radiance>, background: Background) -> [f32; 4] {
    let (color, t) = light.map_or(([0.0; 3], 1.0), |l| (l.color, l.transmittance));
    let (behind, alpha) = match background {
        Background::Transparent => ([0.0; 3], 1.0 - t),
        Background::Color(behind) => (behind, 1.0),
    };
    let [r, g, b] = std::array::from_fn(|c| (color[c] + t * behind[c]) as f32);
    [r, g, b, alpha as f32]
}

/// Fisher and Yates' shuffle.
fn shuffle<T>(items: &mut [T], seed: u64) {
    for i in (1..items.len()).rev() {
        let j = super::march::hash(seed, i as u64) % (i as u64 + 1);
        items.swap(i, j as usize);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let (width, height) = (37, 21);
        let mut image = Image::transparent(width, height);
        let mut tiles = cut(image.pixels_mut(), width, 16);
        assert_eq!(tiles.len(), 6);
        shuffle(&mut tiles, 7);
        for tile in &mut tiles {
            for (y, row) in tile.rows.iter_mut().enumerate() {
                for (x, pixel) in row.iter_mut().enumerate() {
                    pixel[0] += 1.0;
                    pixel[1] = ((tile.row + y) * width + tile.column + x) as f32;
                }
            }
        }
        for (i, pixel) in image.pixels().iter().enumerate() {
            assert_eq!(*pixel, [1.0, i as f32, 0.0, 0.0], "pixel {i}");
        }
    }

    #[test]
    fn a_background_is_seen_through_what_is_left() {
        let light = Some(Radiance { color: [0.5, 0.0, 0.0], transmittance: 0.25, ..Radiance::default() });
        assert_eq!(over(light, Background::Transparent), [0.5, 0.0, 0.0, 0.75]);
        assert_eq!(over(light, Background::Color([1.0, 1.0, 0.0])), [0.75, 0.25, 0.0, 1.0]);
        assert_eq!(over(None, Background::Color([1.0, 0.5, 0.0])), [1.0, 0.5, 0.0, 1.0]);
        assert_eq!(over(None, Background::Transparent), [0.0; 4]);
    }
}
