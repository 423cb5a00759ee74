//! Look-up of a tabulated transfer function as graphics hardware does it, for one length of step.

use super::{Classifier, Rgbs, Tabulated};
use crate::volume::Rescale;

/// How extinction becomes the opacity of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepOpacity {
    /// Length of a step, mm.
    pub step_mm: f64,
    /// Opacities of 1 mm that are at most this are taken for those of a step.
    pub uncorrected: f64,
}

impl StepOpacity {
    /// Opacity of a step, in the precision of a texture: VTK holds the opacity of 1 mm in f32 before it corrects it.
    fn of(self, extinction_per_mm: f64) -> f32 {
        if self.uncorrected == 0.0 {
            return -(-extinction_per_mm * self.step_mm).exp_m1() as f32;
        }
        let of_1_mm = -(-extinction_per_mm).exp_m1() as f32;
        if of_1_mm > self.uncorrected as f32 {
            (1.0 - (1.0 - f64::from(of_1_mm)).powf(self.step_mm)) as f32
        } else {
            of_1_mm
        }
    }
}

/// A texture of straight colour and opacity of a step. [`Classifier::classify`] gives premultiplied colour and opacity of a
/// step in place of emission and extinction per mm.
#[derive(Debug, Clone)]
pub struct Texture<const DIMENSIONS: usize> {
    texels: Vec<[f32; 4]>,
    values: Texels,
    gradients: Texels,
    /// Summed-area table (Crow 1984): entry `(i, j)` counts the opaque texels with both indices below.
    lit_below: Vec<u32>,
}

/// One axis of a texture: `scale · x + offset` is the place of `x` among the texels, 0 at the middle of the first.
#[derive(Debug, Clone, Copy)]
struct Texels {
    count: usize,
    scale: f32,
    offset: f32,
}

impl Texels {
    /// Texels over a range of values, looked up by stored numbers, so that kernels never rescale one.
    fn new(count: usize, [low, high]: [f64; 2], rescale: Rescale) -> Self {
        // A range without width has all of its values in the first texel.
        let width = if high > low { high - low } else { 1.0 };
        let scale = count as f64 / width;
        Texels {
            count,
            scale: (scale * rescale.slope) as f32,
            offset: (scale * (rescale.intercept - low) - 0.5) as f32,
        }
    }

    /// The place of `x`, clamped to the middles of the outer texels.
    #[inline(always)]
    fn place(self, x: f32) -> f32 {
        (self.scale * x + self.offset).clamp(0.0, (self.count - 1) as f32)
    }

    /// The texel before a place, and the share of the one after it.
    #[inline(always)]
    fn split(self, x: f32) -> (usize, f32) {
        let place = self.place(x);
        let below = (place as usize).min(self.count.saturating_sub(2));
        (below, place - below as f32)
    }

    /// First and last texel that a range of `x` reads.
    fn read_by(self, [a, b]: [f32; 2]) -> [usize; 2] {
        let (a, b) = (self.place(a), self.place(b));
        [a.min(b).floor() as usize, a.max(b).ceil() as usize]
    }
}

impl<const DIMENSIONS: usize> Texture<DIMENSIONS> {
    /// The texture of a table for samples with this rescale.
    pub fn new(table: &Tabulated, rescale: Rescale, opacity: StepOpacity) -> Self {
        let texel = |&[r, g, b, extinction]: &[f64; 4]| [r as f32, g as f32, b as f32, opacity.of(extinction)];
        let texels: Vec<[f32; 4]> = table.entries.iter().map(texel).collect();
        let [width, height] = table.size;
        let lit_below = lit_below(&texels, width, height);
        Texture {
            texels,
            values: Texels::new(width, table.values, rescale),
            gradients: Texels::new(height, table.gradients_per_mm, Rescale::IDENTITY),
            lit_below,
        }
    }

    /// Whether no texel of these rectangles, ends included, is opaque to any degree.
    fn are_empty(&self, [i0, i1]: [usize; 2], [j0, j1]: [usize; 2]) -> bool {
        let at = |i: usize, j: usize| self.lit_below[i + j * (self.values.count + 1)];
        at(i1 + 1, j1 + 1) + at(i0, j0) == at(i0, j1 + 1) + at(i1 + 1, j0)
    }
}

fn lit_below(texels: &[[f32; 4]], width: usize, height: usize) -> Vec<u32> {
    let at = |i: usize, j: usize| i + j * (width + 1);
    let mut below = vec![0; (width + 1) * (height + 1)];
    for j in 0..height {
        for i in 0..width {
            let lit = u32::from(texels[i + j * width][3] > 0.0);
            below[at(i + 1, j + 1)] = below[at(i, j + 1)] + below[at(i + 1, j)] + lit - below[at(i, j)];
        }
    }
    below
}

impl<const DIMENSIONS: usize> Classifier<f32> for Texture<DIMENSIONS> {
    const READS_GRADIENT: bool = DIMENSIONS == 2;

    #[inline(always)]
    fn classify(&self, stored: f32, gradient_per_mm: f32) -> Rgbs<f32> {
        let (i, u) = self.values.split(stored);
        let row = |j: usize| {
            let texels = &self.texels[j * self.values.count + i..][..2];
            mix(texels[0], texels[1], u)
        };
        let [r, g, b, opacity] = if Self::READS_GRADIENT {
            let (j, w) = self.gradients.split(gradient_per_mm);
            mix(row(j), row(j + 1), w)
        } else {
            row(0)
        };
        [r * opacity, g * opacity, b * opacity, opacity]
    }

    fn is_empty(&self, stored: [f32; 2], gradient_per_mm: [f32; 2]) -> bool {
        let gradients = if Self::READS_GRADIENT { self.gradients.read_by(gradient_per_mm) } else { [0, 0] };
        self.are_empty(self.values.read_by(stored), gradients)
    }
}

#[inline(always)]
fn mix(a: [f32; 4], b: [f32; 4], u: f32) -> [f32; 4] {
    std::array::from_fn(|c| a[c] + u * (b[c] - a[c]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Tabulated {
        // Extinction 0, 1, 2, 3 at the values 0, 10, 20, 30; red where the value is low.
        let entries = [1.0, 0.75, 0.5, 0.25].iter().enumerate().map(|(i, &r)| [r, 0.0, 0.0, i as f64]).collect();
        Tabulated { size: [4, 1], values: [0.0, 30.0], gradients_per_mm: [0.0; 2], entries }
    }

    #[test]
    fn a_look_up_is_half_an_entry_off_at_the_ends() {
        let opacity = StepOpacity { step_mm: 1e-6, uncorrected: 0.0 };
        let rescale = Rescale { slope: 2.0, intercept: -10.0 };
        let texture = Texture::<1>::new(&ramp(), rescale, opacity);
        for (value, place) in [(-5.0, 0.0), (0.0, 0.0), (3.75, 0.0), (7.5, 0.5), (15.0, 1.5), (22.5, 2.5), (30.0, 3.0)]
        {
            let [_, _, _, found] = texture.classify(rescale.stored(value) as f32, 0.0);
            let expected = 1e-6 * place as f32;
            assert!((found - expected).abs() < 5e-12, "at {value}: found {found:e}, expected {expected:e}");
        }
        assert!(texture.is_empty([5.0, 6.8], [0.0; 2]), "stored 6.875 is the middle of the first texel");
        assert!(!texture.is_empty([5.0, 7.0], [0.0; 2]));
    }

    #[test]
    fn faint_opacities_are_left_uncorrected_where_that_is_wanted() {
        let vtk = StepOpacity { step_mm: 0.25, uncorrected: 1e-4 };
        assert_eq!(vtk.of(1e-5), -(-1e-5_f64).exp_m1() as f32, "that of 1 mm, for a quarter of it");
        let expected = -(-0.25_f64).exp_m1();
        assert!((f64::from(vtk.of(1.0)) - expected).abs() < 1e-7, "found {}, expected {expected}", vtk.of(1.0));
    }

    #[test]
    fn two_dimensions_are_bilinear() {
        let entries = vec![[1.0, 1.0, 1.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0, 1.0, 1.0, 50.0]];
        let table = Tabulated { size: [2, 2], values: [0.0, 2.0], gradients_per_mm: [0.0, 4.0], entries };
        let opacity = StepOpacity { step_mm: 1.0, uncorrected: 0.0 };
        let texture = Texture::<2>::new(&table, Rescale::IDENTITY, opacity);
        let at = |v: f32, g: f32| texture.classify(v, g)[3];
        assert_eq!([at(0.5, 1.0), at(1.5, 3.0), at(1.0, 3.0), at(1.0, 2.0)], [0.0, 1.0, 0.5, 0.25]);
        assert!(texture.is_empty([0.0, 2.0], [0.0, 0.9]) && !texture.is_empty([0.0, 2.0], [0.0, 1.1]));
    }
}
