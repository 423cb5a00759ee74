//! A progress bar on stderr, where that is a terminal.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pellucid::pipeline::Event;

/// Steps of a bar that shows a share.
const SHARES: u64 = 1000;

/// Shows how far a run is.
pub(super) struct Bar {
    bar: ProgressBar,
}

impl Bar {
    /// A bar; hidden if `quiet` or where nobody watches.
    pub(super) fn new(quiet: bool) -> Self {
        let watched = !quiet && std::io::stderr().is_terminal();
        let target = if watched { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(None, target);
        bar.set_style(
            ProgressStyle::with_template("{spinner} {msg}").unwrap_or_else(|_| ProgressStyle::default_spinner()),
        );
        Bar { bar }
    }

    /// Takes note of an event, from any thread.
    pub(super) fn hear(&self, event: Event) {
        match event {
            Event::Stage(stage) => {
                self.bar.set_message(stage);
                self.bar.tick();
            }
            Event::Rays(pixels) => {
                self.bar.set_position(0);
                self.bar.set_length(pixels as u64);
                let template = "{spinner} {msg} {bar:40} {percent}% {elapsed} left {eta}";
                if let Ok(style) = ProgressStyle::with_template(template) {
                    self.bar.set_style(style);
                }
            }
            Event::Pixels(count) => self.bar.inc(count as u64),
        }
    }

    /// Shows what is done now, and the share of the time that is over, 0 to 1.
    pub(super) fn spend(&self, what: &str, share: f64) {
        if self.bar.length() != Some(SHARES) {
            self.bar.set_length(SHARES);
            if let Ok(style) = ProgressStyle::with_template("{spinner} {bar:40} {percent}% {elapsed} {msg}") {
                self.bar.set_style(style);
            }
        }
        self.bar.set_message(what.to_owned());
        self.bar.set_position((share * SHARES as f64) as u64);
        self.bar.tick();
    }

    /// Takes the bar off the screen.
    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
