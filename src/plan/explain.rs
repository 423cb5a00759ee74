//! A plan in words, and as JSON.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::scene::{Background, Camera, ClassifyAt, Clip, HalfSpace, Light, Model, Projection, Shading};
use crate::volume::{ColorEncoding, RgbaEncoding};

use super::{Plan, effects};

/// The plan in words: what is computed in order with its memory, from where, what is not computed and why, warnings.
pub fn explain(plan: &Plan) -> String {
    let mut text = String::new();
    let width = plan.stages.iter().map(|stage| stage.what.len()).max().unwrap_or(0);
    for stage in &plan.stages {
        line(&mut text, stage.name, &format!("{:width$}  {:>9}", stage.what, bytes(stage.bytes)));
    }
    let (when, most) = plan.peak();
    line(&mut text, "memory", &format!("{} at peak, while {when}", bytes(most)));
    line(&mut text, "work", &plan.work().describe());
    if let Some(chosen) = &plan.chosen {
        line(&mut text, "chosen", &chosen.because);
    }
    text.push('\n');
    if !plan.layers.is_empty() {
        line(&mut text, "layers", &layer_names(plan));
    }
    match (&plan.scene.model, &plan.scene.shading) {
        (Model::Value(_), _) => {}
        (Model::Surfaces(_), None) => line(&mut text, "light", "none: the surfaces' own colours"),
        (_, shading) => line(&mut text, "light", &describe_shading(shading.as_ref())),
    }
    let effects = effects::in_words(&plan.scene.effects);
    if !effects.is_empty() {
        line(&mut text, "effects", &effects.join(", "));
    }
    if let Some(clip) = describe_clip(&plan.scene.effects.clip) {
        line(&mut text, "clip", &clip);
    }
    line(&mut text, "behind", &describe_background(plan.scene.background));
    line(&mut text, "camera", &describe_camera(&plan.scene.camera));
    let [view, views] = plan.view;
    if views > 1 {
        line(&mut text, "view", &format!("{} of {views} with one set-up", view + 1));
    }
    line(&mut text, "output", &plan.output.path.display().to_string());
    if !plan.not_computed.is_empty() {
        text.push_str("\nnot computed\n");
        for omission in &plan.not_computed {
            let _ = writeln!(text, "  {:21} {}", omission.what, omission.why);
        }
    }
    if !plan.warnings.is_empty() {
        text.push_str("\nwarnings\n");
        for warning in &plan.warnings {
            let _ = writeln!(text, "  {warning}");
        }
    }
    text
}

fn layer_names(plan: &Plan) -> String {
    plan.layers.iter().map(|layer| layer.name.as_str()).collect::<Vec<_>>().join(" + ")
}

// Writing to a string cannot fail.
fn line(text: &mut String, label: &str, content: &str) {
    let _ = writeln!(text, "{label:10} {}", content.trim_end());
}

fn bytes(count: u64) -> String {
    match count {
        0 => "-".to_owned(),
        1..1_000 => format!("{count} B"),
        1_000..1_000_000 => format!("{:.1} kB", count as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", count as f64 / 1e6),
        _ => format!("{:.1} GB", count as f64 / 1e9),
    }
}

fn describe_shading(shading: Option<&Shading>) -> String {
    let Some(s) = shading else { return "none: emission and absorption alone".to_owned() };
    let sides = if s.two_sided { "two-sided" } else { "one-sided" };
    format!(
        "ambient {}, diffuse {}, specular {} with exponent {}, {sides}, half strength at {} HU/mm, {}",
        s.ambient,
        s.diffuse,
        s.specular,
        s.shininess,
        s.soft_gradient_per_mm,
        s.lights.iter().map(describe_light).collect::<Vec<_>>().join(" and ")
    )
}

/// `None` if nothing is cut off.
fn describe_clip(clip: &Clip) -> Option<String> {
    let side = |h: &HalfSpace| format!("x . {} >= {:.2} mm", vector(h.normal.to_array(), 3), h.offset_mm);
    let sides: Vec<String> = clip.half_spaces.iter().map(side).collect();
    (!sides.is_empty()).then(|| format!("points x with {}", sides.join(", ")))
}

fn describe_light(light: &Light) -> String {
    match light {
        Light::Headlight { .. } => "headlight".to_owned(),
        Light::Directional { towards, .. } => format!("light from {}", vector(towards.to_array(), 2)),
    }
}

fn describe_background(background: Background) -> String {
    match background {
        Background::Transparent => "nothing: the picture keeps its alpha".to_owned(),
        Background::Color(rgb) => format!("linear RGB {}", vector(rgb, 3)),
    }
}

fn describe_camera(camera: &Camera) -> String {
    let [width, height] = camera.size();
    let projection = match camera.projection() {
        Projection::Perspective { fov_degrees } => format!("perspective of {fov_degrees:.2} degrees"),
        Projection::Parallel { height_mm } => format!("parallel, {height_mm:.1} mm high"),
    };
    format!(
        "at {} mm LPS, looking along {}, up {}, {projection}, {width} x {height} pixels",
        vector(camera.position_mm().to_array(), 1),
        vector(camera.forward().to_array(), 2),
        vector(camera.up().to_array(), 2)
    )
}

/// Without the sign of a rounded zero.
fn vector(v: [f64; 3], digits: usize) -> String {
    let numbers = v.map(|x| {
        let text = format!("{x:.digits$}");
        if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) {
            text.trim_start_matches('-').to_owned()
        } else {
            text
        }
    });
    format!("({})", numbers.join(", "))
}

/// The same as JSON, with all numbers in full.
pub fn explain_json(plan: &Plan) -> Value {
    let mut json = plan_json(plan);
    json["work"] = json!(plan.work());
    json
}

/// The same without an estimate of the work, for those who know it or need not: to estimate it, rays are looked at.
pub fn plan_json(plan: &Plan) -> Value {
    let camera = &plan.scene.camera;
    let projection = match camera.projection() {
        Projection::Perspective { fov_degrees } => json!({ "perspective": { "fov_degrees": fov_degrees } }),
        Projection::Parallel { height_mm } => json!({ "parallel": { "height_mm": height_mm } }),
    };
    let layers = plan.layers.iter().map(|layer| {
        json!({
            "name": layer.name,
            "tissue": layer.tissue,
            "terms": layer.terms.len(),
            "max_deviation": layer.max_deviation
        })
    });
    let tf = &plan.scene.transfer_function;
    json!({
        "stages": plan.stages,
        "memory_bytes": plan.memory_bytes(),
        "memory_peak_while": plan.peak().0,
        "colors": plan.colors.map(|RgbaEncoding { opacity_length_mm, color }| json!({
            "opacity_length_mm": opacity_length_mm,
            "encoding": match color {
                ColorEncoding::Srgb => "srgb",
                ColorEncoding::Linear => "linear",
            }
        })),
        "classify": match plan.scene.effects.classify {
            ClassifyAt::Samples => "samples",
            ClassifyAt::Voxels => "voxels",
        },
        "transfer_function": {
            "window": tf.window(),
            "gradient_range_per_mm": tf.gradient_range_per_mm(),
            "layers": layers.collect::<Vec<_>>()
        },
        "shading": plan.scene.shading.as_ref().map(shading_json),
        "clip": plan.scene.effects.clip.half_spaces.iter().map(half_space_json).collect::<Vec<_>>(),
        "effects": effects::effects_json(&plan.scene.effects),
        "mask": plan.label_classes.as_ref().map(|classes| classes.description.as_str()),
        "background": match plan.scene.background {
            Background::Transparent => json!("transparent"),
            Background::Color(rgb) => json!(rgb),
        },
        "camera": {
            "position_mm": camera.position_mm().to_array(),
            "forward": camera.forward().to_array(),
            "right": camera.right().to_array(),
            "up": camera.up().to_array(),
            "projection": projection,
            "size": camera.size()
        },
        "method": plan.method,
        "bound": plan.bound(),
        "chosen_because": plan.chosen.as_ref().map(|chosen| chosen.because.as_str()),
        "certify": plan.certify,
        "view": plan.view,
        "output": { "path": plan.output.path, "format": plan.output.format },
        "not_computed": plan.not_computed,
        "warnings": plan.warnings
    })
}

fn half_space_json(half_space: &HalfSpace) -> Value {
    json!({ "normal": half_space.normal.to_array(), "offset_mm": half_space.offset_mm })
}

fn shading_json(shading: &Shading) -> Value {
    let lights = shading.lights.iter().map(|light| match light {
        Light::Headlight { color } => json!({ "headlight": { "color": color } }),
        Light::Directional { towards, color } => {
            json!({ "directional": { "towards": towards.to_array(), "color": color } })
        }
    });
    json!({
        "ambient": shading.ambient,
        "diffuse": shading.diffuse,
        "specular": shading.specular,
        "shininess": shading.shininess,
        "two_sided": shading.two_sided,
        "soft_gradient_hu_per_mm": shading.soft_gradient_per_mm,
        "lights": lights.collect::<Vec<_>>()
    })
}
