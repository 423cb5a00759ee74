//! The settings that are measured.

use serde::Serialize;

use crate::plan::{Exact, Jitter, JitterKind, March, Method, SampleRule};

/// A kind of settings, whose members differ by how fine they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Fixed steps, sampled at the start of each.
    Left,
    /// Fixed steps, sampled in the middle.
    Midpoint,
    /// Fixed steps, sampled at both ends.
    Trapezoid,
    /// Fixed steps, sampled in the middle, from a random start on each ray.
    Jitter,
    /// Within a tolerance.
    Exact,
}

impl Family {
    /// All of them.
    pub const ALL: [Family; 5] = [Family::Left, Family::Midpoint, Family::Trapezoid, Family::Jitter, Family::Exact];

    /// As charts and tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Family::Left => "march, left",
            Family::Midpoint => "march, midpoint",
            Family::Trapezoid => "march, trapezoid",
            Family::Jitter => "march, midpoint with jitter",
            Family::Exact => "exact",
        }
    }

    /// About how many times as long the next finer setting takes, rather too much than too little: twice the samples, or a
    /// tenth of the tolerance.
    pub(super) fn growth(self) -> f64 {
        match self {
            Family::Exact => 3.0,
            _ => 2.2,
        }
    }
}

/// One setting of the ladder.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rung {
    /// Its kind.
    pub family: Family,
    /// How it is written in a pipeline, after `integrate:`.
    pub setting: String,
    /// Its step in units of the smallest spacing, or its tolerance, as it is written.
    pub fineness: String,
    /// What it is, resolved.
    pub method: Method,
}

/// Distances between samples in units of the smallest spacing, coarse to fine, as they are written.
pub(super) const STEPS: [(&str, f64); 7] =
    [("4", 4.0), ("2", 2.0), ("1", 1.0), ("1/2", 0.5), ("1/4", 0.25), ("1/8", 0.125), ("1/16", 0.0625)];

/// Tolerances of the exact integrator, coarse to fine.
const TOLERANCES: [f64; 5] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];

/// All settings, level by level from coarse to fine: who stops early has seen some of each family.
pub fn ladder(smallest_spacing_mm: f64) -> Vec<Rung> {
    let level = |n: usize| {
        let steps = STEPS.get(n).into_iter().flat_map(move |&(written, voxels)| {
            [Family::Left, Family::Midpoint, Family::Trapezoid, Family::Jitter]
                .map(|family| march(family, written, voxels * smallest_spacing_mm))
        });
        steps.chain(TOLERANCES.get(n).map(|&tolerance| exact(tolerance)))
    };
    (0..STEPS.len().max(TOLERANCES.len())).flat_map(level).collect()
}

/// The exact integrator at a tolerance.
pub fn exact(tolerance: f64) -> Rung {
    let written = match tolerance {
        // One step of an 8-bit channel is what most people write.
        t if t == 1.0 / 255.0 => "1/255".to_owned(),
        t if t < 0.01 => format!("{t:e}"),
        t => t.to_string(),
    };
    Rung {
        family: Family::Exact,
        setting: format!("{{ exact: {{ tolerance: {written} }} }}"),
        fineness: written,
        method: Method::Exact(Exact::within(tolerance)),
    }
}

/// A march of a family by a step in mm, `written` in voxels.
fn march(family: Family, written: &str, step_mm: f64) -> Rung {
    let (rule, name) = match family {
        Family::Left => (SampleRule::Left, "left"),
        Family::Trapezoid => (SampleRule::Trapezoid, "trapezoid"),
        Family::Midpoint | Family::Jitter | Family::Exact => (SampleRule::Midpoint, "midpoint"),
    };
    let jitter = (family == Family::Jitter).then_some(Jitter { seed: 0, kind: JitterKind::White });
    let jitter_written = if jitter.is_some() { ", jitter: {}" } else { "" };
    Rung {
        family,
        setting: format!("{{ march: {{ step_voxels: {written}, rule: {name}{jitter_written} }} }}"),
        fineness: written.to_owned(),
        method: Method::March(March { jitter, ..March::plain(rule, step_mm) }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_there_once_from_coarse_to_fine() {
        let rungs = ladder(0.8);
        assert_eq!(rungs.len(), 4 * STEPS.len() + TOLERANCES.len());
        for family in Family::ALL {
            let fineness: Vec<f64> = rungs
                .iter()
                .filter(|rung| rung.family == family)
                .map(|rung| match rung.method {
                    Method::March(march) => march.step_mm,
                    Method::Exact(exact) => exact.tolerance,
                    Method::Reference => f64::NAN,
                })
                .collect();
            assert!(fineness.windows(2).all(|pair| pair[1] < pair[0]), "{}: found {fineness:?}", family.name());
        }
        assert_eq!(rungs[0].setting, "{ march: { step_voxels: 4, rule: left } }");
        assert_eq!(exact(1.0 / 255.0).setting, "{ exact: { tolerance: 1/255 } }");
        assert_eq!(exact(0.00392).setting, "{ exact: { tolerance: 3.92e-3 } }", "near 1/255 is not 1/255");
        assert_eq!(exact(1e-5).setting, "{ exact: { tolerance: 1e-5 } }");
    }
}
