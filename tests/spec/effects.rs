//! Mistakes in the effects of light.

use super::{SHORT, mistake, read};

#[test]
fn each_mistake_is_named_with_its_key() {
    let light = "{ directional: { towards: [0, 0, 1] } }";
    for (effects, key, expected) in [
        ("depth_cue: { constant: 0, per_mm: 1 }", "effects.depth_cue.constant", "a number above 0"),
        ("depth_cue: { per_mm: -1 }", "effects.depth_cue.per_mm", "at least 0"),
        ("depth_cue: {}", "effects.depth_cue", "the key per_mm"),
        ("fog: {}", "effects.fog", "exactly one of linear, exp, exp2"),
        (
            "fog: { exp: { density_per_mm: 1 }, exp2: { density_per_mm: 1 } }",
            "effects.fog.exp2",
            "exactly one of linear, exp, exp2",
        ),
        ("fog: { linear: { start_mm: 5, end_mm: 5 } }", "effects.fog.linear.end_mm", "a distance beyond start_mm"),
        ("fog: { exp: { density_per_mm: -0.1 } }", "effects.fog.exp.density_per_mm", "at least 0"),
        ("haze: { extinction_per_mm: -1 }", "effects.haze.extinction_per_mm", "at least 0"),
        ("haze: { extinction_per_mm: 1, end_mm: 0 }", "effects.haze.end_mm", "a number above 0"),
        ("shadows: { strength: 1.5 }", "effects.shadows.strength", "0 to 1"),
        ("scattering: { albedo: 2 }", "effects.scattering.albedo", "0 to 1"),
        ("scattering: { albedo: 0.5, anisotropy: 1 }", "effects.scattering.anisotropy", "above -1 and below 1"),
        ("scattering: { albedo: 0.5 }", "effects.scattering.lights", "a directional light"),
        ("shading: {}, scattering: { albedo: 0.5 }", "effects.scattering.lights", "a directional light"),
        ("scattering: { albedo: 0.5, lights: [] }", "effects.scattering.lights", "at least one light"),
        ("scattering: { albedo: 0.5, lights: [headlight] }", "effects.scattering.lights.0", "a directional light"),
        (
            "scattering: { albedo: 0.5, lights: [{ directional: { towards: [0, 0, 0] } }] }",
            "effects.scattering.lights.0.directional.towards",
            "a direction of any length but 0",
        ),
    ] {
        let error = mistake(&format!("{SHORT}effects: {{ {effects} }}\n")).to_string();
        assert!(error.contains(&format!("({key})")) && error.contains(expected), "{effects}: found {error}");
    }
    let shared = format!("{SHORT}effects: {{ shading: {{ lights: [{light}] }}, scattering: {{ albedo: 0.5 }} }}\n");
    assert!(read(&shared).is_ok(), "lights may be written once");
}

#[test]
fn light_has_no_effect_where_nothing_is_lit() {
    let without_layers = SHORT.replace("transfer_function:\n  - preset: bone\n", "");
    for (shown, effect, refused) in [
        ("project: { show: maximum }", "fog: { exp: { density_per_mm: 1 } }", true),
        ("project: { show: mean }", "depth_cue: { per_mm: 1 }", true),
        ("surfaces: [{ hu: 0 }]", "haze: { extinction_per_mm: 1 }", true),
        ("surfaces: [{ hu: 0 }]", "shadows: {}", true),
        ("surfaces: [{ hu: 0 }]", "fog: { exp: { density_per_mm: 1 } }", false),
        ("surfaces: [{ hu: 0 }]", "shading: {}, depth_cue: { per_mm: 1 }", false),
    ] {
        let text = format!("{without_layers}effects: {{ {shown}, {effect} }}\n");
        if refused {
            let error = mistake(&text).to_string();
            assert!(error.contains("nothing would read this key"), "{shown}, {effect}: found {error}");
        } else {
            assert!(read(&text).is_ok(), "{shown}, {effect}");
        }
    }
    let per_sample = "effects: { haze: { extinction_per_mm: 1 } }\nintegrate: { march: { emission: per-sample } }\n";
    let error = mistake(&format!("{SHORT}{per_sample}")).to_string();
    assert!(error.contains("effects.haze") && error.contains("per-sample"), "found {error}");
}

#[test]
fn another_law_of_fog_takes_the_place_of_the_one_in_the_file() {
    let text = format!("{SHORT}effects: {{ fog: {{ exp: {{ density_per_mm: 1 }} }} }}\n");
    let set = ["effects.fog.exp2.density_per_mm=0.5".to_owned()];
    let spec = pellucid::spec::Spec::from_text(&text, std::path::Path::new("scene.yaml"), &set);
    let fog = spec.expect("one law").pipeline.effects.and_then(|e| e.fog).expect("fog");
    assert!(fog.exp.is_none() && fog.exp2.is_some_and(|law| law.density_per_mm == 0.5));
}
