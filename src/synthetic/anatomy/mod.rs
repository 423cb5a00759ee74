//! Regions of the body, as solids and what they are made of.

pub(super) mod chest;
pub(super) mod head;
