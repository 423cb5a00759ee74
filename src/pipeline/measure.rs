//! What a run costs: seconds per stage and peak memory.

use std::time::Instant;

use serde::Serialize;

use super::{Event, Progress};

/// Seconds that a stage took.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageTime {
    /// The stage.
    pub stage: &'static str,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// Times stages one after another and says which begins.
pub(super) struct Stopwatch<'a> {
    progress: Progress<'a>,
    stages: Vec<StageTime>,
}

impl<'a> Stopwatch<'a> {
    /// A stopwatch that has measured nothing yet.
    pub(super) fn start(progress: Progress<'a>) -> Self {
        Stopwatch { progress, stages: Vec::new() }
    }

    /// Called with what happens.
    pub(super) fn progress(&self) -> Progress<'a> {
        self.progress
    }

    /// Does a stage and notes how long it took.
    pub(super) fn time<T>(&mut self, stage: &'static str, work: impl FnOnce() -> T) -> T {
        (self.progress)(Event::Stage(stage));
        let begun = Instant::now();
        let result = work();
        let seconds = begun.elapsed().as_secs_f64();
        tracing::debug!(stage, seconds, "stage done");
        self.stages.push(StageTime { stage, seconds });
        result
    }

    /// The stages in their order.
    pub(super) fn finish(self) -> Vec<StageTime> {
        self.stages
    }
}

/// Most bytes of memory that the process has held so far, `None` where the system does not say (it does on Linux).
pub fn peak_memory_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kibibytes = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    kibibytes.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_announced_and_noted_in_order() {
        let heard = std::sync::Mutex::new(Vec::new());
        let listen = |event| heard.lock().expect("not poisoned").push(event);
        let mut stopwatch = Stopwatch::start(&listen);
        assert_eq!(stopwatch.time("load", || 7), 7, "the result of the work comes through");
        stopwatch.time("plan", || ());
        let stages: Vec<&str> = stopwatch.finish().iter().map(|s| s.stage).collect();
        assert_eq!(stages, ["load", "plan"]);
        assert_eq!(*heard.lock().expect("not poisoned"), [Event::Stage("load"), Event::Stage("plan")]);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn the_peak_is_at_least_what_is_held_now() {
        let held = std::hint::black_box(vec![1_u8; 64 << 20]);
        let peak = peak_memory_bytes().expect("Linux says");
        assert!(peak >= held.len() as u64, "holding {} bytes, found a peak of {peak}", held.len());
    }
}
