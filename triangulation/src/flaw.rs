//! What a check finds wrong, and how far it goes.

use std::fmt;

use crate::tds::{self, CellId, VertexId};

/// How far a check goes. Each level assumes the ones before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// The links between cells, neighbors and vertices agree.
    Links = 1,
    /// The cells form one sphere.
    Manifold = 2,
    /// Every finite cell is positively oriented and the hull is convex. Together these prove that
    /// the cells tile the convex hull without overlap (Devillers, Liotta, Preparata, Tamassia
    /// 1998).
    Orientation = 3,
    /// The kind's own law, ties included.
    Law = 4,
}

/// A flaw found by a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Flaw {
    /// Level 1 or 2: a flaw of the structure.
    Structure(tds::TdsError),
    /// Level 3: a vertex outside of the line or plane of the first cell, although the dimension is
    /// that of a line or plane.
    NotInFlat(VertexId),
    /// Level 3: a cell that is flat or turned around.
    Orientation(CellId),
    /// Level 3: beyond facet `i` of this infinite cell the hull turns inwards.
    NotConvex(CellId, usize),
    /// Level 4: the vertex beyond facet `i` lies in the cell's circumscribed sphere.
    NotDelaunay(CellId, usize),
    /// Level 4: a hidden point is not in the cell that should hide it, or should be visible.
    Hidden(VertexId),
    /// Level 4: an edge is constrained on one side only.
    OneSided(CellId, usize),
    /// Level 4: the tables of lines disagree with the triangulation.
    Lines(LinesFlaw),
    /// Level 4: the sub-constraint between these vertices is missing, because another one blocks
    /// it.
    Missing(VertexId, VertexId),
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Flaw::Structure(error) => error.fmt(f),
            Flaw::NotInFlat(vertex) => write!(
                f,
                "vertex {} is outside of the flat of all others",
                vertex.index()
            ),
            Flaw::Orientation(cell) => write!(f, "cell {cell:?} is flat or turned around"),
            Flaw::NotConvex(cell, i) => write!(
                f,
                "beyond facet {i} of infinite cell {cell:?} the hull turns inwards"
            ),
            Flaw::NotDelaunay(cell, i) => {
                write!(
                    f,
                    "the vertex beyond facet {i} of cell {cell:?} lies in the cell's circumscribed sphere"
                )
            }
            Flaw::Hidden(vertex) => write!(
                f,
                "point {vertex:?} is hidden by a cell that does not hide it"
            ),
            Flaw::OneSided(cell, i) => write!(
                f,
                "edge {i} of cell {cell:?} is constrained on one side only"
            ),
            Flaw::Lines(flaw) => flaw.fmt(f),
            Flaw::Missing(a, b) => write!(
                f,
                "the constraint between vertices {a:?} and {b:?} was left out"
            ),
        }
    }
}

/// A flaw in the lines of a triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LinesFlaw {
    /// The chain of the segment between these vertices does not run in order on both axes, or meets
    /// a vertex twice.
    Order(VertexId, VertexId),
    /// The chain of the segment between these vertices contains an edge that is not constrained.
    Unconstrained(VertexId, VertexId),
    /// The tables name sites, or split edges, that are on no segment's chain.
    Stray,
    /// The constraint between these vertices waits for triangles, although there are some.
    Waiting(VertexId, VertexId),
    /// The grid of the rounding does not fit the lines.
    Rounding,
    /// The index of segments by edges does not agree with their chains.
    Index,
    /// A vertex that was added where lines cross is on no constraint, or was given.
    Added(VertexId),
    /// A vertex owned by lines is named by none.
    Owned(VertexId),
}

impl fmt::Display for LinesFlaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LinesFlaw::Order(a, b) => {
                write!(
                    f,
                    "the chain of the segment between vertices {} and {} is not in order",
                    a.index(),
                    b.index()
                )
            }
            LinesFlaw::Unconstrained(a, b) => {
                write!(
                    f,
                    "the chain of the segment between vertices {} and {} is not constrained",
                    a.index(),
                    b.index()
                )
            }
            LinesFlaw::Stray => f.write_str("the chain of a segment belongs to no line"),
            LinesFlaw::Waiting(a, b) => {
                write!(
                    f,
                    "the constraint between vertices {} and {} waits for triangles",
                    a.index(),
                    b.index()
                )
            }
            LinesFlaw::Rounding => f.write_str("the unit of the grid does not fit the lines"),
            LinesFlaw::Index => {
                f.write_str("the index of segments does not agree with their chains")
            }
            LinesFlaw::Added(v) => write!(f, "vertex {} was added where no lines cross", v.index()),
            LinesFlaw::Owned(v) => write!(f, "vertex {} came with no line", v.index()),
        }
    }
}
