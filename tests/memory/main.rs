//! Memory: what a plan says against what an allocator counts. A program of its own, since the allocator counts everything
//! that its process holds; one test at a time may measure.

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use peak_alloc::PeakAlloc;
use pellucid::pipeline::{self, Options};
use pellucid::plan::Plan;
use pellucid::spec::Spec;
use pellucid::{Fault, integrate};

#[global_allocator]
static HEAP: PeakAlloc = PeakAlloc;

/// Held by the test that measures.
static MEASURING: Mutex<()> = Mutex::new(());

/// Waits for its turn.
fn alone() -> MutexGuard<'static, ()> {
    // The pool's own memory is not the picture's.
    rayon::broadcast(|_| ());
    MEASURING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Most bytes held by `work` beyond what is held before it.
fn peak_of<T>(work: impl FnOnce() -> T) -> (T, u64) {
    HEAP.reset_peak_usage();
    let before = HEAP.current_usage();
    let result = work();
    (result, (HEAP.peak_usage() - before) as u64)
}

const ONE_D: &str = "{ trapezoid: { hu: [100, 300, 2000, 3000] }, opacity_per_mm: 0.5, color: white }";
const TWO_D: &str = "{ trapezoid: { hu: [100, 300, 2000, 3000], gradient_hu_per_mm: [10, 100, 1000, 1200] }, \
                     opacity_per_mm: 0.5, color: white }";

/// Shows at every magnitude up to some, and so wherever the value does: everywhere.
const TWO_D_EVERYWHERE: &str = "{ trapezoid: { hu: [-3000, -2000, 3000, 4000], gradient_hu_per_mm: [0, 0, 1000, 1200] }, \
                                opacity_per_mm: 0.5, color: white }";

fn spec(volume: &str, widget: &str, rest: &str) -> Spec {
    let text = format!(
        "version: 1\nvolume: {volume}\ntransfer_function: [{{ widgets: [{widget}] }}]\nimage: {{ size: [128, 128] }}\n{rest}\n"
    );
    Spec::from_text(&text, Path::new("p.yaml"), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// A scan of the public ones.
#[expect(clippy::print_stderr, reason = "a skipped test says so")]
fn scan(name: &str) -> Option<String> {
    let found = std::env::var_os("PELLUCID_DATA").map(|root| Path::new(&root).join(name)).filter(|path| path.exists());
    if found.is_none() {
        eprintln!("skipped: set PELLUCID_DATA to the folder of public scans to test with {name}");
    }
    found.map(|path| path.display().to_string())
}

#[test]
fn the_plan_predicts_the_peak_on_public_scans() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let output = Some(folder.path().join("a.png"));
    for name in ["thorax-dicom", "engine.nrrd", "bonsai.nrrd", "abdomen/ct.nrrd"] {
        let Some(path) = scan(name) else { continue };
        for (widget, method) in [
            (ONE_D, "exact"),
            (TWO_D, "exact"),
            (ONE_D, "{ march: { step_voxels: 2 } }"),
            (TWO_D, "{ march: { step_voxels: 2 } }"),
        ] {
            let spec = spec(&format!("{{ source: '{path}', values: hu }}"), widget, &format!("integrate: {method}"));
            let options = Options { output: output.clone(), ..Options::default() };
            let scan = pipeline::load(&spec, &options).unwrap();
            let plan = pipeline::plan(&spec, &scan, &options).unwrap();
            let (planned, at_most) = (plan.memory_bytes(), kept_at_most(&plan));
            drop(scan);
            let (outcome, measured) = peak_of(|| pipeline::run(&spec, &options, &|_| ()));
            outcome.unwrap();
            let expected = 0.9 * (planned - at_most) as f64..1.1 * planned as f64;
            let expects = expected.contains(&(measured as f64));
            assert!(expects, "{name}, {method}: planned {planned} bytes, {at_most} of them at most; held {measured}");
        }
    }
}

/// The plan of a picture of the head phantom, and the bytes that rendering it took beyond the volume.
fn rendered(widget: &str, rest: &str) -> (Plan, u64) {
    let spec = spec("{ phantom: { head: { size: 96 } } }", widget, rest);
    let options = Options::default();
    let scan = pipeline::load(&spec, &options).unwrap();
    let plan = pipeline::plan(&spec, &scan, &options).unwrap();
    let (picture, bytes) = peak_of(|| integrate::render(&scan.volume, &plan.scene, &plan.method, &|_| ()));
    picture.unwrap();
    (plan, bytes)
}

/// Bytes for gradient magnitudes, of which only those are kept that are read.
fn kept_at_most(plan: &Plan) -> u64 {
    let is_kept = |what: &str| what.starts_with("gradient magnitude") && what.ends_with("at most");
    plan.stages.iter().filter(|stage| is_kept(&stage.what)).map(|stage| stage.bytes).sum()
}

/// Bytes that a plan gives to stages of this name.
fn planned(plan: &Plan, stages: &[&str]) -> u64 {
    plan.stages.iter().filter(|stage| stages.contains(&stage.name)).map(|stage| stage.bytes).sum()
}

#[test]
fn what_no_effect_reads_is_not_allocated() {
    let _alone = alone();
    let march = "integrate: { march: { step_voxels: 2 } }";
    let lit = "effects: { shading: {} }";
    let lamp = "shading: { lights: [{ directional: { towards: [1, -2, 1] } }] }";
    let cases = [
        ("1D", ONE_D, String::new()),
        ("1D, shaded", ONE_D, lit.to_owned()),
        ("2D", TWO_D, String::new()),
        ("2D, shaded", TWO_D, lit.to_owned()),
        ("1D, marched", ONE_D, march.to_owned()),
        ("1D, marched and shaded", ONE_D, format!("{march}\n{lit}")),
        ("2D, marched", TWO_D, march.to_owned()),
        ("2D, marched, everywhere", TWO_D_EVERYWHERE, march.to_owned()),
        ("a lamp without shadows", ONE_D, format!("effects: {{ {lamp} }}")),
        ("shadows", ONE_D, format!("effects: {{ {lamp}, shadows: {{}} }}")),
        ("shadows, marched", ONE_D, format!("{march}\neffects: {{ {lamp}, shadows: {{}} }}")),
        (
            "fog and haze",
            ONE_D,
            "effects: { fog: { exp: { density_per_mm: 0.001 } }, haze: { extinction_per_mm: 0.001 } }".to_owned(),
        ),
        ("classified at the voxels", ONE_D, "effects: { classify: voxels }".to_owned()),
    ];
    for (name, widget, rest) in cases {
        let (plan, bytes) = rendered(widget, &rest);
        let planned = planned(&plan, &["field", "classify", "light", "integrate"]);
        let apart = bytes.saturating_sub(planned).max((planned - kept_at_most(&plan)).saturating_sub(bytes));
        // What threads keep: those that march the pieces of a tile's rays, others the cells of a round. To march, blocks of 4³ cells are
        // skipped, where the plan counts blocks of 8³, which matters in a small volume alone.
        let threads = rayon::current_num_threads() as u64;
        let kept = if rest.contains("march") { 100_000 * threads + 130_000 } else { 160_000 * threads };
        let room = planned / 10 + 64_000 + kept;
        assert!(apart < room, "{name}: planned {planned} bytes beyond the volume, held {bytes}");
    }
}

#[test]
fn gradient_magnitudes_take_as_much_as_values_where_all_are_read_and_less_where_few_are() {
    let _alone = alone();
    let march = "integrate: { march: { step_voxels: 2 } }";
    let ((_, without), (plan, some), (_, all)) =
        (rendered(ONE_D, march), rendered(TWO_D, march), rendered(TWO_D_EVERYWHERE, march));
    // As many bits as a value has.
    let channel = plan.volume_bytes();
    assert_eq!(kept_at_most(&plan), channel, "what is planned for");
    assert!(all - without > channel * 9 / 10, "the channel has {channel} bytes; {without} without, {all} with");
    assert!(some - without < channel * 3 / 4, "{some} with some of the channel's {channel} bytes, {without} without");
    assert!(some - without > channel / 10, "{some} with some of the channel, {without} without");
}

#[test]
fn a_mask_takes_a_byte_per_voxel_and_none_takes_nothing() {
    let _alone = alone();
    let folder = tempfile::tempdir().unwrap();
    let options = Options { output: Some(folder.path().join("a.png")), ..Options::default() };
    let held = |effects: &str| {
        let spec = spec("{ phantom: { head: { size: 128 } } }", ONE_D, effects);
        let scan = pipeline::load(&spec, &options).unwrap();
        let plan = pipeline::plan(&spec, &scan, &options).unwrap();
        drop(scan);
        (planned(&plan, &["mask"]), plan.memory_bytes(), peak_of(|| pipeline::run(&spec, &options, &|_| ()).unwrap()).1)
    };
    let (masked, _, bytes) = held("effects: { mask: { phantom: structures, labels: { skull: hide } } }");
    let (plain, without, plain_bytes) = held("");
    let voxels = 128 * 128 * 119;
    assert_eq!((masked, plain), (voxels, 0), "a stage of its own, and none without a mask");
    assert!(bytes > plain_bytes + voxels / 4, "{bytes} held with a mask, {plain_bytes} without");
    assert!(plain_bytes < without + without / 10, "{plain_bytes} held without a mask, {without} planned");
}

#[test]
fn a_limit_is_kept_before_anything_is_allocated() {
    let _alone = alone();
    let spec = spec("{ phantom: { head: { size: 96 } } }", TWO_D, "integrate: { march: { step_voxels: 2 } }");
    let folder = tempfile::tempdir().unwrap();
    let never = folder.path().join("never.png");
    let options = Options { output: Some(never.clone()), max_memory_bytes: Some(3_500_000), level: None };
    let (outcome, bytes) = peak_of(|| pipeline::run(&spec, &options, &|_| ()));
    let error = outcome.expect_err("the gradient magnitude and what is made of it take more");
    assert_eq!(error.fault(), Fault::Limit, "found {error}");
    assert!(bytes < 3_500_000, "{bytes} bytes were held");
    assert!(!never.exists(), "nothing is written");
}

#[test]
fn a_scan_beyond_the_limit_is_refused_by_its_header() {
    let _alone = alone();
    let public =
        ["engine.nrrd", "thorax-dicom"].into_iter().filter_map(scan).map(|path| format!("{{ source: '{path}' }}"));
    for volume in public.chain(["{ phantom: { head: { size: 512 } } }".to_owned()]) {
        let spec = spec(&volume, ONE_D, "");
        let options = Options { max_memory_bytes: Some(5_000_000), ..Options::default() };
        let (loaded, bytes) = peak_of(|| pipeline::load(&spec, &options));
        let error = loaded.expect_err("more than 5 MB");
        assert_eq!(error.fault(), Fault::Limit, "found {error}");
        assert!(bytes < 3_000_000, "{volume}: {bytes} bytes were held to find out");
    }
}
