//! Which voxel belongs to which tissue, how much of each there is, and how well labels agree with a reference.
//!
//! **Definition.** Let `σ_t(v, g)` be the extinction of a layer `t` of the [transfer function](crate::transfer), or the sum of
//! the shapes that its preset gives under `classify`. Its *membership* is that extinction as a share of its own peak,
//!
//! ```text
//! m_t(v, g) = σ_t(v, g) / max σ_t        from 0 to 1
//! ```
//!
//! at the value `v` of a voxel and the [gradient magnitude](crate::field) `g` there. A voxel belongs to the tissue of highest
//! membership, if that is at least 1/2 ([`THRESHOLD`]): inside the tissue rather than outside of it, as its widget says. Of
//! tissues of equal membership, which is common where plateaus overlap, the one with the greater extinction
//! `m_t · max σ_t` has it, the picture showing that one; of those still equal, the first. Otherwise it belongs to none.
//! The peak is taken over the domain of the transfer function, and equal means within 1e-9.
//!
//! So opacity decides what belongs, not how opaque an author made a layer: a faint haze of fat is fat. The gradient axis
//! handles partial volume: between air and muscle lie the values of fat, but at a gradient where no fat is.
//!
//! **What value and gradient cannot tell apart** stays together: muscle and liver, spongy bone and contrast agent. How well
//! any function of the two could do is what [`Bound`] says.
//!
//! **Cleaning** ([`clean`]) knows of places where a transfer function does not, and is done only if asked for. Each tissue
//! is cleaned by itself, as a mask of the labels; where two cleaned masks overlap, the layer of greater peak extinction
//! has the voxel.
//!
//! Distances and sizes are of the lattice in the patient, in mm. Voxels are *joined* through their faces.

mod bound;
mod classify;
mod clean;
mod crop;
mod decision;
mod difference;
mod distance;
mod evaluate;
mod fit;
mod histogram;
mod mask;
mod measure;
mod parts;
mod surface;

pub use bound::{Bound, bound};
pub use classify::{classify, membership};
pub use clean::clean;
pub use decision::THRESHOLD;
pub use difference::picture;
pub use evaluate::{Agreement, Comparison, Confusion, Pair, agreement, confusion, mask_of};
pub use fit::{Proposal, fit};
pub use histogram::{BIN_GRADIENT_PER_MM, BIN_VALUE};
pub use mask::Mask;
pub use measure::{TissueMeasure, measure};
