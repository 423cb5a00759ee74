//! Volumes that are already classified: a colour and an opacity at each lattice point.

use super::Volume;
use crate::image::srgb;
use crate::math::extinction_per_mm;

/// How the numbers of an RGBA volume are understood.
///
/// **Definition.** Alpha is the opacity of a length `Δs₀` of what is at the lattice point, and is at most `1 − 2⁻²⁴`; the
/// colour is straight, `c` once it is decoded. At each lattice point
///
/// ```text
/// σ = −ln(1 − α)/Δs₀,      q = σ c,
/// ```
///
/// and `σ` and `q` are interpolated trilinearly. So an opacity means the same at any step and on any spacing, and what is
/// interpolated is the colour times its extinction: the colour of a transparent voxel, which nobody chose, weighs nothing
/// and bleeds into no neighbour, as it would if `c` and `α` were interpolated by themselves (Wittenbrink, Malzbender and
/// Goss 1998). Along a ray inside a cell `σ` and `q` are exactly cubics, without any knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RgbaEncoding {
    /// Δs₀, mm, above 0; the smallest spacing unless told.
    pub opacity_length_mm: f64,
    /// What the numbers of a colour are; sRGB unless told.
    pub color: ColorEncoding,
}

/// What the numbers of a colour are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColorEncoding {
    /// sRGB (IEC 61966-2-1), as pictures have them.
    #[default]
    Srgb,
    /// Linear light.
    Linear,
}

impl RgbaEncoding {
    /// σ of an alpha in [0, 1], 1/mm.
    pub fn extinction_per_mm(self, alpha: f64) -> f64 {
        extinction_per_mm(alpha, self.opacity_length_mm)
    }

    /// Linear light of a colour's component, both in [0, 1].
    pub fn linear(self, component: f64) -> f64 {
        match self.color {
            ColorEncoding::Srgb => srgb::decode(component),
            ColorEncoding::Linear => component,
        }
    }

    /// q in red, green and blue, and σ, 1/mm, of a colour and an alpha in [0, 1].
    pub fn optics_per_mm(self, [r, g, b, alpha]: [f64; 4]) -> [f64; 4] {
        let extinction = self.extinction_per_mm(alpha);
        let [r, g, b] = [r, g, b].map(|component| self.linear(component) * extinction);
        [r, g, b, extinction]
    }
}

impl Volume {
    /// How the numbers of an RGBA volume are understood; `None` for a volume of values.
    pub fn rgba_encoding(&self) -> Option<RgbaEncoding> {
        self.rgba
    }

    /// The same volume with its colours and opacities understood otherwise; a volume of values stays as it is.
    #[must_use]
    pub fn with_rgba_encoding(mut self, encoding: RgbaEncoding) -> Self {
        self.rgba = self.rgba.map(|_| encoding);
        self
    }

    /// q in red, green and blue, and σ, 1/mm, at a lattice point of an RGBA volume; `None` for a volume of values. Panics
    /// outside the grid.
    pub fn optics_per_mm(&self, index: [usize; 3]) -> Option<[f64; 4]> {
        let rgba = self.samples.rgba(self.grid.flatten(index))?;
        self.rgba.map(|encoding| encoding.optics_per_mm(rgba))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Grid, Quantity, Rescale, Samples};
    use glam::DVec3;

    fn volume(samples: Samples) -> Volume {
        let grid = Grid::axis_aligned([2, 1, 1], DVec3::new(2.0, 0.5, 3.0)).unwrap();
        Volume::new(grid, samples, Rescale::IDENTITY, Quantity::Arbitrary).unwrap()
    }

    #[test]
    fn alpha_is_the_opacity_of_the_smallest_spacing_and_color_is_srgb() {
        let volume = volume(Samples::Rgba8(vec![[255, 188, 0, 128], [9, 9, 9, 0]]));
        let [r, g, b, extinction] = volume.optics_per_mm([0, 0, 0]).unwrap();
        // 1 − e^{−σ/2 mm} is 128/255.
        let opacity = 1.0 - (-0.5 * extinction).exp();
        assert!((opacity - 128.0 / 255.0).abs() < 1e-15, "found {opacity}");
        assert!((r - extinction).abs() < 1e-15 && b == 0.0, "found {r} and {b}, expected {extinction} and 0");
        // IEC 61966-2-1: 188/255 by the power law.
        assert!((g / extinction - 0.502_886).abs() < 1e-6, "found {}", g / extinction);
        assert_eq!(volume.optics_per_mm([1, 0, 0]), Some([0.0; 4]), "transparent, whatever its colour");
    }

    #[test]
    fn another_length_and_linear_colors_are_taken_at_their_word() {
        let linear = RgbaEncoding { opacity_length_mm: 4.0, color: ColorEncoding::Linear };
        let volume = volume(Samples::Rgba16(vec![[65_535, 13_107, 0, 65_535], [0; 4]])).with_rgba_encoding(linear);
        let [r, g, _, extinction] = volume.optics_per_mm([0, 0, 0]).unwrap();
        let most = 24.0 * 2.0_f64.ln() / 4.0;
        assert!((extinction - most).abs() < 1e-12, "opaque is 1 - 2^-24: found {extinction}, expected {most}");
        assert!((g / r - 0.2).abs() < 1e-15, "found {}", g / r);
    }

    #[test]
    fn a_volume_of_values_has_no_optics_of_its_own() {
        let encoding = RgbaEncoding { opacity_length_mm: 1.0, color: ColorEncoding::Srgb };
        let volume = volume(Samples::I16(vec![1, 2])).with_rgba_encoding(encoding);
        assert_eq!((volume.rgba_encoding(), volume.optics_per_mm([0, 0, 0])), (None, None));
    }
}
