//! Errors of points and lines that are given, and of vertices that cannot be removed or moved.

use std::error::Error;
use std::fmt;

use crate::geometry::Geometry;
use crate::line_id::LineId;
use crate::tds::VertexId;

/// Two cells to a vertex must be numbered.
pub(crate) const MAX_VERTICES: usize = VertexId::LIMIT / 2;

/// Why a point cannot be inserted. Nothing has changed then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PointError {
    /// A coordinate is NaN or infinite, as the [geometry](crate::geometry::Geometry::is_finite)
    /// says.
    NotFinite,
    /// The magnitude of a coordinate is outside of what the arithmetic is proven for (see
    /// [`Kernel::RANGE`](crate::kernel::Kernel::RANGE)). That of the kernel
    /// [`Wide`](crate::kernel::Wide) is all finite numbers.
    Coordinate,
    /// There are as many vertices as 32-bit numbers can count with their cells: 2^31 - 2.
    TooMany,
}

impl fmt::Display for PointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PointError::NotFinite => {
                f.write_str("the point has a coordinate that is NaN or infinite")
            }
            PointError::Coordinate => {
                f.write_str(
                    "the point has a coordinate that is too large or small to compute with",
                )?;
                f.write_str("; the kernel `Wide` takes all finite numbers")
            }
            PointError::TooMany => write!(f, "more than {MAX_VERTICES} points"),
        }
    }
}

impl Error for PointError {}

/// Why many points or lines cannot be triangulated. Points and lines are named by their positions
/// in the input.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum InputError {
    /// The point at this position has a coordinate that is NaN or infinite; see
    /// [`PointError::NotFinite`].
    NotFinite(usize),
    /// The magnitude of a coordinate of the point at this position is out of range; see
    /// [`PointError::Coordinate`].
    Coordinate(usize),
    /// The point at this position lies before the one before it in
    /// [`spatial_order`](crate::spatial_order), or on the same site, where points have to come in
    /// order.
    Unsorted(usize),
    /// There are more points than 32-bit numbers can count with their cells: the limit is 2^31 - 2.
    TooMany,
    /// A line names a point that does not exist.
    Index {
        /// The position of the line.
        line: usize,
        /// The number that it names.
        index: u32,
    },
    /// Two segments cross, and [`OnCrossing::Reject`](crate::OnCrossing::Reject) was asked for.
    Crossing {
        /// The position of each line, and of the segment in it.
        segments: [(usize, usize); 2],
        /// The crossing, rounded.
        at: [f64; 2],
    },
    /// The caller canceled the work.
    Canceled,
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InputError::NotFinite(index) => {
                write!(f, "point {index} has a coordinate that is NaN or infinite")
            }
            InputError::Coordinate(index) => {
                write!(
                    f,
                    "point {index} has a coordinate that is too large or small to compute with"
                )?;
                f.write_str("; the kernel `Wide` takes all finite numbers")
            }
            InputError::Unsorted(index) => {
                write!(
                    f,
                    "point {index} is not in spatial order, or where the one before it is"
                )
            }
            InputError::TooMany => write!(f, "more than {MAX_VERTICES} points"),
            InputError::Index { line, index } => {
                write!(f, "line {line} names point {index}, which does not exist")
            }
            InputError::Crossing {
                segments: [(line, segment), (other, crossed)],
                at: [x, y],
            } => {
                write!(
                    f,
                    "segment {segment} of line {line} and segment {crossed} of line {other} cross at {x} {y}"
                )
            }
            InputError::Canceled => f.write_str("canceled"),
        }
    }
}

impl Error for InputError {}

impl PointError {
    /// Returns the error of a point that a geometry does not admit; `None` if it does.
    pub(crate) fn of<G: Geometry<N>, const N: usize>(geometry: &G, p: &G::Point) -> Option<Self> {
        if geometry.admits(p) {
            None
        } else if geometry.is_finite(p) {
            Some(PointError::Coordinate)
        } else {
            Some(PointError::NotFinite)
        }
    }

    /// The error of many points, of which the one at this position cannot be inserted.
    pub(crate) fn at(self, position: usize) -> InputError {
        match self {
            PointError::NotFinite => InputError::NotFinite(position),
            PointError::Coordinate => InputError::Coordinate(position),
            PointError::TooMany => InputError::TooMany,
        }
    }
}

impl InputError {
    /// Returns the error of the first point that a geometry does not admit; `None` if it admits
    /// all.
    pub(crate) fn of_points<G: Geometry<N>, const N: usize>(
        geometry: &G,
        points: &[G::Point],
    ) -> Option<Self> {
        let mut errors = points.iter().enumerate();
        errors.find_map(|(position, p)| Some(PointError::of(geometry, p)?.at(position)))
    }
}

/// Why lines do not bound an area.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct GapError {
    /// A line with an end that no other line continues.
    pub line: LineId,
    /// That end, and the nearest other end that no line continues.
    pub ends: [[f64; 2]; 2],
}

impl fmt::Display for GapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let GapError {
            line,
            ends: [[x0, y0], [x1, y1]],
        } = self;
        write!(
            f,
            "the ring of line {} is not closed: it begins at {x0} {y0} and ends at {x1} {y1}",
            line.index()
        )
    }
}

impl Error for GapError {}

/// Why a vertex cannot be removed. Nothing has changed then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum RemovalError {
    /// There is no such vertex.
    NoVertex,
    /// A constraint ends in it or runs through it, or there would be no triangles to hold one that
    /// is elsewhere.
    Constraint,
    /// This line was given by it.
    Line(LineId),
    /// Lines cross in it.
    Crossing,
}

impl fmt::Display for RemovalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RemovalError::NoVertex => f.write_str("there is no such vertex"),
            RemovalError::Constraint => f.write_str("a constraint needs the vertex"),
            RemovalError::Line(line) => write!(f, "line {} was given by the vertex", line.index()),
            RemovalError::Crossing => f.write_str("lines cross in the vertex"),
        }
    }
}

impl Error for RemovalError {}

/// Why a vertex cannot be moved. Nothing has changed then.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MoveError {
    /// The new point cannot be inserted.
    Point(PointError),
    /// The vertex cannot be removed.
    Vertex(RemovalError),
}

impl fmt::Display for MoveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            MoveError::Point(_) => "the vertex cannot be moved to this point",
            MoveError::Vertex(_) => "the vertex cannot be moved from where it is",
        })
    }
}

impl Error for MoveError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            MoveError::Point(error) => Some(error),
            MoveError::Vertex(error) => Some(error),
        }
    }
}

impl From<PointError> for MoveError {
    fn from(error: PointError) -> Self {
        MoveError::Point(error)
    }
}

impl From<RemovalError> for MoveError {
    fn from(error: RemovalError) -> Self {
        MoveError::Vertex(error)
    }
}
