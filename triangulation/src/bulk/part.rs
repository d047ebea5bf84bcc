//! What is known of a range of points that has been triangulated.

/// Stands for no face.
pub(super) const NONE: u32 = u32::MAX;

/// A finished range: two ghosts at opposite ends of it, where searches start (for an arc both are
/// the same ghost); [`NONE`] for a single point.
#[derive(Clone, Copy)]
pub(super) struct BuiltRange {
    pub(super) bottom: u32,
    pub(super) top: u32,
    pub(super) first: u32,
}

/// The coordinate that separates the halves of a merge.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Axis {
    X,
    Y,
}
