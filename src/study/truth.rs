//! The oracle's pixels: computed once, held against every setting.

use rayon::prelude::*;

use super::clock::Deadline;
use super::errors::{Errors, difference};
use crate::image::Image;
use crate::oracle::Oracle;
use crate::scene::Scene;
use crate::volume::Volume;

/// Pixels that each thread computes between two looks at the clock.
const PIXELS_PER_THREAD: usize = 4;

/// Random pixels of a picture, as they should be.
#[derive(Debug, Clone)]
pub(super) struct Truth {
    width: usize,
    /// Position in the picture, row by row, and linear premultiplied RGBA.
    pixels: Vec<(usize, [f64; 4])>,
}

impl Truth {
    /// Up to `most` pixels by the oracle until the deadline, and a few for each thread in any case. Pixels come in the order of a
    /// hash of their position, so that those that were reached in time are as random as all, however long each took.
    pub(super) fn measure(volume: &Volume, scene: &Scene, most: usize, deadline: Deadline) -> Self {
        let oracle = Oracle::new(volume, scene);
        let [width, height] = scene.camera.size();
        let order = in_random_order(width * height);
        let at_once = PIXELS_PER_THREAD * rayon::current_num_threads();
        let mut pixels = Vec::new();
        for batch in order[..most.min(order.len())].chunks(at_once) {
            if !pixels.is_empty() && deadline.left().is_zero() {
                break;
            }
            let truth = |&index: &usize| (index, oracle.pixel(index % width, index / width));
            pixels.par_extend(batch.par_iter().map(truth));
        }
        Truth { width, pixels }
    }

    /// How many pixels are known.
    pub(super) fn len(&self) -> usize {
        self.pixels.len()
    }

    /// Errors of a picture of the same size.
    pub(super) fn errors_of(&self, image: &Image) -> Errors {
        let error = |(index, truth): &(usize, [f64; 4])| {
            difference(image.pixel(index % self.width, index / self.width), *truth)
        };
        Errors::of(self.pixels.iter().map(error).collect())
    }
}

/// The numbers below `count` in the order of their hashes.
fn in_random_order(count: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.par_sort_by_cached_key(|&index| hash(index as u64));
    order
}

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014) after one step of its counter: a bijection.
fn hash(index: u64) -> u64 {
    let z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_comes_once_and_the_first_are_spread_evenly() {
        let order = in_random_order(10_000);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..10_000), "each number once");
        let low = order[..1000].iter().filter(|&&index| index < 5000).count();
        assert!((430..570).contains(&low), "about half of the first are of the lower half, found {low} of 1000");
        assert_eq!(order, in_random_order(10_000), "the same each time");
    }
}
