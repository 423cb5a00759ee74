//! Volumes made by formula: CT phantoms of head and chest, [analytic] fields, and rings in colours ([`rings`]).
//!
//! A phantom is a region of the body as a CT scanner would see it, for pictures and tests without a patient, in HU. The head has
//! skin, fat, muscle, skull, teeth, brain, airways and vessels filled with contrast medium; the chest has ribs, lungs and a heart,
//! too. They are defined in patient coordinates (see [`Region`]) and sampled at any size; nothing in them comes from a scan.
//!
//! ```text
//! anatomy ──► scene ──► raster ──► volume
//! (solids)    (tissues,  (voxels,
//!              one over   partial volume,
//!              the other) noise)
//! ```
//!
//! `sdf` holds the solids, `tissue` what they are made of, `noise` the counter-based hash behind sponge, folds and
//! scanner noise.

pub mod analytic;
mod anatomy;
mod body;
mod noise;
mod raster;
mod rings;
mod scene;
mod sdf;
mod tissue;

pub use body::{BodyPhantom, Region, body, body_labels};
pub use rings::rings;
