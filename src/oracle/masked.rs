//! Transfer functions by place: a passage is cut halfway between voxels, and each part has that of the voxel nearest to its
//! middle.

use super::patches::Patches;
use super::path::Passage;
use crate::scene::{Class, Scene};
use crate::volume::Volume;

/// The scene's transfer function, and those of classes of voxels.
#[derive(Debug, Clone)]
pub(super) struct Functions<'a> {
    volume: &'a Volume,
    shown: Patches,
    /// By class; empty without a mask.
    looks: Vec<Look>,
}

/// What a class of voxels shows.
#[derive(Debug, Clone)]
enum Look {
    Shown,
    Hidden,
    Own(Patches),
}

impl<'a> Functions<'a> {
    pub(super) fn new(volume: &'a Volume, scene: &Scene) -> Self {
        let look = |class: &Class| match class {
            Class::Shown => Look::Shown,
            Class::Hidden => Look::Hidden,
            Class::Own(function) => Look::Own(Patches::new(function)),
        };
        let looks = scene.effects.mask.iter().flat_map(|mask| &mask.classes).map(look).collect();
        Functions { volume, shown: Patches::new(&scene.transfer_function), looks }
    }

    /// The parts of a passage with the transfer function that holds on each, `None` where it is hidden.
    pub(super) fn along(&self, passage: Passage) -> impl Iterator<Item = (Passage, Option<&Patches>)> {
        let classes = self.volume.classes().filter(|_| !self.looks.is_empty());
        let parts = match classes {
            None => [Some(passage), None, None, None],
            Some(_) => octants(&passage),
        };
        parts.into_iter().flatten().map(move |part| {
            let look = classes.and_then(|classes| {
                let class = classes.values()[self.volume.grid().flatten(self.nearest_voxel(&part))];
                self.looks.get(usize::from(class))
            });
            match look {
                None | Some(Look::Shown) => (part, Some(&self.shown)),
                Some(Look::Hidden) => (part, None),
                Some(Look::Own(patches)) => (part, Some(patches)),
            }
        })
    }

    /// The voxel nearest to the middle of a passage.
    fn nearest_voxel(&self, passage: &Passage) -> [usize; 3] {
        let dims = self.volume.grid().dims();
        std::array::from_fn(|a| {
            let middle = passage.cell[a] as f64 + 0.5 * (passage.entry[a] + passage.exit[a]);
            ((middle + 0.5).floor() as usize).min(dims[a] - 1)
        })
    }
}

/// The parts of a passage in the eight octants of its cell, of which a straight line meets at most four.
fn octants(passage: &Passage) -> [Option<Passage>; 4] {
    let at = |t: f64| -> [f64; 3] {
        std::array::from_fn(|a| {
            if t == 1.0 { passage.exit[a] } else { passage.entry[a] + t * (passage.exit[a] - passage.entry[a]) }
        })
    };
    let mut cuts = [0.0, 1.0, 1.0, 1.0, 1.0];
    for a in 0..3 {
        let (entry, exit) = (passage.entry[a] - 0.5, passage.exit[a] - 0.5);
        if entry * exit < 0.0 {
            cuts[a + 1] = entry / (entry - exit);
        }
    }
    cuts.sort_by(f64::total_cmp);
    std::array::from_fn(|i| {
        let (from, to) = (cuts[i], cuts[i + 1]);
        (from < to).then(|| Passage {
            cell: passage.cell,
            entry: at(from),
            exit: at(to),
            from_mm: passage.from_mm + from * passage.length_mm,
            length_mm: (to - from) * passage.length_mm,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octants_join_up_and_meet_halfway() {
        let passage =
            Passage { cell: [3, 1, 2], entry: [0.1, 0.9, 0.0], exit: [0.7, 0.7, 0.4], from_mm: 2.0, length_mm: 5.0 };
        let parts: Vec<Passage> = octants(&passage).into_iter().flatten().collect();
        // The middle is passed along x alone, at two thirds.
        assert_eq!(parts.len(), 2, "found {parts:?}");
        assert!((parts[0].exit[0] - 0.5).abs() < 1e-15 && parts[0].exit[1] > 0.75, "found {parts:?}");
        assert!((parts[0].length_mm - 10.0 / 3.0).abs() < 1e-14, "found {parts:?}");
        assert_eq!((parts[0].entry, parts[1].exit), (passage.entry, passage.exit));
        assert_eq!(parts[0].exit, parts[1].entry);
    }
}
