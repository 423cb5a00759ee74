//! Export: a preset without its gradient axis.

use std::path::Path;

use pellucid::interchange::presets::{ProjectSettings, Projection, project, write_paraview, write_vp, write_vp_json};
use pellucid::spec::{BUILT_IN_PRESETS, built_in_preset, parse_preset};

use super::{difference, imported, read_text, slab, transfer_function};

fn projected(text: &str, settings: &ProjectSettings) -> pellucid::Result<Projection> {
    let text = format!("version: 1\nname: p\nwidgets:\n{text}");
    project(&parse_preset(&text, Path::new("p.yaml")).unwrap_or_else(|error| panic!("{error}")).preset, settings)
}

#[test]
fn a_preset_over_the_value_alone_loses_nothing() {
    let widgets = "  - { trapezoid: { hu: [100, 200, 300, 500] }, opacity_per_mm: 0.9, color: orange }\n\
                   \x20 - { rectangle: { hu: [250, 600] }, extinction_per_mm: 0.2, color: blue }\n";
    let text = format!("version: 1\nname: p\nwidgets:\n{widgets}");
    let preset = parse_preset(&text, Path::new("p.yaml")).unwrap_or_else(|error| panic!("{error}")).preset;
    let projection = project(&preset, &ProjectSettings::default()).unwrap();
    assert!(projection.loss.largest < 1e-12, "found {:?}", projection.loss);
    let original = transfer_function(&preset);
    let writers = [
        ("1d.vp", write_vp(&projection.property)),
        ("1d.vp.json", write_vp_json(&projection.property)),
        ("1d.json", write_paraview(&projection.property)),
    ];
    for (name, text) in writers {
        let [read] = read_text(name, &text.unwrap()).unwrap().try_into().expect("one");
        let back = transfer_function(&imported(&read, 1.0 / 1024.0).preset);
        // Not at the edges themselves, where one number separates the sides of a jump.
        for quarter in 1..=3200 {
            let hu = f64::from(quarter) / 4.0 + 0.1;
            let off = difference(slab(original.evaluate(hu, 0.0), 1.0), slab(back.evaluate(hu, 0.0), 1.0));
            assert!(off <= 2.0 / 1024.0, "{name} at {hu} HU: off by {off}");
        }
    }
}

#[test]
fn the_loss_of_a_gradient_axis_is_what_it_is_by_hand() {
    // 1 up to 50 HU/mm and 0 above: under exp(-g/50)/50 its mean is 1 - 1/e.
    let widget =
        "  - rectangle: { hu: [0, 100], gradient_hu_per_mm: [0, 50] }\n    extinction_per_mm: 1\n    color: red\n";
    let loss = projected(widget, &ProjectSettings::default()).unwrap().loss;
    let share = 1.0 - (-1.0f64).exp();
    let (inside, mean) = (1.0 - (-1.0f64).exp(), 1.0 - (-share).exp());
    assert!((loss.largest - mean).abs() < 1e-9, "above 50 HU/mm: found {loss:?}, expected {mean}");
    let expected = share * (inside - mean) + (1.0 - share) * mean;
    assert!((loss.mean - expected).abs() < 5e-3, "found {loss:?}, expected {expected}");
    let flat = ProjectSettings { mean_gradient_hu_per_mm: 1.0, ..ProjectSettings::default() };
    let loss = projected(widget, &flat).unwrap().loss;
    assert!(loss.mean < 1e-6, "nearly all gradients are within: found {loss:?}");
}

#[test]
fn every_built_in_preset_is_exported_with_its_loss() {
    for (name, _) in BUILT_IN_PRESETS {
        let preset = built_in_preset(name).unwrap().unwrap().preset;
        let projection =
            project(&preset, &ProjectSettings::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
        let gradient = transfer_function(&preset).reads_gradient();
        assert_eq!(projection.loss.largest > 1e-6, gradient, "{name}: {:?}", projection.loss);
        assert!(projection.loss.mean <= projection.loss.largest, "{name}: {:?}", projection.loss);
        assert!(projection.max_deviation <= 1.0 / 1024.0, "{name}: {}", projection.max_deviation);
    }
}

#[test]
fn what_cannot_be_exported_is_refused() {
    let glow = "  - rectangle: { hu: [0, 100] }\n    emission_per_mm: { color: red, strength: 1 }\n";
    let error = projected(glow, &ProjectSettings::default()).expect_err("light of its own").to_string();
    assert!(error.contains("emission_per_mm"), "found {error}");
    let widget = "  - { rectangle: { hu: [0, 100] }, opacity_per_mm: 0.5, color: red }\n";
    for settings in [
        ProjectSettings { mean_gradient_hu_per_mm: 0.0, ..ProjectSettings::default() },
        ProjectSettings { unit_distance_mm: f64::NAN, ..ProjectSettings::default() },
        ProjectSettings { max_deviation: 0.0, ..ProjectSettings::default() },
    ] {
        assert!(projected(widget, &settings).is_err(), "{settings:?}");
    }
}
