//! What a ray shows: light, one number of its values, or level surfaces.

use crate::image::srgb;

/// What a ray shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Model {
    /// Emission and absorption by the transfer function.
    #[default]
    Light,
    /// One number of the values along the ray, as a grey.
    Value(ValueModel),
    /// Level surfaces of the value, composited in the order that the ray crosses them.
    Surfaces(Vec<Surface>),
}

/// One number of the values along a ray, as a grey.
///
/// **Definition.** The number maps to `u = (v − low)/(high − low)`, clamped to `[0, 1]`, and `u` is the grey that a display
/// shows: as with a radiologist's window, what is *displayed* is linear in the value, and linear light is `u` decoded by
/// the sRGB transfer (IEC 61966-2-1). Alpha is 1 where the ray meets the volume and 0 elsewhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueModel {
    /// Which number.
    pub of: ValueOf,
    /// Values shown black and white, HU; the lower first.
    pub window: [f64; 2],
}

/// A number of the values along a ray, inside the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueOf {
    /// Maximum intensity projection.
    Maximum,
    /// Minimum intensity projection.
    Minimum,
    /// Mean over the length, `∫ v ds / ∫ ds`.
    Mean,
}

impl ValueModel {
    /// Linear light of a value.
    pub fn light(&self, value: f64) -> f64 {
        let [low, high] = self.window;
        srgb::decode(((value - low) / (high - low)).clamp(0.0, 1.0))
    }
}

/// A level surface.
///
/// **Definition.** A ray crosses the surface where the value changes from below `value` to at least `value`, or back; the
/// border of the volume is no surface. Each crossing is composited front to back with its opacity, whatever the angle. Its
/// colour is shaded by [`Shading`](super::Shading): `color · reflected + highlight`, or is `color` unshaded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Level, HU.
    pub value: f64,
    /// Opacity of one crossing, in [0, 1].
    pub opacity: f64,
    /// Straight colour, linear RGB.
    pub color: [f64; 3],
}
