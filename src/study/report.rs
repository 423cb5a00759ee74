//! A study as text, as tables for spreadsheets, as JSON and as a chart.

mod chart;

use std::fmt::Write;

use super::{LeftOut, Measurement, PeerMeasurement, Study};
use crate::chart::LogLog;
use crate::error::{Error, Fault, Result};

/// What to know when other programs stand in the table.
const PEERS_NOTE: &str = "\nOther programs: seconds of a frame without set-up, and errors against the same oracle. Lit, VTK's highlight \
                          is Phong's where the scene's is Blinn's, and its errors include that.\n";

/// Forms of a study.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a>(pub &'a Study);

impl Report<'_> {
    /// Everything in words and tables, as Markdown. Settings on the Pareto front are marked.
    pub fn markdown(&self) -> String {
        let Study { size: [width, height], threads, tolerance, oracle_pixels, .. } = self.0;
        let mut text = format!(
            "# Accuracy against time\n\n{width} x {height} pixels, {threads} threads, {}. Errors of {oracle_pixels} random \
             pixels against the oracle, per channel, linear and premultiplied; a number in bold is within {tolerance:.3e}. \
             Seconds are medians on this machine; compare their ratios. `*`: no other setting is both as quick and as \
             accurate.\n\n",
            version()
        );
        let mut line = |cells: &[String]| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        };
        let head = ["", "`integrate:`", "seconds", "repeats", "largest error", "99.9 % within", "RMS error"];
        line(&head.map(str::to_owned));
        line(&["---", "---", "--:", "--:", "--:", "--:", "--:"].map(str::to_owned));
        for (place, m) in self.0.settings.iter().enumerate() {
            let mark = if self.0.front.contains(&place) { "*" } else { "" };
            let [largest, most, rms] = [m.errors.largest, m.errors.of_999_in_1000, m.errors.rms].map(|e| self.error(e));
            let setting = format!("`{}`", m.rung.setting);
            line(&[mark.to_owned(), setting, seconds(m.seconds), m.repeats.to_string(), largest, most, rms]);
        }
        for m in &self.0.peers {
            let [largest, most, rms] = [m.errors.largest, m.errors.of_999_in_1000, m.errors.rms].map(|e| self.error(e));
            let setting = format!("{}, step {}", m.peer, m.step_voxels);
            line(&[String::new(), setting, seconds(m.seconds), m.repeats.to_string(), largest, most, rms]);
        }
        if !self.0.peers.is_empty() {
            text.push_str(PEERS_NOTE);
        }
        text.push_str(
            "\n## What each choice costs\n\nTwo pictures that differ in nothing else, rendered in turns.\n\n",
        );
        let mut line = |cells: &[String]| {
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        };
        let head = ["choice", "by", "time x", "seconds without", "with", "rounds", "largest error without", "with"];
        line(&head.map(str::to_owned));
        line(&["---", "---", "--:", "--:", "--:", "--:", "--:", "--:"].map(str::to_owned));
        for cost in &self.0.costs {
            let [without, with] = cost.seconds.map(seconds);
            let [error, error_with] = cost.errors.map(|errors| self.error(errors.largest));
            let ratio = format!("{:.2}", cost.time_ratio);
            let names = [cost.choice.clone(), cost.by.clone()];
            let [choice, by] = names;
            line(&[choice, by, ratio, without, with, cost.rounds.to_string(), error, error_with]);
        }
        if !self.0.left_out.is_empty() {
            text.push_str("\n## Left out\n\n");
            for LeftOut { what, why } in &self.0.left_out {
                let _ = writeln!(text, "- `{what}`: {why}");
            }
        }
        text
    }

    /// An error, in bold if it is within the tolerance.
    fn error(&self, error: f64) -> String {
        if error <= self.0.tolerance { format!("**{error:.1e}**") } else { format!("{error:.1e}") }
    }

    /// One line per setting (RFC 4180).
    pub fn settings_csv(&self) -> String {
        let mut text = "setting,family,seconds,repeats,samples,pixels,largest_error,error_of_999_in_1000,rms_error,\
                        error_bound,on_front\n"
            .to_owned();
        for (place, Measurement { rung, seconds, repeats, samples, errors, error_bound }) in
            self.0.settings.iter().enumerate()
        {
            let bound = error_bound.map_or(String::new(), |bound| format!("{bound:e}"));
            let _ = writeln!(
                text,
                "\"{}\",\"{}\",{seconds},{repeats},{samples},{},{:e},{:e},{:e},{bound},{}",
                rung.setting,
                rung.family.name(),
                errors.pixels,
                errors.largest,
                errors.of_999_in_1000,
                errors.rms,
                self.0.front.contains(&place)
            );
        }
        for PeerMeasurement { peer, step_voxels, seconds, repeats, errors } in &self.0.peers {
            let _ = writeln!(
                text,
                "\"step {step_voxels}\",\"{peer}\",{seconds},{repeats},,{},{:e},{:e},{:e},,false",
                errors.pixels, errors.largest, errors.of_999_in_1000, errors.rms
            );
        }
        text
    }

    /// One line per choice (RFC 4180).
    pub fn costs_csv(&self) -> String {
        let mut text = "choice,by,time_ratio,seconds_without,seconds_with,rounds,largest_error_without,\
                        largest_error_with\n"
            .to_owned();
        for cost in &self.0.costs {
            let ([without, with], [error, error_with]) = (cost.seconds, cost.errors.map(|errors| errors.largest));
            let _ = writeln!(
                text,
                "\"{}\",\"{}\",{},{without},{with},{},{error:e},{error_with:e}",
                cost.choice, cost.by, cost.time_ratio, cost.rounds
            );
        }
        text
    }

    /// All numbers.
    ///
    /// # Errors
    /// `Fault::Internal` if they have no JSON form.
    pub fn json(&self) -> Result<String> {
        let json = serde_json::json!({ "tool": version(), "study": self.0 });
        serde_json::to_string_pretty(&json)
            .map_err(|cause| Error::new(Fault::Internal, "the study has no JSON form").caused_by(cause))
    }

    /// Largest error against seconds, with the Pareto front and the tolerance.
    pub fn chart(&self) -> LogLog {
        chart::of(self.0)
    }
}

fn version() -> &'static str {
    concat!("pellucid ", env!("CARGO_PKG_VERSION"))
}

/// Three digits, whatever the size.
fn seconds(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{s:.4}"),
        s if s < 1.0 => format!("{s:.3}"),
        s if s < 100.0 => format!("{s:.2}"),
        s => format!("{s:.0}"),
    }
}
