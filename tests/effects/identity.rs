//! An effect of no strength is an effect that is off, and nothing but the scene decides what is seen.

use std::path::Path;

use glam::DVec3;
use pellucid::integrate::{Schedule, render, render_scheduled};
use pellucid::pipeline;
use pellucid::plan::{Emission, Exact, Method, Plan, VolumeInfo};
use pellucid::scene::{DepthCue, Effects, Fog, FogLaw, Haze, Light, Scattering, Scene, Shadows};
use pellucid::spec::Spec;

use crate::march::scenes::{MARCH, blobs_i16, scene, tissue_2d, two_lights};

/// A small head, lit from the side, with these effects besides shading, by this method.
fn picture(effects: &str, method: &str) -> Vec<[u32; 4]> {
    let text = format!(
        "version: 1
volume: {{ phantom: {{ head: {{ size: 24 }} }} }}
transfer_function: [{{ preset: bone }}]
effects:
  shading: {{ lights: [{{ directional: {{ towards: [1, -2, 1] }} }}] }}
{effects}
integrate: {method}
image: {{ size: [32, 32], background: gray }}
"
    );
    let spec = Spec::from_text(&text, Path::new("scene.yaml"), &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let scan = pipeline::load(&spec, &pipeline::Options::default()).expect("a phantom");
    let plan = Plan::new(&spec, &VolumeInfo::from(&scan.volume), None).unwrap_or_else(|error| panic!("{error}"));
    let rendered = render(&scan.volume, &plan.scene, &plan.method, &|_| ()).expect("a picture");
    rendered.image.pixels().iter().map(|p| p.map(f32::to_bits)).collect()
}

#[test]
fn an_effect_of_no_strength_changes_no_bit_and_one_of_some_does() {
    for method in ["exact", "{ march: { step_voxels: 1 } }"] {
        let off = picture("", method);
        for (none, some) in [
            ("depth_cue: { constant: 1, per_mm: 0 }", "depth_cue: { per_mm: 0.001 }"),
            ("shadows: { strength: 0 }", "shadows: { strength: 0.5 }"),
            ("scattering: { albedo: 0 }", "scattering: { albedo: 0.5, anisotropy: 0.3 }"),
            ("fog: { exp: { density_per_mm: 0 } }", "fog: { exp: { density_per_mm: 0.001 } }"),
            ("fog: { exp2: { density_per_mm: 0 } }", "fog: { exp2: { density_per_mm: 0.001 } }"),
            (
                "fog: { linear: { start_mm: 9000, end_mm: 9001 }, color: red }",
                "fog: { linear: { start_mm: 300, end_mm: 900 }, color: red }",
            ),
            ("haze: { extinction_per_mm: 0 }", "haze: { extinction_per_mm: 0.001, color: white }"),
        ] {
            assert!(picture(&format!("  {none}"), method) == off, "{none} changes the picture by {method}");
            assert!(picture(&format!("  {some}"), method) != off, "{some} does not change the picture by {method}");
        }
    }
}

/// All of them at once, on two blobs.
fn everything(scene: Scene) -> Scene {
    let towards = DVec3::new(0.3, -0.8, 0.5).normalize();
    let mut shading = two_lights();
    shading.lights.push(Light::Directional { towards, color: [0.2, 0.4, 0.3] });
    let effects = Effects {
        depth_cue: Some(DepthCue { constant: 0.9, per_mm: 0.002 }),
        shadows: Some(Shadows { strength: 0.8 }),
        scattering: Some(Scattering { albedo: 0.4, anisotropy: 0.3, lights: vec![(towards, [1.0, 0.9, 0.8])] }),
        fog: Some(Fog { law: FogLaw::Exp { density_per_mm: 0.003 }, color: [0.1, 0.2, 0.3] }),
        haze: Some(Haze { extinction_per_mm: 0.002, color: [0.3, 0.3, 0.4], end_mm: 500.0 }),
        ..Effects::default()
    };
    Scene { shading: Some(shading), effects, ..scene }
}

#[test]
fn threads_and_the_order_of_tiles_do_not_matter() {
    let volume = blobs_i16();
    let scene = everything(scene(&volume, tissue_2d(), None));
    for method in [Method::Exact(Exact::within(1e-3)), Method::March(MARCH)] {
        let expected = render(&volume, &scene, &method, &|_| ()).expect("a picture");
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            for shuffled_tiles in [None, Some(5)] {
                let schedule = Schedule { shuffled_tiles, ..Schedule::default() };
                let found = pool.install(|| render_scheduled(&volume, &scene, &method, schedule, &|_| ()));
                let found = found.expect("a picture");
                assert!(found.image.pixels() == expected.image.pixels(), "{threads} threads, {schedule:?}, {method:?}");
                assert_eq!(found.statistics, expected.statistics, "{threads} threads, {schedule:?}");
            }
        }
        assert!(expected.statistics.kernel.contains("atmosphere"), "found {}", expected.statistics.kernel);
    }
}

#[test]
fn empty_space_is_leapt_over_without_a_trace_but_rounding() {
    let volume = blobs_i16();
    let scene = everything(scene(&volume, tissue_2d(), None));
    let pixels = |empty_space_skipping| {
        let schedule = Schedule { empty_space_skipping, ..Schedule::default() };
        let rendered = render_scheduled(&volume, &scene, &Method::March(MARCH), schedule, &|_| ()).expect("a picture");
        (rendered.image.pixels().to_vec(), rendered.statistics.samples)
    };
    let ((leapt, few), (all, many)) = (pixels(true), pixels(false));
    let off = leapt.iter().flatten().zip(all.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(off < 1e-6 && few < many, "{off:e} apart with {few} of {many} samples");
}

#[test]
fn haze_has_no_samples_to_emit_by() {
    let volume = blobs_i16();
    let scene = everything(scene(&volume, tissue_2d(), None));
    let method = Method::March(pellucid::plan::March { emission: Emission::PerSample, ..MARCH });
    let error = render(&volume, &scene, &method, &|_| ()).expect_err("it has no meaning");
    assert!(error.to_string().contains("haze"), "found {error}");
}
