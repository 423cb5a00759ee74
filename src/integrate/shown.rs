//! What of a volume shows by a transfer function: in which blocks, and the gradient magnitudes that are read there.

use super::empty_space::{EmptySpace, widened};
use super::march::ByPlace;
use crate::field::{BlockRanges, GradientUnits, Macrocells, Magnitudes, Spacing, Steps, Trilinear, Voxel};

/// What a kernel reads of a volume beside its values, and nothing else.
pub(super) struct Shown {
    /// The gradient magnitude, if the transfer function reads it.
    pub(super) magnitudes: Option<Magnitudes>,
    /// Where nothing shows, if that is passed over.
    pub(super) empty_space: Option<EmptySpace>,
}

impl Shown {
    /// By blocks of `2^LOG2` cells per axis, at most as large as those of [`Macrocells`].
    ///
    /// Magnitudes are kept of the blocks in which something may show at any magnitude up to their largest: elsewhere a magnitude of 0
    /// shows as little as the right one, whoever reads it.
    pub(super) fn new<const LOG2: u32, V: Voxel, K: Spacing, C: ByPlace>(
        field: &Trilinear<'_, V, K>,
        units: &GradientUnits,
        classifier: &C,
        passes_over: bool,
    ) -> Self {
        // Blocks are counted in even steps.
        let passes_over = passes_over && K::EVEN;
        if !C::READS_GRADIENT {
            let space = || EmptySpace::new(&BlockRanges::<LOG2>::new(field), None, classifier);
            return Shown { magnitudes: None, empty_space: passes_over.then(space) };
        }
        let values = BlockRanges::<LOG2>::new(field);
        let ranges = BlockRanges::<LOG2>::of_magnitudes(field, units);
        let steps = Steps::up_to(ranges.ranges().iter().fold(0.0, |largest: f32, &[_, high]| largest.max(high)));
        let ranges = ranges.mapped(|m| steps.rounded(m));
        let blocks = values.blocks();
        let is_read = |block: [usize; 3]| {
            let within = |a: usize| {
                let times = 1 << (Macrocells::LOG2_CELLS - LOG2);
                block[a] * times..((block[a] + 1) * times).min(blocks[a])
            };
            let may_show = |[i, j, k]: [usize; 3]| {
                let b = i + blocks[0] * (j + blocks[1] * k);
                let [_, high] = ranges.ranges()[b];
                !classifier.is_empty_in(b, widened(values.ranges()[b]), widened([0.0, high]))
            };
            within(2).any(|k| within(1).any(|j| within(0).any(|i| may_show([i, j, k]))))
        };
        let magnitudes = Magnitudes::new(field, units, steps, is_read);
        let empty_space = passes_over.then(|| EmptySpace::new(&values, Some(&ranges), classifier));
        Shown { magnitudes: Some(magnitudes), empty_space }
    }
}
