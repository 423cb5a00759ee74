//! The bound that a picture claims is that of the kernel that ran, and what the plan says of it beforehand is what will run.

use pellucid::integrate::{Statistics, render};
use pellucid::plan::{Bound, Exact, ExactKernel, Method};
use pellucid::scene::{Scene, Shading};
use pellucid::transfer::{Curve, Knot, Optics, Term};
use pellucid::volume::Volume;

use crate::support::scenes::{headlight, rough_volume, scene_around, two_colors, two_lights};

/// A ramp from -200 to 900 HU of this extinction and emission at its end, 1/mm.
fn ramp(extinction_per_mm: f64, emission_per_mm: f64) -> Term {
    let end = Optics { extinction_per_mm, emission_per_mm: [emission_per_mm; 3] };
    let knots = [(-200.0, Optics::NOTHING), (900.0, end)].map(|(value, optics)| Knot { value, optics });
    Term { curve: Curve::new(knots.to_vec()).expect("finite knots"), weight: None }
}

/// Two knots this many HU apart.
fn narrow(width_hu: f64) -> Term {
    let knots = [(0.0, Optics::NOTHING), (width_hu, Optics::colored(0.5, [1.0; 3])), (500.0, Optics::NOTHING)];
    let knots = knots.map(|(value, optics)| Knot { value, optics });
    Term { curve: Curve::new(knots.to_vec()).expect("finite knots"), weight: None }
}

fn statistics(volume: &Volume, scene: &Scene, settings: Exact) -> Statistics {
    render(volume, scene, &Method::Exact(settings), &|_| ()).expect("a picture").statistics
}

#[test]
fn the_bound_is_that_of_the_kernel_that_ran_and_the_plan_says_it_beforehand() {
    let volume = rough_volume(10);
    let flat = Shading { diffuse: 0.0, specular: 0.0, ..headlight() };
    let three_lights = Shading { lights: [two_lights(true).lights, headlight().lights].concat(), ..headlight() };
    // What is shown, its light, the asked bound, and what comes of them.
    let (estimated, proven) = (Bound::Estimated, Bound::Proven);
    for (name, term, shading, asked, bound, kernel) in [
        ("lit", two_colors(), Some(headlight()), estimated, estimated, "/lit/"),
        ("lit, to be proven", two_colors(), Some(headlight()), proven, proven, "/lit-proven/"),
        ("lit without a direction", two_colors(), Some(flat), estimated, estimated, "/lit/"),
        ("unlit", two_colors(), None, estimated, proven, "/unlit/"),
        ("as bright as may be", ramp(0.05, 0.8), Some(headlight()), estimated, estimated, "/lit/"),
        ("brighter", ramp(0.05, 0.85), Some(headlight()), estimated, proven, "/lit-proven/"),
        ("absorbs nothing", ramp(0.0, 0.05), Some(headlight()), estimated, proven, "/lit-proven/"),
        ("three lights", two_colors(), Some(three_lights), estimated, proven, "/lit/f32"),
        ("narrow", narrow(0.5), Some(headlight()), estimated, proven, "/lit/f64"),
    ] {
        let scene = scene_around(&volume, vec![term], shading, [6, 5]);
        let settings = Exact { tolerance: 1.0 / 255.0, bound: asked };
        let found = statistics(&volume, &scene, settings);
        assert!(found.kernel.contains(kernel), "{name}: {} is not {kernel}", found.kernel);
        assert_eq!(found.bound, Some(bound), "{name}: by {}", found.kernel);
        let planned = ExactKernel::of(&scene, &volume, &settings);
        assert_eq!(planned.bound(), bound, "{name}: planned as {planned:?}, found {}", found.kernel);
        let by_name = match planned {
            ExactKernel::InRegisters(_) => !found.kernel.ends_with("/f32") && !found.kernel.ends_with("/f64"),
            ExactKernel::Single => found.kernel.ends_with("/f32"),
            ExactKernel::Double => found.kernel.ends_with("/f64"),
        };
        assert!(by_name, "{name}: planned as {planned:?}, found {}", found.kernel);
    }
}

#[test]
fn a_finer_tolerance_calls_for_f64_where_knots_are_close() {
    let volume = rough_volume(10);
    let scene = scene_around(&volume, vec![narrow(2.0)], Some(headlight()), [6, 5]);
    let kernel = |tolerance| ExactKernel::of(&scene, &volume, &Exact::within(tolerance));
    assert_eq!(kernel(1.0 / 255.0), ExactKernel::InRegisters(Bound::Estimated));
    assert_eq!(kernel(1e-3), ExactKernel::Double);
    assert_eq!(statistics(&volume, &scene, Exact::within(1e-3)).bound, Some(Bound::Proven));
}

#[test]
fn what_marches_claims_no_bound() {
    let volume = rough_volume(10);
    let scene = scene_around(&volume, vec![two_colors()], Some(headlight()), [6, 5]);
    let march = Method::March(pellucid::plan::March::plain(pellucid::plan::SampleRule::Midpoint, 0.5));
    for method in [march, Method::Reference] {
        let found = render(&volume, &scene, &method, &|_| ()).expect("a picture").statistics;
        assert_eq!((found.bound, found.error_bound), (None, None), "{}", found.kernel);
    }
}
