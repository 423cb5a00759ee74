//! A series as a scan.

use std::collections::BTreeMap;
use std::path::Path;

use super::assemble::assemble;
use super::choice::SeriesChoice;
use super::folder::{Folder, scan_folder};
use super::geometry::Stack;
use super::series::{Series, Slice};
use super::spacing::SliceSpacing;
use crate::error::Result;
use crate::io::{FileFate, Scan};
use crate::volume::{Grid, Quantity, Slices, Volume};

/// Reads one series of a folder, or of a single file, as a volume.
///
/// `max_bytes` is the most memory that the volume may take while it is read.
///
/// # Errors
/// `Fault::Input` if there is no such series or its files are damaged, `Fault::Unsupported` for pixels that this build does
/// not decode, `Fault::Geometry` for slices that make no lattice, `Fault::Limit` for more than `max_bytes`.
pub fn read(path: &Path, choice: &SeriesChoice, max_bytes: Option<u64>) -> Result<Scan> {
    read_spaced(path, choice, SliceSpacing::Even, max_bytes)
}

/// The same for slices whose spacing may change.
///
/// # Errors
/// As [`read`].
pub fn read_spaced(path: &Path, choice: &SeriesChoice, spacing: SliceSpacing, max_bytes: Option<u64>) -> Result<Scan> {
    let folder = scan_folder(path)?;
    let series = choice.pick(&folder)?;
    let stack = series.stack(spacing)?;
    let slices: Vec<Slice> = stack.order.iter().map(|&index| series.slices[index].clone()).collect();
    let grid = Grid::new(series.dims, stack.index_to_lps_mm).map_err(|error| error.at(path))?;
    let assembled = assemble(series, &slices, max_bytes)?;
    let (quantity, quantity_warning) = quantity(series, &slices);
    let warnings = quantity_warning
        .into_iter()
        .chain(stack.warnings.iter().cloned())
        .chain(lossy_warning(&slices))
        .chain(assembled.warnings)
        .chain(folder_warnings(&folder, series))
        .collect();
    let reading_bytes = assembled.reading_bytes;
    let volume = Volume::new(grid, assembled.samples, assembled.rescale, quantity)
        .and_then(|volume| stack.slices.iter().cloned().try_fold(volume, Volume::with_slices))
        .map_err(|error| error.at(path))?;
    let facts = facts(series, &stack, assembled.rescale_text);
    Ok(Scan { labels: None, facts, warnings, files: fates(&folder, series), volume, reading_bytes })
}

/// What the values measure: Rescale Type is HU unless it says otherwise (PS3.3 §C.8.2.1 and §C.11.1.1.2).
fn quantity(series: &Series, slices: &[Slice]) -> (Quantity, Option<String>) {
    let unit = slices[0].file().rescale_type.as_deref();
    let same_unit = slices.iter().all(|slice| slice.file().rescale_type.as_deref() == unit);
    let has_rescale = slices.iter().all(|slice| matches!(slice.frame().rescale, Ok(Some(_))));
    let is_ct = series.modality == "CT";
    match unit {
        _ if !same_unit => {
            (Quantity::Arbitrary, Some("Rescale Type differs between slices: not taken as HU".to_owned()))
        }
        _ if !has_rescale => (
            Quantity::Arbitrary,
            Some("Rescale Slope and Intercept are missing: stored numbers are taken as they are, not as HU".to_owned()),
        ),
        Some("HU") if is_ct => (Quantity::Hu, None),
        Some("HU") => {
            (Quantity::Hu, Some(format!("modality {}, with values in HU as Rescale Type says", series.modality)))
        }
        None if is_ct => (Quantity::Hu, None),
        None => (Quantity::Arbitrary, Some(format!("modality {}: values are not taken as HU", series.modality))),
        Some(other) => (Quantity::Arbitrary, Some(format!("Rescale Type is {other}: values are not taken as HU"))),
    }
}

fn lossy_warning(slices: &[Slice]) -> Option<String> {
    let lossy = slices.iter().filter(|slice| slice.file().lossy).count();
    (lossy > 0).then(|| format!("{lossy} slices were compressed with loss: their values are not those of the scanner"))
}

fn folder_warnings(folder: &Folder, chosen: &Series) -> Vec<String> {
    let mut warnings: Vec<String> = folder
        .series
        .iter()
        .filter(|series| series.uid == chosen.uid && !std::ptr::eq(*series, chosen) && !series.is_localizer())
        .map(|series| format!("{} images of the same series have another geometry and are left out", series.dims[2]))
        .collect();
    if folder.damaged > 0 {
        warnings.push(format!("{} files may be images but could not be read; see the list of files", folder.damaged));
    }
    warnings
}

fn facts(series: &Series, stack: &Stack, rescale: String) -> Vec<(String, String)> {
    let [columns, rows, count] = series.dims;
    let [low, high] = stack.range_mm;
    let number = series.number.map_or_else(|| "none".to_owned(), |number| number.to_string());
    let mut facts = vec![
        ("format", "DICOM".to_owned()),
        ("series UID", series.uid.clone()),
        ("series number", number),
        ("series description", series.description.clone()),
        ("modality", series.modality.clone()),
        ("transfer syntax", series.transfer_syntax.clone()),
        ("dimensions", format!("{columns} x {rows} x {count}")),
        ("slice spacing", slice_spacing(stack)),
        ("slice positions", format!("{low:.3} to {high:.3} mm along the normal")),
        ("uneven spacing", format!("up to {:.6} mm of {:.4} mm accepted", stack.deviation_mm, stack.tolerance_mm)),
        ("rescale", rescale),
    ];
    if stack.tilt_degrees > 0.01 {
        facts.push(("gantry tilt", format!("{:.3} degrees, kept as shear", stack.tilt_degrees)));
    }
    facts.into_iter().map(|(label, text)| (label.to_owned(), text)).collect()
}

fn slice_spacing(stack: &Stack) -> String {
    match stack.slices.as_ref().map(Slices::step_range) {
        None => format!("{:.4} mm along the normal", stack.spacing_mm),
        Some(steps) => {
            let [least, most] = steps.map(|step| step * stack.spacing_mm);
            format!("{least:.4} to {most:.4} mm along the normal, uneven")
        }
    }
}

/// The fate of every file of the folder, by path.
fn fates(folder: &Folder, chosen: &Series) -> Vec<FileFate> {
    let mut fates: BTreeMap<_, FileFate> = folder.others.iter().map(|fate| (fate.path.clone(), fate.clone())).collect();
    for series in &folder.series {
        let used = std::ptr::eq(series, chosen);
        let reason = if used {
            "a slice of the series".to_owned()
        } else if series.is_localizer() {
            "a localizer".to_owned()
        } else if series.uid == chosen.uid {
            "of the same series, with another geometry".to_owned()
        } else {
            format!("of another series: {}", series.label())
        };
        for slice in &series.slices {
            let path = slice.path().to_path_buf();
            // A file with frames in several groups is used if one of them is.
            let fate = fates.entry(path.clone()).or_insert(FileFate { path, used, reason: reason.clone() });
            if used && !fate.used {
                fate.used = true;
                fate.reason.clone_from(&reason);
            }
        }
    }
    fates.into_values().collect()
}
