//! One named test per hard case of the numerics: what breaks renderers, with what must come out.
//!
//! Most bodies run every renderer of [`renderers`] and say what is expected from the definitions: closed forms, limits,
//! symmetries. A new integrator is one more line in that list. [`INDEX`] says which test holds which case.

mod data;
mod depth;
mod geometry;
mod index;
mod march;
mod parts;
mod transfer;

use std::ops::Deref;

use glam::DVec3;
use pellucid::integrate::exact::{Precision, tracer};
use pellucid::integrate::render;
use pellucid::oracle::Oracle;
use pellucid::plan::{Colors, Emission, Lattice, March, Method, Order, Reflection, SampleRule};
use pellucid::scene::{Camera, Projection, Ray, Scene};
use pellucid::volume::Volume;

use crate::support::scenes::difference;

/// Each case with the tests that hold it, by name, wherever they stand.
const INDEX: [(u32, &str, &[&str]); 31] = [
    (1, "1 - exp(-x) for small x", &["absorbed_is_within_its_stated_relative_error", "thin_fog_keeps_its_digits"]),
    (
        2,
        "100 000 thin segments",
        &["many_thin_cells_attenuate_like_one_thick_one", "a_hundred_thousand_thin_steps_lose_what_rounding_loses"],
    ),
    (3, "huge optical depth", &["opaque_matter_is_opaque_at_any_extinction"]),
    (4, "opacity correction", &["opacity_correction_keeps_its_digits"]),
    (5, "nearly equal attenuation", &["nearly_equal_attenuation_at_both_ends_is_that_of_their_mean"]),
    (6, "accumulated steps", &["the_last_of_many_faces_is_found_where_it_is", "steps_are_counted_and_never_added_up"]),
    (7, "a far camera", &["a_camera_a_kilometre_away_sees_the_same"]),
    (
        8,
        "rays on faces, edges and corners",
        &[
            "axis_parallel_rays_on_faces_and_edges_see_what_rays_beside_them_see",
            "rays_on_the_boundary_of_the_domain_belong_to_it",
            "diagonals_through_edges_and_corners_see_what_rays_beside_them_see",
            "directions_that_are_nearly_along_an_axis_are_those_along_it",
        ],
    ),
    (9, "an eye inside or behind", &["what_lies_behind_the_eye_is_not_seen"]),
    (10, "axes of one voxel", &["axes_of_one_voxel_are_constant_over_their_spacing"]),
    (
        11,
        "anisotropy, shear, reflection",
        &[
            "length_is_in_millimetres_on_every_lattice",
            "the_gradient_of_a_linear_field_is_the_same_on_every_lattice",
            "turning_or_reflecting_patient_and_camera_together_changes_nothing",
        ],
    ),
    (
        12,
        "no gradient",
        &[
            "a_constant_volume_has_no_gradient_and_the_ambient_light",
            "a_gradient_that_vanishes_at_a_point_is_passed_without_harm",
        ],
    ),
    (13, "samples that are no numbers", &["numbers_that_are_none_are_refused_at_the_door"]),
    (
        14,
        "16-bit extremes and rescales",
        &[
            "sixteen_bit_extremes_are_apart_by_all_of_65535",
            "the_rescale_maps_samples_to_values_also_downwards_and_far_up",
        ],
    ),
    (
        15,
        "steps beyond the volume and far below a voxel",
        &["a_step_longer_than_the_volume_is_one_interval", "a_step_of_a_millionth_of_a_voxel_is_refused"],
    ),
    (
        16,
        "unsorted, repeated and single knots",
        &[
            "unsorted_and_repeated_knots_are_the_sorted_curve",
            "one_knot_is_fog_whatever_the_value",
            "a_ramp_of_no_width_is_a_step",
            "spikes_of_no_width_and_no_height_are_dropped",
        ],
    ),
    (17, "thin shells", &["thin_shells_are_never_missed", "shells_within_one_steep_cell_are_each_found"]),
    (
        18,
        "tangential crossings",
        &[
            "a_value_that_only_touches_a_step_does_not_cross_it",
            "a_value_that_barely_crosses_a_step_does_cross_it",
            "tangential_crossings_of_jumps_hold_in_f32",
        ],
    ),
    (19, "nearly degenerate cubics", &["cubics_that_are_nearly_straight_need_no_case_of_their_own"]),
    (20, "early termination", &["early_termination_errs_by_no_more_than_it_leaves"]),
    (
        21,
        "half a voxel",
        &[
            "sampling_a_trilinear_field_more_finely_changes_nothing",
            "a_field_that_is_moved_by_half_a_voxel_is_caught_by_refining_the_lattice",
        ],
    ),
    (22, "the boundary", &["the_domain_ends_at_the_outermost_voxels"]),
    (23, "straight colours", &["the_color_of_what_is_invisible_does_not_bleed"]),
    (24, "sRGB", &["greys_survive_encoding_and_half_of_white_is_188"]),
    (25, "quantised gradients", &["it_equals_the_definition_inside_and_on_the_border"]),
    (26, "macrocells without an apron", &["what_is_interpolated_lies_in_the_range_of_its_macrocell"]),
    (
        27,
        "the magnitude as a channel",
        &["at_the_voxels_it_is_the_length_of_the_gradient", "a_step_along_the_gradient_axis_is_crossed_where_it_is"],
    ),
    (28, "threads and tile order", &["threads_and_tile_order_change_no_bit"]),
    (29, "f32 and f64", &["every_pixel_is_within_tolerance_and_bound"]),
    // Scattering is not computed by any integrator, so there is nothing to hold.
    (
        30,
        "scattering in slabs",
        &["light_let_through_is_smooth_where_the_angles_meet", "the_phase_function_is_stable_as_it_becomes_isotropic"],
    ),
    (
        31,
        "NaN in a metric",
        &["a_nan_is_infinitely_far_even_from_itself", "a_difference_that_is_not_a_number_is_infinite"],
    ),
];

/// A way to compute what a ray sees.
pub(crate) struct Renderer {
    name: &'static str,
    radiance: fn(&Volume, &Scene, &Ray) -> Sight,
}

/// What a ray sees: premultiplied linear RGBA without the background.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sight {
    rgba: [f64; 4],
    /// Largest error of a channel that is allowed: what the renderer itself says, or is known for on these cases.
    bound: f64,
}

impl From<[f64; 4]> for Sight {
    /// An expectation, without error.
    fn from(rgba: [f64; 4]) -> Self {
        Sight { rgba, bound: 0.0 }
    }
}

impl Deref for Sight {
    type Target = [f64; 4];

    fn deref(&self) -> &[f64; 4] {
        &self.rgba
    }
}

impl PartialEq<[f64; 4]> for Sight {
    fn eq(&self, other: &[f64; 4]) -> bool {
        self.rgba == *other
    }
}

/// All of them.
fn renderers() -> Vec<Renderer> {
    let mut renderers = renderers_without_march("");
    renderers.push(Renderer { name: "march", radiance: marched });
    renderers
}

/// All but the march, which cannot do everything that is asked of the others.
fn renderers_without_march(_reason: &'static str) -> Vec<Renderer> {
    vec![
        Renderer { name: "oracle", radiance: |v, s, r| Sight { rgba: Oracle::new(v, s).radiance(r), bound: 1e-13 } },
        Renderer {
            name: "oracle by collocation",
            radiance: |v, s, r| {
                let segment = Oracle::new(v, s).segment_by_collocation(r, 0.0, f64::INFINITY);
                Sight { rgba: segment.rgba(), bound: 1e-13 }
            },
        },
        Renderer { name: "exact in f64 at 1e-6", radiance: |v, s, r| traced(v, s, r, 1e-6, Precision::Double) },
        Renderer { name: "exact in f32 at 1e-4", radiance: |v, s, r| traced(v, s, r, 1e-4, Precision::Single) },
    ]
}

fn traced(volume: &Volume, scene: &Scene, ray: &Ray, tolerance: f64, precision: Precision) -> Sight {
    let Some(traced) = tracer(volume, scene, tolerance, precision).trace(ray) else { return [0.0; 4].into() };
    let [r, g, b] = traced.radiance;
    Sight { rgba: [r, g, b, traced.opacity], bound: traced.bound }
}

/// Marched in 4000 steps from corner to corner.
fn marched(volume: &Volume, scene: &Scene, ray: &Ray) -> Sight {
    let [first, .., last] = volume.grid().corners_mm();
    Sight { rgba: march(volume, scene, ray, &settings(first.distance(last) / 4000.0)), bound: 5e-3 }
}

/// A plain march of second order.
fn settings(step_mm: f64) -> March {
    March {
        step_mm,
        rule: SampleRule::Midpoint,
        order: Order::FrontToBack,
        colors: Colors::Associated,
        emission: Emission::PerLength,
        lattice: Lattice::PerRay,
        bisections: 0,
        jitter: None,
        termination_transmittance: 0.0,
        table: None,
        reflection: Reflection::BlinnPhong,
    }
}

/// A picture of one pixel.
fn march(volume: &Volume, scene: &Scene, ray: &Ray, settings: &March) -> [f64; 4] {
    let scene = Scene { camera: camera_along(ray), ..scene.clone() };
    let rendered = render(volume, &scene, &Method::March(*settings), &|_| ()).expect("settings of a march");
    rendered.image.pixel(0, 0).map(f64::from)
}

/// A camera whose only pixel looks along a ray.
fn camera_along(ray: &Ray) -> Camera {
    let up = if ray.direction.z.abs() < 0.9 { DVec3::Z } else { DVec3::X };
    let projection = Projection::Parallel { height_mm: 1.0 };
    Camera::look_at(ray.origin_mm, ray.origin_mm + ray.direction, up, projection, [1, 1]).expect("a valid camera")
}

impl Renderer {
    fn sees(&self, volume: &Volume, scene: &Scene, ray: &Ray) -> Sight {
        let found = (self.radiance)(volume, scene, ray);
        assert!(found.iter().all(|x| x.is_finite()), "{}: found {found:?} along {ray:?}", self.name);
        assert!((0.0..=1.0).contains(&found[3]), "{}: found an alpha of {} along {ray:?}", self.name, found[3]);
        found
    }
}

/// What a renderer finds must be as expected, within the bounds of both and `slack`: how far the expectation itself is
/// from the case, or a change of the last bit of the input moves the answer.
fn assert_sees(renderer: &Renderer, case: &str, found: impl Into<Sight>, expected: impl Into<Sight>, slack: f64) {
    let (found, expected) = (found.into(), expected.into());
    let (error, allowed) = (difference(*found, *expected), found.bound + expected.bound + slack);
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
fn an_error_above_the_bound_is_noticed() {
    let found = Sight { rgba: [0.0, 0.0, 0.0, 0.5], bound: 1e-3 };
    let wrong = Renderer { name: "wrong", radiance: |_, _, _| [0.0; 4].into() };
    let check = |expected: [f64; 4]| std::panic::catch_unwind(|| assert_sees(&wrong, "case", found, expected, 0.0));
    assert!(check([0.0, 0.0, 0.0, 0.5005]).is_ok());
    assert!(check([0.0, 0.0, 0.0, 0.502]).is_err());
    assert!(check([0.0, f64::NAN, 0.0, 0.5]).is_err());
}
