//! How much memory a run may take, and whether its plan fits.

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use super::Options;
use crate::error::{Error, Fault, Result};
use crate::plan::Plan;

/// Share of the free memory that a run takes unless told: the rest is for others, and for what an estimate leaves out.
const SHARE_OF_FREE: f64 = 0.8;

/// Most bytes that a run may hold: as the options say, or a share of what is free now, also where a control group
/// (a container) leaves less than the machine has. `None` where the system does not say.
pub fn limit_bytes(options: &Options) -> Option<u64> {
    options.max_memory_bytes.or_else(|| free_bytes().map(|free| (SHARE_OF_FREE * free as f64) as u64))
}

fn free_bytes() -> Option<u64> {
    let memory = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(memory);
    let available = Some(system.available_memory()).filter(|&bytes| bytes > 0)?;
    Some(system.cgroup_limits().map_or(available, |group| available.min(group.free_memory)))
}

/// Refuses a volume made by rule that would take more than `max_bytes`; `element` is the key of its size.
///
/// # Errors
/// `Fault::Limit`.
pub(super) fn refuse_beyond(max_bytes: Option<u64>, needed: u64, element: &str) -> Result<()> {
    let Some(most) = max_bytes.filter(|&most| needed > most) else { return Ok(()) };
    Err(Error::new(Fault::Limit, "the volume does not fit into memory")
        .element(element)
        .found(format!("{needed} bytes"))
        .expected(format!("at most {most} bytes"))
        .remedy("ask for a smaller size, or raise --max-memory"))
}

/// Refuses a plan that needs more memory than it may have, before any of it is allocated.
///
/// # Errors
/// `Fault::Limit`, naming the stage that takes most.
pub(super) fn check(plan: &Plan, options: &Options) -> Result<()> {
    let (needed, Some(most)) = (plan.memory_bytes(), limit_bytes(options)) else { return Ok(()) };
    // What is loaded is no longer free.
    let held = if options.max_memory_bytes.is_some() { 0 } else { plan.volume_bytes() };
    if needed <= most + held {
        return Ok(());
    }
    let largest = plan.stages.iter().max_by_key(|stage| stage.bytes);
    Err(Error::new(Fault::Limit, "the plan does not fit into memory")
        .element(
            largest.map_or_else(String::new, |stage| format!("{}: {}, {} bytes", stage.name, stage.what, stage.bytes)),
        )
        .found(format!("{needed} bytes at peak"))
        .expected(format!("at most {} bytes", most + held))
        .remedy("ask for a smaller picture or volume, leave out the effect that takes most, or raise --max-memory"))
}
