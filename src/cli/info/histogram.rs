//! A histogram in one line of text.

use pellucid::Volume;

/// Eight heights of block characters, lowest first.
const BLOCKS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// The volume's values in `bins` equal bins from the lowest to the highest, one character each. Heights are logarithmic in
/// the counts, since most of a scan is air; an empty bin is a space.
pub(super) fn line(volume: &Volume, bins: usize) -> String {
    let [low, high] = volume.value_range();
    let per_bin = (high - low) / bins as f64;
    let mut counts = vec![0_u64; bins];
    for index in 0..volume.samples().len() {
        let value = volume.rescale().value(volume.samples().stored(index));
        // A volume of one value has bins of no width; all of it is in the first.
        let bin = if per_bin > 0.0 { ((value - low) / per_bin) as usize } else { 0 };
        counts[bin.min(bins - 1)] += 1;
    }
    bars(&counts)
}

fn bars(counts: &[u64]) -> String {
    let scale = |count: u64| ((count + 1) as f64).log2();
    let highest = counts.iter().copied().max().map_or(1.0, scale);
    let bar = |&count: &u64| match count {
        0 => ' ',
        _ => BLOCKS[((scale(count) / highest * BLOCKS.len() as f64) as usize).min(BLOCKS.len() - 1)],
    };
    counts.iter().map(bar).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use pellucid::volume::{Grid, Quantity, Rescale, Samples};

    fn volume(values: Vec<i16>) -> Volume {
        let grid = Grid::axis_aligned([values.len(), 1, 1], DVec3::ONE).expect("a valid grid");
        Volume::new(grid, Samples::I16(values), Rescale::IDENTITY, Quantity::Hu).expect("a valid volume")
    }

    #[test]
    fn the_highest_bin_is_full_and_an_empty_one_blank() {
        assert_eq!(bars(&[0, 1, 1_000_000]), " ▁█");
    }

    #[test]
    fn values_fall_into_their_bins_and_the_highest_value_into_the_last() {
        let line = line(&volume(vec![-1000, -1000, -1000, 1000]), 4);
        assert_eq!(line.chars().map(|c| c == ' ').collect::<Vec<_>>(), [false, true, true, false], "found {line:?}");
    }

    #[test]
    fn a_volume_of_one_value_has_one_bar() {
        assert_eq!(line(&volume(vec![7; 5]), 3), "█  ");
    }
}
