//! A study as a chart.

use crate::chart::{LogLog, Series};
use crate::study::{Family, Measurement, PeerMeasurement, Study};

/// Errors below this are drawn here: what rounding in f32 leaves is no matter of settings, and 0 is on no logarithmic axis.
const LEAST_ERROR: f64 = 1e-8;

/// Largest error against seconds, with the Pareto front and the tolerance.
pub(super) fn of(study: &Study) -> LogLog {
    let [width, height] = study.size;
    LogLog {
        title: "Accuracy against time".to_owned(),
        subtitle: format!(
            "{width} × {height} pixels, {} threads; numbers are steps in voxels, or tolerances",
            study.threads
        ),
        x_label: "seconds per picture".to_owned(),
        y_label: format!("largest error of {} pixels", study.oracle_pixels),
        series: series(study),
        front: Some(Series {
            name: "Pareto front".to_owned(),
            points: front(study).map(|m| point(m.seconds, m.errors.largest)).collect(),
        }),
        level: Some((format!("tolerance {}", crate::study::exact(study.tolerance).fineness), study.tolerance)),
        notes: notes(study),
    }
}

fn point(seconds: f64, error: f64) -> [f64; 2] {
    [seconds, error.max(LEAST_ERROR)]
}

fn front(study: &Study) -> impl Iterator<Item = &Measurement> {
    study.front.iter().filter_map(|&place| study.settings.get(place))
}

/// Our settings by family, then other programs, each from coarse to fine.
fn series(study: &Study) -> Vec<Series> {
    let ours = Family::ALL.map(|family| {
        let of_family = study.settings.iter().filter(|m| m.rung.family == family);
        let mut points: Vec<(f64, [f64; 2])> =
            of_family.map(|m| (fineness(m), point(m.seconds, m.errors.largest))).collect();
        points.sort_by(|a, b| b.0.total_cmp(&a.0));
        Series { name: family.name().to_owned(), points: points.into_iter().map(|(_, point)| point).collect() }
    });
    let mut names: Vec<&str> = study.peers.iter().map(|m| m.peer.as_str()).collect();
    names.dedup();
    let theirs = names.into_iter().map(|name| {
        let of_peer = study.peers.iter().filter(|m| m.peer == name);
        Series { name: name.to_owned(), points: of_peer.map(|m| point(m.seconds, m.errors.largest)).collect() }
    });
    ours.into_iter().filter(|series| !series.points.is_empty()).chain(theirs).collect()
}

/// The step in mm, or the tolerance.
fn fineness(m: &Measurement) -> f64 {
    use crate::plan::Method;
    match m.rung.method {
        Method::March(march) => march.step_mm,
        Method::Exact(exact) => exact.tolerance,
        Method::Reference => 0.0,
    }
}

/// What stands beside points, in the order in which it gets room: the front, other programs, the exact integrator. The
/// steps of the march are those of the other programs, and beside its points, which are close together, would be in doubt.
fn notes(study: &Study) -> Vec<([f64; 2], String)> {
    let note = |m: &Measurement| (point(m.seconds, m.errors.largest), m.rung.fineness.clone());
    let of = |family: Family| study.settings.iter().filter(move |m| m.rung.family == family);
    let peer = |m: &PeerMeasurement| (point(m.seconds, m.errors.largest), m.step_voxels.clone());
    let mut notes: Vec<([f64; 2], String)> = Vec::new();
    for (place, fineness) in front(study).map(note) {
        // Families at the same step lie side by side on the front: one number says it for all.
        if notes.iter().all(|(_, written)| *written != fineness) {
            notes.push((place, fineness));
        }
    }
    notes.extend(study.peers.iter().map(peer));
    for m in of(Family::Exact).map(note) {
        if !notes.contains(&m) {
            notes.push(m);
        }
    }
    notes
}
