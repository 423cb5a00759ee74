//! Pictures: linear, premultiplied RGBA in f32 until they are encoded.

mod color_space;
pub mod figure;
pub mod metrics;
pub mod over;
mod plane;
pub mod srgb;

/// A picture in memory: linear RGB premultiplied by alpha, f32, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 4]>,
}

impl Image {
    /// A picture of transparent black.
    pub fn transparent(width: usize, height: usize) -> Self {
        Image { width, height, pixels: vec![[0.0; 4]; width * height] }
    }

    /// A picture of these pixels, row by row from the top left. Panics if their number is not `width · height`.
    pub fn from_pixels(width: usize, height: usize, pixels: Vec<[f32; 4]>) -> Self {
        assert_eq!(pixels.len(), width * height, "{width} x {height} pixels");
        Image { width, height, pixels }
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row from the top left.
    pub fn pixels(&self) -> &[[f32; 4]] {
        &self.pixels
    }

    /// All pixels, to be written.
    pub fn pixels_mut(&mut self) -> &mut [[f32; 4]] {
        &mut self.pixels
    }

    /// The pixel at a column and row from the top left.
    pub fn pixel(&self, column: usize, row: usize) -> [f32; 4] {
        assert!(column < self.width, "column {column} of {}", self.width);
        self.pixels[row * self.width + column]
    }
}
