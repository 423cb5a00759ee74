//! What the script reads, as JSON.

use serde_json::{Value, json};

use super::frame::Frame;
use crate::error::{Error, Fault, Result};
use crate::plan::{Plan, explain_json};
use crate::scene::{Background, Light, Model, Projection, Shading};
use crate::volume::Volume;

/// Camera, lights, grid and step; all lengths in mm, directions in LPS.
pub(super) fn json(volume: &Volume, plan: &Plan, frame: &Frame, step_mm: f64) -> Result<Value> {
    let scene = &plan.scene;
    if scene.model != Model::Light {
        return Err(Error::new(Fault::Unsupported, "only scenes of light are exported to VTK")
            .element("effects")
            .found("a projection or surfaces"));
    }
    let camera = &scene.camera;
    // VTK lights a parallel view from the camera's position, so that position must be far away.
    let distance_mm = match camera.projection() {
        Projection::Perspective { .. } => 0.0,
        Projection::Parallel { .. } => FAR * frame.spacing_mm.length() * largest(volume.grid().dims()),
    };
    let (projection, size_mm) = match camera.projection() {
        Projection::Perspective { fov_degrees } => ("perspective", fov_degrees),
        Projection::Parallel { height_mm } => ("parallel", height_mm),
    };
    let motion = frame.motion.matrix3;
    let origin = frame.motion.translation;
    let rows: Vec<[f64; 4]> =
        (0..3).map(|r| [motion.x_axis[r], motion.y_axis[r], motion.z_axis[r], origin[r]]).collect();
    let tf = &scene.transfer_function;
    Ok(json!({
        "pellucid": env!("CARGO_PKG_VERSION"),
        "spacing_mm": frame.spacing_mm.to_array(),
        "motion": rows,
        "step_mm": step_mm,
        "transfer_function": { "dimensions": if tf.reads_gradient() { 2 } else { 1 } },
        "camera": {
            "position_mm": (camera.position_mm() - distance_mm * camera.forward()).to_array(),
            "forward": camera.forward().to_array(),
            "up": camera.up().to_array(),
            "projection": projection,
            "fov_degrees_or_height_mm": size_mm,
            "size": camera.size()
        },
        "background": match scene.background {
            Background::Transparent => Value::Null,
            Background::Color(rgb) => json!(rgb),
        },
        "shading": scene.shading.as_ref().map(shading),
        "notes": notes(plan),
        "plan": explain_json(plan)
    }))
}

/// How far a parallel camera stands off, in diagonals of the volume.
const FAR: f64 = 1000.0;

fn largest(dims: [usize; 3]) -> f64 {
    dims.into_iter().max().unwrap_or(1) as f64
}

fn shading(shading: &Shading) -> Value {
    let lights = shading.lights.iter().map(|light| match light {
        Light::Headlight { color } => json!({ "towards": null, "color": color }),
        Light::Directional { towards, color } => json!({ "towards": towards.to_array(), "color": color }),
    });
    json!({
        "ambient": shading.ambient,
        "diffuse": shading.diffuse,
        "specular": shading.specular,
        "shininess": shading.shininess,
        "two_sided": shading.two_sided,
        "lights": lights.collect::<Vec<_>>()
    })
}

/// Where VTK cannot do what the scene says.
fn notes(plan: &Plan) -> Vec<String> {
    let mut notes = Vec::new();
    let Some(shading) = &plan.scene.shading else { return notes };
    let headlight_alone = matches!(shading.lights[..], [Light::Headlight { .. }]);
    if shading.specular > 0.0 {
        notes.push("VTK's highlight is Phong's, (r.v)^shininess; the scene's is Blinn's, (n.h)^shininess".to_string());
    }
    if shading.soft_gradient_per_mm > 0.0 {
        notes.push("VTK does not fade light out where the gradient vanishes".to_string());
    }
    if shading.ambient > 0.0 && !headlight_alone {
        notes.push("VTK leaves ambient light out unless a headlight is the only light".to_string());
    }
    notes
}
