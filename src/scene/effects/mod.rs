//! Effects beyond emission and absorption: what each is, exact in f64. A scene has none unless it asks for it.

mod clip;
mod depth_cue;
mod fog;
mod haze;
mod mask;
mod scattering;
mod shadows;

pub use clip::{Clip, HalfSpace};
pub use depth_cue::DepthCue;
pub use fog::{Fog, FogLaw};
pub use haze::Haze;
pub use mask::{Class, Mask};
pub use scattering::Scattering;
pub use shadows::Shadows;

/// What a scene asks for beyond emission and absorption; nothing by default.
///
/// They apply in this order. What is outside `clip` neither absorbs nor emits, nor what `mask` hides. At each point that is left, the transfer
/// function's emission is shaded, its lit terms dimmed by `depth_cue` and `shadows`; `scattering` replaces its share of the
/// emission; `fog` mixes in its colour; `haze` adds a medium of its own.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Effects {
    /// The part of space that is shown.
    pub clip: Clip,
    /// What each class of voxels shows, where not all show the same.
    pub mask: Option<Mask>,
    /// Where the transfer function is evaluated.
    pub classify: ClassifyAt,
    /// Levoy's dimming of lit terms with distance.
    pub depth_cue: Option<DepthCue>,
    /// Shadows towards directional lights.
    pub shadows: Option<Shadows>,
    /// Light scattered once.
    pub scattering: Option<Scattering>,
    /// Fog as OpenGL defines it.
    pub fog: Option<Fog>,
    /// Fog as a medium.
    pub haze: Option<Haze>,
}

impl Effects {
    /// Whether any effect of light is there: depth cue, shadows, scattering, fog or haze.
    pub fn change_light(&self) -> bool {
        let Effects { depth_cue, shadows, scattering, fog, haze, .. } = self;
        depth_cue.is_some() || shadows.is_some() || scattering.is_some() || fog.is_some() || haze.is_some()
    }
}

/// Where the transfer function is evaluated, and what is then interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ClassifyAt {
    /// At each point, from the interpolated value and gradient magnitude (post-classification).
    #[default]
    Samples,
    /// At the lattice points (pre-classification, Levoy 1988): there the transfer function is evaluated with the value and
    /// the gradient magnitude, shaded by the gradient, on the ray from the eye to that point ([`Camera::direction_to`]).
    /// Extinction `σ` and shaded emission `q` are interpolated trilinearly, as those of an RGBA volume are. What a
    /// transfer function shows between the values of two neighbouring voxels is then not seen: it is their model's error.
    ///
    /// [`Camera::direction_to`]: crate::scene::Camera::direction_to
    Voxels,
}
