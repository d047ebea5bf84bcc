//! The engine that all kinds share: insertion, removal, flips, checks, and edges for constraints.

pub(crate) mod check;
pub(crate) mod constrained_edges;
mod corridor;
pub(crate) mod flip;
pub(crate) mod insert;
pub(crate) mod kind_methods;
pub(crate) mod payloads;
pub(crate) mod removal;
pub(crate) mod trace;

pub use constrained_edges::ConstrainedEdges;
pub use insert::Inserted;
