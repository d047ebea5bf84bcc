//! What was typed, and what it means.
//!
//! The options as typed (`args`) are kept apart from their meaning (`plan`, `inputs`, `outputs`).

pub(super) mod args;
mod condition;
pub(super) mod habits;
pub(super) mod inputs;
pub(super) mod outputs;
pub(super) mod plan;
pub(super) mod run_file;
