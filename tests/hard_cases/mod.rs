//! One named test per hard case of the numerics: what breaks renderers, with what must come out.
//!
//! Each body runs every renderer of [`renderers`] and says what is expected from the definitions: closed forms, limits,
//! symmetries. A new integrator is one more line in that list.

mod data;
mod depth;
mod geometry;
mod transfer;

use pellucid::oracle::Oracle;
use pellucid::scene::{Ray, Scene};
use pellucid::volume::Volume;

use crate::support::scenes::difference;

/// A way to compute what a ray sees.
pub(crate) struct Renderer {
    name: &'static str,
    /// Premultiplied linear RGBA without the background.
    radiance: fn(&Volume, &Scene, &Ray) -> [f64; 4],
    /// Largest error of a channel on these cases, whose colours are at most 1.
    tolerance: f64,
}

fn renderers() -> Vec<Renderer> {
    vec![
        Renderer { name: "oracle", radiance: |v, s, r| Oracle::new(v, s).radiance(r), tolerance: 1e-13 },
        Renderer {
            name: "oracle by collocation",
            radiance: |v, s, r| Oracle::new(v, s).segment_by_collocation(r, 0.0, f64::INFINITY).rgba(),
            tolerance: 1e-13,
        },
    ]
}

impl Renderer {
    fn sees(&self, volume: &Volume, scene: &Scene, ray: &Ray) -> [f64; 4] {
        let found = (self.radiance)(volume, scene, ray);
        assert!(found.iter().all(|x| x.is_finite()), "{}: found {found:?} along {ray:?}", self.name);
        assert!((0.0..=1.0).contains(&found[3]), "{}: found an alpha of {} along {ray:?}", self.name, found[3]);
        found
    }
}

/// What a renderer finds must be as expected, within its tolerance and `slack`: how far the expectation itself is from
/// the case, or a change of the last bit of the input moves the answer.
fn assert_sees(renderer: &Renderer, case: &str, found: [f64; 4], expected: [f64; 4], slack: f64) {
    let (error, allowed) = (difference(found, expected), renderer.tolerance + slack);
    assert!(
        error <= allowed,
        "{}, {case}: error {error:e} above {allowed:e}: found {found:?}, expected {expected:?}",
        renderer.name
    );
}

/// What opaque matter of one colour shows at this optical depth.
fn slab(color: [f64; 3], optical_depth: f64) -> [f64; 4] {
    let alpha = -(-optical_depth).exp_m1();
    let [r, g, b] = color.map(|c| c * alpha);
    [r, g, b, alpha]
}

#[test]
fn an_error_above_the_tolerance_is_noticed() {
    let wrong = Renderer { name: "wrong", radiance: |_, _, _| [0.0, 0.0, 0.0, 0.5], tolerance: 1e-3 };
    let check =
        |expected| std::panic::catch_unwind(|| assert_sees(&wrong, "case", [0.0, 0.0, 0.0, 0.5], expected, 0.0));
    assert!(check([0.0, 0.0, 0.0, 0.5005]).is_ok());
    assert!(check([0.0, 0.0, 0.0, 0.502]).is_err());
    assert!(check([0.0, f64::NAN, 0.0, 0.5]).is_err());
}
