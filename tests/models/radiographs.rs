//! Radiographs of a stack of water and bone against the law of Beer and Lambert.

use std::path::Path;

use glam::DVec3;
use pellucid::image::srgb;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::oracle::Oracle;
use pellucid::plan::{Plan, VolumeInfo};
use pellucid::scene::Scene;
use pellucid::spec::Spec;
use pellucid::transfer::attenuation::{Attenuation, Material};
use pellucid::volume::Volume;

use crate::support::scenes::{ray, unit_grid, volume_of};

/// The scene of a pipeline with a volume of one's own.
fn scene(volume: &Volume, rest: &str) -> Scene {
    let text = format!("version: 1\nvolume: {{ phantom: head }}\nimage: {{ size: [8, 8], background: white }}\n{rest}");
    let spec = Spec::from_text(&text, Path::new("scene.yaml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    Plan::new(&spec, &VolumeInfo::from(volume), None).unwrap_or_else(|error| panic!("{error}")).scene
}

/// 10 mm of water, 1 mm between, 8 mm of bone, 1 mm between, 5 mm of air; and its optical depth at an energy.
fn stack(scanned_at_kev: f64) -> (Volume, impl Fn(f64) -> f64) {
    let bone_hu = Attenuation { kev: 60.0, scanned_at_kev }.bone_hu();
    let volume = volume_of(unit_grid([4, 26, 4]), |[_, j, _]| match j {
        0..=10 => 0.0,
        11..=19 => bone_hu,
        _ => -1000.0,
    });
    let depth = |kev: f64| {
        let [air, water, bone] =
            [Material::Air, Material::Water, Material::CorticalBone].map(|m| m.attenuation_per_mm(kev));
        // Between bone and air the value passes water, at a share of the way that the numbers of HU give.
        let bone_hu = Attenuation { kev, scanned_at_kev: 70.0 }.bone_hu();
        let to_water = bone_hu / (bone_hu + 1000.0);
        let last = to_water * 0.5 * (bone + water) + (1.0 - to_water) * 0.5 * (water + air);
        10.0 * water + 0.5 * (water + bone) + 8.0 * bone + last + 5.0 * air
    };
    (volume, depth)
}

#[test]
fn a_stack_of_water_and_bone_obeys_beer_and_lambert() {
    let (volume, depth) = stack(70.0);
    let through = ray([1.3, -40.0, 1.8], [0.0, 1.0, 0.0]);
    for kev in [30.0, 60.0, 70.0, 87.0, 150.0] {
        let expected = depth(kev);
        let film = scene(&volume, &format!("transfer_function: [{{ attenuation: {{ kev: {kev} }} }}]\n"));
        for precision in [Precision::Single, Precision::Double] {
            let traced = tracer(&volume, &film, 1e-7, precision).trace(&through).expect("met");
            let apart = (traced.transmittance - (-expected).exp()).abs();
            assert!(apart < 1e-6, "{kev} keV, {precision:?}: {apart:e} from e^−{expected}");
            assert_eq!(traced.radiance, [0.0; 3], "attenuation emits nothing");
        }
        let apart = (Oracle::new(&volume, &film).radiance(&through)[3] + (-expected).exp_m1()).abs();
        assert!(apart < 1e-6, "{kev} keV, the oracle: {apart:e}");
        let depth = format!(
            "transfer_function: [{{ attenuation: {{ kev: {kev} }} }}]\n\
             effects: {{ project: {{ show: optical-depth, window_optical_depth: [0, 8] }} }}\n"
        );
        let bright = scene(&volume, &depth);
        let grey = tracer(&volume, &bright, 1e-3, Precision::Single).trace(&through).expect("met").radiance[0];
        let found = 8.0 * srgb::encode(grey);
        assert!((found - expected).abs() < 1e-6, "{kev} keV: an optical depth of {found}, expected {expected}");
    }
}

#[test]
fn a_layer_of_attenuation_scales_and_shifts_like_others() {
    let (volume, depth) = stack(70.0);
    let through = ray([1.3, -40.0, 1.8], [0.0, 1.0, 0.0]);
    let transmitted = |layer: &str| {
        let film = scene(&volume, &format!("transfer_function: [{{ attenuation: {{ kev: 60 }}{layer} }}]\n"));
        tracer(&volume, &film, 1e-7, Precision::Double).trace(&through).expect("met").transmittance
    };
    let half = transmitted(", opacity_scale: 0.5");
    assert!((half - (-0.5 * depth(60.0)).exp()).abs() < 1e-6, "half of the attenuation: found {half}");
    // Everything is as if it had 1000 HU more: the air of the stack is water then.
    let shifted = transmitted(", shift_hu: -1000");
    let water = Material::Water.attenuation_per_mm(60.0);
    let less = shifted / transmitted("");
    assert!(less < (-20.0 * 0.5 * water).exp(), "the shift adds to what attenuates: a factor of {less}");
}

#[test]
fn the_energy_of_the_scan_matters_only_beyond_water() {
    let flat = |hu| volume_of(unit_grid([4, 11, 4]), move |_| hu);
    let through = ray([1.3, -40.0, 1.8], [0.0, 1.0, 0.0]);
    let transmitted = |hu: f64, scanned_at: f64| {
        let volume = flat(hu);
        let layer = format!("{{ attenuation: {{ kev: 60, scanned_at_kev: {scanned_at} }} }}");
        let film = scene(&volume, &format!("transfer_function: [{layer}]\n"));
        tracer(&volume, &film, 1e-7, Precision::Double).trace(&through).expect("met").transmittance
    };
    for hu in [-1000.0, -300.0, 0.0] {
        let apart = (transmitted(hu, 60.0) - transmitted(hu, 80.0)).abs();
        assert!(apart < 1e-12, "{hu} HU: {apart:e}");
    }
    // The same HU measured with harder rays stands for more bone.
    let (soft, hard) = (transmitted(800.0, 60.0), transmitted(800.0, 80.0));
    assert!(hard < 0.95 * soft, "800 HU let through {soft} scanned at 60 keV, {hard} at 80 keV");
}

#[test]
fn far_from_the_stack_the_film_is_white() {
    let (volume, _) = stack(70.0);
    let film = scene(&volume, "transfer_function: [{ attenuation: { kev: 60 } }]\ncamera: { zoom: 0.3 }\n");
    let corner = Oracle::new(&volume, &film).pixel(0, 0);
    assert_eq!(corner, [1.0; 4], "a ray that misses shows the background");
    let center = film.camera.pixel_ray(4, 4);
    assert!(center.direction.dot(DVec3::Y) > 0.9, "the picture is taken from the front");
}
