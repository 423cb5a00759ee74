//! `pellucid evaluate`: labels against a reference.

use std::path::PathBuf;

use pellucid::io::dicom::SeriesChoice;
use pellucid::io::{load, png, read_labels};
use pellucid::pipeline::pairs;
use pellucid::spec::ReferenceTissues;
use pellucid::tissue::{Agreement, Bound, Comparison, Confusion, agreement, bound, confusion, picture};
use pellucid::{Result, Volume};

use super::table::{Table, TableFormat, number};
use super::{Global, stderr, stdout};

/// Arguments of `pellucid evaluate`.
#[derive(Debug, clap::Args)]
pub(super) struct Evaluate {
    /// The labels: .seg.nrrd, .nrrd, .nii or .nii.gz
    labels: PathBuf,

    /// What they should be, on the same voxels
    #[arg(long, value_name = "FILE")]
    reference: PathBuf,

    /// Which labels of the reference make up which tissue, a YAML file: `version: 1` and `tissues: { bone: [25, "92-115"] }`
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,

    /// The scan, for --bound and under --picture
    #[arg(long, value_name = "SCAN")]
    scan: Option<PathBuf>,

    /// Also the best Dice that any function of HU, and of HU and gradient magnitude, could reach on this scan
    #[arg(long, requires = "scan")]
    bound: bool,

    /// Draw where labels and reference differ, a PNG
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,

    /// How the tables are printed
    #[arg(long, value_enum, default_value_t = TableFormat::Text)]
    format: TableFormat,
}

impl Evaluate {
    /// Compares; the tables go to stdout.
    pub(super) fn run(&self, global: &Global) -> Result<()> {
        let (labels, reference) = (read_labels(&self.labels)?, read_labels(&self.reference)?);
        let map = self.map.as_deref().map(ReferenceTissues::load).transpose()?;
        let pairs = pairs(&labels, &reference, map.as_ref())?;
        let comparison = Comparison::new(&labels, &reference, pairs)?;
        if let (Some(map), false) = (&map, global.quiet) {
            let unmatched = map.tissues().map(|(name, _)| name).filter(|name| labels.position_of(name).is_none());
            unmatched.for_each(|name| stderr::say(&format!("warning: the labels have no {name}: it is left out")));
        }
        let scan = self.scan.as_deref().map(|path| load(path, &SeriesChoice::Largest, None)).transpose()?;
        let scan = scan.map(|scan| scan.volume);
        if let Some(path) = &self.picture {
            png::write(path, &picture(&comparison, scan.as_ref()), png::Depth::Eight, &[])?;
        }
        let bounds = if self.bound { bounds(&comparison, scan.as_ref())? } else { Vec::new() };
        let (agreement, confusion) = (agreement(&comparison)?, confusion(&comparison));
        match self.format {
            TableFormat::Text => {
                let tables = [table(&agreement, &bounds).text(), confused(&confusion).text()];
                stdout::print(&tables.join("\n\n"))
            }
            TableFormat::Csv => stdout::print(&table(&agreement, &bounds).csv()),
            TableFormat::Json => stdout::print_json(&serde_json::json!({
                "tissues": agreement, "bounds": bounds, "confusion": confusion
            })),
        }
    }
}

fn bounds(comparison: &Comparison<'_>, scan: Option<&Volume>) -> Result<Vec<Bound>> {
    let Some(scan) = scan else { return Ok(Vec::new()) };
    comparison.pairs.iter().map(|pair| bound(scan, &comparison.reference_mask(pair))).collect()
}

fn table(agreement: &[Agreement], bounds: &[Bound]) -> Table {
    let mut header = vec!["tissue", "Dice", "Jaccard", "ml", "reference ml", "difference %", "HD95 mm", "mean SD mm"];
    if !bounds.is_empty() {
        header.extend(["best by HU", "by HU and gradient"]);
    }
    let mut table = Table::new(&header);
    for (n, tissue) in agreement.iter().enumerate() {
        let mut row = vec![
            tissue.tissue.clone(),
            number(tissue.dice, 4),
            number(tissue.jaccard, 4),
            number(Some(tissue.ml), 2),
            number(Some(tissue.reference_ml), 2),
            number(tissue.difference_percent, 1),
            number(tissue.hausdorff_95_mm, 2),
            number(tissue.mean_surface_distance_mm, 2),
        ];
        row.extend(
            bounds
                .get(n)
                .into_iter()
                .flat_map(|bound| [bound.by_value, bound.by_value_and_gradient].map(|dice| number(Some(dice), 4))),
        );
        table.row(row);
    }
    table
}

/// Rows are labels, columns are the reference.
fn confused(confusion: &Confusion) -> Table {
    let header: Vec<&str> = std::iter::once("voxels").chain(confusion.reference.iter().map(String::as_str)).collect();
    let mut table = Table::new(&header);
    for (name, voxels) in confusion.labels.iter().zip(&confusion.voxels) {
        table.row(std::iter::once(name.clone()).chain(voxels.iter().map(u64::to_string)).collect());
    }
    table
}
