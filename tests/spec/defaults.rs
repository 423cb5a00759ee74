//! What is left out stays open in the spec, and forms that are kinder than YAML are understood.

use pellucid::spec::{BackgroundSpec, Color, IntegrateSpec, LightSpec, PhantomBody, PhantomSpec, Series, VolumeSource};
use std::path::{Path, PathBuf};

use super::{SHORT, read};

#[test]
fn what_is_left_out_is_none() {
    let pipeline = read(SHORT).unwrap().pipeline;
    assert_eq!(pipeline.volume.phantom, Some(PhantomSpec::Head(PhantomBody::default())), "a name takes its defaults");
    assert!(pipeline.camera.is_none() && pipeline.integrate.is_none() && pipeline.effects.is_none());
    assert!(pipeline.output.is_none() && pipeline.certify.is_none() && pipeline.image.is_none());
}

#[test]
fn numbers_may_be_fractions() {
    let tolerance = |text: &str| match read(&format!("{SHORT}integrate: {{ exact: {{ tolerance: {text} }} }}\n")) {
        Ok(spec) => match spec.pipeline.integrate {
            Some(IntegrateSpec::Exact(exact)) => exact.tolerance,
            other => panic!("found {other:?}"),
        },
        Err(error) => panic!("{error}"),
    };
    for text in ["1/256", "\"1/256\"", "1 / 256", "0.00390625", "3.90625e-3"] {
        assert_eq!(tolerance(text), Some(1.0 / 256.0), "{text}");
    }
}

#[test]
fn choices_may_be_written_by_name_alone() {
    let text = format!("{SHORT}integrate: march\neffects: {{ shading: {{ lights: [headlight] }} }}\n");
    let pipeline = read(&text).unwrap().pipeline;
    assert_eq!(pipeline.integrate, Some(IntegrateSpec::March(Default::default())));
    let lights = pipeline.effects.and_then(|e| e.shading).and_then(|s| s.lights);
    assert_eq!(lights, Some(vec![LightSpec::Headlight { color: None }]));
}

#[test]
fn colors_are_srgb_in_hexadecimal_and_linear_in_numbers() {
    let background = |text: &str| {
        let image = read(&format!("{SHORT}image: {{ background: {text} }}\n")).unwrap().pipeline.image;
        image.and_then(|image| image.background)
    };
    assert_eq!(background("transparent"), Some(BackgroundSpec::Transparent));
    assert_eq!(background("\"#fff\""), Some(BackgroundSpec::Color(Color([1.0; 3]))));
    assert_eq!(background("[0.25, 0.5, 1]"), Some(BackgroundSpec::Color(Color([0.25, 0.5, 1.0]))));
    let Some(BackgroundSpec::Color(Color([r, g, b]))) = background("\"#bc0a00\"") else { panic!("no colour") };
    // IEC 61966-2-1: 188/255 by the power law, 10/255 by the straight piece.
    assert!((r - 0.502_886).abs() < 1e-6, "found {r}");
    assert!((g - 10.0 / 255.0 / 12.92).abs() < 1e-12, "found {g}");
    assert_eq!(b, 0.0);
}

#[test]
fn paths_are_relative_to_the_pipeline() {
    let text = SHORT.replace("phantom: head", "source: ../scans/head, series: largest");
    let spec = pellucid::spec::Spec::from_text(&text, Path::new("pipelines/a.yaml"), &[]).unwrap();
    let path = PathBuf::from("pipelines/../scans/head");
    let expected = VolumeSource::File { path, series: Some(Series::Largest), slices: None };
    assert_eq!(spec.volume_source(), expected);
    assert_eq!(spec.output(), None);
    let text = format!("{text}output: /pictures/head.png\n");
    let spec = pellucid::spec::Spec::from_text(&text, Path::new("pipelines/a.yaml"), &[]).unwrap();
    assert_eq!(spec.output(), Some(PathBuf::from("/pictures/head.png")), "an absolute path stays");
}

#[test]
fn a_resolved_pipeline_reads_back_the_same() {
    let text = include_str!("../../pipelines/boundaries.yaml");
    let spec = read(text).unwrap();
    let json = serde_json::to_string(&spec.pipeline).unwrap();
    let again = read(&json).unwrap();
    assert_eq!(again.pipeline, spec.pipeline, "JSON is YAML: {json}");
}
