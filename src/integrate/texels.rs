//! Emission and extinction given at the voxels: by the colours of an RGBA volume, or as they are.

use crate::math::Real;
use crate::volume::RgbaEncoding;

/// Emission in red, green and blue, and extinction, 1/mm, at each voxel; chosen by type.
pub(super) trait Texels<R: Real>: Sync {
    /// At the voxel in this place of memory.
    fn optics(&self, voxel: usize) -> [R; 4];
    /// Number of voxels.
    fn len(&self) -> usize;
}

/// The colours of an RGBA volume, by tables over all values that a component can take.
#[derive(Debug, Clone)]
pub(super) struct Rgba<'a, T, R> {
    texels: &'a [[T; 4]],
    /// σ by alpha, 1/mm.
    extinction: Vec<R>,
    /// Linear light by component.
    linear: Vec<R>,
}

/// A component of a colour.
pub(super) trait Component: Copy + Sync + Into<usize> {
    /// Name of its colours in kernel names.
    const NAME: &'static str;
    /// The largest one, which stands for 1.
    const LARGEST: usize;
}

impl Component for u8 {
    const NAME: &'static str = "rgba8";
    const LARGEST: usize = u8::MAX as usize;
}

impl Component for u16 {
    const NAME: &'static str = "rgba16";
    const LARGEST: usize = u16::MAX as usize;
}

impl<'a, T: Component, R: Real> Rgba<'a, T, R> {
    pub(super) fn new(texels: &'a [[T; 4]], encoding: RgbaEncoding) -> Self {
        let table = |f: &dyn Fn(f64) -> f64| {
            (0..=T::LARGEST).map(|i| R::from_f64(f(i as f64 / T::LARGEST as f64))).collect::<Vec<_>>()
        };
        Rgba { texels, extinction: table(&|a| encoding.extinction_per_mm(a)), linear: table(&|c| encoding.linear(c)) }
    }
}

impl<T: Component, R: Real> Texels<R> for Rgba<'_, T, R> {
    #[inline(always)]
    fn optics(&self, voxel: usize) -> [R; 4] {
        let [r, g, b, alpha] = self.texels[voxel].map(Into::into);
        let extinction = self.extinction[alpha];
        [extinction * self.linear[r], extinction * self.linear[g], extinction * self.linear[b], extinction]
    }

    fn len(&self) -> usize {
        self.texels.len()
    }
}

impl<R: Real> Texels<R> for Vec<[f32; 4]> {
    #[inline(always)]
    fn optics(&self, voxel: usize) -> [R; 4] {
        self[voxel].map(R::from_f32)
    }

    fn len(&self) -> usize {
        self.as_slice().len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{ColorEncoding, Grid, Quantity, Rescale, Samples, Volume};
    use glam::DVec3;

    #[test]
    fn the_tables_hold_the_definition() {
        let texels: Vec<[u8; 4]> = (0..=255).map(|i| [i, 255 - i, i / 2, i]).collect();
        let grid = Grid::axis_aligned([256, 1, 1], DVec3::splat(0.5)).unwrap();
        for color in [ColorEncoding::Srgb, ColorEncoding::Linear] {
            let encoding = RgbaEncoding { opacity_length_mm: 0.7, color };
            let samples = Samples::Rgba8(texels.clone());
            let volume = Volume::new(grid, samples, Rescale::IDENTITY, Quantity::Arbitrary).unwrap();
            let volume = volume.with_rgba_encoding(encoding);
            let table = Rgba::<u8, f64>::new(&texels, encoding);
            for voxel in 0..256 {
                let expected = volume.optics_per_mm([voxel, 0, 0]).unwrap();
                assert_eq!(table.optics(voxel), expected, "voxel {voxel}, {color:?}");
            }
        }
    }
}
