//! Refinement of the picture: windows whose size doubles, each upsampled to the next.

use super::Integrator;
use super::manufactured::{sampled, smooth, trilinear, window};
use super::report::{Check, Expected};
use crate::error::Result;

/// Sides of the windows, pixels.
const SIZES: [usize; 5] = [8, 16, 32, 64, 128];

/// The order in the pixel's size with both ways of upsampling. The second finds pixels whose rays miss their centres.
///
/// # Errors
/// Whatever the integrator says.
pub fn checks(name: &str, integrator: &Integrator<'_>) -> Result<Vec<Check>> {
    let volume = sampled(trilinear, 2)?;
    let picture = |size: usize| integrator(&volume, &window(smooth()?, size)?, 0.0);
    let pictures = SIZES.into_iter().map(picture).collect::<Result<Vec<_>>>()?;
    let series = |upsampled: Upsampling| -> Vec<[f64; 2]> {
        let pairs = SIZES.iter().zip(pictures.windows(2));
        pairs.map(|(&size, pair)| [1.0 / size as f64, difference(&pair[0], &pair[1], size, upsampled)]).collect()
    };
    Ok(vec![
        Check::order(name, "order in the pixel, nearest", Expected::order(1.0, 0.2), series(nearest)),
        Check::order(name, "order in the pixel, bilinear", Expected::order(2.0, 0.25), series(bilinear)),
    ])
}

/// A pixel of a picture twice as wide: from the picture, its side, and the place in the wide one.
type Upsampling = fn(&[[f64; 4]], usize, [usize; 2]) -> [f64; 4];

fn nearest(picture: &[[f64; 4]], size: usize, [column, row]: [usize; 2]) -> [f64; 4] {
    picture[row / 2 * size + column / 2]
}

/// Centres of the wide picture lie a quarter of a pixel from those of the other.
fn bilinear(picture: &[[f64; 4]], size: usize, place: [usize; 2]) -> [f64; 4] {
    let [x, y] = place.map(|p| (p as f64 - 0.5) / 2.0);
    let (column, row) = (x as usize, y as usize);
    let (u, v) = (x - column as f64, y - row as f64);
    let at = |c: usize, r: usize| picture[r * size + c];
    std::array::from_fn(|channel| {
        let across = |r: usize| (1.0 - u) * at(column, r)[channel] + u * at(column + 1, r)[channel];
        (1.0 - v) * across(row) + v * across(row + 1)
    })
}

/// Largest difference between a picture and one twice as wide, but for the outermost pixels, which have no neighbours.
fn difference(coarse: &[[f64; 4]], fine: &[[f64; 4]], size: usize, upsampled: Upsampling) -> f64 {
    let inner = 1..2 * size - 1;
    let places = inner.clone().flat_map(|row| inner.clone().map(move |column| [column, row]));
    let apart = |[column, row]: [usize; 2]| {
        let (found, expected) = (upsampled(coarse, size, [column, row]), fine[row * 2 * size + column]);
        super::largest_difference(&[found], &[expected])
    };
    places.map(apart).fold(0.0, f64::max)
}
