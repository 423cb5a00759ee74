//! `render` and `explain` end to end.

use super::program::{Folder, pellucid};

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).expect("valid JSON")
}

/// The bytes after decoding, so that metadata may differ.
fn pixels(path: &str) -> Vec<u8> {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("the picture is there"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("of a size that fits")];
    let frame = reader.next_frame(&mut pixels).expect("whole");
    pixels.truncate(frame.buffer_size());
    pixels
}

#[test]
fn stdout_is_the_path_and_the_sidecar_lies_beside_the_picture() {
    let folder = Folder::new("render");
    let run = pellucid(&["render", &folder.pipeline()]).success();
    assert_eq!(run.stdout, format!("{}\n", folder.path("head.png")));
    assert_eq!(folder.names(), ["head.png", "head.png.json", "head.yaml"]);
    assert!(run.stderr.contains("integrate") && run.stderr.contains("threads"), "a summary; found:\n{}", run.stderr);
    assert!(!run.stderr.contains('\u{1b}'), "no colours and no bar where no terminal is; found:\n{}", run.stderr);
}

#[test]
fn quiet_says_nothing_but_the_result() {
    let folder = Folder::new("quiet");
    let run = pellucid(&["-q", "render", &folder.pipeline()]).success();
    assert_eq!(run.stderr, "");
    assert_eq!(run.stdout.lines().count(), 1, "found {:?}", run.stdout);
}

#[test]
fn the_picture_goes_where_it_is_told_and_its_folders_are_made() {
    let folder = Folder::new("output");
    let picture = folder.path("deep/er/x.png");
    let run = pellucid(&["render", &folder.pipeline(), "-o", &picture, "--size", "8x6"]).success();
    assert_eq!(run.stdout, format!("{picture}\n"));
    assert_eq!(pixels(&picture).len() % (8 * 6), 0, "8 x 6 pixels");
}

#[test]
fn an_override_changes_the_picture() {
    let folder = Folder::new("override");
    let pipeline = folder.pipeline();
    let turned = folder.path("turned.png");
    pellucid(&["render", &pipeline]).success();
    pellucid(&["render", &pipeline, "--set", "camera.azimuth=-60", "-o", &turned]).success();
    assert_ne!(pixels(&folder.path("head.png")), pixels(&turned));
}

#[test]
fn the_number_of_threads_does_not_show() {
    let folder = Folder::new("threads");
    let pipeline = folder.pipeline();
    let render = |threads: &str, name: &str| {
        let picture = folder.path(name);
        pellucid(&["render", &pipeline, "--threads", threads, "-o", &picture]).success();
        let sidecar = std::fs::read_to_string(format!("{picture}.json")).expect("the sidecar");
        (pixels(&picture), json(&sidecar)["picture"]["pixels_sha256"].to_string())
    };
    let (one, two) = (render("1", "one.png"), render("2", "two.png"));
    assert_eq!(one.1, two.1, "the same pixels before encoding");
    assert!(one.0 == two.0, "the same pixels after encoding");
    assert!(one.0.iter().any(|&byte| byte != one.0[0]), "and something is in the picture");
}

#[test]
fn the_sidecar_says_how_the_picture_was_made_and_not_of_whom() {
    let folder = Folder::new("sidecar");
    let scan = folder.path("DOE^JANE.nrrd");
    pellucid(&["phantom", "head", "--size", "24", "--nrrd", &scan]).success();
    let source = format!("volume.source={scan}");
    let pipeline = folder.pipeline();
    pellucid(&["render", &pipeline, "--set", &source]).success();
    let text = std::fs::read_to_string(folder.path("head.png.json")).expect("the sidecar");
    assert!(!text.contains("DOE"), "neither the scan's path nor its name; found:\n{text}");
    let sidecar = json(&text);
    let info = json(&pellucid(&["info", &scan, "--format", "json"]).success().stdout);
    for key in ["values_sha256", "dims", "index_to_lps_mm"] {
        assert_eq!(sidecar["volume"][key], info[key], "{key} as `info` gives it");
    }
    assert_eq!(sidecar["method"]["name"], "exact");
    let (bound, asked) = (&sidecar["method"]["error_bound"], &sidecar["method"]["tolerance"]);
    assert!(bound.as_f64() <= asked.as_f64() && bound.is_f64(), "bound {bound}, asked {asked}");
    let stages: Vec<&str> =
        sidecar["stages"].as_array().expect("a list").iter().filter_map(|s| s["stage"].as_str()).collect();
    assert_eq!(stages, ["load", "plan", "normalise", "integrate", "encode"]);
    assert_eq!(sidecar["picture"]["size"], serde_json::json!([40, 30]));
}

#[test]
fn explain_renders_nothing() {
    let folder = Folder::new("explain");
    let pipeline = folder.pipeline();
    let text = pellucid(&["explain", &pipeline]).success().stdout;
    assert!(text.contains("exact"), "names the method; found:\n{text}");
    let plan = json(&pellucid(&["explain", &pipeline, "--format", "json"]).success().stdout);
    assert!(plan.is_object(), "found {plan}");
    assert_eq!(folder.names(), ["head.yaml"]);
}
