//! Layers become the transfer function: units, colours, settings, and presets on values that are not HU.

use pellucid::plan::{Plan, VolumeInfo};
use pellucid::volume::Quantity;

use super::{plan, spec, volume};

fn widgets(list: &str) -> String {
    format!("transfer_function:\n  - widgets:\n{}", list.lines().map(|l| format!("      {l}\n")).collect::<String>())
}

#[test]
fn opacity_is_per_mm_and_color_is_straight() {
    let tf = plan(&widgets("- { rectangle: { hu: [0, 100] }, opacity_per_mm: 0.75, color: [1, 0.5, 0] }"));
    let optics = tf.scene.transfer_function.evaluate(50.0, 0.0);
    let expected = 2.0 * std::f64::consts::LN_2;
    assert!((optics.extinction_per_mm - expected).abs() < 1e-15, "found {}", optics.extinction_per_mm);
    assert_eq!(optics.emission_per_mm, [1.0, 0.5, 0.0].map(|c| c * optics.extinction_per_mm));
}

#[test]
fn light_of_its_own_adds_to_the_light_of_what_absorbs() {
    let both = "- rectangle: { hu: [0, 100] }\n  extinction_per_mm: 2\n  color: [0.5, 0, 0]\n  \
                emission_per_mm: { color: [0, 1, 0], strength: 0.25 }\n\
                - { rectangle: { hu: [200, 300] }, emission_per_mm: { color: white, strength: 3 } }";
    let tf = plan(&widgets(both)).scene.transfer_function;
    assert_eq!(tf.evaluate(50.0, 0.0).emission_per_mm, [1.0, 0.25, 0.0]);
    let glow = tf.evaluate(250.0, 0.0);
    assert_eq!((glow.extinction_per_mm, glow.emission_per_mm), (0.0, [3.0; 3]), "emission alone");
}

#[test]
fn points_are_linear_in_extinction_and_associated_color() {
    let points = "- points:\n    - { hu: 0, extinction_per_mm: 0 }\n    \
                  - { hu: 100, extinction_per_mm: 4, color: [1, 0, 0] }\n    \
                  - { hu: 200, extinction_per_mm: 1, color: [0, 1, 0] }\n  gradient_weight: [[0, 0], [500, 1]]";
    let tf = plan(&widgets(points)).scene.transfer_function;
    let half = tf.evaluate(150.0, 250.0);
    assert_eq!(half.extinction_per_mm, 0.5 * 2.5);
    assert_eq!(half.emission_per_mm, [0.5 * 2.0, 0.5 * 0.5, 0.0]);
    assert_eq!(tf.evaluate(50.0, 1000.0).emission_per_mm, [2.0, 0.0, 0.0], "no colour bleeds in where nothing absorbs");
}

#[test]
fn a_layer_scales_shifts_and_recolors() {
    let layer = "    opacity_scale: 0.5\n    color: [0, 0, 1]\n    scale: 2\n    shift_hu: 1000\n";
    let list = "- rectangle: { hu: [0, 100], gradient_hu_per_mm: [10, 20] }\n  extinction_per_mm: 4\n  color: white";
    let tf = plan(&format!("{}{layer}", widgets(list))).scene.transfer_function;
    let inside = tf.evaluate(1150.0, 30.0);
    assert_eq!((inside.extinction_per_mm, inside.emission_per_mm), (2.0, [0.0, 0.0, 2.0]));
    for (v, g) in [(999.0, 30.0), (1201.0, 30.0), (1150.0, 19.0), (1150.0, 41.0)] {
        assert_eq!(tf.evaluate(v, g).extinction_per_mm, 0.0, "outside at {v}, {g}");
    }
}

#[test]
fn layers_add_up_and_keep_their_names() {
    let rest = "transfer_function:\n  - preset: skin\n    opacity_scale: 0.4\n  - preset: bone\n";
    let plan = plan(rest);
    let names: Vec<&str> = plan.layers.iter().map(|layer| layer.name.as_str()).collect();
    assert_eq!(names, ["skin", "bone"]);
    assert!(plan.layers.iter().all(|layer| layer.tissue.is_some()), "presets classify");
    let terms: usize = plan.layers.iter().map(|layer| layer.terms.len()).sum();
    assert_eq!(plan.scene.transfer_function.terms().len(), terms);
}

#[test]
fn a_preset_in_hu_needs_values_in_hu() {
    let arbitrary = VolumeInfo { quantity: Quantity::Arbitrary, value_range: [0.0, 255.0], ..volume() };
    let plan_for = |rest: &str| Plan::new(&spec(rest), &arbitrary, None);
    let preset = "transfer_function:\n  - preset: bone\n";
    let error = plan_for(preset).unwrap_err();
    let message = error.to_string();
    assert!(message.starts_with("pipelines/scene.yaml:4:13: this preset is in HU"), "found {message}");
    assert!(message.contains("values: hu") && message.contains("shift_hu"), "the remedy: {message}");
    plan_for(&format!("{preset}    shift_hu: 1024\n")).expect("the layer says how its values relate to HU");
    plan_for(&widgets("- { rectangle: { hu: [80, 255] }, extinction_per_mm: 1, color: white }"))
        .expect("widgets in place are in the volume's own values");
}

#[test]
fn shifted_values_become_hu() {
    use pellucid::Volume;
    use pellucid::volume::{Grid, Rescale, Samples};
    let grid = Grid::axis_aligned([2, 1, 1], glam::DVec3::ONE).unwrap();
    let volume = Volume::new(grid, Samples::I16(vec![0, 1024]), Rescale::IDENTITY, Quantity::Arbitrary).unwrap();
    let written = |rest: &str| {
        let text = super::pipeline("").replace("phantom: head", &format!("phantom: head{rest}"));
        let spec = pellucid::spec::Spec::from_text(&text, std::path::Path::new("scene.yaml"), &[]).unwrap();
        let volume = spec.interpret(volume.clone());
        (volume.quantity(), volume.value([1, 0, 0]))
    };
    assert_eq!(written(""), (Quantity::Arbitrary, 1024.0));
    assert_eq!(written(", values: hu"), (Quantity::Hu, 1024.0));
    assert_eq!(written(", shift_hu: -1024"), (Quantity::Hu, 0.0));
}

#[test]
fn a_widget_that_takes_too_many_rows_is_named() {
    let sharp = "- { triangle: { apex_hu: 0, opening_mm: 1, edge: 0.01, gradient_hu_per_mm: [1, 1000] }, opacity_per_mm: 1, color: red }";
    let message = Plan::new(&spec(&widgets(sharp)), &volume(), None).unwrap_err().to_string();
    let expected = "pipelines/scene.yaml: a widget's shape takes too many rows of gradient magnitudes \
                    (transfer_function.0.widgets.0)";
    assert!(message.starts_with(expected), "found {message}");
}

#[test]
fn a_scene_that_shows_nothing_is_warned_of() {
    let beyond = plan(&widgets("- { rectangle: { hu: [2000, 3000] }, extinction_per_mm: 1, color: white }"));
    let nothing = |plan: &Plan| plan.warnings.iter().any(|w| w.contains("nothing in this volume"));
    assert!(nothing(&beyond), "the volume ends at 1800: {:?}", beyond.warnings);
    let within = plan(&widgets("- { rectangle: { hu: [1700, 3000] }, extinction_per_mm: 1, color: white }"));
    assert!(!nothing(&within), "found {:?}", within.warnings);
}
