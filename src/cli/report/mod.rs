//! What a run prints: messages, progress and the summary.

pub(super) mod accuracy;
pub(super) mod class_comparison;
pub(super) mod commands;
pub(super) mod comparison;
pub(super) mod console;
pub(super) mod escape;
pub(super) mod last_words;
pub(super) mod names;
pub(super) mod profiles;
mod progress;
pub(super) mod run_plan;
mod statistics;
pub(super) mod stdout;
pub(super) mod summary;
pub(super) mod systems;
pub(super) mod volumes;
pub(super) mod written;
