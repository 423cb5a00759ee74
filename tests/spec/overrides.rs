//! `--set key.path=value`.

use std::path::Path;

use pellucid::spec::{Color, IntegrateSpec, Pipeline, Spec};

use super::SHORT;

fn with(text: &str, overrides: &[&str]) -> pellucid::Result<Pipeline> {
    let overrides: Vec<String> = overrides.iter().map(|&o| o.to_owned()).collect();
    Spec::from_text(text, Path::new("scene.yaml"), &overrides).map(|spec| spec.pipeline)
}

#[test]
fn overrides_change_add_and_remove_keys() {
    let text = format!("{SHORT}integrate: exact\neffects: {{ shading: {{ ambient: 0.1 }} }}\n");
    let pipeline = with(
        &text,
        &[
            "integrate.exact.tolerance=1/1000",
            "transfer_function.0.opacity_scale=0.5",
            "transfer_function.0.color=#ffffff",
            "camera.view=left",
            "camera={ view: right }",
            "effects.shading=null",
            "image.size=[64, 32]",
        ],
    )
    .unwrap();
    let Some(IntegrateSpec::Exact(exact)) = pipeline.integrate else { panic!("not exact") };
    assert_eq!(exact.tolerance, Some(0.001), "a setting of what was written by its name alone");
    assert_eq!(pipeline.transfer_function[0].opacity_scale, Some(0.5));
    assert_eq!(pipeline.transfer_function[0].color, Some(Color::WHITE), "a colour without quotes is no comment");
    assert_eq!(pipeline.camera.and_then(|c| c.view), Some(pellucid::spec::ViewName::Right), "the last one counts");
    assert_eq!(pipeline.effects.and_then(|e| e.shading), None, "null removes");
    assert_eq!(pipeline.image.and_then(|i| i.size), Some([64, 32]));
}

#[test]
fn errors_name_the_override() {
    let message = |set: &str| match with(SHORT, &[set]) {
        Ok(pipeline) => panic!("{set} passed: {pipeline:?}"),
        Err(error) => error.to_string(),
    };
    assert_eq!(
        message("camera.azimut=3"),
        "--set camera.azimut=3: there is no such key (camera.azimut): found azimut, expected one of view, azimuth, \
         elevation, roll, zoom, projection, fov_degrees, fit, position_mm, target_mm, up, height_mm\n  \
         remedy: did you mean azimuth?"
    );
    assert_eq!(
        message("camera.fov_degrees=200"),
        "--set camera.fov_degrees=200: a value is out of range (camera.fov_degrees): found 200, expected an angle above 0 \
         and below 180 degrees"
    );
    assert_eq!(
        message("transfer_function.1.preset=skin"),
        "--set transfer_function.1.preset=skin: there is no item 1 in a list of 1; the first is 0 \
         (transfer_function.1.preset)"
    );
    assert!(message("camera").contains("an override has no value"), "{}", message("camera"));
    assert!(message("camera..view=left").contains("an empty key"));
    assert!(message("camera={ view: ").contains("not valid YAML"));
}

#[test]
fn paths_of_an_override_are_relative_to_the_working_directory() {
    use pellucid::spec::VolumeSource;
    let text = SHORT.replace("phantom: head", "source: scan.nrrd");
    let path = |overrides: &[String]| {
        let spec = Spec::from_text(&text, Path::new("pipelines/scene.yaml"), overrides).unwrap();
        match spec.volume_source() {
            VolumeSource::File { path, .. } => path,
            other => panic!("found {other:?}"),
        }
    };
    assert_eq!(path(&[]), Path::new("pipelines/scan.nrrd"));
    assert_eq!(path(&["volume.source=scans/head.nrrd".to_owned()]), Path::new("scans/head.nrrd"));
}

#[test]
fn labels_in_a_file_take_the_place_of_a_phantoms() {
    let text = format!("{SHORT}effects: {{ mask: {{ phantom: structures, labels: {{ 1: hide }} }} }}\n");
    let overrides = ["volume.source=scan.nrrd".to_owned(), "effects.mask.source=scan.seg.nrrd".to_owned()];
    let spec = Spec::from_text(&text, Path::new("scene.yaml"), &overrides).expect("labels of the scan");
    assert_eq!(spec.labels_path().as_deref(), Some(Path::new("scan.seg.nrrd")));
    assert_eq!(spec.pipeline.effects.and_then(|effects| effects.mask).and_then(|mask| mask.phantom), None);
}
