//! Effects, resolved: one that is named with a strength of 0 is not there.

use crate::scene::{ClassifyAt, Effects};
use crate::spec::{ClassifyAtName, Spec};

pub(super) fn resolve(spec: &Spec) -> Effects {
    let classify = match spec.pipeline.effects.as_ref().and_then(|effects| effects.classify) {
        None | Some(ClassifyAtName::Samples) => ClassifyAt::Samples,
        Some(ClassifyAtName::Voxels) => ClassifyAt::Voxels,
    };
    Effects { classify, ..Effects::default() }
}
