//! Effects of light: defaults, what is left out and why, and what is told about it.

use glam::DVec3;
use pellucid::plan::{Plan, explain, explain_json};
use pellucid::scene::{DepthCue, Effects, Fog, FogLaw, Haze, Scattering, Shadows};

use super::{plan, spec, volume};

/// Shading with a light from the side, and these effects.
fn with(effects: &str) -> Plan {
    let lights = "[headlight, { directional: { towards: [0, -3, 0], color: red } }]";
    plan(&format!("effects:\n  shading: {{ lights: {lights} }}\n{effects}image: {{ background: [0.5, 0.25, 0] }}\n"))
}

/// Why an effect is not computed.
fn why(plan: &Plan, what: &str) -> String {
    let found = plan.not_computed.iter().find(|omission| omission.what == what);
    found.unwrap_or_else(|| panic!("{what} is computed: {:?}", plan.scene.effects)).why.clone()
}

#[test]
fn every_default_is_decided() {
    let effects = |text| with(text).scene.effects;
    let off = Effects::default;
    let cue = Some(DepthCue { constant: 1.0, per_mm: 0.01 });
    assert_eq!(effects("  depth_cue: { per_mm: 0.01 }\n"), Effects { depth_cue: cue, ..off() });
    assert_eq!(effects("  shadows: {}\n"), Effects { shadows: Some(Shadows { strength: 1.0 }), ..off() });
    let lights = vec![(-DVec3::Y, [1.0, 0.0, 0.0])];
    let scattering = Some(Scattering { albedo: 0.5, anisotropy: 0.0, lights });
    assert_eq!(effects("  scattering: { albedo: 0.5 }\n"), Effects { scattering, ..off() }, "shading's lights");
    let law = FogLaw::Exp2 { density_per_mm: 0.01 };
    let fog = Some(Fog { law, color: [0.5, 0.25, 0.0] });
    assert_eq!(
        effects("  fog: { exp2: { density_per_mm: 0.01 } }\n"),
        Effects { fog, ..off() },
        "the background's colour"
    );
    let Some(Haze { color, end_mm, .. }) = effects("  haze: { extinction_per_mm: 0.01 }\n").haze else {
        panic!("there is no haze")
    };
    // The camera is at (31.5, about -188, 48); the farthest corners are (0 or 63, 94, 0 or 96).
    let plan = with("");
    let farthest = DVec3::new(0.0, 94.0, 0.0).distance(plan.scene.camera.position_mm());
    assert_eq!(color, [0.5, 0.25, 0.0]);
    assert!((end_mm - farthest).abs() < 1e-9, "found {end_mm} mm, expected {farthest} mm");
}

#[test]
fn what_has_no_strength_is_not_there_and_why_is_said() {
    let off = with("");
    assert!(!off.demand.visibility, "nobody reads transmittances");
    for (text, what, reason) in [
        ("", "fog", "the pipeline does not name it"),
        ("  depth_cue: { per_mm: 0 }\n", "depth cue", "its constant is 1 and per_mm is 0"),
        ("  shadows: { strength: 0 }\n", "shadows", "their strength is 0"),
        ("  scattering: { albedo: 0 }\n", "scattering", "its albedo is 0"),
        ("  fog: { exp: { density_per_mm: 0 } }\n", "fog", "its density is 0"),
        ("  fog: { exp2: { density_per_mm: 0 } }\n", "fog", "its density is 0"),
        ("  haze: { extinction_per_mm: 0 }\n", "haze", "its extinction is 0"),
    ] {
        let none = with(text);
        assert_eq!(none.scene, off.scene, "{text}");
        assert_eq!(none.demand, off.demand, "{text}");
        assert_eq!(why(&none, what), reason);
        assert_eq!(none.warnings, off.warnings, "{text}: an author who writes 0 knows");
    }
}

#[test]
fn what_has_nothing_to_act_on_is_not_there_and_is_warned_of() {
    let unlit = "effects: { shading: { diffuse: 0, specular: 0 }, ";
    for (text, what, reason) in [
        ("effects: { shadows: {} }\n".to_owned(), "shadows", "lit terms"),
        ("effects: { shadows: {}, shading: {} }\n".to_owned(), "shadows", "no directional light"),
        (format!("{unlit} shadows: {{}} }}\n"), "shadows", "lit terms"),
        (format!("{unlit} depth_cue: {{ per_mm: 1 }} }}\n"), "depth cue", "lit terms"),
        ("effects: { fog: { linear: { start_mm: 9000, end_mm: 9001 } } }\n".to_owned(), "fog", "behind the volume"),
    ] {
        let idle = plan(&text);
        assert!(why(&idle, what).contains(reason), "{text}: found {}", why(&idle, what));
        let warned = idle.warnings.iter().any(|warning| warning.starts_with(what) && warning.contains(reason));
        assert!(warned, "{text}: found {:?}", idle.warnings);
        assert!(!idle.scene.effects.change_light());
    }
}

#[test]
fn an_effect_that_is_there_is_read_for_listed_and_explained() {
    let plan = with(
        "  shadows: { strength: 0.5 }
  scattering: { albedo: 0.5, anisotropy: 0.3, lights: [{ directional: { towards: [0, -3, 0] } }, { directional: { towards: [0, 0, 1] } }] }
  fog: { linear: { start_mm: 100, end_mm: 300 } }
  haze: { extinction_per_mm: 0.001, end_mm: 1000 }
  depth_cue: { constant: 0.5, per_mm: 0.01 }
",
    );
    assert!(plan.demand.visibility && plan.demand.gradient);
    let stage = plan.stages.iter().find(|stage| stage.name == "light").expect("transmittances are computed");
    assert_eq!(stage.bytes, 2 * 4 * 64 * 48 * 33, "two directions, of which one is shared");
    let text = explain(&plan);
    for words in [
        "depth cue 1/(0.5 + 0.01 d) of the lit terms, d in mm",
        "shadows of strength 0.5",
        "scattering of 2 lights, albedo 0.5, anisotropy 0.3",
        "fog linear from 100 to 300 mm",
        "haze of 0.001 per mm to 1000.0 mm",
        "transmittance towards 2 lights",
        "exact/i16/tf1d/atmosphere",
    ] {
        assert!(text.contains(words), "{words} is not in\n{text}");
    }
    let json = explain_json(&plan);
    assert_eq!(json["effects"]["fog"]["law"]["linear"]["end_mm"], 300.0);
    assert_eq!(json["effects"]["scattering"]["lights"].as_array().map(Vec::len), Some(2));
    assert_eq!(explain_json(&with(""))["effects"]["fog"], serde_json::Value::Null);
}

#[test]
fn what_scatters_is_not_scaled_by_ambient_light() {
    let lights = "lights: [{ directional: { towards: [0, -1, 0] } }]";
    let plan = plan(&format!(
        "effects: {{ shading: {{ ambient: 0.5, diffuse: 0, specular: 0, {lights} }}, scattering: {{ albedo: 0.5 }} }}\n"
    ));
    assert_eq!(plan.scene.transfer_function.evaluate(1000.0, 0.0).emission_per_mm, [2.0; 3]);
    assert_eq!(plan.scene.shading.as_ref().map(|s| s.ambient), Some(0.5));
    assert!(!plan.demand.gradient, "a constant factor needs no gradient");
}

#[test]
fn haze_that_ends_within_the_volume_is_refused() {
    let spec = spec("effects: { haze: { extinction_per_mm: 0.01, end_mm: 100 } }\n");
    let error = Plan::new(&spec, &volume(), None).expect_err("it ends too early").to_string();
    assert!(error.contains("effects.haze.end_mm") && error.contains("found 100 mm"), "found {error}");
}
