//! Checks on the steps that clean labels.

use std::collections::BTreeMap;

use super::Check;
use crate::error::Result;
use crate::spec::CleanSpec;

/// Longest reach of a step, mm; what is larger than a body is a mistake.
const MOST_MM: f64 = 1000.0;

/// Checks numbers; whether there are layers of these names is known once presets are read.
pub(super) fn check_clean(check: Check<'_>, clean: &BTreeMap<String, Vec<CleanSpec>>) -> Result<()> {
    for (name, steps) in clean {
        check.require(&format!("clean.{name}"), !steps.is_empty(), "at least one step")?;
        for (i, step) in steps.iter().enumerate() {
            let (key, holds, expected) = match *step {
                CleanSpec::LargestPart | CleanSpec::FillHoles | CleanSpec::Body => continue,
                CleanSpec::SmallestPartMl(ml) => ("smallest_part_ml", ml > 0.0, "a volume above 0, ml"),
                CleanSpec::ClosingMm(mm) => ("closing_mm", mm > 0.0 && mm <= MOST_MM, "above 0 and at most 1000 mm"),
                CleanSpec::MajorityMm(mm) => ("majority_mm", mm > 0.0 && mm <= MOST_MM, "above 0 and at most 1000 mm"),
            };
            check.require(&format!("clean.{name}.{i}.{key}"), holds, expected)?;
        }
    }
    Ok(())
}
