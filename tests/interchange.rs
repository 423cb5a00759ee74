//! Presets of other programs: what they say against what is imported, and back.

mod formats;
mod gradient;
mod projection;
mod slicer;

use std::fs;
use std::path::{Path, PathBuf};

use pellucid::image::srgb;
use pellucid::interchange::presets::{ImportSettings, Imported, VolumeProperty, import, read};
use pellucid::plan::preset_terms;
use pellucid::spec::{Preset, parse_preset};
use pellucid::transfer::{Optics, TransferFunction};

/// A file of this folder.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/interchange").join(name)
}

/// Writes a text under a name of its own and reads the presets in it.
fn read_text(name: &str, text: &str) -> pellucid::Result<Vec<VolumeProperty>> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("interchange");
    fs::create_dir_all(&folder).expect("a folder can be made");
    let path = folder.join(name);
    fs::write(&path, text).expect("the folder is writable");
    read(&path)
}

/// A preset as a pipeline reads what was written of it.
fn written_and_read(imported: &Imported) -> Preset {
    let path = format!("{}.yaml", imported.preset.name);
    parse_preset(&imported.yaml(), Path::new(&path))
        .unwrap_or_else(|error| panic!("{error}\n{}", imported.yaml()))
        .preset
}

fn imported(property: &VolumeProperty, max_deviation: f64) -> Imported {
    let settings = ImportSettings { max_deviation, ..ImportSettings::default() };
    import(property, "imported", &settings).unwrap_or_else(|error| panic!("{}: {error}", property.name))
}

/// The transfer function of a preset, over more than any value of a CT scan.
fn transfer_function(preset: &Preset) -> TransferFunction {
    let terms = preset_terms(preset).expect("a preset that was checked");
    TransferFunction::new([-4000.0, 5000.0], 1500.0, terms).expect("a domain")
}

/// Opacity and straight colour times opacity (linear) of a slab, from extinction and emission.
fn slab(optics: Optics, length_mm: f64) -> [f64; 4] {
    let opacity = 1.0 - (-optics.extinction_per_mm * length_mm).exp();
    let color = optics.emission_per_mm.map(|q| if q > 0.0 { q / optics.extinction_per_mm } else { 0.0 });
    [opacity, color[0] * opacity, color[1] * opacity, color[2] * opacity]
}

/// The same from an opacity and an sRGB colour.
fn slab_of_srgb(opacity: f64, color: &[f64]) -> [f64; 4] {
    let light = |c: f64| srgb::decode(c) * opacity;
    [opacity, light(color[0]), light(color[1]), light(color[2])]
}

fn difference(a: [f64; 4], b: [f64; 4]) -> f64 {
    a.iter().zip(b).map(|(x, y)| if (x - y).is_nan() { f64::INFINITY } else { (x - y).abs() }).fold(0.0, f64::max)
}
