//! Why a compact triangulation has no answer.

use std::fmt;

use crate::tds::{CellId, VertexId};

use super::law::Law;

/// The version of the format that is written and read.
pub(super) const VERSION: u32 = 2;

/// The reason why a [`Compact`](crate::Compact) triangulation has no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum CompactError {
    /// The first bytes are not those of a compact triangulation.
    Foreign,
    /// The version of the format is unknown.
    Version(u32),
    /// An entry of the header is impossible.
    Header(&'static str),
    /// There are fewer or more bytes than the header and the sections announce.
    Length {
        /// Bytes according to the header, or up to the end of the section that is incomplete.
        expected: u64,
        /// Bytes present.
        found: u64,
    },
    /// The triangulation is one of the plane where one of space is expected, or the other.
    Space {
        /// Vertices of a cell at full dimension: 3 in the plane, 4 in space.
        expected: usize,
        /// Those of the file.
        found: usize,
    },
    /// The number of coordinates of a point is not that of the geometry.
    Coordinates {
        /// Coordinates of a point of the geometry.
        expected: usize,
        /// Coordinates of a point of the file.
        found: usize,
    },
    /// The vertex does not exist, or its point or its cell is impossible.
    Vertex(VertexId),
    /// The cell does not exist, or one of its vertices or neighbors is impossible.
    Cell(CellId),
    /// The query is one for Delaunay triangulations, but the file has another law.
    Unanswerable(Law),
}

impl fmt::Display for CompactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CompactError::Foreign => write!(f, "not a compact triangulation: wrong magic bytes"),
            CompactError::Version(version) => {
                write!(
                    f,
                    "a compact triangulation of version {version}; the known version is {}",
                    VERSION
                )
            }
            CompactError::Header(what) => write!(f, "the header is damaged: {what}"),
            CompactError::Length { expected, found } => {
                write!(f, "{found} bytes where {expected} are announced")
            }
            CompactError::Space { expected, found } => {
                let name = |corners: usize| if corners == 4 { "space" } else { "the plane" };
                write!(
                    f,
                    "a triangulation of {}; one of {} is expected",
                    name(*found),
                    name(*expected)
                )
            }
            CompactError::Coordinates { expected, found } => {
                write!(
                    f,
                    "points of {found} coordinates; the geometry has {expected}"
                )
            }
            CompactError::Vertex(vertex) => {
                write!(f, "vertex {vertex:?} does not exist or is damaged")
            }
            CompactError::Cell(cell) => write!(f, "cell {cell:?} does not exist or is damaged"),
            CompactError::Unanswerable(law) => {
                write!(
                    f,
                    "a query for Delaunay triangulations; the law here is {law:?}"
                )
            }
        }
    }
}

impl std::error::Error for CompactError {}
