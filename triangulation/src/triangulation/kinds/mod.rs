//! The kinds of triangulations: each owns an engine and adds its law.

pub(super) mod basic;
pub(super) mod constrained;
pub(super) mod constrained_delaunay;
pub(super) mod delaunay;
pub(super) mod regular;
