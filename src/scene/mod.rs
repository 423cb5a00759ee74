//! The scene: what is pictured, from where and in what light, resolved and exact in f64.
//!
//! A [`Scene`] is shared by every integrator and by the oracle: it holds definitions, never an approximation.
//!
//! **Light.** Along a ray with parameter `s` in mm, `dI/ds = q − σ I`, so that
//! `I = I₀ T(D) + ∫ q(s) exp(−∫₀^s σ) ds` with `T(D) = exp(−∫₀^D σ)` (Max 1995). `σ` and `q` come from the
//! [transfer function](crate::transfer); shading multiplies `q`. Colour is linear and premultiplied.

mod camera;
mod effects;
mod lighting;
mod model;
mod rays;
mod shading;

pub use camera::{Camera, Projection, Ray};
pub use effects::{
    Class, ClassifyAt, Clip, DepthCue, Effects, Fog, FogLaw, HalfSpace, Haze, Mask, Scattering, Shadows,
};
pub use model::{Model, Surface, ValueModel, ValueOf};
pub use rays::Rays;
pub use shading::{Light, Shading};

use crate::transfer::TransferFunction;

/// What is pictured: resolved definitions, no options left open.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// What a ray shows.
    pub model: Model,
    /// What absorbs and emits.
    pub transfer_function: TransferFunction,
    /// Shading by the gradient; `None` renders emission and absorption alone, and no gradient is read for it.
    pub shading: Option<Shading>,
    /// From where.
    pub camera: Camera,
    /// Light behind the volume.
    pub background: Background,
    /// What it asks for beyond that.
    pub effects: Effects,
}

impl Scene {
    /// The scene's transfer function, and those that classes of voxels have in its place.
    pub fn transfer_functions(&self) -> impl Iterator<Item = &TransferFunction> {
        let classes = self.effects.mask.iter().flat_map(|mask| &mask.classes);
        let own = classes.filter_map(|class| match class {
            Class::Own(function) => Some(function),
            Class::Shown | Class::Hidden => None,
        });
        std::iter::once(&self.transfer_function).chain(own)
    }
}

/// The light behind the volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// Nothing: the picture keeps its alpha.
    Transparent,
    /// An even colour, linear RGB; the picture is opaque.
    Color([f64; 3]),
}
