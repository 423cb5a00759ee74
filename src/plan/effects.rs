//! Effects, resolved: one that is named with a strength of 0 is not there.

use crate::scene::Effects;
use crate::spec::Spec;

pub(super) fn resolve(_spec: &Spec) -> Effects {
    Effects::default()
}
