//! Output on stderr: errors, warnings, notes, the summary, and progress on a terminal.

use std::collections::HashSet;
use std::fmt::Display;
use std::io::Write;
use std::sync::{Mutex, PoisonError};

use indicatif::{MultiProgress, ProgressDrawTarget};

use super::escape;
use super::last_words::LastWords;
use super::names::name;
use super::progress::Bar;
use crate::error::Error;
use crate::run::{Context, Monitor, Notice, Progress, Severity, Size, Stage};

/// How much is printed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verbosity {
    /// Nothing but errors: who calls gets a report.
    Silent,
    Quiet,
    #[default]
    Normal,
    Verbose,
}

/// Prints the messages of a run to stderr. Equal notices, notes and warnings are printed once.
#[derive(Debug)]
pub(crate) struct Console {
    level: Verbosity,
    bars: MultiProgress,
    said: Mutex<HashSet<String>>,
}

impl Console {
    pub(crate) fn new(level: Verbosity) -> Self {
        let target = match level {
            Verbosity::Silent | Verbosity::Quiet => ProgressDrawTarget::hidden(),
            // Hidden by itself if stderr is not a terminal.
            _ => ProgressDrawTarget::stderr(),
        };
        Console {
            level,
            bars: MultiProgress::with_draw_target(target),
            said: Mutex::default(),
        }
    }

    /// Prints an error, and its hint on a line of its own.
    pub(crate) fn error(&self, error: &Error) {
        self.print(&format!("error: {}", error.render(&name)));
        if let Some(cure) = error.cure_text() {
            self.print(&format!("hint: {}", cure.render(&name)));
        }
    }

    /// Prints a warning: something is probably not as intended.
    pub(crate) fn warning(&self, text: impl Display) {
        if self.level > Verbosity::Silent {
            self.once(format!("warning: {text}"));
        }
    }

    /// Prints a note, unless the run is quiet: a choice that was made for the user, or something
    /// worth knowing.
    pub(crate) fn note(&self, text: impl Display) {
        if self.level > Verbosity::Quiet {
            self.once(format!("note: {text}"));
        }
    }

    /// Prints a line if the run is verbose.
    pub(crate) fn detail(&self, text: impl Display) {
        if self.level == Verbosity::Verbose {
            self.print(&text.to_string());
        }
    }

    /// Prints a line of the summary, unless the run is quiet.
    pub(crate) fn line(&self, text: impl Display) {
        if self.level > Verbosity::Quiet {
            self.print(&text.to_string());
        }
    }

    /// Returns what prints a note if a signal ends the program while it lives, unless the run is
    /// quiet.
    pub(crate) fn note_if_ended(&self, text: impl Display) -> Option<LastWords> {
        (self.level > Verbosity::Quiet).then(|| LastWords::new(format!("note: {text}")))
    }

    /// Returns the context of a run that shows its notices and progress here.
    pub(crate) fn context(&self) -> Context<'_> {
        Context {
            monitor: self,
            ..Context::default()
        }
    }

    /// Prints a line unless it was printed before; returns true if it was printed.
    fn once(&self, text: String) -> bool {
        let is_new = self
            .said
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(text.clone());
        if is_new {
            self.print(&text);
        }
        is_new
    }

    /// Prints one line. A closed stderr is ignored.
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
        let text = notice.text().render(&name);
        let (least, text) = match notice.severity() {
            Severity::Detail => (Verbosity::Verbose, text),
            Severity::Note => (Verbosity::Normal, format!("note: {text}")),
            Severity::Warning => (Verbosity::Quiet, format!("warning: {text}")),
        };
        if self.level >= least && self.once(text) {
            notice
                .details()
                .iter()
                .for_each(|line| self.line(format_args!("            {}", line.render(&name))));
        }
    }
}
