//! CT volume rendering with a known error.
//!
//! The modules are the data flow:
//!
//! ```text
//! volume ──► field ──► classify ──► integrate ──► image
//! (HU, mm)   (value,    (transfer     (the volume    (linear RGBA,
//!            gradient)   function)     rendering      PNG, EXR)
//!                                      integral)
//! ```
//!
//! `ARCHITECTURE.md` in the repository says which module may use which, and how to add to them.

pub mod demand;
pub mod error;
pub mod math;
pub mod simd;

pub mod image;
pub mod scene;
pub mod transfer;
pub mod volume;

pub mod chart;
pub mod classify;
pub mod field;
pub mod io;
pub mod spec;
pub mod synthetic;

pub mod histogram;
pub mod oracle;
pub mod plan;

pub mod integrate;
pub mod tissue;

pub mod interchange;
pub mod study;
pub mod verify;

pub mod pipeline;

pub use error::{Error, Fault, Result};
pub use image::Image;
pub use scene::Scene;
pub use transfer::TransferFunction;
pub use volume::Volume;
