//! A table of even places is the even lattice, and a table of others is not.

use pellucid::integrate::exact::Precision;
use pellucid::volume::Slices;

use super::{exact, slices, truth};
use crate::march::scenes::{MARCH, apart, blobs_f32, blobs_i16, pixels, scene, tissue_1d, tissue_2d, two_lights};

fn even_table() -> Slices {
    let places: Vec<f64> = (0..13).map(|k| 3.0 + 1.7 * f64::from(k)).collect();
    Slices::new(&places).expect("ascending places")
}

#[test]
fn a_table_of_even_places_is_the_even_lattice() {
    for volume in [blobs_i16(), blobs_f32()] {
        let table = volume.clone().with_slices(even_table()).unwrap();
        for function in [tissue_1d(), tissue_2d()] {
            for shading in [None, Some(two_lights())] {
                let scene = scene(&volume, function.clone(), shading);
                let by_oracle = apart(&truth(&table, &scene), &truth(&volume, &scene));
                assert!(by_oracle < 1e-11, "{by_oracle:e} by the oracle");
                let [a, b] = [&table, &volume].map(|v| exact(v, &scene, 1e-4, Precision::Double));
                // Pieces may be halved at another place.
                assert!(apart(&a, &b) < 1e-5, "{:e} by the exact integrator", apart(&a, &b));
                let marched = apart(&pixels(&table, &scene, MARCH), &pixels(&volume, &scene, MARCH));
                assert!(marched < 2e-5, "{marched:e} by marching");
            }
        }
    }
}

#[test]
fn a_table_of_other_places_is_another_picture() {
    let volume = blobs_i16();
    let table = volume.clone().with_slices(slices()).unwrap();
    let scene = scene(&volume, tissue_1d(), None);
    assert!(apart(&truth(&table, &scene), &truth(&volume, &scene)) > 0.01, "the oracle reads the table");
    assert!(apart(&pixels(&table, &scene, MARCH), &pixels(&volume, &scene, MARCH)) > 0.01, "the march reads the table");
}
