//! What shows: keys that go together, and keys that nothing would read.

use super::{mistake, read};

const HEAD: &str = "version: 1\nvolume: { phantom: head }\n";
const BONE: &str = "transfer_function: [{ preset: bone }]\n";

/// The error of a pipeline must name this key and say why.
fn refused(rest: &str, key: &str, why: &str) {
    let message = mistake(&format!("{HEAD}{rest}")).to_string();
    assert!(message.contains(key) && message.contains(why), "{rest}: expected {key} and `{why}`, found {message}");
}

fn accepted(rest: &str) {
    read(&format!("{HEAD}{rest}")).unwrap_or_else(|error| panic!("{rest}: {error}"));
}

#[test]
fn a_window_is_in_the_unit_of_what_it_shows() {
    accepted("effects: { project: { show: maximum } }\n");
    accepted("effects: { project: { show: sum, window_hu_mm: [-1e5, 1e5] } }\n");
    accepted(&format!("{BONE}effects: {{ project: {{ show: optical-depth, window_optical_depth: [0, 5] }} }}\n"));
    refused("effects: { project: { show: sum, window_hu: [0, 1] } }\n", "effects.project.window_hu", "window_hu_mm");
    refused("effects: { project: { show: sum } }\n", "effects.project.window_hu_mm", "no default");
    refused(
        "effects: { project: { show: mean, window_hu: [5, 5] } }\n",
        "effects.project.window_hu",
        "the lower first",
    );
    refused(
        &format!("{BONE}effects: {{ project: {{ show: optical-depth, window_hu: [0, 5] }} }}\n"),
        "effects.project.window_hu",
        "window_optical_depth",
    );
}

#[test]
fn a_threshold_goes_with_local_maxima() {
    accepted("effects: { project: { show: local-maximum, threshold_hu: 150 } }\n");
    refused("effects: { project: { show: local-maximum } }\n", "effects.project.threshold_hu", "the least value");
    refused(
        "effects: { project: { show: maximum, threshold_hu: 150 } }\n",
        "effects.project.threshold_hu",
        "only local-maximum",
    );
}

#[test]
fn a_transfer_function_is_for_what_reads_it() {
    refused(
        &format!("{BONE}effects: {{ project: {{ show: sum, window_hu_mm: [0, 1] }} }}\n"),
        "transfer_function",
        "number",
    );
    refused(
        "effects: { project: { show: optical-depth, window_optical_depth: [0, 5] } }\n",
        "transfer_function",
        "at least one layer",
    );
}

#[test]
fn light_is_absorbed_emitted_or_both_where_there_is_light() {
    for light in ["absorption", "emission", "both"] {
        accepted(&format!("{BONE}effects: {{ light: {light} }}\n"));
        refused(&format!("effects: {{ light: {light}, surfaces: [{{ hu: 300 }}] }}\n"), "effects.light", "surfaces");
        refused(&format!("effects: {{ light: {light}, project: {{ show: mean }} }}\n"), "effects.light", "no light");
    }
    refused(&format!("{BONE}effects: {{ light: absorption, shading: {{}} }}\n"), "effects.shading", "only absorbs");
    for key in ["specular: 0.1", "shininess: 5"] {
        let name = key.split(':').next().unwrap_or_default();
        refused(&format!("{BONE}effects: {{ light: emission, shading: {{ {key} }} }}\n"), name, "highlight");
    }
}

#[test]
fn attenuation_has_an_energy_of_the_tables_and_no_colour() {
    accepted("transfer_function: [{ attenuation: { kev: 60 }, opacity_scale: 0.5 }]\n");
    refused("transfer_function: [{ attenuation: { kev: 511 } }]\n", "attenuation.kev", "10 to 200 keV");
    refused(
        "transfer_function: [{ attenuation: { kev: 60, scanned_at_kev: 9 } }]\n",
        "scanned_at_kev",
        "10 to 200 keV",
    );
    refused(
        "transfer_function: [{ attenuation: { kev: 60 }, color: red }]\n",
        "transfer_function.0.color",
        "no colour",
    );
    refused("transfer_function: [{ attenuation: { kev: 60 }, preset: bone }]\n", "attenuation", "exclude");
    refused(
        "transfer_function: [{ opacity_scale: 2 }]\n",
        "transfer_function.0",
        "exactly one of preset, widgets, attenuation",
    );
}

#[test]
fn marching_reads_what_its_picture_is_made_of() {
    let number = "effects: { project: { show: maximum } }\n";
    let surfaces = "effects: { surfaces: [{ hu: 300 }] }\n";
    accepted(&format!(
        "{number}integrate: {{ march: {{ rule: left, lattice: view-planes, jitter: {{ seed: 1 }} }} }}\n"
    ));
    accepted(&format!("{surfaces}integrate: {{ march: {{ bisections: 4, termination_transmittance: 0.01 }} }}\n"));
    for (head, key, why) in [
        (number, "order: back-to-front", "not composited"),
        (number, "colors: straight", "not composited"),
        (number, "emission: per-sample", "only light is emitted"),
        (number, "termination_transmittance: 0.01", "not composited"),
        (number, "bisections: 4", "only surfaces"),
        (BONE, "bisections: 4", "only surfaces"),
        (surfaces, "rule: left", "between the ends of each interval"),
        (surfaces, "order: back-to-front", "in their order"),
        (surfaces, "bisections: 33", "at most 32"),
    ] {
        let name = key.split(':').next().unwrap_or_default();
        refused(&format!("{head}integrate: {{ march: {{ {key} }} }}\n"), &format!("integrate.march.{name}"), why);
    }
}
