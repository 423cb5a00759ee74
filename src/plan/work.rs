//! How much there is to do, before anything is done.

use crate::field::Chord;
use crate::scene::Scene;
use crate::volume::Grid;

use super::Method;

/// Rays that are looked at, at most: as many as decide two digits.
const MOST_PROBES: usize = 16_384;

/// Rays, and what they pass: an estimate by every so many pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Work {
    /// Pixels whose rays meet the volume.
    pub rays: u64,
    /// Cells that these rays pass, and samples that they take, if nothing is skipped and no ray ends early; samples of
    /// marching only.
    pub cells: u64,
    /// See `cells`.
    pub samples: Option<u64>,
}

/// Looks at a grid of pixels, and counts for each as many as it stands for.
pub(super) fn expected(scene: &Scene, method: &Method, grid: &Grid) -> Work {
    let [width, height] = scene.camera.size();
    let stride = (1..).find(|s| width.div_ceil(*s) * height.div_ceil(*s) <= MOST_PROBES).unwrap_or(1);
    let first = stride / 2;
    let probes = |size: usize| (first.min(size - 1)..size).step_by(stride);
    let (mut met, mut cells, mut length_mm, mut count) = (0_u64, 0.0, 0.0, 0_u64);
    for row in probes(height) {
        for column in probes(width) {
            count += 1;
            let Some(chord) = Chord::new(grid, &scene.effects.clip, scene.camera.pixel_ray(column, row)) else {
                continue;
            };
            met += 1;
            length_mm += chord.length_mm;
            cells += 1.0 + (chord.length_mm * chord.index_per_mm).abs().element_sum();
        }
    }
    let share = (width * height) as f64 / count.max(1) as f64;
    let samples = match method {
        Method::March(march) => Some((share * length_mm / march.step_mm) as u64),
        Method::Exact(_) | Method::Reference => None,
    };
    Work { rays: (share * met as f64) as u64, cells: (share * cells) as u64, samples }
}

impl Work {
    /// In words.
    pub(super) fn describe(&self) -> String {
        let passed = match self.samples {
            Some(samples) => format!("{} samples", rounded(samples)),
            None => format!("{} cells", rounded(self.cells)),
        };
        format!("about {} rays, at most {passed}", rounded(self.rays))
    }
}

/// Two digits, since it is an estimate.
fn rounded(count: u64) -> String {
    let [value, unit] = match count {
        0..1_000 => return count.to_string(),
        1_000..1_000_000 => [count as f64 / 1e3, 0.0],
        1_000_000..1_000_000_000 => [count as f64 / 1e6, 1.0],
        _ => [count as f64 / 1e9, 2.0],
    };
    let digits = usize::from(value < 10.0);
    format!("{value:.digits$} {}", ["thousand", "million", "billion"][unit as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_digits_are_said() {
        let words = [0, 999, 1_234, 12_345, 9_876_543, 412_000_000, 1_500_000_000].map(rounded);
        assert_eq!(words, ["0", "999", "1.2 thousand", "12 thousand", "9.9 million", "412 million", "1.5 billion"]);
    }
}
