//! Every pixel by the oracle.

use rayon::prelude::*;

use super::{Frame, Rendered, Statistics};
use crate::image::Image;
use crate::oracle::Oracle;

/// Renders by the oracle, rounded to f32 at the end.
pub(super) fn render(frame: &Frame<'_>) -> Rendered {
    let [width, height] = frame.scene.camera.size();
    let pixels = Oracle::new(frame.volume, frame.scene).render(frame.progress);
    let pixels = pixels.into_par_iter().map(|p| p.map(|x| x as f32)).collect();
    let image = Image::from_pixels(width, height, pixels);
    let rays = (width * height) as u64;
    Rendered {
        image,
        statistics: Statistics { samples: 0, error_bound: None, bound: None, rays, kernel: "reference/f64".into() },
    }
}
