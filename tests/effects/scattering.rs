//! Single scattering by a homogeneous slab, against its closed forms.

use std::f64::consts::PI;

use glam::DVec3;
use pellucid::math::scattering::{henyey_greenstein, slab_reflected, slab_transmitted};
use pellucid::oracle::Oracle;
use pellucid::scene::{Effects, Scattering, Scene};
use pellucid::volume::{Grid, Volume};

use super::{assert_everyone_sees, one_ray};
use crate::support::scenes::{difference, function_1d, scene, volume_of};

const DEPTH_MM: f64 = 2.0;
const EXTINCTION_PER_MM: f64 = 0.9;

/// A slab from z = 0 to 2 mm, so wide that its middle knows nothing of its sides, on a lattice of `n` points across.
fn slab(n: usize) -> Volume {
    let grid = Grid::axis_aligned([5, 5, n], DVec3::new(1000.0, 1000.0, DEPTH_MM / (n - 1) as f64));
    volume_of(grid.expect("a valid grid"), |_| 50.0)
}

/// A white medium of albedo 0.75 seen through the middle of the slab from above, in light of colour `color`.
fn lit_slab(towards: DVec3, color: [f64; 3], looking: DVec3, anisotropy: f64) -> Scene {
    let white = [1.0; 3];
    let mut scene = scene(function_1d(&[(0.0, EXTINCTION_PER_MM, white), (100.0, EXTINCTION_PER_MM, white)]));
    // Nothing is absorbed into light of its own.
    let middle = DVec3::new(2100.0, 1900.0, 0.5 * DEPTH_MM);
    scene.camera = one_ray(middle - 50.0 * looking, looking);
    let scattering = Scattering { albedo: 0.75, anisotropy, lights: vec![(towards, color)] };
    scene.effects = Effects { scattering: Some(scattering), ..Effects::default() };
    scene
}

#[test]
fn a_slab_reflects_and_transmits_what_the_closed_forms_say() {
    // Between two of its points the transmittance, an exponential, is a straight line to 5e-6.
    let volume = slab(401);
    let depth = EXTINCTION_PER_MM * DEPTH_MM;
    let looking = DVec3::new(0.3, 0.2, -1.0).normalize();
    let color = [1.0, 0.5, 0.25];
    for (towards, anisotropy) in [
        (DVec3::new(0.4, 0.0, 1.0).normalize(), 0.0),
        (DVec3::new(-0.2, 0.7, 0.8).normalize(), 0.6),
        (DVec3::new(0.4, 0.1, -1.0).normalize(), 0.0),
        (DVec3::new(0.1, 0.3, -0.9).normalize(), -0.4),
        // Looking into the light: the angles to the normal are the same, where textbook forms are 0/0.
        (looking, 0.3),
    ] {
        let (mu, mu0) = (looking.z.abs(), towards.z.abs());
        let isotropic =
            if towards.z > 0.0 { slab_reflected(0.75, depth, mu, mu0) } else { slab_transmitted(0.75, depth, mu, mu0) };
        let phase = henyey_greenstein(anisotropy, towards.dot(looking));
        let scattered = 4.0 * PI * isotropic * 4.0 * PI * phase;
        // What does not scatter shows the medium's own colour.
        let alpha = 1.0 - (-depth / mu).exp();
        let [r, g, b] = color.map(|l| scattered * l + 0.25 * alpha);
        let scene = lit_slab(towards, color, looking, anisotropy);
        let what = format!("light from {towards}, g = {anisotropy}");
        assert_everyone_sees(&volume, &scene, [r, g, b, alpha], [5e-6, 1e-3, 5e-6], &what);
    }
}

#[test]
fn scattering_is_stable_as_it_becomes_isotropic_and_as_its_albedo_vanishes() {
    let volume = slab(41);
    let looking = DVec3::new(0.3, 0.2, -1.0).normalize();
    let towards = DVec3::new(0.4, 0.0, 1.0).normalize();
    let seen = |scene: &Scene| Oracle::new(&volume, scene).pixel(0, 0);
    let even = seen(&lit_slab(towards, [1.0; 3], looking, 0.0));
    for g in [1e-300, 1e-17, -1e-12] {
        let off = difference(seen(&lit_slab(towards, [1.0; 3], looking, g)), even);
        assert!(off < 1e-11, "g = {g:e}: {off:e} from isotropic");
    }
    let mut faint = lit_slab(towards, [1.0; 3], looking, 0.5);
    let plain = Scene { effects: Effects::default(), ..faint.clone() };
    for albedo in [0.0, 1e-15] {
        if let Some(scattering) = &mut faint.effects.scattering {
            scattering.albedo = albedo;
        }
        let off = difference(seen(&faint), seen(&plain));
        assert!(off < 1e-13, "albedo {albedo:e}: {off:e} from emission and absorption");
    }
}
