//! What was assumed and what looks wrong, as texts and as warnings.

use breakline::run::{Notice, Severity};
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

/// Issues a Python warning for each notice that is one.
///
/// # Errors
/// The exception that a warning is turned into, if the user has asked for that.
pub(crate) fn warn(py: Python<'_>, notices: &[Notice]) -> PyResult<()> {
    let mut warnings = notices
        .iter()
        .filter(|notice| is_warning(notice))
        .peekable();
    if warnings.peek().is_none() {
        return Ok(());
    }
    let texts: Vec<String> = warnings.map(|notice| notice.text().render(&name)).collect();
    py.import("breakline._errors")?
        .getattr("warn")?
        .call1((texts,))
        .map(drop)
}
