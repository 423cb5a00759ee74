//! What a ray shows: light, one number of what lies along it, or level surfaces.

use crate::image::srgb;

/// What a ray shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Model {
    /// Emission and absorption by the transfer function.
    #[default]
    Light,
    /// One number of what lies along the ray, as a grey.
    Value(ValueModel),
    /// Level surfaces of the value, composited in the order that the ray crosses them.
    Surfaces(Vec<Surface>),
}

/// One number of what lies along a ray, as a grey.
///
/// **Definition.** The number maps to `u = (x − low)/(high − low)`, clamped to `[0, 1]`, and `u` is the grey that a display
/// shows: as with a radiologist's window, what is *displayed* is linear in the number, and linear light is `u` decoded by
/// the sRGB transfer (IEC 61966-2-1). Alpha is 1 where the ray meets the volume and 0 elsewhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueModel {
    /// Which number.
    pub of: ValueOf,
    /// Numbers shown black and white, in the number's unit; the lower first.
    pub window: [f64; 2],
}

/// A number of what lies along a ray.
///
/// **Definitions.** `s` is the length along the ray in mm, from where it enters the volume to where it leaves it at `L`;
/// `v(s)` is the value, HU, and `σ(s)` the extinction that the transfer function gives there, 1/mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValueOf {
    /// `max v`, HU: maximum intensity projection (Wallis, Miller, Lerner and Kleerup 1989).
    Maximum,
    /// `min v`, HU: minimum intensity projection, for airways.
    Minimum,
    /// `∫ v ds / L`, HU: what a slab looks like on average.
    Mean,
    /// `∫ v ds`, HU mm.
    Sum,
    /// The first local maximum of at least `threshold`, HU: local maximum intensity projection (Sato et al. 1998), in which
    /// a vessel hides what is brighter behind it.
    ///
    /// With the largest value so far `M(s) = max v` over `[0, s]`, it is `M` at the first `s` where `M(s) ≥ threshold` and
    /// `v(s) < M(s) − f`, and `max v` over the whole ray if there is none. `f` is [`ValueModel::smallest_fall`]: less of a
    /// fall than that is rounding. So a plateau counts with its value, once it falls; a maximum on the face between two
    /// cells is one like any other; and outside the volume everything is lower, so that a ray that enters at `threshold` or
    /// above and falls from there shows the value at which it enters.
    LocalMaximum {
        /// The least value that counts as a maximum, HU.
        threshold: f64,
    },
    /// `τ = ∫ σ ds`, dimensionless: what a radiograph measures, `−ln(I/I₀)` (Beer and Lambert).
    OpticalDepth,
}

impl ValueOf {
    /// Its name, as in pipelines and names of kernels.
    pub fn name(self) -> &'static str {
        match self {
            ValueOf::Maximum => "maximum",
            ValueOf::Minimum => "minimum",
            ValueOf::Mean => "mean",
            ValueOf::Sum => "sum",
            ValueOf::LocalMaximum { .. } => "local-maximum",
            ValueOf::OpticalDepth => "optical-depth",
        }
    }

    /// Whether it is a number of the transfer function, not of the values alone.
    pub fn reads_transfer_function(self) -> bool {
        self == ValueOf::OpticalDepth
    }
}

impl ValueModel {
    /// Linear light of a number.
    pub fn light(&self, number: f64) -> f64 {
        let [low, high] = self.window;
        srgb::decode(((number - low) / (high - low)).clamp(0.0, 1.0))
    }

    /// The fall, in the number's unit, that ends a local maximum: a billionth of the window, which no display shows, and
    /// which the rounding of f64 stays far below.
    pub fn smallest_fall(&self) -> f64 {
        let [low, high] = self.window;
        1e-9 * (high - low)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_linear_on_the_display_and_clamped() {
        let model = ValueModel { of: ValueOf::Sum, window: [-1000.0, 3000.0] };
        for (number, grey) in [(-2000.0, 0.0), (-1000.0, 0.0), (0.0, 0.25), (3000.0, 1.0), (1e9, 1.0)] {
            let (found, expected) = (model.light(number), srgb::decode(grey));
            assert!((found - expected).abs() < 1e-15, "{number}: found {found}, expected {expected}");
        }
    }
}
