//! What a run prints: messages, progress and the summary.

pub(super) mod console;
pub(super) mod escape;
mod progress;
pub(super) mod summary;
