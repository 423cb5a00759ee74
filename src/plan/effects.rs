//! Effects, resolved: one that is named with a strength of 0 is not there.

use crate::scene::{Effects, Mask};
use crate::spec::Spec;
use crate::volume::Grid;

use super::clip;

pub(super) fn resolve(spec: &Spec, grid: &Grid, mask: Option<Mask>) -> Effects {
    Effects { clip: clip::resolve(spec, grid), mask, ..Effects::default() }
}
