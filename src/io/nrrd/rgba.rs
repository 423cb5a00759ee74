//! Volumes of colours with an opacity: an axis of kind `RGBA-color` beside the three of space.

use super::elements::{Element, Elements};
use super::header::{Axis, Header};
use super::kind::Kind;
use crate::error::{Error, Fault, Result};
use crate::volume::Samples;

/// True for an axis along which red, green, blue and alpha lie.
pub(super) fn holds_components(axis: &Axis) -> bool {
    axis.kind == Some(Kind::Rgba)
}

/// True for an axis whose kind or size is that of colours, though not of colours with an opacity for sure.
pub(super) fn may_hold_components(axis: &Axis) -> bool {
    axis.kind.is_some_and(Kind::is_color) || matches!((axis.kind, axis.size), (Some(Kind::Vector) | None, 3 | 4))
}

/// The error for colours that do not say how opaque they are: what a ray would show of them is anyone's guess.
pub(super) fn without_opacity(header: &Header) -> Error {
    Error::new(Fault::Unsupported, "the colours have no opacity, or do not say that they have one")
        .element("kinds")
        .found(header.shape())
        .expected("an axis of 4 of kind RGBA-color: red, green, blue and alpha")
        .remedy("add an alpha to each voxel, the opacity of one voxel's length, and write the kind RGBA-color")
}

/// The samples of a header's colours, wherever in the order of axes their components lie; `None` for other headers.
///
/// # Errors
/// `Fault::Unsupported` for components that are not unsigned integers of 8 or 16 bits. The caller names the file.
pub(super) fn samples(header: &Header, elements: &Elements) -> Option<Result<Samples>> {
    let color = header.axes.iter().position(holds_components)?;
    // Elements from one component to the next, and from one run of voxels to the next.
    let stride: usize = header.axes[..color].iter().map(|axis| axis.size).product();
    Some(match elements {
        Elements::U8(values) => Ok(Samples::Rgba8(texels(values, stride))),
        Elements::U16(values) => Ok(Samples::Rgba16(texels(values, stride))),
        other => {
            Err(Error::new(Fault::Unsupported, "the components of the colours are of a type that is not read here")
                .element("type")
                .found(other.element_type().name())
                .expected("uint8 or uint16, from 0 to the largest number")
                .remedy("scale the components to 0 to 255 and store them as uint8"))
        }
    })
}

fn texels<T: Element + Copy>(values: &[T], stride: usize) -> Vec<[T; 4]> {
    let run = |run: &[T]| (0..stride).map(|i| std::array::from_fn(|c| run[i + c * stride])).collect::<Vec<_>>();
    values.chunks_exact(4 * stride).flat_map(run).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_lie_together_or_apart() {
        let together: Vec<u8> = (0..8).collect();
        assert_eq!(texels(&together, 1), [[0, 1, 2, 3], [4, 5, 6, 7]]);
        let apart = [0_u16, 4, 1, 5, 2, 6, 3, 7];
        assert_eq!(texels(&apart, 2), [[0, 1, 2, 3], [4, 5, 6, 7]]);
    }
}
