//! `pellucid study`, and pipelines that leave the method to measurements.

use super::program::{Folder, pellucid};

#[test]
fn a_study_is_a_folder_of_tables_charts_and_maps() {
    let folder = Folder::new("study");
    let (pipeline, out) = (folder.pipeline(), folder.path("out"));
    let run = pellucid(&["study", &pipeline, "-o", &out, "--seconds", "1", "--pixels", "50"]).success();
    assert!(run.stdout.starts_with("# Accuracy against time\n"), "found:\n{}", run.stdout);
    for name in ["study.md", "study.json", "settings.csv", "costs.csv", "accuracy-against-time.svg"] {
        let text = std::fs::read_to_string(folder.path(&format!("out/{name}"))).expect(name);
        assert!(text.len() > 100, "{name} has {} bytes", text.len());
    }
    let maps =
        std::fs::read_dir(&out).expect("a folder").filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let pictures: Vec<String> = maps.filter(|name| name.ends_with(".png")).collect();
    assert!(pictures.len() >= 2, "a chart and at least one map, found {pictures:?}");
}

#[test]
fn a_python_without_vtk_is_said_before_anything_is_measured() {
    let folder = Folder::new("study-without-vtk");
    let (pipeline, out) = (folder.pipeline(), folder.path("out"));
    let run = pellucid(&["study", &pipeline, "-o", &out, "--peers", "vtk", "--python", "no-such-python"]).failure(4);
    assert!(run.stderr.contains("no-such-python") && run.stderr.contains("--python"), "found {}", run.stderr);
    assert!(!std::path::Path::new(&out).exists(), "nothing is written");
}

#[test]
fn arguments_of_a_study_that_mean_nothing_are_refused() {
    for wrong in [["--tolerance", "0"], ["--tolerance", "1"], ["--seconds", "-1"], ["--pixels", "0"]] {
        let argument = format!("{}={}", wrong[0], wrong[1]);
        let run = pellucid(&["study", "x.yaml", "-o", "out", &argument]).failure(2);
        assert!(run.stderr.contains(wrong[0]), "{wrong:?}: found {}", run.stderr);
    }
}

#[test]
fn a_method_left_to_measurements_is_chosen_and_said() {
    let folder = Folder::new("auto");
    let (pipeline, picture) = (folder.pipeline(), folder.path("auto.png"));
    let run = pellucid(&["render", &pipeline, "--set", "integrate=auto", "-o", &picture]).success();
    run.says(&["integrate: {", "random pixels", "warning: integrate: auto"]);
    let sidecar = std::fs::read_to_string(format!("{picture}.json")).expect("a sidecar");
    let sidecar: serde_json::Value = serde_json::from_str(&sidecar).expect("JSON");
    let (tolerance, candidates) = (&sidecar["method"]["tolerance"], &sidecar["choice"]["candidates"]);
    assert!(tolerance.as_f64().is_some_and(|t| (t - 1.0 / 255.0).abs() < 1e-12), "found {tolerance}");
    assert!(candidates.as_array().is_some_and(|all| !all.is_empty()), "found {candidates}");
    assert_eq!(sidecar["plan"]["method"], sidecar["choice"]["method"], "the method chosen is the one of the plan");
}

#[test]
fn explain_says_which_method_measurements_choose() {
    let folder = Folder::new("auto-explained");
    let pipeline = folder.pipeline();
    let run = pellucid(&["explain", &pipeline, "--set", "integrate.auto.budget_ms=60000"]).success();
    let line = run.stdout.lines().find(|line| line.starts_with("chosen"));
    assert!(line.is_some_and(|line| line.contains("most accurate of")), "found:\n{}", run.stdout);
    assert_eq!(folder.names(), ["head.yaml"], "nothing is written");
}
