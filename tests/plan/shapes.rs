//! Terms against the shapes they stand for: nowhere further than the bound, and the bound is not idle.

use pellucid::TransferFunction;
use pellucid::transfer::Optics;
use pellucid::transfer::shapes::{Ellipse, Gaussian, Shape, Triangle};

const PEAK: Optics = Optics { extinction_per_mm: 3.0, emission_per_mm: [3.0, 1.5, 0.75] };

/// Largest deviation of the terms from the shape over a fine lattice, as a share of its height, and the bound.
fn deviation(shape: Shape, max_deviation: f64) -> (f64, f64) {
    let expansion = shape.expand(PEAK, max_deviation).unwrap();
    let tf = TransferFunction::new([-1024.0, 3071.0], 1500.0, expansion.terms).unwrap();
    let mut largest = 0.0f64;
    for j in 0..350 {
        let g = (f64::from(j) + 0.25) * 1500.0 / 350.0;
        for i in 0..1000 {
            let v = -1024.0 + (f64::from(i) + 0.25) * 4095.0 / 1000.0;
            let optics = tf.evaluate(v, g);
            let height = optics.extinction_per_mm / PEAK.extinction_per_mm;
            for c in 0..3 {
                let share = optics.emission_per_mm[c] / PEAK.emission_per_mm[c];
                assert!((share - height).abs() < 1e-12, "the colour is the same everywhere: {share} and {height}");
            }
            largest = largest.max((height - shape.ideal(v, g)).abs());
        }
    }
    (largest, expansion.max_deviation)
}

const CONTOUR: Shape =
    Shape::Triangle(Triangle { apex: 300.0, opening_mm: 1.5, edge: 1.0, gradient_per_mm: [50.0, 1400.0] });
const WEDGE: Shape =
    Shape::Triangle(Triangle { apex: 300.0, opening_mm: 1.5, edge: 0.5, gradient_per_mm: [50.0, 1400.0] });
const ELLIPSE: Shape = Shape::Ellipse(Ellipse {
    value: 200.0,
    value_radius: 700.0,
    gradient_per_mm: 300.0,
    gradient_radius_per_mm: 500.0,
});
const BELL: Shape = Shape::Gaussian(Gaussian { value: [200.0, 150.0], gradient_per_mm: Some([400.0, 120.0]) });
const BELL_1D: Shape = Shape::Gaussian(Gaussian { value: [200.0, 150.0], gradient_per_mm: None });

#[test]
fn rectangles_and_trapezoids_are_exact() {
    let shapes = [
        Shape::Rectangle { value: [0.0, 400.0], gradient_per_mm: None },
        Shape::Rectangle { value: [0.0, 400.0], gradient_per_mm: Some([100.0, 300.0]) },
        Shape::Trapezoid { value: [0.0, 100.0, 400.0, 800.0], gradient_per_mm: Some([0.0, 50.0, 600.0, 600.0]) },
        Shape::Trapezoid { value: [0.0, 0.0, 0.0, 800.0], gradient_per_mm: None },
    ];
    for shape in shapes {
        let (found, bound) = deviation(shape, 1.0 / 32.0);
        assert!(found < 1e-14 && bound == 0.0, "{shape:?}: found {found}, bound {bound}");
    }
}

#[test]
fn the_others_stay_within_their_bound() {
    for shape in [CONTOUR, WEDGE, ELLIPSE, BELL, BELL_1D] {
        for asked in [1.0 / 8.0, 1.0 / 32.0, 1.0 / 100.0] {
            let (found, bound) = deviation(shape, asked);
            assert!(bound <= asked * (1.0 + 1e-12), "{shape:?}: bound {bound}, asked {asked}");
            assert!(found <= bound, "{shape:?} at {asked}: found {found}, bound {bound}");
            assert!(found > 0.1 * bound, "{shape:?} at {asked}: the bound {bound} is idle, found {found}");
        }
    }
}

#[test]
fn the_comparison_sees_a_shape_that_is_not_met() {
    let coarse = CONTOUR.expand(PEAK, 1.0 / 8.0).unwrap();
    let tf = TransferFunction::new([-1024.0, 3071.0], 1500.0, coarse.terms).unwrap();
    let largest = (0..1000)
        .map(|i| (300.0 + f64::from(i), 700.0))
        .map(|(v, g)| (tf.evaluate(v, g).extinction_per_mm / 3.0 - WEDGE.ideal(v, g)).abs())
        .fold(0.0, f64::max);
    assert!(largest > 0.25, "contour for wedge: found {largest}");
}

#[test]
fn shapes_reach_their_full_height() {
    let peaks = [(CONTOUR, 300.0, 50.0), (WEDGE, 300.0, 777.0), (ELLIPSE, 200.0, 300.0), (BELL, 200.0, 400.0)];
    for (shape, v, g) in peaks {
        let expansion = shape.expand(PEAK, 1.0 / 32.0).unwrap();
        let tf = TransferFunction::new([-1024.0, 3071.0], 1500.0, expansion.terms).unwrap();
        let found = tf.evaluate(v, g).extinction_per_mm;
        assert!((found - 3.0).abs() < 1e-12, "{shape:?}: found {found}, expected 3");
    }
}

#[test]
fn a_shape_of_too_many_rows_is_refused() {
    let sharp = Shape::Triangle(Triangle { apex: 0.0, opening_mm: 1.0, edge: 0.01, gradient_per_mm: [1.0, 1000.0] });
    let error = sharp.expand(PEAK, 1.0 / 100.0).unwrap_err().to_string();
    assert!(error.contains("too many rows") && error.contains("max_deviation"), "found {error}");
}
