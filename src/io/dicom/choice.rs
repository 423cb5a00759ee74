//! Which series of a folder is meant.

use super::folder::Folder;
use super::series::{Series, Verdict};
use crate::error::{Error, Fault, Result};

/// Which series to read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum SeriesChoice {
    /// The one with the most slices, then voxels; localizers are left aside. Two equal ones are an error.
    #[default]
    Largest,
    /// By Series Instance UID, number or description: the whole of one of them without regard to case, else a part that
    /// only one series has.
    Named(String),
}

impl SeriesChoice {
    /// The series that is meant.
    ///
    /// # Errors
    /// `Fault::Input`, listing the series there are, if none or more than one is meant.
    pub(super) fn pick<'a>(&self, folder: &'a Folder) -> Result<&'a Series> {
        if folder.series.is_empty() {
            return Err(Error::new(Fault::Input, "no DICOM image found")
                .at(&folder.path)
                .found(others(folder))
                .remedy("name a folder that holds the slices of a CT series"));
        }
        match self {
            SeriesChoice::Largest => largest(folder),
            SeriesChoice::Named(name) => named(folder, name),
        }
    }
}

fn largest(folder: &Folder) -> Result<&Series> {
    let size = |series: &Series| (!series.is_localizer(), series.dims[2], series.voxels());
    let most = folder.series.iter().map(size).max();
    let largest: Vec<&Series> = folder.series.iter().filter(|series| Some(size(series)) == most).collect();
    match largest[..] {
        [only] => Ok(only),
        _ => Err(Error::new(Fault::Input, "several series are equally large")
            .at(&folder.path)
            .found(list(&largest))
            .remedy("choose one by its UID, number or description")),
    }
}

fn named<'a>(folder: &'a Folder, name: &str) -> Result<&'a Series> {
    let wanted = name.trim().to_lowercase();
    let keys = |series: &Series| {
        [
            series.uid.clone(),
            series.number.map(|n| n.to_string()).unwrap_or_default(),
            series.description.to_lowercase(),
        ]
    };
    let exact = |series: &&Series| !wanted.is_empty() && keys(series).contains(&wanted);
    // A number is not searched for parts: "1" would be in "10".
    let part = |series: &&Series| {
        let [uid, _, description] = keys(series);
        !wanted.is_empty() && (uid.contains(&wanted) || description.contains(&wanted))
    };
    let mut meant: Vec<&Series> = folder.series.iter().filter(exact).collect();
    if meant.is_empty() {
        meant = folder.series.iter().filter(part).collect();
    }
    // A localizer shares the UID of its slices; whoever names the series means the slices.
    if meant.len() > 1 {
        let renderable: Vec<&Series> = meant.iter().copied().filter(|s| s.verdict == Verdict::Renderable).collect();
        if let [only] = renderable[..]
            && meant.iter().all(|series| series.uid == only.uid)
        {
            return Ok(only);
        }
    }
    let error = |what: &str, list: String| {
        Error::new(Fault::Input, format!("{what} '{name}'"))
            .at(&folder.path)
            .found(list)
            .remedy("choose one by its UID, number or description")
    };
    match meant[..] {
        [only] => Ok(only),
        [] => Err(error("no series is called", list(&folder.series.iter().collect::<Vec<_>>()))),
        _ => Err(error("several series are called", list(&meant))),
    }
}

fn list(series: &[&Series]) -> String {
    let lines: Vec<String> = series.iter().map(|series| format!("\n    {}", series.label())).collect();
    lines.concat()
}

fn others(folder: &Folder) -> String {
    match folder.others.first() {
        None => "no files".to_owned(),
        Some(first) => {
            format!("{} other files; the first, {}: {}", folder.others.len(), first.path.display(), first.reason)
        }
    }
}
