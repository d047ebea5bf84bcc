use std::error::Error;
use std::fmt;

use super::{CellId, VertexId};

/// A fault of a complex of cells.
///
/// A facet is given by a cell that has it and the index of the vertex opposite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum TdsError {
    /// There are more vertices or cells than 32-bit numbers can count: the limit is
    /// [`Id::LIMIT`](super::Id::LIMIT).
    TooMany,
    /// A cell refers to a vertex that does not exist, or twice to one.
    Vertex {
        /// The cell.
        cell: CellId,
        /// The vertex.
        vertex: VertexId,
    },
    /// A cell refers to a neighbor that does not exist, or twice to one. The two then have the same
    /// vertices.
    Neighbor {
        /// The cell.
        cell: CellId,
        /// The index of the neighbor.
        facet: usize,
    },
    /// Only one cell has this facet; in a closed complex, two do.
    OneCell {
        /// The cell.
        cell: CellId,
        /// The index of the facet in it.
        facet: usize,
    },
    /// Three or more cells have this facet; in a manifold, two do.
    ThreeCells {
        /// The third of the cells.
        cell: CellId,
        /// The index of the facet in it.
        facet: usize,
    },
    /// The neighbor across a facet does not have this cell as a neighbor, or shares another facet
    /// with it.
    NotMutual {
        /// The cell.
        cell: CellId,
        /// The index of the facet in it.
        facet: usize,
    },
    /// The cells on both sides of a facet are not oriented alike.
    NotOriented {
        /// One of the cells.
        cell: CellId,
        /// The index of the facet in it.
        facet: usize,
    },
    /// The cell that a vertex refers to does not have it.
    CellOfVertex(VertexId),
    /// A vertex is in no cell.
    Isolated(VertexId),
    /// The link of a vertex is not a circle (where cells are triangles) or not a sphere (where they
    /// are tetrahedra).
    Link(VertexId),
    /// The complex is not connected; this cell is not in the first component.
    NotConnected(CellId),
    /// The numbers of vertices, edges and so on are not those of a sphere; this is the Euler
    /// characteristic.
    Euler(i64),
}

impl fmt::Display for TdsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TdsError::TooMany => write!(f, "more than 2^32 - 3 vertices or cells"),
            TdsError::Vertex { cell, vertex } => {
                write!(
                    f,
                    "cell {cell:?} names vertex {vertex:?}, which does not exist, or names it twice"
                )
            }
            TdsError::Neighbor { cell, facet } => {
                write!(
                    f,
                    "neighbor {facet} of cell {cell:?} does not exist, or has the same vertices"
                )
            }
            TdsError::OneCell { cell, facet } => {
                write!(f, "facet {facet} of cell {cell:?} is in no other cell")
            }
            TdsError::ThreeCells { cell, facet } => {
                write!(f, "facet {facet} of cell {cell:?} is in two other cells")
            }
            TdsError::NotMutual { cell, facet } => {
                write!(
                    f,
                    "neighbor {facet} of cell {cell:?} does not share that facet"
                )
            }
            TdsError::NotOriented { cell, facet } => {
                write!(
                    f,
                    "cell {cell:?} and its neighbor {facet} are not oriented alike"
                )
            }
            TdsError::CellOfVertex(vertex) => {
                write!(f, "the cell of vertex {vertex:?} does not have it")
            }
            TdsError::Isolated(vertex) => write!(f, "vertex {vertex:?} is in no cell"),
            TdsError::Link(vertex) => {
                write!(f, "the link of vertex {vertex:?} is not a circle or sphere")
            }
            TdsError::NotConnected(cell) => write!(f, "cell {cell:?} is in a component of its own"),
            TdsError::Euler(euler) => write!(
                f,
                "the Euler characteristic is {euler}, not that of a sphere"
            ),
        }
    }
}

impl Error for TdsError {}

/// The reason why a complex was not edited. It is unchanged then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum EditError {
    /// The complex is not of full dimension `N - 1`.
    NotFull,
    /// More vertices or cells than 32-bit numbers can count: the limit is
    /// [`Id::LIMIT`](super::Id::LIMIT).
    TooMany,
    /// There is no such cell.
    Cell(CellId),
    /// There is no such facet.
    Facet {
        /// The cell.
        cell: CellId,
        /// An index that none of its vertices has.
        facet: usize,
    },
    /// There is no such vertex.
    Vertex(VertexId),
    /// There is no edge between these vertices.
    Edge([VertexId; 2]),
    /// More cells have the face than a flip allows.
    Star {
        /// The number of these cells.
        cells: usize,
    },
    /// The face that a flip would create is in the complex already.
    Exists,
    /// The cells do not form a hole that a star can fill.
    Hole,
    /// The links of these vertices have more in common than the link of the edge between them.
    Links([VertexId; 2]),
}

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EditError::NotFull => write!(f, "the complex is not of full dimension"),
            EditError::TooMany => write!(f, "more than 2^32 - 3 vertices or cells"),
            EditError::Cell(cell) => write!(f, "there is no cell {cell:?}"),
            EditError::Facet { cell, facet } => write!(f, "cell {cell:?} has no facet {facet}"),
            EditError::Vertex(vertex) => write!(f, "there is no vertex {vertex:?}"),
            EditError::Edge([a, b]) => {
                write!(f, "there is no edge between vertices {a:?} and {b:?}")
            }
            EditError::Star { cells } => {
                write!(f, "{cells} cells have the face, more than a flip takes")
            }
            EditError::Exists => write!(f, "the face that the flip would create exists already"),
            EditError::Hole => write!(
                f,
                "the cells do not form a hole that the star of a vertex can fill"
            ),
            EditError::Links([a, b]) => {
                write!(
                    f,
                    "the links of vertices {a:?} and {b:?} have more in common than the link of their edge"
                )
            }
        }
    }
}

impl Error for EditError {}
