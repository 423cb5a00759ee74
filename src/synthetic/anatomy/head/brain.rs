//! Brain, its fluid spaces and membranes.

use crate::synthetic::scene::Tissue;
use crate::synthetic::sdf::{Solid, blend, common, ellipsoid, half_space, rod, tube};
use crate::synthetic::tissue::{CALCIFICATION, CSF, DURA, GREY, Material, WHITE};

use super::skull;

/// Everything inside the skull, from the fluid around the brain to the pineal gland.
pub(super) fn tissues() -> Vec<Tissue> {
    let cavity = skull::cavity();
    let tentorium = half_space((0.0, 40.0, 14.0), (0.0, 0.35, -1.0));
    let under_tentorium = half_space((0.0, 40.0, 11.0), (0.0, -0.35, 1.0));
    let cerebrum = common(3.0, [cavity.clone().grown(-2.2), tentorium]).cut(3.0, falx().grown(1.4));
    let cerebellum =
        common(4.0, [cavity.clone().grown(-2.5), under_tentorium, ellipsoid((0.0, 44.0, -2.0), (48.0, 34.0, 26.0))]);
    vec![
        Tissue::new(DURA, cavity.clone().grown(1.5)),
        Tissue::new(CSF, cavity.grown(-0.6)),
        Tissue::new(Material::Folded { fold_mm: 12.0 }, cerebrum),
        Tissue::new(Material::Folded { fold_mm: 5.5 }, cerebellum),
        Tissue::new(WHITE, corpus_callosum()),
        Tissue::new(WHITE, brain_stem()),
        Tissue::new(GREY, deep_nuclei().mirrored()),
        Tissue::new(DURA, falx()),
        Tissue::new(CSF, ventricles()),
        Tissue::new(GREY, blend(2.0, [ellipsoid((13.0, -6.0, 47.0), (4.0, 14.0, 5.0)).mirrored()])),
        Tissue::new(
            CALCIFICATION,
            blend(
                1.0,
                [
                    ellipsoid((0.0, 22.0, 36.0), (2.4, 3.0, 2.4)),
                    ellipsoid((20.0, 34.0, 42.0), (1.8, 4.0, 2.0)).mirrored(),
                ],
            ),
        ),
    ]
}

/// The fold of dura between the hemispheres.
fn falx() -> Solid {
    let sheet =
        common(0.5, [half_space((0.9, 0.0, 0.0), (1.0, 0.0, 0.0)), half_space((-0.9, 0.0, 0.0), (-1.0, 0.0, 0.0))]);
    let free_edge = rod(&[(0.0, -44.0, 46.0, 20.0), (0.0, 2.0, 52.0, 20.0), (0.0, 36.0, 38.0, 18.0)]);
    common(0.5, [sheet, skull::cavity()]).cut(1.0, free_edge)
}

fn corpus_callosum() -> Solid {
    tube(&[
        (0.0, -36.0, 42.0, 4.0),
        (0.0, -40.0, 54.0, 4.5),
        (0.0, -20.0, 63.0, 3.6),
        (0.0, 8.0, 64.0, 3.4),
        (0.0, 30.0, 56.0, 5.0),
    ])
}

fn brain_stem() -> Solid {
    let midbrain = ellipsoid((0.0, 4.0, 22.0), (15.0, 12.0, 10.0));
    let pons = ellipsoid((0.0, 4.0, 5.0), (17.0, 13.0, 13.0));
    let medulla = tube(&[(0.0, 8.0, -5.0, 10.0), (0.0, 16.0, -24.0, 6.5)]);
    blend(6.0, [midbrain, pons, medulla])
}

fn deep_nuclei() -> Solid {
    let thalamus = ellipsoid((10.0, 6.0, 40.0), (8.0, 14.0, 9.0));
    let lentiform = ellipsoid((23.0, -10.0, 38.0), (6.0, 17.0, 10.0));
    let caudate = tube(&[(13.0, -30.0, 44.0, 6.0), (15.0, -10.0, 56.0, 4.0), (18.0, 10.0, 56.0, 2.5)]);
    blend(1.0, [thalamus, lentiform, caudate])
}

fn ventricles() -> Solid {
    let lateral = tube(&[
        (9.0, -38.0, 46.0, 4.0),
        (8.0, -22.0, 54.0, 5.0),
        (9.0, 2.0, 57.0, 5.0),
        (17.0, 26.0, 52.0, 6.5),
        (22.0, 36.0, 42.0, 7.5),
        (30.0, 24.0, 28.0, 4.0),
        (32.0, 0.0, 20.0, 2.8),
    ]);
    let occipital_horn = tube(&[(22.0, 38.0, 44.0, 6.0), (22.0, 58.0, 40.0, 3.0)]);
    let third = ellipsoid((0.0, 0.0, 38.0), (2.2, 14.0, 10.0));
    let aqueduct = tube(&[(0.0, 12.0, 30.0, 1.4), (0.0, 16.0, 16.0, 1.4)]);
    let fourth = ellipsoid((0.0, 20.0, 4.0), (7.0, 5.0, 11.0));
    let suprasellar = ellipsoid((0.0, -20.0, 27.0), (12.0, 9.0, 5.0));
    let quadrigeminal = ellipsoid((0.0, 21.0, 24.0), (11.0, 4.0, 5.0));
    blend(3.0, [blend(3.0, [lateral, occipital_horn]).mirrored(), third, aqueduct, fourth, suprasellar, quadrigeminal])
}
