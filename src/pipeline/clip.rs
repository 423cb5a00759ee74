//! What the fixed window of values cuts off.

use rayon::prelude::*;
use serde::Serialize;

use crate::volume::{Samples, Volume};

/// Voxels that are counted at once; their number fits 32 bits.
const PART: usize = 1 << 18;

/// How many voxels lie outside the window of the transfer function; they are treated as at its ends.
///
/// The window is fixed and written down, never the volume's own minimum and maximum: one metal clip would move every
/// tissue. So what it cuts off is counted and said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Clipped {
    /// Voxels below the window.
    pub below: u64,
    /// Voxels above the window.
    pub above: u64,
    /// Voxels in all.
    pub voxels: u64,
}

impl Clipped {
    /// Counts the voxels of a volume outside `[low, high]`, in its values.
    pub fn count(volume: &Volume, [low, high]: [f64; 2]) -> Self {
        let rescale = volume.rescale();
        let outside = |stored: f64| {
            let value = rescale.value(stored);
            (u64::from(value < low), u64::from(value > high))
        };
        let add = |a: (u64, u64), b: (u64, u64)| (a.0 + b.0, a.1 + b.1);
        let (below, above) = match volume.samples() {
            Samples::I16(data) => {
                // Which stored numbers are outside: they are in one piece at either end.
                let [low_end, high_end] = [i32::from(i16::MIN), i32::from(i16::MAX)];
                let ends = |is_outside: &dyn Fn(f64) -> bool| {
                    let is_outside = |&stored: &i32| is_outside(rescale.value(f64::from(stored)));
                    let below = (low_end..=high_end).take_while(is_outside).count() as i32;
                    let above = (low_end..=high_end).rev().take_while(is_outside).count() as i32;
                    [low_end + below, high_end - above]
                };
                let within = [ends(&|value| value < low), ends(&|value| value > high)];
                let count = |part: &[i16]| {
                    let outside = |[first, last]: [i32; 2]| {
                        part.iter().map(|&v| u32::from(i32::from(v) < first || last < i32::from(v))).sum::<u32>()
                    };
                    (u64::from(outside(within[0])), u64::from(outside(within[1])))
                };
                data.par_chunks(PART).map(count).reduce(|| (0, 0), add)
            }
            // Colours are not put into a window.
            Samples::Rgba8(_) | Samples::Rgba16(_) => (0, 0),
            Samples::F32(data) => data.par_iter().map(|&v| outside(f64::from(v))).reduce(|| (0, 0), add),
        };
        Clipped { below, above, voxels: volume.samples().len() as u64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Quantity, Rescale};
    use glam::DVec3;

    #[test]
    fn values_outside_the_window_are_counted_and_its_ends_are_inside() {
        let grid = Grid::axis_aligned([5, 1, 1], DVec3::ONE).expect("a valid grid");
        let rescale = Rescale { slope: -2.0, intercept: 10.0 };
        // Values 12, 10, 8, 6, 4.
        let samples = Samples::I16(vec![-1, 0, 1, 2, 3]);
        let volume = Volume::new(grid, samples, rescale, Quantity::Hu).expect("a valid volume");
        assert_eq!(Clipped::count(&volume, [6.0, 10.0]), Clipped { below: 1, above: 1, voxels: 5 });
        assert_eq!(Clipped::count(&volume, [-1e9, 1e9]), Clipped { below: 0, above: 0, voxels: 5 });
        assert_eq!(Clipped::count(&volume, [20.0, 30.0]), Clipped { below: 5, above: 0, voxels: 5 });
    }
}
