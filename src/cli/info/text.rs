//! What `info` knows of a scan, for people.

use pellucid::io::Scan;

use super::histogram;
use super::report::{FileReport, Report, SeriesReport, VolumeReport};

/// Characters of the histogram.
const HISTOGRAM_BINS: usize = 64;

/// The report as lines of text.
pub(super) fn of(report: &Report, scan: Option<&Scan>) -> String {
    let mut rows: Vec<(String, String)> = Vec::new();
    if let (Some(volume), Some(scan)) = (&report.volume, scan) {
        rows.extend(volume_rows(volume));
        rows.push(("histogram".to_string(), format!("[{}]", histogram::line(&scan.volume, HISTOGRAM_BINS))));
        // What the reader says in its own words, less what stands above in ours.
        let said = |label: &String| rows.iter().any(|(said, _)| said == label);
        let more: Vec<_> =
            scan.facts.iter().filter(|(label, text)| !said(label) && !text.is_empty()).cloned().collect();
        rows.extend(more);
    }
    let mut text = table(&rows);
    if !report.series.is_empty() {
        text.push_str("series:\n");
        report.series.iter().for_each(|series| text.push_str(&series_lines(series)));
    }
    text.push_str(&file_lines(&report.files));
    report.warnings.iter().for_each(|warning| text.push_str(&format!("warning: {warning}\n")));
    text
}

fn table(rows: &[(String, String)]) -> String {
    let widest = rows.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
    rows.iter().map(|(label, value)| format!("{label:widest$}  {value}\n")).collect()
}

fn volume_rows(volume: &VolumeReport) -> Vec<(String, String)> {
    let [nx, ny, nz] = volume.dims;
    let [sx, sy, sz] = volume.spacing_mm;
    let [low, high] = volume.value_range;
    let values = match volume.quantity {
        "rgba" => format!("colours with an alpha of {low} to {high}"),
        "hu" => format!("{low} to {high} HU"),
        _ => format!("{low} to {high}, not known to be HU"),
    };
    let [x, y, z] = volume.index_to_lps_mm.map(|row| row[3]);
    let rows = [
        ("dimensions", format!("{nx} x {ny} x {nz} voxels")),
        ("spacing", format!("{sx:.4} x {sy:.4} x {} mm", between_slices(volume, sz))),
        (
            "axes",
            ["i", "j", "k"]
                .iter()
                .enumerate()
                .map(|(axis, name)| direction(volume, axis, name))
                .collect::<Vec<_>>()
                .join(", "),
        ),
        ("first voxel", format!("({x:.3}, {y:.3}, {z:.3}) mm, LPS")),
        ("values", values),
        ("values SHA-256", volume.values_sha256.clone()),
    ];
    rows.map(|(label, text)| (label.to_string(), text)).to_vec()
}

/// The distance between slices, mm: one number, or from the smallest to the largest.
fn between_slices(volume: &VolumeReport, mean_mm: f64) -> String {
    let Some(positions_mm) = &volume.slice_positions_mm else { return format!("{mean_mm:.4}") };
    let steps = positions_mm.windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = steps.fold((f64::INFINITY, 0.0f64), |(least, most), step| (least.min(step), most.max(step)));
    format!("{least:.4} to {most:.4} (uneven)")
}

/// Where an axis leads, to the nearest of the patient's six directions.
fn direction(volume: &VolumeReport, axis: usize, name: &str) -> String {
    let step = volume.index_to_lps_mm.map(|row| row[axis]);
    let main = (0..3).max_by(|&a, &b| step[a].abs().total_cmp(&step[b].abs())).unwrap_or(0);
    let towards = [["right", "left"], ["front", "back"], ["feet", "head"]][main][usize::from(step[main] > 0.0)];
    let length = step.iter().map(|s| s * s).sum::<f64>().sqrt();
    let oblique = step[main].abs() < 0.999 * length;
    format!("{name} to the {towards}{}", if oblique { " (oblique)" } else { "" })
}

fn series_lines(series: &SeriesReport) -> String {
    let [columns, rows, slices] = series.dims;
    let number = series.number.map_or_else(|| "-".to_string(), |number| number.to_string());
    let identity = [series.uid.as_str(), &series.transfer_syntax].into_iter().filter(|text| !text.is_empty());
    let mut lines = format!(
        "  {number}  {} {columns} x {rows} x {slices}  {}\n     {}\n",
        series.modality,
        series.description,
        identity.collect::<Vec<_>>().join(", ")
    );
    if let Some(reason) = &series.refused {
        lines.push_str(&format!("     refused: {reason}\n"));
    }
    lines
}

/// Files that were used in one line, the others one by one.
fn file_lines(files: &[FileReport]) -> String {
    if files.is_empty() {
        return String::new();
    }
    let used = files.iter().filter(|file| file.used).count();
    let mut lines = format!("files: {used} used, {} left out\n", files.len() - used);
    for file in files.iter().filter(|file| !file.used) {
        lines.push_str(&format!("  {}: {}\n", file.path, file.reason));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(index_to_lps_mm: [[f64; 4]; 3]) -> VolumeReport {
        VolumeReport {
            dims: [2, 3, 4],
            index_to_lps_mm,
            spacing_mm: [1.0, 1.0, 2.0],
            slice_positions_mm: None,
            value_range: [-1000.0, 3000.0],
            quantity: "hu",
            values_sha256: "00".to_string(),
        }
    }

    #[test]
    fn axes_are_named_after_the_patient() {
        let report = volume([[-1.0, 0.0, 0.5, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]]);
        let names: Vec<String> = (0..3).map(|axis| direction(&report, axis, "x")).collect();
        assert_eq!(names, ["x to the right", "x to the back", "x to the head (oblique)"]);
    }

    #[test]
    fn files_that_were_left_out_are_named_with_the_reason() {
        let file = |path: &str, used| FileReport { path: path.to_string(), used, reason: "why".to_string() };
        assert_eq!(file_lines(&[file("a", true), file("b", false)]), "files: 1 used, 1 left out\n  b: why\n");
        assert_eq!(file_lines(&[]), "");
    }
}
