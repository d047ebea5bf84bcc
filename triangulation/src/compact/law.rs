//! The law of a compact triangulation, as its header names it.

/// The law that a file claims for its triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// No law: written by a [`Basic`](crate::Basic) or [`Regular`](crate::Regular) triangulation.
    None = 0,
    /// The law of [`Delaunay`](crate::Delaunay).
    Delaunay = 1,
    /// Some edges are constrained: written by [`Constrained`](crate::Constrained).
    Constrained = 2,
    /// The law of [`ConstrainedDelaunay`](crate::ConstrainedDelaunay).
    ConstrainedDelaunay = 3,
}

impl Law {
    pub(super) fn from_number(number: u32) -> Option<Self> {
        [
            Law::None,
            Law::Delaunay,
            Law::Constrained,
            Law::ConstrainedDelaunay,
        ]
        .into_iter()
        .find(|&l| l as u32 == number)
    }

    pub(super) fn has_constraints(self) -> bool {
        matches!(self, Law::Constrained | Law::ConstrainedDelaunay)
    }
}
