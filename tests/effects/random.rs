//! Random scenes with random effects of light: the exact integrator is within its tolerance and its bound of the oracle.

use glam::DVec3;
use pellucid::scene::{
    Background, DepthCue, Effects, Fog, FogLaw, Haze, Light, Model, Scattering, Scene, Shading, Shadows,
};
use proptest::prelude::*;

use crate::properties::{camera, direction, held_to_tolerance_and_bound, shading, transfer_function, volume};

fn color() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.0..1.0f64)
}

fn depth_cue() -> impl Strategy<Value = DepthCue> {
    (prop_oneof![Just(1.0), 0.05..2.0f64], prop_oneof![Just(0.0), 1e-4..0.2f64])
        .prop_map(|(constant, per_mm)| DepthCue { constant, per_mm })
}

/// Distances as shares of that of the volume's centre, where it is near the start, the end, or beyond.
fn fog() -> impl Strategy<Value = (FogLaw, [f64; 3])> {
    let law = prop_oneof![
        (0.2..1.2f64, 0.01..0.6f64).prop_map(|(start_mm, more)| FogLaw::Linear { start_mm, end_mm: start_mm + more }),
        (0.0..6.0f64).prop_map(|density_per_mm| FogLaw::Exp { density_per_mm }),
        (0.0..3.0f64).prop_map(|density_per_mm| FogLaw::Exp2 { density_per_mm }),
    ];
    (law, color())
}

fn lights() -> impl Strategy<Value = Vec<(DVec3, [f64; 3])>> {
    // Along axes of the patient too, which are those of some volumes.
    let towards = prop_oneof![direction(), Just(DVec3::Z), Just(-DVec3::X)];
    prop::collection::vec((towards, color()), 1..3)
}

fn scattering() -> impl Strategy<Value = Scattering> {
    (0.0..1.0f64, -0.8..0.8f64, lights()).prop_map(|(albedo, anisotropy, lights)| Scattering {
        albedo,
        anisotropy,
        lights,
    })
}

type Written =
    (Option<DepthCue>, Option<Shadows>, Option<Scattering>, Option<(FogLaw, [f64; 3])>, Option<(f64, [f64; 3], f64)>);

/// Any combination; distances and lengths relative to that of the volume.
fn effects() -> impl Strategy<Value = Written> {
    let shadows = (0.1..1.0f64).prop_map(|strength| Shadows { strength });
    let haze = (0.0..3.0f64, color(), 0.0..1.0f64);
    let of = prop::option::of::<prop::strategy::BoxedStrategy<DepthCue>>;
    (
        of(depth_cue().boxed()),
        prop::option::of(shadows),
        prop::option::of(scattering()),
        prop::option::of(fog()),
        prop::option::of(haze),
    )
}

/// The effects at a distance of the volume's centre and its radius, mm.
fn at_distance((depth_cue, shadows, scattering, fog, haze): Written, distance_mm: f64, radius_mm: f64) -> Effects {
    let fog = fog.map(|(law, color)| {
        let law = match law {
            FogLaw::Linear { start_mm, end_mm } => {
                FogLaw::Linear { start_mm: start_mm * distance_mm, end_mm: end_mm * distance_mm }
            }
            FogLaw::Exp { density_per_mm } => FogLaw::Exp { density_per_mm: density_per_mm / distance_mm },
            FogLaw::Exp2 { density_per_mm } => FogLaw::Exp2 { density_per_mm: density_per_mm / distance_mm },
        };
        Fog { law, color }
    });
    let end_mm = distance_mm + radius_mm;
    let haze = haze.map(|(depth, color, behind)| Haze {
        extinction_per_mm: depth / end_mm,
        color,
        end_mm: (1.0 + behind) * end_mm,
    });
    Effects { depth_cue, shadows, scattering, fog, haze, ..Effects::default() }
}

/// Shading whose directional lights are shared with scattering, half of the time.
fn sharing_lights(mut shading: Shading, scattering: Option<&Scattering>, share: bool) -> Shading {
    if let (true, Some((towards, color))) = (share, scattering.and_then(|s| s.lights.first().copied())) {
        shading.lights.push(Light::Directional { towards, color });
    }
    shading
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn pictures_with_effects_of_light_are_within_tolerance_and_bound(
        volume in volume(),
        transfer_function in transfer_function(),
        shading in prop::option::of(shading()),
        effects in effects(),
        (from, share, parallel) in (direction(), any::<bool>(), any::<bool>()),
        distance in prop_oneof![Just(0.2), 1.2..6.0f64],
        tolerance in prop_oneof![Just(1.0 / 255.0), Just(1e-3), Just(1e-4)],
    ) {
        let center = volume.grid().center_mm();
        let radius = volume.grid().corners_mm().iter().map(|c| c.distance(center)).fold(0.0, f64::max);
        let effects = at_distance(effects, distance * radius, radius);
        let shading = shading.map(|s| sharing_lights(s, effects.scattering.as_ref(), share));
        let camera = camera(volume.grid(), from, distance, parallel);
        let scene = Scene { model: Model::Light, transfer_function, shading, camera, background: Background::Transparent, effects };
        held_to_tolerance_and_bound(&volume, &scene, tolerance)?;
    }
}
