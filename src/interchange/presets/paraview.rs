//! ParaView's JSON colour maps: a list of `Name`, `ColorSpace`, `RGBPoints` and, where opacity was saved, `Points`.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::function::{Function, Node};
use super::read::{named_after, syntax_error};
use super::volume_property::VolumeProperty;
use crate::error::{Error, Fault, Result};

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "PascalCase")]
struct ColorMap {
    #[serde(default)]
    name: Option<String>,
    #[serde(default)]
    color_space: Option<String>,
    /// x, r, g, b of each point.
    #[serde(rename = "RGBPoints", default)]
    rgb_points: Option<Vec<f64>>,
    /// x, opacity, midpoint, sharpness of each point.
    #[serde(default)]
    points: Option<Vec<f64>>,
}

pub(super) fn read(path: &Path, text: &str) -> Result<Vec<VolumeProperty>> {
    let tree: Value = serde_json::from_str(text).map_err(|error| syntax_error(path, text, error))?;
    // One map may stand there without the list around it.
    let maps: Vec<ColorMap> = match tree {
        Value::Array(_) => serde_json::from_str(text),
        _ => serde_json::from_str(text).map(|map| vec![map]),
    }
    .map_err(|error| syntax_error(path, text, error))?;
    if maps.is_empty() {
        return Err(Error::new(Fault::Input, "there is no colour map in this file").at(path));
    }
    let property = |(k, map)| understood(map, path).map_err(|error| error.at(path).element(element(k, map)));
    maps.iter().enumerate().map(property).collect()
}

fn element(k: usize, map: &ColorMap) -> String {
    map.name.clone().unwrap_or_else(|| format!("colour map {}", k + 1))
}

fn understood(map: &ColorMap, path: &Path) -> Result<VolumeProperty> {
    let steps = match map.color_space.as_deref().unwrap_or("RGB") {
        "RGB" => 0.0,
        "Step" => 1.0,
        other => {
            return Err(Error::new(Fault::Unsupported, "colours between points are not straight lines in RGB")
                .found(format!("ColorSpace {other}"))
                .expected("RGB or Step")
                .remedy("set the colour space to RGB in ParaView's editor, which adds no points, and save it again"));
        }
    };
    let flat = |list: &Option<Vec<f64>>, name: &str, remedy: &str| {
        let list = list
            .clone()
            .filter(|list| !list.is_empty())
            .ok_or_else(|| Error::new(Fault::Input, "the colour map is not whole").expected(name).remedy(remedy))?;
        if list.len() % 4 == 0 {
            return Ok(list);
        }
        let error = Error::new(Fault::Input, format!("{name} end within a point"));
        Err(error.found(format!("{} numbers", list.len())).expected("a multiple of 4"))
    };
    let colors = flat(&map.rgb_points, "RGBPoints", "save a colour map with control points, not one of categories")?;
    let opacities = flat(&map.points, "Points", "save it with its opacity function, or add Points to the file")?;
    let color = colors.chunks_exact(4).map(|p| Node { sharpness: steps, ..Node::linear(p[0], [p[1], p[2], p[3]]) });
    let opacity = opacities.chunks_exact(4).map(|p| Node { x: p[0], y: [p[1]], midpoint: p[2], sharpness: p[3] });
    Ok(VolumeProperty {
        name: map.name.clone().unwrap_or_else(|| named_after(path)),
        scalar_opacity: Function::new(opacity.collect())?,
        gradient_opacity: None,
        color: Function::new(color.collect())?,
        unit_distance_mm: None,
        shading: None,
    })
}

/// The text of a JSON colour map with opacity. Gradient opacity and shading have no place in it.
///
/// # Errors
/// `Fault::Unsupported` for colours that are not straight lines in RGB; `Fault::Internal` if there is no JSON form.
pub fn write(property: &VolumeProperty) -> Result<String> {
    let colors = property.color.nodes();
    if colors.iter().any(|node| Node::linear(node.x, node.y) != *node) {
        return Err(Error::new(Fault::Unsupported, "a ParaView colour map has straight lines between its colours"));
    }
    let map = ColorMap {
        name: Some(property.name.clone()),
        color_space: Some("RGB".to_owned()),
        rgb_points: Some(colors.iter().flat_map(|n| [n.x, n.y[0], n.y[1], n.y[2]]).collect()),
        points: Some(
            property.scalar_opacity.nodes().iter().flat_map(|n| [n.x, n.y[0], n.midpoint, n.sharpness]).collect(),
        ),
    };
    let text = serde_json::to_string_pretty(&[map]);
    text.map_err(|cause| Error::new(Fault::Internal, "the colour map has no JSON form").caused_by(cause))
}
