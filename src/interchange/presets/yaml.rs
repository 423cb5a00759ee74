//! An imported preset as YAML, a point a line.

use super::import::{ColorNumbers, Imported};
use crate::spec::{PointSpec, Preset, ValuesName, Widget};

pub(super) fn text(imported: &Imported) -> String {
    let Preset { version, name, description, values, widgets, .. } = &imported.preset;
    let mut text = format!(
        "# Opacities of {} mm became extinction per mm. A slab of any length has the same opacity and colour within {:.1e}.\n",
        imported.unit_distance_mm, imported.max_deviation
    );
    if imported.colors == ColorNumbers::Light {
        text.push_str(
            "# Its colours are VTK's numbers taken for light, so what is rendered holds VTK's numbers, and no light.\n",
        );
    }
    if let Some(difference) = imported.whole_step_difference {
        text.push_str(&format!(
            "# Gradient opacity became a weight, VTK's limit for short steps; in steps of {} mm VTK's opacity is up to \
             {difference:.2} off it.\n",
            imported.unit_distance_mm
        ));
    }
    if let Some(phong) = imported.shading {
        text.push_str(&format!(
            "# It was shaded; a pipeline does that by\n#   effects: {{ shading: {{ ambient: {}, diffuse: {}, specular: {}, \
             shininess: {} }} }}\n",
            phong.ambient, phong.diffuse, phong.specular, phong.shininess
        ));
    }
    text.push_str(&format!("version: {version}\nname: {}\n", quoted(name)));
    if let Some(description) = description {
        text.push_str(&format!("description: {}\n", quoted(description)));
    }
    if *values == Some(ValuesName::Arbitrary) {
        text.push_str("values: arbitrary\n");
    }
    text.push_str("widgets:\n");
    widgets.iter().for_each(|widget| push_widget(&mut text, widget));
    text
}

fn push_widget(text: &mut String, widget: &Widget) {
    text.push_str("  - points:\n");
    for point in widget.points.iter().flatten() {
        let PointSpec { hu, extinction_per_mm, color, .. } = point;
        text.push_str(&format!("      - {{ hu: {hu}, extinction_per_mm: {}", extinction_per_mm.unwrap_or(0.0)));
        if let Some(color) = color {
            text.push_str(&format!(", color: {:?}", color.0));
        }
        text.push_str(" }\n");
    }
    if let Some(weight) = &widget.gradient_weight {
        text.push_str(&format!("    gradient_weight: {weight:?}\n"));
    }
}

/// What is a JSON string is one in YAML, whatever its characters.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
