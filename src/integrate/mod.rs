//! The volume rendering integral along each ray of a picture.
pub mod exact;
