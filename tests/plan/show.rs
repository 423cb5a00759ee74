//! What shows, resolved, and what is therefore not computed.

use std::path::Path;

use pellucid::plan::{Plan, explain};
use pellucid::scene::{Model, ValueOf};
use pellucid::spec::Spec;

use super::volume;

fn plan(rest: &str) -> Plan {
    let text = format!("version: 1\nvolume: {{ phantom: head }}\n{rest}");
    let spec = Spec::from_text(&text, Path::new("scene.yaml"), &[]).unwrap_or_else(|error| panic!("{rest}: {error}"));
    Plan::new(&spec, &volume(), None).unwrap_or_else(|error| panic!("{rest}: {error}"))
}

/// What is not computed, with its reason.
fn omissions(plan: &Plan) -> Vec<String> {
    plan.not_computed.iter().map(|o| format!("{}: {}", o.what, o.why)).collect()
}

const DEPTH: &str = "effects: { project: { show: optical-depth, window_optical_depth: [0, 5] } }\n";

#[test]
fn numbers_are_explained_in_their_units() {
    for (project, integrate, expected) in [
        (
            "show: maximum, window_hu: [0, 1800]",
            "exact",
            "exact/i16/maximum/f64: the largest value along each ray, black at 0 and white at 1800 HU; exact to rounding",
        ),
        (
            "show: sum, window_hu_mm: [-5, 5]",
            "{ march: { step_mm: 0.5 } }",
            "march/i16/sum/f32: the integral of the value along each ray, black at -5 and white at 5 HU mm; \
             steps of 0.5000 mm, midpoint samples",
        ),
        (
            "show: local-maximum, threshold_hu: 150",
            "reference",
            "reference in f64: the first local maximum of at least 150 HU along each ray, black at -1024 and white at \
             3071 HU; every pixel by the oracle",
        ),
    ] {
        let plan = plan(&format!("effects: {{ project: {{ {project} }} }}\nintegrate: {integrate}\n"));
        let text = explain(&plan);
        assert!(text.contains(expected), "expected {expected}, found\n{text}");
        assert!(!text.contains("\nlayers") && !text.contains("\nlight"), "a number has neither:\n{text}");
        assert_eq!(plan.warnings, [""; 0], "{project}");
        let why = "classification: effects.project shows a number of the values, not light";
        assert!(omissions(&plan).iter().any(|o| o == why), "found {:?}", omissions(&plan));
    }
}

#[test]
fn an_optical_depth_reads_extinction_and_no_emission() {
    let two_d = "  - widgets:
      - trapezoid: { hu: [-600, -450, -250, -100], gradient_hu_per_mm: [80, 200, 3000, 3000] }
        opacity_per_mm: 0.3
        color: white
";
    let plan_of = |layers: &str| plan(&format!("transfer_function:\n{layers}{DEPTH}integrate: march\n"));
    let depth = plan_of(two_d);
    assert!(depth.demand.gradient_magnitude && depth.demand.macrocells && !depth.demand.gradient, "{:?}", depth.demand);
    let text = explain(&depth);
    assert!(text.contains("march/i16/tf2d/optical-depth/f32: the optical depth along each ray"), "found\n{text}");
    assert!(text.contains("classify   2D transfer function"), "found\n{text}");
    let knots = depth.scene.transfer_function.terms().iter().flat_map(|t| t.curve.knots());
    assert!(knots.into_iter().all(|k| k.optics.emission_per_mm == [0.0; 3]), "emission is not computed");
    let glow =
        "  - widgets:\n      - rectangle: { hu: [0, 100] }\n        emission_per_mm: { color: red, strength: 1 }\n";
    let dark = plan_of(glow);
    assert!(dark.warnings.iter().any(|w| w.contains("nothing in this volume absorbs")), "found {:?}", dark.warnings);
}

#[test]
fn sums_and_means_have_no_use_for_macrocells() {
    for (show, expected) in [("mean", false), ("maximum", true), ("minimum", true)] {
        let plan = plan(&format!("effects: {{ project: {{ show: {show} }} }}\nintegrate: march\n"));
        assert_eq!(plan.demand.macrocells, expected, "{show}");
        let why = "macrocells: every value counts, so no block of cells could be skipped";
        assert_eq!(omissions(&plan).iter().any(|o| o == why), !expected, "{show}: {:?}", omissions(&plan));
    }
}

#[test]
fn surfaces_without_opacity_are_dropped() {
    let surfaces = |opacities: [f64; 2]| {
        let [a, b] = opacities;
        plan(&format!("effects: {{ surfaces: [{{ hu: -300, opacity: {a} }}, {{ hu: 500, opacity: {b} }}] }}\n"))
    };
    let one = surfaces([0.0, 0.5]);
    let Model::Surfaces(left) = &one.scene.model else { panic!("surfaces, found {:?}", one.scene.model) };
    assert_eq!(left.iter().map(|s| s.value).collect::<Vec<_>>(), [500.0]);
    let why = "surface: the one at -300 has an opacity of 0";
    assert!(omissions(&one).iter().any(|o| o == why), "found {:?}", omissions(&one));
    assert!(explain(&one).contains("surfaces at 500 HU of opacity 0.5"), "found\n{}", explain(&one));
    let none = surfaces([0.0, 0.0]);
    assert!(none.warnings.iter().any(|w| w.contains("background alone")), "found {:?}", none.warnings);
}

#[test]
fn absorption_and_emission_alone_leave_the_other_out() {
    let layers = "transfer_function:\n  - preset: bone\n  - attenuation: { kev: 60 }\n";
    let absorption = plan(&format!("{layers}effects: {{ light: absorption }}\n"));
    let knots = |plan: &Plan| -> Vec<_> {
        plan.scene.transfer_function.terms().iter().flat_map(|t| t.curve.knots().to_vec()).collect()
    };
    assert!(knots(&absorption).iter().all(|k| k.optics.emission_per_mm == [0.0; 3]));
    assert!(omissions(&absorption).iter().any(|o| o == "emission: effects.light shows absorption alone"));
    assert!(absorption.warnings.iter().any(|w| w.contains("picture will be black")), "{:?}", absorption.warnings);
    let lit = plan(&format!("{layers}effects: {{ light: absorption }}\nimage: {{ background: white }}\n"));
    assert_eq!(lit.warnings, [""; 0]);
    let emission = plan(&format!("{layers}effects: {{ light: emission }}\n"));
    assert!(knots(&emission).iter().all(|k| k.optics.extinction_per_mm == 0.0));
    let why =
        "layer: attenuation at 60 keV emits nothing everywhere in the window and the range of gradient magnitudes";
    assert!(omissions(&emission).iter().any(|o| o == why), "found {:?}", omissions(&emission));
}

#[test]
fn attenuation_is_a_layer_by_its_energy_and_needs_hu() {
    let layer = "transfer_function: [{ attenuation: { kev: 60 } }]\n";
    let plan = plan(&format!("{layer}{DEPTH}"));
    assert_eq!(plan.layers[0].name, "attenuation at 60 keV");
    let Model::Value(model) = &plan.scene.model else { panic!("a value, found {:?}", plan.scene.model) };
    assert_eq!((model.of, model.window), (ValueOf::OpticalDepth, [0.0, 5.0]));
    let text = format!("version: 1\nvolume: {{ phantom: head }}\n{layer}");
    let spec = Spec::from_text(&text, Path::new("scene.yaml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    let arbitrary = pellucid::plan::VolumeInfo { quantity: pellucid::volume::Quantity::Arbitrary, ..volume() };
    let error = Plan::new(&spec, &arbitrary, None).expect_err("HU of arbitrary values").to_string();
    assert!(error.contains("this attenuation is in HU") && error.contains("shift_hu"), "found {error}");
}
