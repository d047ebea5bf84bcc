//! Triangulations: geometry times combinatorics.
//!
//! A [`Geometry`] says what a point is and answers questions about a few of them, with the arithmetic of a
//! [kernel](crate::kernel). A [`Tds`] knows which cells are neighbors, and no coordinates. One engine,
//! [`Triangulation`], joins them: it locates points, grows the zone that a new point is in conflict with, and replaces
//! it by the point's star. It knows neither the dimension nor the law. The kinds are thin: they own an engine and lend
//! it for reading only.
//!
//! | kind | law | |
//! |---|---|---|
//! | [`Triangulation`] | none: a point splits what it lies on | plane, space |
//! | [`Delaunay`] | no vertex inside of a cell's circumscribed sphere | plane, space |
//! | [`Regular`] | the same with weights; points of too little weight are hidden | plane |
//! | [`Constrained`] | some edges are forced, and do not cross | plane |
//! | [`ConstrainedDelaunay`] | Delaunay among vertices that see each other past lines, which may cross | plane |
//!
//! [`Compact`] is read where it lies, in a file mapped to memory, say: what the kinds write with `write_compact`.
//! Questions are the same there, and are written once, over [`Embedded`].
//!
//! ```
//! use breakline::geometry::Plane;
//! use breakline::triangulation::{Delaunay, Level, Location};
//!
//! let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
//! let (mut t, v) = Delaunay::<Plane, 3>::from_points(Plane::default(), &corners)?;
//! let middle = t.insert([2.0, 2.0])?;
//! assert_eq!(t.tds().vertices_around(middle).count(), 4);
//! assert!(matches!(t.locate(&[3.0, 2.0], None), Location::Cell { touching: 0, .. }));
//! assert_eq!(t.nearest(&[3.5, 0.0], None), Some(v[1]));
//! t.remove(middle);
//! assert!(t.check(Level::Law).is_empty());
//! # Ok::<(), breakline::triangulation::Refused>(())
//! ```
//!
//! **Dimensions.** Without points the dimension is -1, with one it is 0, 1 while all are collinear, 2 in the plane or
//! while all are coplanar, and 3 in space. Each is a state of the same structure: it is traversed, asked and checked,
//! grows by insertion and, in the plane, shrinks by removal.
//!
//! **Infinity.** Beyond each facet of the convex hull there is a cell that ends in one vertex,
//! [`VertexId::INFINITE`]. So every cell has all its neighbors. What is called *finite* leaves these out.
//!
//! **One answer.** Where points lie on a common empty sphere, a symbolic perturbation chooses among the triangulations,
//! so that each is a function of the set of points (and constraints): the order of insertion does not show in the
//! cells. The core cannot fail on points that it admitted; [`Refused`] says which are not.
//!
//! | to | use |
//! |---|---|
//! | triangulate many points at once | [`Delaunay::from_points`], [`Regular::from_points`], [`ConstrainedDelaunay::from_points`] |
//! | add points one by one | `insert`; points near each other should come near each other, see [`spatial_order`] |
//! | take points out again, or move them | `remove`, `move_to`; in the plane |
//! | keep something at each vertex, at each cell | [`Delaunay::insert_with`], [`Delaunay::with_cell_data`] |
//! | triangulate points and lines | [`ConstrainedDelaunay::from_lines`] |
//! | add, remove, divide, join lines | [`ConstrainedDelaunay::insert_lines`], `remove_line`, `split_line`, `join_lines` |
//! | know what lines enclose | [`ConstrainedDelaunay::nesting`] |
//! | have no small angles, no large triangles | [`ConstrainedDelaunay::refined`], see [`refine`] |
//! | find where a place lies | [`Triangulation::locate`]; from elsewhere, by a [strategy](Locate) |
//! | know what is nearest | [`Delaunay::nearest`], [`Delaunay::nearest_first`], [`Delaunay::within`] |
//! | know what a rectangle holds, what a segment meets | [`Triangulation::within_rectangle`], [`Triangulation::along`] |
//! | know what a new point would destroy | [`Delaunay::conflict_zone`], [`ConstrainedDelaunay::conflict_zone`] |
//! | draw Voronoi diagrams | [`Triangulation::circumcenter`], [`Delaunay::voronoi_edge`], [`Delaunay::voronoi_cell`] |
//! | weigh points | [`Regular::hidden`], [`Regular::hidden_under`], [`Regular::nearest`] |
//! | draw power diagrams | [`Regular::power_center`], [`Regular::power_edge`], [`Regular::power_cell`] |
//! | interpolate | [`Delaunay::sibson`], [`Delaunay::laplace`] |
//! | see it | [`Triangulation::svg`] |
//! | save it | serde, with the feature `serde`: all kinds, in the plane |
//! | keep it in a file, and ask without loading it | [`Delaunay::write_compact`], [`Compact`] |
//! | walk over cells, edges, vertices | [`Triangulation::finite_cells`], [`Triangulation::tds`]; outwards: [`Triangulation::faces_from`] |
//! | prove it right | [`Delaunay::check`], [`ConstrainedDelaunay::check`], to a [`Level`] |
//!
//! All questions take `&self`. In space points cannot be removed, and there are the basic and the Delaunay kind.
//!
//! A walk starts where the last insertion was, if nothing else is said. [`Near`] a cell, [`JumpAndWalk`], [`Buckets`]
//! and [`Hierarchy`] say from where, [`StraightLine`] which way: a place has one answer with all of them.
//!
//! Who knows another package finds its calls beside ours in the [guides](crate::guide).
//!
//! Below: what a new point, the dot, is in conflict with; the edges that its star will stand on are red.
//!
#![doc = "<div style=\"max-width: 24em\">"]
#![doc = include_str!("../../docs/pictures/conflict-zone.svg")]
#![doc = "</div>"]

mod basic;
mod bulk;
mod check;
mod compact;
mod constrained;
mod corridor;
mod crossed;
mod delaunay;
mod edit;
mod embedded;
mod flip;
mod insert;
mod lines;
mod locate;
mod low_degree;
mod nesting;
mod network;
mod query;
pub mod refine;
mod regular;
mod remove;
#[cfg(feature = "serde")]
mod saved;
mod segment;
mod sides;
mod simplify;
mod walled;

pub(crate) use bulk::Sites;
pub use bulk::spatial_order;
pub use check::{Flaw, Level};
pub use compact::{Compact, Damaged, Law};
pub use constrained::{ConstrainedDelaunay, Walls};
pub use delaunay::Delaunay;
pub use edit::Kept;
pub use embedded::{Embedded, PointOf};
pub(crate) use lines::LineVertices;
pub use lines::{LineId, LineTag};
pub use locate::{Buckets, Hierarchy, JumpAndWalk, Locate, Location, Near, StraightLine};
pub use network::{OnCrossing, Rounding};
pub use query::{ConflictZone, Mark, Passage, VoronoiCell, VoronoiEdge};
pub use regular::Regular;
pub use walled::{Blocked, Constrained};

use std::fmt;

use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, Tds, VertexId, Zone};

/// A point that a triangulation cannot take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refused {
    /// The point at this position has a coordinate that is not finite, or whose magnitude is outside
    /// of what the arithmetic is proven for (see [`Kernel::RANGE`](crate::kernel::Kernel::RANGE)).
    Coordinate(usize),
    /// There are more points than 32-bit numbers can count with their cells: the limit is 2^31 - 2.
    TooMany,
    /// A line names a point that does not exist.
    Index {
        /// The line, by its position.
        line: usize,
        /// The number it names.
        index: u32,
    },
    /// Two segments cross, and [`OnCrossing::Reject`] was asked for.
    Crossing {
        /// Each line by its position, and the segment in it.
        segments: [(usize, usize); 2],
        /// Where, rounded.
        place: [f64; 2],
    },
    /// The ends of a ring are apart.
    Open {
        /// The ring, by its position.
        ring: usize,
        /// Its first and its last point.
        gap: [[f64; 2]; 2],
    },
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Refused::Coordinate(index) => {
                write!(f, "point {index} has a coordinate that is not finite or too large or small to compute with")
            }
            Refused::TooMany => write!(f, "more than {MAX_VERTICES} points"),
            Refused::Index { line, index } => write!(f, "line {line} names point {index}, which does not exist"),
            Refused::Crossing { segments: [(line, segment), (other, crossed)], place: [x, y] } => {
                write!(f, "segment {segment} of line {line} and segment {crossed} of line {other} cross at {x} {y}")
            }
            Refused::Open { ring, gap: [[x0, y0], [x1, y1]] } => {
                write!(f, "ring {ring} is not closed: it begins at {x0} {y0} and ends at {x1} {y1}")
            }
        }
    }
}

impl std::error::Error for Refused {}

/// Two cells to a vertex must be numbered.
const MAX_VERTICES: usize = VertexId::LIMIT / 2;

/// Points and cells without a law of their own: the basic kind; and, for reading, what all kinds share.
///
#[derive(Debug, Clone)]
pub struct Triangulation<G: Geometry<N>, const N: usize, V = (), C = ()> {
    geometry: G,
    tds: Tds<N, V, C>,
    points: Vec<G::Point>,
    /// Scratch of the insertion.
    zone: Zone,
    /// Where the last insertion ended, where the next begins to look.
    last: Option<CellId>,
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// The geometry.
    pub fn geometry(&self) -> &G {
        &self.geometry
    }

    /// The combinatorics.
    pub fn tds(&self) -> &Tds<N, V, C> {
        &self.tds
    }

    /// -1 without a point, 0 with one, 1 if all are collinear, and so on.
    pub fn dimension(&self) -> i32 {
        self.tds.dimension()
    }

    /// Finite vertices.
    pub fn vertex_count(&self) -> usize {
        self.tds.vertex_count()
    }

    /// The point of a finite vertex. Of one that was removed it is still there, see [`points`](Self::points).
    ///
    /// # Panics
    /// If there never was such a vertex, like an index; of the infinite one, too.
    #[inline(always)]
    pub fn point(&self, vertex: VertexId) -> &G::Point {
        &self.points[vertex.index()]
    }

    /// All points, in the order of their vertices' numbers. Where a [vertex](Tds::is_vertex) has been removed,
    /// its point is still there.
    pub fn points(&self) -> &[G::Point] {
        &self.points
    }

    /// The cells without the infinite vertex, in order of their numbers. Below full dimension these
    /// have fewer vertices: segments, or triangles in space.
    pub fn finite_cells(&self) -> impl Iterator<Item = CellId> + '_ {
        self.tds.cells().filter(|&cell| !self.tds.is_infinite(cell))
    }

    /// The points of a full cell without the infinite vertex.
    #[inline(always)]
    fn simplex(&self, cell: CellId) -> [&G::Point; N] {
        self.tds.corners(cell).map(|v| &self.points[v.index()])
    }

    /// Whether the complex spans the space.
    #[inline(always)]
    fn is_full(&self) -> bool {
        self.tds.dimension() as usize == N - 1
    }

    #[inline(always)]
    fn side_of_facet(&self, cell: CellId, replaced: usize, q: &G::Point) -> Sign {
        let Ok(sign) = sides::side_of_facet(self, cell, replaced, q);
        sign
    }

    #[inline(always)]
    fn in_conflict(&self, cell: CellId, q: &G::Point) -> bool {
        let Ok(is_in_conflict) = sides::in_conflict(self, cell, q);
        is_in_conflict
    }
}
