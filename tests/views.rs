//! Several views with one set-up: each is, to the bit, the picture that it would be alone.

use std::path::Path;

use pellucid::Fault;
use pellucid::integrate::{Schedule, Views};
use pellucid::pipeline::{self, Options, Outcome};
use pellucid::spec::Spec;

const ONE_D: &str = "transfer_function: [{ preset: skin, opacity_scale: 0.4 }, { preset: bone }]";
const TWO_D: &str = "transfer_function: [{ widgets: [{ trapezoid: { hu: [100, 300, 2000, 3000], \
                     gradient_hu_per_mm: [10, 100, 1000, 1200] }, opacity_per_mm: 0.5, color: white }] }]";
const LIT: &str = "effects: { shading: { ambient: 0.2, diffuse: 0.7, specular: 0.2 } }";

fn spec(what: &str, camera: &str) -> Spec {
    let text = format!(
        "version: 1\nvolume: {{ phantom: {{ head: {{ size: 40 }} }} }}\nimage: {{ size: [40, 32] }}\n{what}\n{camera}\n"
    );
    Spec::from_text(&text, Path::new("head.yaml"), &[]).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn run(spec: &Spec) -> (tempfile::TempDir, Vec<Outcome>) {
    let folder = tempfile::tempdir().expect("a folder");
    let options = Options { output: Some(folder.path().join("head.png")), ..Options::default() };
    let outcomes = pipeline::run(spec, &options, &|_| ()).unwrap_or_else(|error| panic!("{error}"));
    (folder, outcomes)
}

/// Hashes of the pixels before encoding.
fn pictures(spec: &Spec) -> Vec<String> {
    run(spec).1.into_iter().map(|outcome| outcome.sidecar.picture.pixels_sha256).collect()
}

#[test]
fn each_view_is_the_picture_that_it_is_alone() {
    let kinds = [
        ("exact", format!("{ONE_D}\nintegrate: exact")),
        ("exact, 2D, lit", format!("{TWO_D}\n{LIT}\nintegrate: exact")),
        ("exact, f64", format!("{ONE_D}\nintegrate: {{ exact: {{ tolerance: 1e-9 }} }}")),
        ("march", format!("{ONE_D}\nintegrate: march")),
        ("march, 2D, lit", format!("{TWO_D}\n{LIT}\nintegrate: march")),
        ("march, trapezoid", format!("{TWO_D}\nintegrate: {{ march: {{ rule: trapezoid }} }}")),
        ("as VTK", format!("{ONE_D}\n{LIT}\nintegrate: {{ march: {{ compatibility: vtk }} }}")),
        ("maximum", "effects: { project: { show: maximum, window_hu: [0, 1800] } }\nintegrate: march".to_owned()),
        (
            "optical depth",
            format!(
                "{TWO_D}\neffects: {{ project: {{ show: optical-depth, window_optical_depth: [0, 3] }} }}\nintegrate: march"
            ),
        ),
        ("surfaces", "effects: { surfaces: [{ hu: 400, color: white }] }\nintegrate: march".to_owned()),
        ("at voxels", format!("{ONE_D}\neffects: {{ classify: voxels }}\nintegrate: march")),
        (
            "at voxels, lit",
            format!("{ONE_D}\neffects: {{ classify: voxels, shading: {{ ambient: 0.2 }} }}\nintegrate: exact"),
        ),
        (
            "shadows",
            format!(
                "{ONE_D}\neffects: {{ shading: {{ lights: [{{ directional: {{ towards: [-1, -1, 1] }} }}] }}, \
                 shadows: {{ strength: 1 }} }}\nintegrate: {{ march: {{ step_voxels: 1 }} }}"
            ),
        ),
        (
            "fog",
            format!("{ONE_D}\neffects: {{ fog: {{ linear: {{ start_mm: 100, end_mm: 900 }} }} }}\nintegrate: march"),
        ),
        (
            "depth cue",
            format!("{ONE_D}\neffects: {{ depth_cue: {{ constant: 0.1, per_mm: 0.003 }} }}\nintegrate: march"),
        ),
        (
            "mask",
            format!(
                "{ONE_D}\neffects: {{ mask: {{ phantom: structures, labels: {{ skull: hide }} }} }}\nintegrate: exact"
            ),
        ),
    ];
    let cameras = ["{ view: left, elevation: 20 }", "{ azimuth: 30 }", "{ view: superior, projection: parallel }"];
    for (kind, what) in kinds {
        let together = pictures(&spec(&what, &format!("views: {{ cameras: [{}] }}", cameras.join(", "))));
        let alone = cameras.map(|camera| pictures(&spec(&what, &format!("camera: {camera}"))).remove(0));
        assert_eq!(together, alone, "{kind}");
        assert!(alone[0] != alone[1] && alone[1] != alone[2], "{kind}: three views are three pictures");
    }
}

#[test]
fn each_view_has_a_file_of_its_own_with_its_sidecar() {
    let turntable = "camera: { elevation: 10 }\nviews: { turntable: { pictures: 12, degrees: 90 } }";
    let (folder, outcomes) = run(&spec(ONE_D, turntable));
    let names: Vec<_> = outcomes.iter().map(|o| o.sidecar.picture.file.clone()).collect();
    assert_eq!((names.len(), names[0].as_str(), names[11].as_str()), (12, "head-01.png", "head-12.png"));
    for outcome in &outcomes {
        assert!(outcome.picture.exists() && outcome.sidecar_path.exists(), "{}", outcome.picture.display());
    }
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 24, "and nothing else");
    let stages = |o: &Outcome| o.sidecar.stages.iter().map(|s| s.stage).collect::<Vec<_>>();
    assert_eq!(stages(&outcomes[0])[0], "load");
    assert_eq!(stages(&outcomes[5]), ["plan", "integrate", "encode"], "a further view reads nothing again");
    let plan = &outcomes[5].sidecar.plan;
    assert_eq!(plan["view"], serde_json::json!([5, 12]));
}

#[test]
fn the_patient_on_a_turntable_comes_no_nearer() {
    let turntable = "views: { turntable: { pictures: 8 } }";
    let (_folder, outcomes) = run(&spec(ONE_D, turntable));
    let distances: Vec<f64> = outcomes
        .iter()
        .map(|o| {
            let at = o.sidecar.plan["camera"]["position_mm"].as_array().expect("three numbers").clone();
            let [x, y] = [0, 1].map(|i| at[i].as_f64().expect("a number"));
            x.hypot(y)
        })
        .collect();
    let [least, most] = [f64::min, f64::max].map(|f| distances.iter().copied().reduce(f).expect("eight"));
    // The volume's centre is not the origin.
    assert!(most - least < 0.1 * most, "found {distances:?}");
    let alone = run(&spec(ONE_D, "camera: { view: anterior }")).1.remove(0);
    let from_front = alone.sidecar.plan["camera"]["position_mm"][1].as_f64().expect("a number").abs();
    assert!(distances[0] > from_front, "far enough for the corners: {} mm, {from_front} mm alone", distances[0]);
}

#[test]
fn what_a_view_reads_of_the_volume_is_made_once() {
    let spec = spec(TWO_D, "integrate: march");
    let scan = pipeline::load(&spec, &Options::default()).expect("a scan");
    let plan = pipeline::plan(&spec, &scan, &Options::default()).expect("a plan");
    let views = Views::new(&scan.volume, &plan.scene, &plan.method, Schedule::default()).expect("views");
    let first = views.render(&|_| ()).expect("a picture");
    let again = views.render_scene(&plan.scene.clone(), &|_| ()).expect("a picture");
    assert_eq!(first.image.pixels(), again.image.pixels());
    assert_eq!(first.statistics, again.statistics);
}

#[test]
fn views_that_cannot_be_are_refused() {
    let refused = |camera: &str| {
        let text = format!("version: 1\nvolume: {{ phantom: head }}\n{ONE_D}\n{camera}\n");
        let error = Spec::from_text(&text, Path::new("head.yaml"), &[]).expect_err(camera);
        assert_eq!(error.fault(), Fault::Spec, "{error}");
        error.to_string()
    };
    let placed = "camera: { position_mm: [0, -900, 0], target_mm: [0, 0, 0] }\n";
    for (camera, says) in [
        ("views: { cameras: [] }".to_owned(), "1 to 10000 cameras"),
        ("views: { turntable: { pictures: 0 } }".to_owned(), "1 to 10000 pictures"),
        ("views: { cameras: [{}, { zoom: -1 }] }".to_owned(), "views.cameras.1.zoom"),
        (format!("{placed}views: {{ turntable: {{}} }}"), "views.turntable"),
        (format!("{placed}views: {{ cameras: [{{ azimuth: 5 }}] }}"), "views.cameras.0.azimuth"),
        ("views: { cameras: [{ azimut: 5 }] }".to_owned(), "azimut"),
    ] {
        let found = refused(&camera);
        assert!(found.contains(says), "{camera}\nfound: {found}\nexpected in it: {says}");
    }
}
