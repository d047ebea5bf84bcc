//! What a run prints: messages, progress and the summary.

pub(super) mod console;
pub(super) mod escape;
mod notices;
mod progress;
pub(super) mod summary;
