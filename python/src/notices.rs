//! What was assumed and what looks wrong, as texts and as warnings.

use breakline::run::{Event, Notice, Severity};
use pyo3::prelude::*;

use crate::names::name;

/// Returns the text of a notice, with the name of its severity.
fn pair(notice: &Notice) -> (&'static str, String) {
    let severity = match notice.severity() {
        Severity::Detail => "detail",
        Severity::Note => "note",
        Severity::Warning => "warning",
    };
    (severity, notice.text().render(&name))
}

/// Returns the texts of notices, each with the name of its severity.
pub(crate) fn pairs(notices: &[Notice]) -> Vec<(&'static str, String)> {
    notices.iter().map(pair).collect()
}

/// Returns true for what is a warning in Python: also that an argument has no effect, which nobody
/// would see otherwise.
fn is_warning(notice: &Notice) -> bool {
    notice.severity() == Severity::Warning || matches!(notice, Notice::MemoryUnused(_))
}

/// Returns true if an event changes what the caller goes on with.
fn is_surprise(event: &Event) -> bool {
    matches!(event, Event::PlannedAgain(_))
}

/// What a call warns of, in the order in which it was found.
#[derive(Default)]
pub(crate) struct Warnings(Vec<String>);

impl Warnings {
    pub(crate) fn notice(&mut self, notice: &Notice) {
        if is_warning(notice) {
            self.0.push(notice.text().render(&name));
        }
    }

    pub(crate) fn event(&mut self, event: &Event) {
        if is_surprise(event) {
            self.0.extend(event.note());
        }
    }

    /// Issues a Python warning for each.
    ///
    /// # Errors
    /// The exception that a warning is turned into, if the user has asked for that.
    pub(crate) fn issue(&self, py: Python<'_>) -> PyResult<()> {
        if self.0.is_empty() {
            return Ok(());
        }
        py.import("breakline._errors")?
            .getattr("warn")?
            .call1((&self.0,))
            .map(drop)
    }
}
