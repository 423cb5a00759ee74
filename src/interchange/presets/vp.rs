//! `.vp`: Slicer's volume property as text, one value per line.
//!
//! Interpolation of voxels (0 nearest, 1 linear), shade, diffuse, ambient, specular, specular power; then three lists:
//! scalar opacity, gradient opacity, colour. It holds no unit distance, midpoint or sharpness.

use std::path::Path;

use super::function::{Function, Node};
use super::numbers::{counted, written};
use super::read::named_after;
use super::volume_property::{Phong, VolumeProperty};
use crate::error::{Error, Fault, Result, TextPlace};

const LINES: [&str; 9] = [
    "interpolation",
    "shade",
    "diffuse",
    "ambient",
    "specular",
    "specularPower",
    "scalarOpacity",
    "gradientOpacity",
    "colorTransfer",
];

pub(super) fn read(path: &Path, text: &str) -> Result<VolumeProperty> {
    let lines: Vec<(usize, &str)> =
        text.lines().map(str::trim).enumerate().filter(|(_, line)| !line.is_empty()).collect();
    if lines.len() != LINES.len() {
        return Err(Error::new(Fault::Input, "this is no volume property")
            .at(path)
            .found(format!("{} lines", lines.len()))
            .expected(format!("{}: {}", LINES.len(), LINES.join(", "))));
    }
    let at = |k: usize, error: Error| {
        let line = lines[k].0 + 1;
        let place = TextPlace { line, column: 1, span: None, text: text.to_owned() };
        error.at(path).element(LINES[k]).place(place)
    };
    let number = |k: usize| {
        let number = lines[k].1.parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0);
        let error = || Error::new(Fault::Input, "a line holds no number").found(lines[k].1).expected("a number");
        number.ok_or_else(|| at(k, error()))
    };
    let shade = number(1)? != 0.0;
    let [diffuse, ambient, specular, shininess] = [number(2)?, number(3)?, number(4)?, number(5)?];
    Ok(VolumeProperty {
        name: named_after(path),
        scalar_opacity: counted(lines[6].1).map_err(|error| at(6, error))?,
        gradient_opacity: Some(counted(lines[7].1).map_err(|error| at(7, error))?),
        color: counted(lines[8].1).map_err(|error| at(8, error))?,
        unit_distance_mm: None,
        shading: shade.then_some(Phong { ambient, diffuse, specular, shininess }),
    })
}

/// The text of a `.vp` file.
///
/// # Errors
/// `Fault::Unsupported` for points with a midpoint or a sharpness, which it cannot hold.
pub fn write(property: &VolumeProperty) -> Result<String> {
    let linear = |linear: bool| {
        let error = Error::new(Fault::Unsupported, "a .vp file holds straight lines between points only");
        if linear { Ok(()) } else { Err(error.remedy("write .vp.json")) }
    };
    linear(is_linear(&property.scalar_opacity) && is_linear(&property.color))?;
    linear(property.gradient_opacity.as_ref().is_none_or(is_linear))?;
    let shading = property.shading.unwrap_or(Phong { ambient: 0.1, diffuse: 0.9, specular: 0.2, shininess: 10.0 });
    let even = "4 0 1 255 1".to_owned();
    Ok(format!(
        "1\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}\n",
        u8::from(property.shading.is_some()),
        shading.diffuse,
        shading.ambient,
        shading.specular,
        shading.shininess,
        written(&property.scalar_opacity),
        property.gradient_opacity.as_ref().map_or(even, written),
        written(&property.color),
    ))
}

fn is_linear<const N: usize>(function: &Function<N>) -> bool {
    function.nodes().iter().all(|node| Node::linear(node.x, node.y) == *node)
}
