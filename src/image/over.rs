//! Porter and Duff's *over* (1984): layers composited into one picture.
//!
//! **Definition.** Layers `1 … N` from the front with associated colours `C_i = c_i α_i` make
//!
//! ```text
//! C = Σ_i C_i Π_{j<i} (1 − α_j),      α = 1 − Π_i (1 − α_i).
//! ```
//!
//! Both directions of compositing are this sum in another order of its products. They are computed in f64, and alpha by
//! what each layer adds to it, never as a difference from 1: so a thousand layers of opacity 1e-8 keep all their digits.

use super::Image;

/// Whether the colours of a picture are multiplied by its alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Association {
    /// They are not, as the PNG standard has it.
    #[default]
    Straight,
    /// They are, also called premultiplied: as encoded, the way programs do that hold 8 bits.
    Associated,
}

/// An associated colour and its alpha, linear.
type Rgba = [f64; 4];

/// A layer of straight colour with its colour associated.
pub fn associated([r, g, b, alpha]: Rgba) -> Rgba {
    [r * alpha, g * alpha, b * alpha, alpha]
}

/// A layer with its colour straight; black where nothing is.
pub fn straight([r, g, b, alpha]: Rgba) -> Rgba {
    if alpha > 0.0 { [r / alpha, g / alpha, b / alpha, alpha] } else { [0.0; 4] }
}

/// Associated layers, the first in front, composited front to back.
pub fn front_to_back(layers: impl IntoIterator<Item = Rgba>) -> Rgba {
    let mut pixel = Pixel::NOTHING;
    layers.into_iter().for_each(|layer| pixel.add_behind(layer));
    pixel.rgba
}

/// Associated layers, the last in front, composited back to front.
pub fn back_to_front(layers: impl IntoIterator<Item = Rgba>) -> Rgba {
    layers.into_iter().fold([0.0; 4], |behind, layer| {
        let kept = 1.0 - layer[3];
        std::array::from_fn(|c| layer[c] + kept * behind[c])
    })
}

/// Layers of straight colours, the first in front; the result is straight too. What `front_to_back` does to associated ones,
/// with a division per layer.
pub fn front_to_back_straight(layers: impl IntoIterator<Item = Rgba>) -> Rgba {
    let mut transmittance = 1.0;
    layers.into_iter().fold([0.0; 4], |front, [r, g, b, opacity]| {
        let (before, added) = (front[3], transmittance * opacity);
        transmittance -= added;
        let alpha = before + added;
        let blended = |front: f64, layer: f64| if alpha > 0.0 { (front * before + layer * added) / alpha } else { 0.0 };
        [blended(front[0], r), blended(front[1], g), blended(front[2], b), alpha]
    })
}

/// Pictures composited front to back, one at a time, so that two are held however many there are.
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    width: usize,
    height: usize,
    pixels: Vec<Pixel>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Pixel {
    rgba: Rgba,
    transmittance: f64,
}

impl Pixel {
    const NOTHING: Pixel = Pixel { rgba: [0.0; 4], transmittance: 1.0 };

    fn add_behind(&mut self, layer: Rgba) {
        for (sum, c) in self.rgba.iter_mut().zip(layer) {
            *sum += self.transmittance * c;
        }
        self.transmittance -= self.transmittance * layer[3];
    }
}

impl Stack {
    /// No layers yet.
    pub fn new(width: usize, height: usize) -> Self {
        Stack { width, height, pixels: vec![Pixel::NOTHING; width * height] }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Adds a picture behind all that were added before. Panics if it has another size.
    pub fn add_behind(&mut self, layer: &Image) {
        assert_eq!(self.size(), [layer.width(), layer.height()], "layers of one size");
        for (pixel, layer) in self.pixels.iter_mut().zip(layer.pixels()) {
            pixel.add_behind(layer.map(f64::from));
        }
    }

    /// The picture, over an even colour behind all layers if there is one; then it is opaque.
    pub fn image(&self, behind: Option<[f64; 3]>) -> Image {
        let pixel = |pixel: &Pixel| {
            let [r, g, b, alpha] = pixel.rgba;
            match behind {
                None => [r, g, b, alpha],
                Some(color) => {
                    let [br, bg, bb] = color.map(|c| pixel.transmittance * c);
                    [r + br, g + bg, b + bb, 1.0]
                }
            }
            .map(|x| x as f32)
        };
        Image::from_pixels(self.width, self.height, self.pixels.iter().map(pixel).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `count` layers of seeded colours with alphas from 1e-8 to 1, straight, evenly in the logarithm.
    fn layers(count: usize, seed: u64, thinnest: f64) -> Vec<Rgba> {
        let mut state = seed;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..count).map(|_| [unit(), unit(), unit(), thinnest.powf(unit())]).collect()
    }

    /// The definition, term by term: the products in logarithms, where no factor is lost.
    fn by_formula(straight: &[Rgba]) -> Rgba {
        let mut sum = [0.0; 4];
        for (i, &[r, g, b, alpha]) in straight.iter().enumerate() {
            let logarithm: f64 = straight[..i].iter().map(|layer| (-layer[3]).ln_1p()).sum();
            let seen = alpha * logarithm.exp();
            for (sum, c) in sum.iter_mut().zip([r, g, b, 1.0]) {
                *sum += seen * c;
            }
        }
        sum
    }

    fn apart(found: Rgba, expected: Rgba) -> f64 {
        let relative = |(x, e): (f64, f64)| if e == 0.0 { x.abs() } else { (x / e - 1.0).abs() };
        found.into_iter().zip(expected).map(relative).fold(0.0, |a, d| if d <= a { a } else { d })
    }

    #[test]
    fn both_directions_and_both_associations_are_the_formula() {
        for count in [1, 2, 10, 1000] {
            for thinnest in [0.5, 1e-3, 1e-8] {
                for seed in 0..5 {
                    let straight_layers = layers(count, seed, thinnest);
                    let expected = by_formula(&straight_layers);
                    let front = straight_layers.iter().map(|&layer| associated(layer));
                    for (name, found) in [
                        ("front to back", front_to_back(front.clone())),
                        ("back to front", back_to_front(front.rev())),
                        ("straight", associated(front_to_back_straight(straight_layers.iter().copied()))),
                    ] {
                        let apart = apart(found, expected);
                        assert!(apart < 1e-12, "{name}, {count} layers, {thinnest:e}: {apart:e} off, relatively");
                    }
                }
            }
        }
    }

    #[test]
    fn a_thousand_thin_layers_add_up() {
        for alpha in [1e-8_f64, 1e-15] {
            let thin = vec![[0.25 * alpha, 0.0, 0.0, alpha]; 1000];
            let expected = -(1000.0 * (-alpha).ln_1p()).exp_m1();
            let expected = [0.25 * expected, 0.0, 0.0, expected];
            let (front, back) = (front_to_back(thin.clone()), back_to_front(thin));
            assert!(apart(front, expected) < 1e-13, "front to back: found {front:?}, expected {expected:?}");
            assert!(apart(back, expected) < 1e-13, "back to front: found {back:?}, expected {expected:?}");
        }
    }

    #[test]
    fn an_opaque_layer_hides_what_is_behind_and_a_transparent_one_nothing() {
        let (red, none, blue) = ([0.5, 0.0, 0.0, 0.5], [0.0; 4], [0.0, 0.0, 1.0, 1.0]);
        let expected = [0.5, 0.0, 0.5, 1.0];
        assert_eq!(front_to_back([red, none, blue, red]), expected);
        assert_eq!(back_to_front([red, blue, none, red]), expected);
        assert_eq!(straight(red), [1.0, 0.0, 0.0, 0.5]);
        assert_eq!(straight(none), none, "nothing has no colour");
    }

    #[test]
    fn the_comparison_sees_layers_in_the_wrong_order() {
        let mut shuffled = layers(10, 3, 0.5);
        let expected = by_formula(&shuffled);
        shuffled.swap(2, 3);
        assert!(apart(by_formula(&shuffled), expected) > 1e-3, "the order of layers matters");
        assert!(apart([f64::NAN; 4], expected).is_nan() || apart([f64::NAN; 4], expected) > 1e300, "nor is NaN near");
    }

    #[test]
    fn a_stack_of_pictures_is_composited_pixel_by_pixel() {
        let (front, back) = ([[0.25, 0.0, 0.0, 0.5], [0.0; 4]], [[0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 0.5, 0.5]]);
        let mut stack = Stack::new(2, 1);
        for layer in [front, back] {
            stack.add_behind(&Image::from_pixels(2, 1, layer.to_vec()));
        }
        assert_eq!(stack.image(None).pixels(), [[0.25, 0.5, 0.0, 1.0], [0.0, 0.0, 0.5, 0.5]]);
        assert_eq!(stack.image(Some([1.0; 3])).pixels(), [[0.25, 0.5, 0.0, 1.0], [0.5, 0.5, 1.0, 1.0]]);
    }
}
