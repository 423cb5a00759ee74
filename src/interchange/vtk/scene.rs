//! What the script reads, as JSON.

use serde_json::{Value, json};

use super::frame::Frame;
use crate::error::{Error, Fault, Result};
use crate::plan::{Crop, Plan, plan_json};
use crate::scene::{Background, ClassifyAt, HalfSpace, Light, Model, Projection, Scene, Shading, ValueOf};
use crate::volume::Volume;

/// Camera, lights, grid and step; all lengths in mm, directions in LPS.
pub(super) fn json(volume: &Volume, plan: &Plan, frame: &Frame, step_mm: f64, blend: Value) -> Result<Value> {
    let scene = &plan.scene;
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
    let crop = Crop::new(scene, volume.grid());
    if crop.planes.half_spaces.len() > MOST_PLANES {
        return Err(Error::new(Fault::Unsupported, "VTK's mapper has eight clipping planes")
            .element("effects.clip")
            .found(format!("{} planes", crop.planes.half_spaces.len())));
    }
    Ok(json!({
        "pellucid": env!("CARGO_PKG_VERSION"),
        "spacing_mm": frame.spacing_mm.to_array(),
        "motion": rows,
        "step_mm": step_mm,
        "blend": blend,
        "crop_voxels": crop.is_cropped().then(|| crop_voxels(&crop, frame, volume.grid().dims())),
        "clipping_planes": crop.planes.half_spaces.iter().map(plane).collect::<Vec<_>>(),
        "transfer_function": { "dimensions": if reads_gradient(scene) { 2 } else { 1 } },
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
        "plan": plan_json(plan)
    }))
}

/// Clipping planes that VTK's mapper looks at.
const MOST_PLANES: usize = 8;

/// The box that is left, `[[low, high]; 3]`; well outside the volume where nothing is cut off.
fn crop_voxels(crop: &Crop, frame: &Frame, dims: [usize; 3]) -> Value {
    let within = |axis: usize| {
        let [low, high] = frame.range(axis, crop.ranges[axis]);
        let voxels = dims[axis] as f64;
        [low.max(-voxels), high.min(2.0 * voxels)]
    };
    json!([within(0), within(1), within(2)])
}

/// A point of the plane, and the direction of what is shown.
fn plane(half_space: &HalfSpace) -> Value {
    let HalfSpace { normal, offset_mm } = half_space;
    let point = *normal * (offset_mm / normal.length_squared());
    json!({ "point_mm": point.to_array(), "normal": normal.normalize().to_array() })
}

/// Whether VTK is given gradient magnitudes.
pub(super) fn reads_gradient(scene: &Scene) -> bool {
    scene.model == Model::Light && scene.transfer_function.reads_gradient()
}

/// Refuses what VTK has no equal of.
pub(super) fn check(volume: &Volume, scene: &Scene) -> Result<()> {
    let effects = &scene.effects;
    let refused = [
        ("volume", "colours in place of values", volume.samples().are_rgba()),
        ("volume", "slices at uneven distances", volume.slices().is_some()),
        ("effects", "a depth cue, shadows, scattering, fog or haze", effects.change_light()),
        ("effects.mask", "a mask", effects.mask.is_some()),
        ("effects.classify", "classification at the voxels", effects.classify == ClassifyAt::Voxels),
    ];
    match refused.into_iter().find(|(.., is)| *is) {
        None => Ok(()),
        Some((element, found, _)) => Err(Error::new(Fault::Unsupported, "the exported scene cannot hold this")
            .element(element)
            .found(found)
            .remedy("leave it out to hold the rest against VTK")),
    }
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
    let Scene { model, effects, .. } = &plan.scene;
    if !effects.clip.half_spaces.is_empty() {
        notes.push("VTK's cut faces are off by up to a step, and cropping by up to half a voxel".to_string());
    }
    if matches!(model, Model::Surfaces(_)) {
        notes.push("VTK shows a surface at the first sample behind it, and one at a time".to_string());
    }
    if matches!(model, Model::Value(of) if matches!(of.of, ValueOf::Mean | ValueOf::Sum)) {
        notes.push(
            "VTK's average and sum have no window: the script applies it, and a window shows them raw".to_string(),
        );
    }
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
