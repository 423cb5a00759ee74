//! Gradient opacity: a product in extinction, which VTK's rule approaches as its steps get shorter.

use pellucid::interchange::presets::{ImportSettings, VolumeProperty, import};

use super::{imported, read_text, transfer_function, written_and_read};

/// Opacity 0 to 0.8 over 0 to 100, gradient opacity 0 to 1 over 10 to 60 of VTK's units.
const VARYING: &str = "1\n0\n0.9\n0.1\n0.2\n10\n4 0 0 100 0.8\n6 0 0 10 0 60 1\n8 0 1 1 1 100 1 1 1\n";

fn varying(name: &str) -> VolumeProperty {
    read_text(name, VARYING).expect("it is read").swap_remove(0)
}

fn settings(voxel_mm: Option<f64>) -> ImportSettings {
    ImportSettings { voxel_mm, max_deviation: 1e-3, ..ImportSettings::default() }
}

#[test]
fn it_is_the_limit_of_vtks_rule_for_short_steps() {
    let imported = import(&varying("limit.vp"), "imported", &settings(Some(2.0))).expect("it is imported");
    let function = transfer_function(&written_and_read(&imported));
    for value in [20.0, 50.0, 99.0] {
        for gradient_hu_per_mm in [0.0, 5.0, 10.0, 20.0, 29.0, 40.0] {
            // VTK at a step of 1/4096 of the unit distance, along a whole one; voxels of 2 mm.
            let step = 1.0 / 4096.0;
            let corrected = 1.0 - (1.0 - 0.8 * value / 100.0_f64).powf(step);
            let factor = ((2.0 * gradient_hu_per_mm - 10.0) / 50.0_f64).clamp(0.0, 1.0);
            let expected = 1.0 - (1.0 - corrected * factor).powf(1.0 / step);
            let found = 1.0 - (-function.evaluate(value, gradient_hu_per_mm).extinction_per_mm).exp();
            let off = (found - expected).abs();
            assert!(off < 2e-3, "at {value} HU, {gradient_hu_per_mm} HU/mm: found {found}, expected {expected}");
        }
    }
}

#[test]
fn the_difference_at_a_whole_step_is_reported() {
    let imported = import(&varying("whole-step.vp"), "imported", &settings(Some(2.0))).expect("it is imported");
    // The largest |0.8 w - (1 - 0.2^w)|, where its derivative is 0: 0.2^w = 0.8 / ln 5.
    let w = -(0.8 / 5f64.ln()).ln() / 5f64.ln();
    let expected = (1.0 - 0.2f64.powf(w)) - 0.8 * w;
    let found = imported.whole_step_difference.expect("it varies");
    assert!((found - expected).abs() < 1e-4, "found {found}, expected {expected}");
    assert!(imported.yaml().contains("limit for short steps"), "the file says so");
}

#[test]
fn without_a_spacing_it_means_nothing() {
    let error = import(&varying("refused.vp"), "imported", &settings(None)).expect_err("it is refused").to_string();
    assert!(error.contains("gradientOpacity") && error.contains("spacing"), "found {error}");
}

#[test]
fn a_constant_one_is_a_factor_of_the_extinction() {
    for (list, factor) in [("4 0 1 255 1", 1.0), ("4 0 0.25 255 0.25", 0.25)] {
        let text = VARYING.replace("6 0 0 10 0 60 1", list);
        let property = read_text(&format!("constant-{factor}.vp"), &text).expect("it is read").swap_remove(0);
        let imported = imported(&property, 1e-3);
        let found = transfer_function(&written_and_read(&imported)).evaluate(100.0, 700.0).extinction_per_mm;
        let expected = -factor * 0.2f64.ln();
        assert!((found - expected).abs() < 1e-4, "{list}: found {found}, expected {expected}");
        assert_eq!(imported.whole_step_difference, None);
    }
}
