//! Absorption alone, emission alone, and both: a change of the transfer function, by the plan.

use std::path::Path;

use pellucid::integrate::exact::{Precision, tracer};
use pellucid::oracle::Oracle;
use pellucid::plan::{Plan, VolumeInfo};
use pellucid::scene::Scene;
use pellucid::spec::Spec;
use pellucid::volume::Volume;

use crate::support::scenes::{difference, ray, rough_volume, unit_grid, volume_of};

const SOFT: &str = "  - widgets:
      - points:
          - { hu: -200, opacity_per_mm: 0 }
          - { hu: 100, extinction_per_mm: 0.2, color: [1, 0.5, 0.25] }
          - { hu: 900, extinction_per_mm: 0.4, color: [0.25, 0.5, 1], emission_per_mm: { color: [0, 1, 0], strength: 0.1 } }
";

fn scene(volume: &Volume, effects: &str) -> Scene {
    let image = "image: { size: [24, 24], background: [0.5, 0.75, 1] }";
    let text = format!("version: 1\nvolume: {{ phantom: head }}\n{image}\ntransfer_function:\n{SOFT}{effects}");
    let spec = Spec::from_text(&text, Path::new("scene.yaml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    Plan::new(&spec, &VolumeInfo::from(volume), None).unwrap_or_else(|error| panic!("{error}")).scene
}

/// Exact within 1e-5, checked against the oracle.
fn pixels(volume: &Volume, scene: &Scene) -> Vec<[f64; 4]> {
    let oracle = Oracle::new(volume, scene);
    let tracer = tracer(volume, scene, 1e-5, Precision::Double);
    let rays = (0..24 * 24).map(|i| scene.camera.pixel_ray(i % 24, i / 24));
    rays.map(|ray| {
        let found = tracer.trace(&ray).map_or([0.0; 4], |t| {
            let [r, g, b] = t.radiance;
            [r, g, b, t.opacity]
        });
        let apart = difference(found, oracle.radiance(&ray));
        assert!(apart < 1e-5, "{apart:e} from the oracle");
        found
    })
    .collect()
}

#[test]
fn absorption_keeps_the_alpha_and_emission_keeps_none() {
    let volume = rough_volume(9);
    let shown = |effects: &str| pixels(&volume, &scene(&volume, effects));
    let both = shown("");
    let written = shown("effects: { light: both }\n");
    assert!(both == written, "both is what a scene without the key shows");
    let (mut dimmer, mut brighter) = (0, 0);
    for ((b, a), e) in
        both.iter().zip(shown("effects: { light: absorption }\n")).zip(shown("effects: { light: emission }\n"))
    {
        assert_eq!([a[0], a[1], a[2]], [0.0; 3], "nothing is emitted");
        assert!((a[3] - b[3]).abs() < 2e-5, "the same is absorbed: {} and {}", a[3], b[3]);
        assert_eq!(e[3], 0.0, "nothing is absorbed");
        assert!(e[0] >= b[0] - 2e-5, "nothing hides what emits: {} and {}", e[0], b[0]);
        dimmer += usize::from(a[3] > 0.1);
        brighter += usize::from(e[0] > 1.1 * b[0]);
    }
    assert!(dimmer > 50 && brighter > 50, "{dimmer} pixels absorb, {brighter} are brighter without absorption");
}

#[test]
fn a_slab_that_only_emits_adds_its_emission_to_the_light_behind() {
    let volume = volume_of(unit_grid([5, 11, 5]), |_| 900.0);
    let through = ray([2.2, -30.0, 1.8], [0.0, 1.0, 0.0]);
    let emitting = scene(&volume, "effects: { light: emission }\n");
    let traced = tracer(&volume, &emitting, 1e-7, Precision::Double).trace(&through).expect("met");
    // 10 mm of σc plus its own light.
    for (found, expected) in traced.radiance.into_iter().zip([1.0, 2.0 + 1.0, 4.0]) {
        assert!((found - expected).abs() < 1e-6, "found {:?}, expected {expected}", traced.radiance);
    }
    assert_eq!((traced.transmittance, traced.opacity), (1.0, 0.0));
    let absorbing = scene(&volume, "effects: { light: absorption }\n");
    let traced = tracer(&volume, &absorbing, 1e-7, Precision::Double).trace(&through).expect("met");
    assert!((traced.transmittance - (-4.0f64).exp()).abs() < 1e-7, "10 mm of 0.4/mm: found {}", traced.transmittance);
    let behind = Oracle::new(&volume, &absorbing).pixel(12, 12);
    let expected = [0.5, 0.75, 1.0].map(|c| c * behind[2]);
    assert!(difference([behind[0], behind[1], behind[2]], expected) < 1e-12, "light of the background: {behind:?}");
}

#[test]
fn emission_has_no_highlight() {
    let volume = rough_volume(9);
    let lit = scene(&volume, "effects: { light: emission, shading: { ambient: 0.5, diffuse: 0.5 } }\n");
    assert_eq!(lit.shading.as_ref().map(|s| s.specular), Some(0.0));
    assert!(pixels(&volume, &lit).iter().all(|p| p[3] == 0.0), "nothing is absorbed");
    let ambient = scene(&volume, "effects: { light: emission, shading: { ambient: 0.5, diffuse: 0 } }\n");
    assert_eq!(ambient.shading, None, "a constant factor needs no gradient");
    let plain = pixels(&volume, &scene(&volume, "effects: { light: emission }\n"));
    for (half, whole) in pixels(&volume, &ambient).iter().zip(plain) {
        assert!((2.0 * half[1] - whole[1]).abs() < 3e-5, "half the light: {} of {}", half[1], whole[1]);
    }
}
