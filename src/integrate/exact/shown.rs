//! Where values count: inside the clip, and not where a mask hides them.

use crate::scene::{Mask, Scene};
use crate::volume::Volume;

use super::cells::{Domain, Segment};
use super::nearest::Nearest;

/// The part of a volume whose values count.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shown<'a> {
    pub(super) domain: Domain<'a>,
    /// `None` if nothing is hidden.
    pub(super) hiding: Option<Hiding<'a>>,
}

/// Which classes are hidden, and where they are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hiding<'a> {
    mask: &'a Mask,
    nearest: Nearest<'a>,
}

/// What a ray passes next.
#[derive(Debug, Clone, Copy)]
pub(super) enum Passed {
    /// A segment whose values count.
    Shown(Segment),
    /// A segment whose values are hidden.
    Hidden,
}

/// Where nothing is hidden.
impl From<Segment> for Passed {
    #[inline(always)]
    fn from(segment: Segment) -> Self {
        Passed::Shown(segment)
    }
}

impl Passed {
    /// The segment, if its values count.
    pub(super) fn shown(self) -> Option<Segment> {
        match self {
            Passed::Shown(segment) => Some(segment),
            Passed::Hidden => None,
        }
    }
}

impl<'a> Shown<'a> {
    pub(super) fn new(volume: &'a Volume, scene: &'a Scene) -> Self {
        let hiding = scene.effects.mask.as_ref().zip(volume.classes());
        let hiding = hiding.map(|(mask, classes)| Hiding { mask, nearest: Nearest::new(classes, volume.grid()) });
        Shown { domain: Domain::new(volume, scene), hiding }
    }
}

impl Hiding<'_> {
    /// What segments are when they are cut where the class changes.
    pub(super) fn pass(self, segments: impl Iterator<Item = Segment>) -> impl Iterator<Item = Passed> {
        segments.flat_map(move |segment| {
            let parts = self.nearest.parts(&segment);
            (0..parts.count()).map(move |i| {
                let (ends, class) = parts.part(i);
                if self.mask.hides(class) { Passed::Hidden } else { Passed::Shown(segment.part(ends)) }
            })
        })
    }
}
