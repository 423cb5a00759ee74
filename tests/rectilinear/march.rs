//! Marching through uneven slices converges to the oracle with the square of the step.

use pellucid::plan::March;

use super::{slices, truth};
use crate::march::scenes::{MARCH, blobs_i16, pixels, scene, tissue_1d, tissue_2d, two_lights};

fn rms(a: &[[f32; 4]], b: &[[f64; 4]]) -> f64 {
    let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(&a, &b)| (f64::from(a) - b).powi(2));
    (squares.sum::<f64>() / (4 * a.len()) as f64).sqrt()
}

#[test]
fn it_converges_with_the_square_of_the_step() {
    let volume = blobs_i16().with_slices(slices()).unwrap();
    for (function, shading) in [(tissue_1d(), None), (tissue_2d(), None), (tissue_2d(), Some(two_lights()))] {
        let scene = scene(&volume, function, shading);
        let truth = truth(&volume, &scene);
        let error = |step_mm: f64| rms(&pixels(&volume, &scene, March { step_mm, ..MARCH }), &truth);
        let errors = [0.4, 0.2, 0.1, 0.05].map(error);
        // Kinks at cell faces and knots make single rays irregular; over a picture and three halvings the order shows.
        let order = (errors[0] / errors[3]).log2() / 3.0;
        assert!((1.8..2.3).contains(&order), "order {order} of errors {errors:?}");
        assert!(errors[3] < 1e-4, "found errors {errors:?}");
    }
}
