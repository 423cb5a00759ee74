//! Membership as it is defined, on volumes that are known.

use pellucid::field::{GradientUnits, Trilinear, gradient_magnitude_per_mm};
use pellucid::tissue::{THRESHOLD, classify, membership};
use pellucid::volume::{Rescale, Samples};
use pellucid::{Fault, Volume};

use super::{numbers, tissues, volume};

/// Smooth, rough, and with a jump: every kind of gradient.
fn mixed() -> Volume {
    volume([17, 15, 13], |[i, j, k]| {
        let wave = 300.0 * (0.9 * i as f64).sin() * (0.4 * j as f64 + 0.2 * k as f64).cos();
        wave as i16 + if k > 7 { 200 } else { -80 } + (i * 7919 + j * 104_729 + k * 1_299_709) as i16 % 23
    })
}

/// Three layers that overlap, one without a gradient axis, one of an ellipse.
const LAYERS: &str = "transfer_function:
  - widgets: [{ trapezoid: { hu: [-150, -100, 40, 60], gradient_hu_per_mm: [0, 0, 60, 120] }, opacity_per_mm: 0.1, color: red }]
  - widgets: [{ rectangle: { hu: [0, 150] }, opacity_per_mm: 0.4, color: white }]
  - widgets:
      - { ellipse: { hu: 200, hu_radius: 150, gradient_hu_per_mm: 120, gradient_radius_hu_per_mm: 110 }, opacity_per_mm: 0.8, color: blue }
      - { trapezoid: { hu: [300, 400, 3071, 3071] }, opacity_per_mm: 0.5, color: blue }";

#[test]
fn labels_follow_the_definition_voxel_by_voxel() {
    let volume = mixed();
    let tissues = tissues(LAYERS, &volume).unwrap();
    let Samples::I16(data) = volume.samples() else { panic!("16 bits") };
    let field = Trilinear::new(data, volume.grid().dims()).unwrap();
    let gradient = gradient_magnitude_per_mm(&field, &GradientUnits::new(volume.grid(), volume.rescale()));
    let expected = |index: usize| {
        let value = volume.rescale().value(volume.samples().stored(index));
        let of = tissues.tissues.iter().map(|t| t.membership(value, f64::from(gradient[index])));
        let of: Vec<f64> = of.collect();
        let highest = of.iter().copied().fold(0.0, f64::max);
        if highest < THRESHOLD - 1e-9 {
            return 0;
        }
        let densest = |a: &usize, b: &usize| {
            let peak = |n: usize| tissues.tissues[n].peak_extinction_per_mm;
            // Of equals the first: max_by takes the last, so later ones count as smaller.
            peak(*a).total_cmp(&peak(*b)).then(b.cmp(a))
        };
        let equals = (0..of.len()).filter(|n| of[*n] >= highest - 1e-9);
        equals.max_by(densest).map_or(0, |n| n + 1)
    };
    let labels = classify(&volume, &tissues).unwrap();
    let mut seen = [0; 4];
    for (index, label) in labels.voxels().iter().enumerate() {
        assert_eq!(usize::from(*label), expected(index), "voxel {:?}", volume.grid().unflatten(index));
        seen[usize::from(*label)] += 1;
    }
    assert!(seen.iter().all(|n| *n > 50), "the case has some of each tissue and of none: found {seen:?}");

    let as_floats = Samples::F32(data.iter().map(|v| f32::from(*v)).collect());
    let floats = Volume::new(*volume.grid(), as_floats, Rescale::IDENTITY, volume.quantity()).unwrap();
    assert_eq!(classify(&floats, &tissues).unwrap(), labels, "storage does not matter");
}

#[test]
fn memberships_are_shares_of_the_peak() {
    let volume = mixed();
    let tissues = tissues(LAYERS, &volume).unwrap();
    for tissue in &tissues.tissues {
        let shares = membership(&volume, tissue).unwrap();
        let highest = shares.iter().copied().fold(0.0, f32::max);
        assert!(shares.iter().all(|m| (0.0..=1.0).contains(m)), "{}: from 0 to 1", tissue.segment.name);
        assert!(highest > 0.5, "{}: something is inside, found at most {highest}", tissue.segment.name);
    }
}

#[test]
fn opacity_decides_ties_and_nothing_else() {
    let volume = volume([3, 3, 3], |_| 40);
    let layers = |a: f64, b: f64| {
        let widget = |opacity| format!("{{ rectangle: {{ hu: [0, 100] }}, opacity_per_mm: {opacity}, color: red }}");
        format!("transfer_function: [{{ widgets: [{}] }}, {{ widgets: [{}] }}]", widget(a), widget(b))
    };
    let label = |a, b| numbers(&classify(&volume, &tissues(&layers(a, b), &volume).unwrap()).unwrap())[0];
    assert_eq!(label(0.01, 0.02), 2, "the denser of two that are both wholly there");
    assert_eq!(label(0.02, 0.01), 1, "wherever it stands");
    assert_eq!(label(0.02, 0.02), 1, "the first of equals");
    let faint = "transfer_function: [{ preset: fat, opacity_scale: 0.001 }]";
    let fat = super::volume([3, 3, 3], |_| -100);
    let labels = classify(&fat, &tissues(faint, &fat).unwrap()).unwrap();
    assert!(numbers(&labels).iter().all(|n| *n == 5), "a faint haze of fat is fat");
}

#[test]
fn what_cannot_be_classified_is_refused_with_its_place() {
    let volume = volume([2, 2, 2], |_| 0);
    for (layers, says) in [
        ("transfer_function: [{ preset: bone, opacity_scale: 1 }, { preset: bone }]", "the same label"),
        ("transfer_function: [{ preset: fat, opacity_scale: 0 }]", "nothing can belong"),
        ("transfer_function: [{ preset: fat }]\nclean: { bone: [fill-holes] }", "no layer of this name"),
        ("effects: { project: { show: maximum } }", "no layer to classify by"),
    ] {
        let error = tissues(layers, &volume).expect_err(says);
        assert_eq!(error.fault(), Fault::Spec, "{error}");
        assert!(error.to_string().contains(says) && error.to_string().contains("tissues.yaml:"), "found {error}");
    }
    // Widgets of a label of their own make up for opacity that is not there.
    assert!(tissues("transfer_function: [{ preset: bone, opacity_scale: 0 }]", &volume).is_ok());
}

#[test]
fn without_the_gradient_the_widget_is_as_wide_as_it_gets() {
    let volume = mixed();
    let with = tissues(LAYERS, &volume).unwrap();
    let without = with.without_gradient().unwrap();
    for (with, without) in with.tissues.iter().zip(&without.tissues) {
        for value in (-200..600).step_by(7).map(f64::from) {
            let highest = (0..300).map(|g| with.membership(value, f64::from(g))).fold(0.0, f64::max);
            let found = without.membership(value, 0.0);
            assert!(found >= highest - 1e-9, "{} at {value} HU: found {found} below {highest}", with.segment.name);
        }
        assert!(!without.membership_function().reads_gradient(), "nobody reads the gradient");
    }
}
