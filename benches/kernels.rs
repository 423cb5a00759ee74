//! Kernels over the public API: samples per second of both integrators, and what surrounds them.
//!
//! `cargo bench --bench kernels -- [FILTER]`. One thread, so that a number is one core's. Compare runs on the same machine
//! only; for regressions in numbers that no other load disturbs see `instructions.py`.
#![allow(missing_docs, reason = "criterion's macros make items without docs")]
#![allow(clippy::print_stderr, reason = "counts that go with the rates, for a program that is run by hand")]

use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group};
use pellucid::classify::{Classifier, bake};
use pellucid::image::metrics;
use pellucid::integrate;
use pellucid::io;
use pellucid::io::dicom::SeriesChoice;
use pellucid::pipeline::{self, Options};
use pellucid::plan::Plan;
use pellucid::spec::Spec;
use pellucid::volume::Volume;

/// Pipelines differ from `head.yaml` by these: value alone, or its opacities weighted by the gradient magnitude.
const TWO_D: &str = "transfer_function.0.widgets.0.gradient_weight=[[0, 0], [300, 1]]";
const LIT: &str = "effects.shading={}";
const METHODS: [(&str, &str); 2] =
    [("exact", "integrate={ exact: { tolerance: 1/255 } }"), ("march", "integrate={ march: { step_voxels: 1/2 } }")];

/// The head with these changes, resolved.
fn planned(changes: &[&str]) -> (Volume, Plan) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/head.yaml");
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    let options = Options::default();
    let spec = Spec::load(&path, &changes).expect("a valid pipeline");
    let scan = pipeline::load(&spec, &options).expect("a phantom");
    let plan = pipeline::plan(&spec, &scan, &options).expect("a plan");
    (scan.volume, plan)
}

/// Samples per second of each integrator, by a 1D and a 2D transfer function, unlit and lit.
fn integrators(criterion: &mut Criterion) {
    for (method, integrate) in METHODS {
        let mut group = criterion.benchmark_group(method);
        for (name, changes) in
            [("1d/unlit", vec![]), ("1d/lit", vec![LIT]), ("2d/unlit", vec![TWO_D]), ("2d/lit", vec![TWO_D, LIT])]
        {
            let changes: Vec<&str> = std::iter::once(integrate).chain(changes).collect();
            let (volume, plan) = planned(&changes);
            let render = || integrate::render(&volume, &plan.scene, &plan.method, &|_| ()).expect("a picture");
            let counted = render().statistics;
            let per_ray = counted.samples as f64 / counted.rays.max(1) as f64;
            eprintln!("{}: {} rays, {} samples, {per_ray:.1} per ray", counted.kernel, counted.rays, counted.samples);
            group.throughput(Throughput::Elements(counted.samples));
            group.bench_function(name, |bencher| bencher.iter(|| black_box(render())));
        }
        group.finish();
    }
}

/// Look-ups per second of a baked transfer function.
fn classification(criterion: &mut Criterion) {
    const LOOKUPS: u16 = 4096;
    let mut group = criterion.benchmark_group("classify");
    group.throughput(Throughput::Elements(u64::from(LOOKUPS)));
    for (name, changes) in [("1d", vec![]), ("2d", vec![TWO_D])] {
        let (volume, plan) = planned(&changes);
        let baked = bake::<f32>(&plan.scene.transfer_function, volume.rescale());
        group.bench_function(name, |bencher| bencher.iter(|| (0..LOOKUPS).map(|n| looked_up(&baked, n)).sum::<f32>()));
    }
    group.finish();
}

/// Extinction at one of many places over both axes.
fn looked_up(baked: &pellucid::classify::Baked<f32>, n: u16) -> f32 {
    use pellucid::classify::Baked;
    let (value, gradient) = (f32::from(n) - 1024.0, f32::from(n % 61) * 10.0);
    match baked {
        Baked::OneD(function) => black_box(function.classify(value, gradient))[3],
        Baked::TwoD(function) => black_box(function.classify(value, gradient))[3],
    }
}

/// Pixels per second of a comparison of two pictures.
fn comparison(criterion: &mut Criterion) {
    let [coarse, fine] = [METHODS[1].1, METHODS[0].1].map(|integrate| {
        let (volume, plan) = planned(&[integrate]);
        integrate::render(&volume, &plan.scene, &plan.method, &|_| ()).expect("a picture").image
    });
    let mut group = criterion.benchmark_group("compare");
    group.throughput(Throughput::Elements(fine.pixels().len() as u64));
    group.bench_function("numbers", |b| b.iter(|| metrics::compare(&fine, &coarse, 1.0 / 255.0)));
    group.bench_function("as seen", |b| b.iter(|| metrics::compare_as_seen(&fine, &coarse, 1.0 / 255.0)));
    group.finish();
}

/// Bytes per second from a NRRD file that is in the system's cache.
fn loading(criterion: &mut Criterion) {
    let (volume, _) = planned(&[]);
    let folder = tempfile::tempdir().expect("a folder");
    let mut group = criterion.benchmark_group("load");
    group.throughput(Throughput::Bytes(2 * volume.grid().voxel_count() as u64));
    for (name, encoding) in [("nrrd/raw", io::nrrd::Encoding::Raw), ("nrrd/gzip", io::nrrd::Encoding::Gzip)] {
        let path = folder.path().join("head.nrrd");
        io::nrrd::write(&path, &volume, encoding, &[]).expect("written");
        group.bench_function(name, |bencher| {
            bencher.iter(|| io::load(&path, &SeriesChoice::default(), None).expect("read"))
        });
    }
    group.finish();
}

/// On one thread, with a time for each that keeps the whole run within a few minutes.
fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("one thread");
    benches();
    Criterion::default().configure_from_args().final_summary();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(4)).configure_from_args();
    targets = integrators, classification, comparison, loading
}
