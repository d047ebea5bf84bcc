//! What is said on stderr: errors, warnings, notes, the summary, and progress on a terminal.

use std::collections::HashSet;
use std::fmt::Display;
use std::io::Write;
use std::sync::{Mutex, PoisonError};

use indicatif::{MultiProgress, ProgressDrawTarget};

use super::args::ConsoleArgs;
use super::escape;
use super::notices;
use super::progress::Bar;
use crate::error::Error;
use crate::run::{Context, Monitor, Notice, Progress, Severity, Size, Stage};

/// How much is said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Quiet,
    Normal,
    Verbose,
}

/// The voice of a run. Notes and warnings are said once each.
#[derive(Debug)]
pub(super) struct Console {
    level: Level,
    bars: MultiProgress,
    said: Mutex<HashSet<String>>,
}

impl Console {
    pub(super) fn new(args: &ConsoleArgs) -> Self {
        let level = match (args.quiet, args.verbose) {
            (true, _) => Level::Quiet,
            (_, true) => Level::Verbose,
            _ => Level::Normal,
        };
        let target = match level {
            Level::Quiet => ProgressDrawTarget::hidden(),
            // Hides itself where stderr is no terminal.
            _ => ProgressDrawTarget::stderr(),
        };
        Console { level, bars: MultiProgress::with_draw_target(target), said: Mutex::default() }
    }

    /// The error, and its cure on a line of its own.
    pub(super) fn error(&self, error: &Error) {
        self.print(&format!("error: {error}"));
        if let Some(cure) = error.cure_text() {
            self.print(&format!("hint: {cure}"));
        }
    }

    /// Something that is probably not as it should be.
    pub(super) fn warning(&self, text: impl Display) {
        self.once(format!("warning: {text}"));
    }

    /// A choice that was made, or something worth knowing.
    pub(super) fn note(&self, text: impl Display) {
        if self.level > Level::Quiet {
            self.once(format!("note: {text}"));
        }
    }

    /// What only some want to know.
    pub(super) fn detail(&self, text: impl Display) {
        if self.level == Level::Verbose {
            self.print(&text.to_string());
        }
    }

    /// A line of the summary.
    pub(super) fn line(&self, text: impl Display) {
        if self.level > Level::Quiet {
            self.print(&text.to_string());
        }
    }

    /// What a run needs: notices and progress are shown here.
    pub(super) fn context(&self) -> Context<'_> {
        Context { monitor: self, ..Context::default() }
    }

    fn once(&self, text: String) {
        let is_new = self.said.lock().unwrap_or_else(PoisonError::into_inner).insert(text.clone());
        if is_new {
            self.print(&text);
        }
    }

    /// Prints one line. A closed stderr is no reason to stop.
    fn print(&self, text: &str) {
        self.bars.suspend(|| {
            let _ = writeln!(std::io::stderr(), "{}", escape::line(text));
        });
    }
}

impl Monitor for Console {
    fn start(&self, stage: Stage, size: Size) -> Box<dyn Progress> {
        Box::new(Bar::new(&self.bars, stage, size))
    }

    fn notice(&self, notice: &Notice) {
        let mut lines = notices::lines(notice).into_iter();
        let first = lines.next().unwrap_or_default();
        match notice.severity() {
            Severity::Detail => self.detail(first),
            Severity::Note => self.note(first),
            Severity::Warning => self.warning(first),
        }
        lines.for_each(|line| self.line(line));
    }
}
