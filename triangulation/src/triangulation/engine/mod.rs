//! The engine that all kinds share: insertion, removal, flips, checks, and edges for constraints.

pub(super) mod check;
pub(super) mod constrained_edges;
mod corridor;
pub(super) mod flip;
pub(super) mod insert;
pub(super) mod payloads;
pub(super) mod removal;
pub(super) mod remove;
pub(super) mod remove_low_degree;
pub(super) mod remove_space;
pub(super) mod trace;
