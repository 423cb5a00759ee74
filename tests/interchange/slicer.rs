//! Slicer's own CT presets: an import has the opacity and the colour that they say, at every HU and between.

use std::fs;

use pellucid::image::srgb;
use pellucid::interchange::presets::{ColorNumbers, ImportSettings, import, preset_name, read};
use proptest::prelude::*;

use super::{difference, file, imported, slab, transfer_function, written_and_read};

/// A preset as the test reads it: names with rows of `x, y…`, by cutting the text at its quotes.
struct Published {
    name: String,
    opacity: Vec<Vec<f64>>,
    color: Vec<Vec<f64>>,
}

fn published() -> Vec<Published> {
    let text = fs::read_to_string(file("slicer/presets.xml")).expect("the file is there");
    let of = |element: &str, key: &str| {
        element
            .split(&format!("{key}=\""))
            .nth(1)
            .and_then(|rest| rest.split('"').next())
            .expect("an attribute")
            .to_owned()
    };
    let rows = |list: String, width: usize| {
        let numbers: Vec<f64> = list.split(' ').skip(1).map(|word| word.parse().expect("a number")).collect();
        numbers.chunks(width).map(<[f64]>::to_vec).collect()
    };
    let elements = text.split("<VolumeProperty").skip(1);
    elements
        .map(|element| Published {
            name: of(element, "name"),
            opacity: rows(of(element, "scalarOpacity"), 2),
            color: rows(of(element, "colorTransfer"), 4),
        })
        .collect()
}

/// Straight lines between rows, constant beyond them.
fn line(rows: &[Vec<f64>], x: f64) -> Vec<f64> {
    let pair = rows.windows(2).find(|pair| pair[0][0] <= x && x < pair[1][0]);
    match pair {
        Some([a, b]) => {
            let t = (x - a[0]) / (b[0] - a[0]);
            (1..a.len()).map(|i| a[i] + t * (b[i] - a[i])).collect()
        }
        _ if x < rows[0][0] => rows[0][1..].to_vec(),
        _ => rows[rows.len() - 1][1..].to_vec(),
    }
}

/// The largest deviation of an import from what is published, at these values.
fn deviation(published: &Published, bound: f64, colors: ColorNumbers, values: impl IntoIterator<Item = f64>) -> f64 {
    let properties = read(&file("slicer/presets.xml")).unwrap_or_else(|error| panic!("{error}"));
    let property = properties.iter().find(|property| property.name == published.name).expect("by its name");
    let settings = ImportSettings { max_deviation: bound, colors, ..ImportSettings::default() };
    let imported = import(property, "imported", &settings).unwrap_or_else(|error| panic!("{}: {error}", property.name));
    assert!(imported.max_deviation <= bound, "{}: reports {}", published.name, imported.max_deviation);
    let function = transfer_function(&written_and_read(&imported));
    let at = |hu: f64| {
        let color = line(&published.color, hu).into_iter().map(|c| match colors {
            ColorNumbers::Display => srgb::decode(c),
            ColorNumbers::Light => c,
        });
        let color: Vec<f64> = color.collect();
        // What is said to be opaque lets 2^-24 through (`math::extinction_per_mm`), so that its extinction is finite.
        let of_unit = line(&published.opacity, hu)[0].min(1.0 - 2f64.powi(-24));
        let of_length = |length_mm: f64| {
            let opacity = 1.0 - (1.0 - of_unit).powf(length_mm);
            let expected = [opacity, opacity * color[0], opacity * color[1], opacity * color[2]];
            difference(slab(function.evaluate(hu, 0.0), length_mm), expected)
        };
        [0.25, 1.0, 7.0, 60.0, 500.0].into_iter().map(of_length).fold(0.0, f64::max)
    };
    values.into_iter().map(at).fold(0.0, f64::max)
}

#[test]
fn all_presets_are_what_they_were_at_every_hu() {
    let all = published();
    assert_eq!(all.len(), 22, "the CT presets of the file");
    for bound in [1.0 / 1024.0, 0.01] {
        for (published, colors) in all.iter().flat_map(|p| [(p, ColorNumbers::Display), (p, ColorNumbers::Light)]) {
            let found = deviation(published, bound, colors, (-3100..=3700).map(f64::from));
            assert!(found <= bound, "{} within {bound}: found {found}", published.name);
        }
    }
}

/// The comparison can fail: without knots, a straight line in extinction is far from one in opacity.
#[test]
fn a_coarse_bound_is_not_a_fine_one() {
    let bone = published().into_iter().find(|p| p.name == "CT-Bone").expect("CT-Bone");
    let found = deviation(&bone, 0.25, ColorNumbers::Display, (-3100..=3700).map(f64::from));
    assert!(found > 0.02 && found <= 0.25, "found {found}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Between whole numbers, too, and for any bound.
    #[test]
    fn any_value_is_within_any_bound(
        which in 0usize..22,
        exponent in 4..12_i32,
        values in prop::collection::vec(-3100.0..3700.0_f64, 200),
    ) {
        let bound = 2f64.powi(-exponent);
        let published = &published()[which];
        let found = deviation(published, bound, ColorNumbers::Display, values);
        prop_assert!(found <= bound, "{} within {bound}: found {found}", published.name);
    }
}

#[test]
fn names_are_those_of_files_and_shading_is_said() {
    let properties = read(&file("slicer/presets.xml")).expect("it is read");
    assert_eq!(preset_name(&properties[10].name), "ct-coronary-arteries-2");
    let text = imported(&properties[2], 1e-3).yaml();
    assert!(text.contains("diffuse: 0.9, specular: 0.2, shininess: 10"), "found\n{text}");
    let unshaded = imported(&properties[12], 1e-3).yaml();
    assert!(!unshaded.contains("shaded"), "found\n{unshaded}");
}

#[test]
fn the_text_form_is_the_same_preset() {
    let [vp] = read(&file("slicer/ct-bone.vp")).expect("it is read").try_into().expect("one");
    let xml = read(&file("slicer/presets.xml")).expect("it is read").swap_remove(2);
    assert_eq!(vp.name, "ct-bone");
    assert_eq!((vp.scalar_opacity, vp.color, vp.shading), (xml.scalar_opacity, xml.color, xml.shading));
}
