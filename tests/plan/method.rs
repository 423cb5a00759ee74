//! Integrators, light and output with their defaults.

use std::path::{Path, PathBuf};

use pellucid::Fault;
use pellucid::plan::{
    Bound, Colors, Emission, Exact, ExactKernel, Format, Jitter, JitterKind, Lattice, March, Method, Order, Plan,
    Reflection, SampleRule, explain, explain_json,
};
use pellucid::scene::{Background, Light};

use super::{plan, spec, volume};

const MARCH: March = March {
    step_mm: 0.5,
    rule: SampleRule::Midpoint,
    order: Order::FrontToBack,
    colors: Colors::Associated,
    emission: Emission::PerLength,
    lattice: Lattice::PerRay,
    bisections: 0,
    jitter: None,
    termination_transmittance: 0.0,
    table: None,
    reflection: Reflection::BlinnPhong,
};

#[test]
fn settings_and_their_defaults() {
    assert_eq!(plan("").method, Method::Exact(Exact::within(1.0 / 255.0)), "by default");
    let cases = [
        ("exact: { tolerance: 1/1000 }", Method::Exact(Exact::within(1e-3))),
        // Half of the smallest spacing, 1 mm.
        ("march: {}", Method::March(MARCH)),
        ("march: { step_voxels: 2 }", Method::March(March { step_mm: 2.0, ..MARCH })),
        ("march: { step_mm: 0.7, rule: left }", Method::March(March { step_mm: 0.7, rule: SampleRule::Left, ..MARCH })),
        (
            "march: { order: back-to-front, colors: straight, emission: per-sample, lattice: view-planes }",
            Method::March(March {
                order: Order::BackToFront,
                colors: Colors::Straight,
                emission: Emission::PerSample,
                lattice: Lattice::ViewPlanes,
                ..MARCH
            }),
        ),
        (
            "march: { rule: trapezoid, jitter: { seed: 7, kind: low-discrepancy }, termination_transmittance: 1/256 }",
            Method::March(March {
                rule: SampleRule::Trapezoid,
                jitter: Some(Jitter { seed: 7, kind: JitterKind::LowDiscrepancy }),
                termination_transmittance: 1.0 / 256.0,
                ..MARCH
            }),
        ),
    ];
    for (written, expected) in cases {
        assert_eq!(plan(&format!("integrate: {{ {written} }}\n")).method, expected, "{written}");
    }
    assert_eq!(plan("integrate: reference\n").method, Method::Reference);
}

#[test]
fn what_is_known_of_the_error_is_said_of_the_kernel_that_will_run() {
    let (lit, narrow) =
        ("effects: { shading: {} }\n", "{ rectangle: { hu: [300, 300.5] }, extinction_per_mm: 2, color: white }");
    let narrow = format!("transfer_function: [{{ widgets: [{narrow}] }}]\n{lit}");
    let asked = format!("integrate: {{ exact: {{ bound: proven }} }}\n{lit}");
    let (estimated, proven) = (Bound::Estimated, Bound::Proven);
    for (rest, kernel, name, said) in [
        ("", ExactKernel::InRegisters(proven), "tf1d/unlit: ", "within 3.922e-3 "),
        (lit, ExactKernel::InRegisters(estimated), "tf1d/lit: ", "misses is estimated"),
        (&asked, ExactKernel::InRegisters(proven), "tf1d/lit-proven: ", "within 3.922e-3 "),
        (&narrow, ExactKernel::Double, "tf1d/lit: ", "all of it proven"),
    ] {
        let plan = plan(rest);
        assert_eq!((plan.exact_kernel, plan.bound()), (Some(kernel), Some(kernel.bound())), "{rest}");
        let text = explain(&plan);
        assert!(text.contains(name) && text.contains(said), "{rest}: {name} or {said} is missing in\n{text}");
        let word = if kernel.bound() == estimated { "estimated" } else { "proven" };
        assert_eq!(explain_json(&plan)["bound"], word, "{rest}");
    }
    assert_eq!(plan("integrate: march\n").bound(), None, "marching has none");
}

#[test]
fn lights_are_unit_vectors() {
    let lights = "effects: { shading: { lights: [{ directional: { towards: [0, -3e200, 4e200] } }] } }\n";
    let shading = plan(lights).scene.shading.unwrap();
    let [Light::Directional { towards, color }] = shading.lights.as_slice() else { panic!("{shading:?}") };
    assert!((*towards - glam::DVec3::new(0.0, -0.6, 0.8)).length() < 1e-12, "found {towards}");
    assert_eq!(*color, [1.0; 3]);
}

#[test]
fn the_background_is_black_unless_told() {
    assert_eq!(plan("").scene.background, Background::Color([0.0; 3]));
    assert_eq!(plan("image: { background: transparent }\n").scene.background, Background::Transparent);
}

#[test]
fn the_picture_is_where_it_is_wanted() {
    let output = |rest: &str, wanted: Option<&str>| {
        Plan::new(&spec(rest), &volume(), wanted.map(Path::new)).map(|plan| (plan.output.path, plan.output.format))
    };
    let is = |found: pellucid::Result<(PathBuf, Format)>, path: &str, format| {
        assert_eq!(found.unwrap(), (PathBuf::from(path), format));
    };
    is(output("", None), "pipelines/scene.png", Format::Png8);
    is(output("output: a.png\nimage: { bits: 16 }\n", None), "pipelines/a.png", Format::Png16);
    is(output("output: a.png\n", Some("b.exr")), "b.exr", Format::Exr);
    let error = output("", Some("b.gif")).unwrap_err();
    assert_eq!(error.fault(), Fault::Spec);
    assert!(error.to_string().contains("b.gif"), "found {error}");
}
