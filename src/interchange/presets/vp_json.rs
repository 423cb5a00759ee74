//! `.vp.json`: Slicer's volume property as JSON, version 1.0.0 of its schema.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::function::{Function, Node};
use super::read::{named_after, syntax_error};
use super::volume_property::{Phong, VolumeProperty};
use crate::error::{Error, Fault, Result};

/// The version of the schema that is written.
const SCHEMA: &str = "https://raw.githubusercontent.com/Slicer/Slicer/main/Modules/Loadable/VolumeRendering/Resources/Schema/volume-property-schema-v1.0.0.json#";

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct File {
    #[serde(rename = "@schema", default)]
    schema: String,
    volume_properties: Vec<Property>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Property {
    #[serde(skip_serializing_if = "Option::is_none")]
    effective_range: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    interpolation_type: Option<String>,
    components: Vec<Component>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Component {
    #[serde(default)]
    shade: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    lighting: Option<Lighting>,
    #[serde(default)]
    disable_gradient_opacity: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    scalar_opacity_unit_distance: Option<f64>,
    scalar_opacity: Points,
    #[serde(skip_serializing_if = "Option::is_none")]
    gradient_opacity: Option<Points>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rgb_transfer_function: Option<Points>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gray_transfer_function: Option<Points>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Lighting {
    ambient: f64,
    diffuse: f64,
    specular: f64,
    specular_power: f64,
}

#[derive(Serialize, Deserialize)]
struct Points {
    #[serde(rename = "type", skip_serializing_if = "Option::is_none")]
    kind: Option<String>,
    points: Vec<Point>,
}

#[derive(Serialize, Deserialize)]
struct Point {
    x: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    y: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    color: Option<[f64; 3]>,
    #[serde(default = "half")]
    midpoint: f64,
    #[serde(default)]
    sharpness: f64,
}

fn half() -> f64 {
    0.5
}

pub(super) fn read(path: &Path, text: &str) -> Result<Vec<VolumeProperty>> {
    let file: File = serde_json::from_str(text).map_err(|error| syntax_error(path, text, error))?;
    let several = file.volume_properties.len() > 1;
    let property = |(k, property): (usize, &Property)| {
        let number = if several { format!("-{}", k + 1) } else { String::new() };
        let element = format!("volumeProperties.{k}");
        understood(property, named_after(path) + &number, &element).map_err(|error| error.at(path))
    };
    let properties = file.volume_properties.iter().enumerate().map(property).collect::<Result<Vec<_>>>()?;
    if properties.is_empty() {
        let error = Error::new(Fault::Input, "there is no volume property in this file").at(path);
        return Err(error.element("volumeProperties").expected("at least one"));
    }
    Ok(properties)
}

fn understood(property: &Property, name: String, element: &str) -> Result<VolumeProperty> {
    let [component] = property.components.as_slice() else {
        return Err(Error::new(Fault::Unsupported, "a volume property of several components is not a preset")
            .element(format!("{element}.components"))
            .found(property.components.len().to_string())
            .expected("1"));
    };
    let element = format!("{element}.components.0");
    let color = match (&component.rgb_transfer_function, &component.gray_transfer_function) {
        (Some(rgb), _) => function(rgb, &format!("{element}.rgbTransferFunction"), |point| point.color),
        (None, Some(gray)) => function(gray, &format!("{element}.grayTransferFunction"), |p| p.y.map(|y| [y; 3])),
        (None, None) => {
            let error = Error::new(Fault::Input, "the volume property has no colours").element(&element);
            Err(error.expected("rgbTransferFunction or grayTransferFunction"))
        }
    };
    let opacity = |points: &Points, key: &str| function(points, &format!("{element}.{key}"), |p| p.y.map(|y| [y]));
    let gradient = component.gradient_opacity.as_ref().filter(|_| !component.disable_gradient_opacity);
    let lighting = component.lighting.as_ref().filter(|_| component.shade);
    Ok(VolumeProperty {
        name,
        scalar_opacity: opacity(&component.scalar_opacity, "scalarOpacity")?,
        gradient_opacity: gradient.map(|points| opacity(points, "gradientOpacity")).transpose()?,
        color: color?,
        unit_distance_mm: component.scalar_opacity_unit_distance,
        shading: lighting.map(|lighting| Phong {
            ambient: lighting.ambient,
            diffuse: lighting.diffuse,
            specular: lighting.specular,
            shininess: lighting.specular_power,
        }),
    })
}

fn function<const N: usize>(
    points: &Points,
    element: &str,
    y: impl Fn(&Point) -> Option<[f64; N]>,
) -> Result<Function<N>> {
    let node = |(i, point): (usize, &Point)| {
        let missing = || {
            let error = Error::new(Fault::Input, "a point has no value").element(format!("{element}.points.{i}"));
            error.expected(if N == 3 { "color or y" } else { "y" })
        };
        let Point { x, midpoint, sharpness, .. } = *point;
        Ok(Node { x, y: y(point).ok_or_else(missing)?, midpoint, sharpness })
    };
    let nodes = points.points.iter().enumerate().map(node).collect::<Result<Vec<_>>>()?;
    Function::new(nodes).map_err(|error| error.element(format!("{element}.points")))
}

/// The text of a `.vp.json` file.
///
/// # Errors
/// `Fault::Internal` if it has no JSON form, which numbers that are finite have.
pub fn write(property: &VolumeProperty) -> Result<String> {
    let nodes = property.scalar_opacity.nodes();
    let component = Component {
        shade: property.shading.is_some(),
        lighting: property.shading.map(|phong| Lighting {
            ambient: phong.ambient,
            diffuse: phong.diffuse,
            specular: phong.specular,
            specular_power: phong.shininess,
        }),
        disable_gradient_opacity: property.gradient_opacity.is_none(),
        scalar_opacity_unit_distance: Some(property.unit_distance_mm.unwrap_or(1.0)),
        scalar_opacity: points(&property.scalar_opacity, |[y]| (Some(y), None)),
        gradient_opacity: property.gradient_opacity.as_ref().map(|f| points(f, |[y]| (Some(y), None))),
        rgb_transfer_function: Some(points(&property.color, |color| (None, Some(color)))),
        gray_transfer_function: None,
    };
    let file = File {
        schema: SCHEMA.to_owned(),
        volume_properties: vec![Property {
            effective_range: Some([nodes[0].x, nodes[nodes.len() - 1].x]),
            interpolation_type: Some("linear".to_owned()),
            components: vec![component],
        }],
    };
    let text = serde_json::to_string_pretty(&file);
    text.map_err(|cause| Error::new(Fault::Internal, "the volume property has no JSON form").caused_by(cause))
}

fn points<const N: usize>(
    function: &Function<N>,
    parts: impl Fn([f64; N]) -> (Option<f64>, Option<[f64; 3]>),
) -> Points {
    let kind = if N == 3 { "colorTransferFunction" } else { "piecewiseLinearFunction" };
    let point = |node: &Node<N>| {
        let (y, color) = parts(node.y);
        Point { x: node.x, y, color, midpoint: node.midpoint, sharpness: node.sharpness }
    };
    Points { kind: Some(kind.to_owned()), points: function.nodes().iter().map(point).collect() }
}
