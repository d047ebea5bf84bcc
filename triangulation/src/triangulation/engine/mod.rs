//! The engine that all kinds share: insertion, removal, flips, the sides of facets and spheres,
//! checks.

pub(super) mod check;
pub(super) mod embedded;
pub(super) mod flip;
pub(super) mod insert;
pub(super) mod payloads;
pub(super) mod remove;
pub(super) mod remove_low_degree;
pub(super) mod sides;
