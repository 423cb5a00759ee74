//! What nobody needs is not computed.

use super::plan;

const TWO_D: &str = "transfer_function:
  - widgets:
      - trapezoid: { hu: [-600, -450, -250, -100], gradient_hu_per_mm: [80, 200, 3000, 3000] }
        opacity_per_mm: 0.3
        color: white
";

/// The same values at every gradient magnitude up to the range, which is written as a 2D function but is none.
const ONE_D_IN_DISGUISE: &str = "transfer_function:
  - widgets:
      - trapezoid: { hu: [-600, -450, -250, -100], gradient_hu_per_mm: [0, 0, 3000, 3000] }
        opacity_per_mm: 0.3
        color: white
";

fn reads(rest: &str) -> (bool, bool) {
    let demand = plan(rest).demand;
    (demand.gradient, demand.gradient_magnitude)
}

#[test]
fn demand_is_the_union_of_what_the_scene_reads() {
    let shading = "effects: { shading: {} }\n";
    assert_eq!(reads(""), (false, false), "1D, unshaded");
    assert_eq!(reads(shading), (true, false), "1D, shaded");
    assert_eq!(reads(TWO_D), (false, true), "2D, unshaded");
    assert_eq!(reads(&format!("{TWO_D}{shading}")), (true, true), "2D, shaded");
}

#[test]
fn a_weight_that_is_constant_over_the_range_costs_no_gradient() {
    assert_eq!(reads(ONE_D_IN_DISGUISE), (false, false));
    let wide = format!("gradient: {{ range_hu_per_mm: [0, 4000] }}\n{ONE_D_IN_DISGUISE}");
    assert_eq!(reads(&wide), (false, true), "with a wider range the weight ends within it");
    let [narrow, wide] = [ONE_D_IN_DISGUISE, &wide].map(|rest| plan(rest).scene.transfer_function);
    for v in [-500.0, -300.0, -120.0, 40.0] {
        assert_eq!(narrow.evaluate(v, 700.0), wide.evaluate(v, 700.0), "the same function, at {v}");
    }
}

#[test]
fn an_effect_of_no_strength_is_an_effect_that_is_off() {
    let off = plan("");
    let dark = plan("effects: { shading: { ambient: 1, diffuse: 0, specular: 0 } }\n");
    assert_eq!(dark.scene, off.scene);
    assert_eq!(dark.demand, off.demand);
    let dim = plan("effects: { shading: { ambient: 0.5, diffuse: 0, specular: 0 } }\n");
    assert!(dim.scene.shading.is_none(), "a constant factor needs no gradient");
    let [bright, dim] = [&off, &dim].map(|plan| plan.scene.transfer_function.evaluate(1000.0, 0.0));
    assert_eq!(dim.extinction_per_mm, bright.extinction_per_mm);
    assert_eq!(dim.emission_per_mm, bright.emission_per_mm.map(|q| 0.5 * q));
}

#[test]
fn a_layer_of_no_strength_is_left_out() {
    let with = format!("{TWO_D}    opacity_scale: 0\n  - preset: bone\n");
    let without = "transfer_function:\n  - preset: bone\n";
    assert_eq!(plan(&with).scene, plan(without).scene);
    assert_eq!(reads(&with), reads(without), "what a layer of no strength would read is not read");
    let omitted = plan(&with).not_computed;
    assert!(omitted.iter().any(|o| o.what == "layer" && o.why.contains("layer 1")), "found {omitted:?}");
}

#[test]
fn macrocells_are_read_by_what_skips_blocks() {
    for method in ["{ march: { step_voxels: 1 } }", "exact"] {
        assert!(plan(&format!("integrate: {method}\n")).demand.macrocells, "{method} skips blocks");
    }
    for other in ["integrate: exact\neffects: { haze: { extinction_per_mm: 0.001 } }", "integrate: reference"] {
        let plan = plan(&format!("{other}\n"));
        assert!(!plan.demand.macrocells, "{other} skips cell by cell, or not at all");
        assert!(plan.not_computed.iter().any(|o| o.what == "macrocells"), "{other} says so");
    }
}
