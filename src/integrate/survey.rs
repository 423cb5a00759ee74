//! What is found out about a volume and what shows of it, whatever the view.

use std::sync::OnceLock;

use super::empty_space::EmptySpace;
use super::light_volumes::Transmittances;
use super::march::Blocks;
use super::shown::Shown;

/// Found out by the first view that needs it, and read by all that follow: the views of one volume under one transfer function, by
/// one method. What a kernel does not read is never found out.
#[derive(Default)]
pub(super) struct Survey {
    /// What shows by a transfer function.
    pub(super) shown: OnceLock<Shown>,
    /// Where nothing shows, by whatever else.
    pub(super) empty_space: OnceLock<EmptySpace>,
    /// The values of blocks.
    pub(super) blocks: OnceLock<Blocks>,
    /// What gets through to the lights.
    pub(super) transmittances: OnceLock<Transmittances>,
}
