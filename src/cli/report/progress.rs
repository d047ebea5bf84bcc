//! Progress bars on a terminal.

use std::fmt::Write;
use std::time::Duration;

use indicatif::style::ProgressTracker;
use indicatif::{HumanCount, MultiProgress, ProgressBar, ProgressState, ProgressStyle};

use crate::run::{Progress, Size, Stage};

/// A progress bar; it disappears from the terminal when it is dropped.
#[derive(Debug)]
pub(super) struct Bar(ProgressBar);

impl Bar {
    pub(super) fn new(bars: &MultiProgress, stage: Stage, size: Size) -> Self {
        let (bar, template) = match size {
            Size::Items(count) => (
                ProgressBar::new(count),
                "{msg} [{bar:30}] {human_pos} of {human_len}, {rate}, {eta} left",
            ),
            Size::Unknown => (
                ProgressBar::no_length(),
                "{msg} {spinner} {human_pos}, {rate}, {elapsed}",
            ),
            Size::Uncounted => (ProgressBar::no_length(), "{msg} {spinner} {elapsed}"),
        };
        let bar = bars.add(bar);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> ").with_key("rate", Rate));
        }
        bar.set_message(stage.title());
        bar.enable_steady_tick(Duration::from_millis(200));
        Bar(bar)
    }
}

impl Progress for Bar {
    fn add(&self, items: u64) {
        self.0.inc(items);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Items per second, as a whole number.
#[derive(Clone)]
struct Rate;

impl ProgressTracker for Rate {
    fn clone_box(&self) -> Box<dyn ProgressTracker> {
        Box::new(self.clone())
    }

    fn tick(&mut self, _: &ProgressState, _: std::time::Instant) {}

    fn reset(&mut self, _: &ProgressState, _: std::time::Instant) {}

    fn write(&self, state: &ProgressState, out: &mut dyn Write) {
        // There is nobody to whom a failure could be reported.
        let _ = write!(out, "{}/s", HumanCount(state.per_sec() as u64));
    }
}
