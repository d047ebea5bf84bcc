//! Triangulations: geometry times combinatorics.
//!
//! A [geometry](crate::geometry::Geometry) defines what a point is and answers questions about a
//! few points, with the arithmetic of a [kernel](crate::kernel). A [`Tds`](crate::tds::Tds) stores
//! which cells are neighbors, and no coordinates. One engine, [`Triangulation`], joins the two: it
//! locates points, finds the conflict zone of a new point, and replaces the zone by the point's
//! star. It depends neither on the dimension nor on the law. The kinds are thin: each owns an
//! engine, and dereferences to it for reading.
//!
//! | kind | law | |
//! |---|---|---|
//! | [`Basic`] | none: a point splits what it lies on | plane, space |
//! | [`Delaunay`] | no vertex inside of a cell's circumscribed sphere | plane, space |
//! | [`Regular`] | Delaunay with weights; points of too little weight are hidden | plane, space |
//! | [`Constrained`] | some edges are constrained, and do not cross | plane |
//! | [`ConstrainedDelaunay`] | Delaunay among vertices that see each other past constraints; lines may cross | plane |
//!
//! [`Compact`] is a read-only triangulation that works directly on bytes, for example those of a
//! memory-mapped file, as the kinds write them with `write_compact`. It has the same queries, which
//! are written once, over [`Embedded`].
//!
//! ```
//! use breakline_triangulation::geometry::Plane;
//! use breakline_triangulation::{Delaunay, Level, Location};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
//!     let (mut t, v) = Delaunay::from_points(Plane::new(), &corners)?;
//!     let middle = t.insert([2.0, 2.0])?;
//!     assert_eq!(t.tds().vertices_around(middle).count(), 4);
//!     assert!(matches!(t.locate(&[3.0, 2.0], None), Location::Cell { .. }));
//!     assert_eq!(t.nearest(&[3.5, 0.0], None), Some(v[1]));
//!     t.remove(middle)?;
//!     assert!(t.check(Level::Law).is_empty());
//!     Ok(())
//! }
//! ```
//!
//! The geometry defines the points: [`Plane::new()`](crate::geometry::Plane::new) has `[x, y]`,
//! [`Space::new()`](crate::geometry::Space::new) has `[x, y, z]`. [`Delaunay2`], [`Delaunay3`] and
//! so on are short names of the types: `Delaunay2<u32>` has a number at each vertex.
//!
//! **Dimensions.** Without points the dimension is -1, with one it is 0, 1 while all are collinear,
//! 2 in the plane or while all are coplanar, and 3 in space. Each is a state of the same structure:
//! it can be traversed, queried and checked, grows by insertion and, but for [`Basic`] in space,
//! shrinks by removal.
//!
//! **Infinity.** Beyond each facet of the convex hull there is a cell that joins the facet to the
//! one infinite vertex, [`VertexId::INFINITE`](crate::tds::VertexId::INFINITE). So every cell has
//! all its neighbors. *Finite* vertices and cells are all others.
//!
//! **One answer.** Where points lie on a common empty sphere, a symbolic perturbation chooses among
//! the triangulations. So the result is a function of the set of points (and constraints): the
//! cells do not depend on the order of insertion. The core cannot fail on points that it accepted;
//! [`PointError`] and [`InputError`] say which are refused.
//!
//! | to | use |
//! |---|---|
//! | triangulate many points at once | [`Delaunay::from_points`], [`Regular::from_points`], [`ConstrainedDelaunay::from_points`] |
//! | insert points one by one | `insert`; insert points near each other one after the other, see [`spatial_order`] |
//! | remove points again, or move them | `remove`, `move_to`; of [`Basic`] in the plane only |
//! | keep a value at each vertex, at each cell | [`Delaunay::insert_with`], [`Delaunay::with_cell_data`] |
//! | triangulate points and lines | [`ConstrainedDelaunay::from_lines`] |
//! | insert, remove, split, join lines | [`ConstrainedDelaunay::insert_lines`], `remove_line`, `split_line`, `join_lines` |
//! | find what lines enclose | [`ConstrainedDelaunay::nesting`] |
//! | avoid small angles and large triangles | [`ConstrainedDelaunay::refined`], see [`refine`] |
//! | locate a point | [`Triangulation::locate`]; from a starting point of your choice, by a [strategy](Locate) |
//! | find what is nearest | [`Delaunay::nearest`], [`Delaunay::nearest_first`], [`Delaunay::within`] |
//! | find what is in a rectangle or box, what a segment meets | [`Triangulation::within_rectangle`], [`Triangulation::within_box`], [`Triangulation::along`] |
//! | find what a new point would destroy | [`Delaunay::conflict_zone`], [`ConstrainedDelaunay::conflict_zone`] |
//! | find the convex hull | [`tds::Tds::hull`]; in space [`Triangulation::convex_hull`] |
//! | construct Voronoi diagrams | [`Triangulation::circumcenter`], [`Delaunay::voronoi_edge`], [`Delaunay::voronoi_cell`]; in space also [`Delaunay::voronoi_facet`] |
//! | give weights to points | [`Regular::hidden`], [`Regular::hidden_under`], [`Regular::nearest`] |
//! | construct power diagrams | [`Regular::power_center`], [`Regular::power_edge`], [`Regular::power_cell`]; in space also [`Regular::power_facet`] |
//! | interpolate | [`Delaunay::sibson`], [`Delaunay::laplace`] |
//! | draw it | [`Triangulation::svg`] |
//! | save it | serde, with the feature `serde`: all kinds |
//! | keep it in a file, and query it without loading it | [`Delaunay::write_compact`], [`Compact`] |
//! | visit cells, edges, vertices | [`Triangulation::finite_cells`], [`Triangulation::tds`]; outwards from a face: [`Triangulation::faces_from`] |
//! | run the same queries on a structure of your own | [`query`], over [`Embedded`] |
//! | build and edit a surface of any genus | [`tds::Tds::from_cells`] |
//! | check it | [`Delaunay::check`], [`ConstrainedDelaunay::check`], up to a [`Level`] |
//!
//! All queries take `&self`. In space, these exist: construction, insertion, and removal and moves
//! except of [`Basic`]; payloads; location by all strategies; what a segment meets; vertices in a
//! box, nearest vertices, conflict zones, stars, rings around edges; flips by [`Basic`]; hidden
//! points; the convex hull; Voronoi and power diagrams, natural neighbor coordinates; serde,
//! [`Compact`]; and checks. Gabriel tests and [alpha shapes](AlphaShapes) are for space only. All
//! else is for the plane only: constraints, other queries and pictures. Construction from many
//! points is by divide and conquer in the plane only.
//!
//! By default, a walk starts where the last insertion ended. [`Near`] a cell, [`JumpAndWalk`],
//! [`Buckets`] and [`Hierarchy`] start elsewhere, and [`StraightLine`] walks differently; all of
//! them return the same location.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `parallel` | yes | bulk construction and arrangements run on all threads, with rayon; the results are the same without it |
//! | `simd` | yes | bulk construction in space uses vector instructions, with wide and safe_arch; the results are the same without it |
//! | `serde` | no | triangulations can be serialized and deserialized |
//!
//! # Modules
//!
//! Each module uses only those above it in this list; the items at the root use all of them.
//!
//! | module | contains |
//! |---|---|
//! | [`num`] | number types whose sign is exact |
//! | [`kernel`] | predicates: formula times number |
//! | [`geometry`] | what a triangulation needs to know about points |
//! | [`tds`] | combinatorics, without coordinates |
//! | [`arrangement`] | segments that cross, rounded so that they meet at common ends only |
//!
//! If you know another package, the [guides](crate::guide) map its calls to those of this one.
//!
//! The conflict zone of a new point, the dot: the triangles that it destroys. Its star will stand
//! on the red edges.
//!
#![doc = "<div style=\"max-width: 24em\">"]
#![doc = include_str!("../docs/pictures/conflict-zone.svg")]
#![doc = "</div>"]

pub mod arrangement;
mod bulk;
mod compact;
mod embedded;
mod engine;
mod error;
mod flaw;
pub mod geometry;
pub mod guide;
mod hierarchy;
pub mod kernel;
mod kinds;
mod line_id;
mod lines;
mod locate;
pub mod num;
mod parallel;
pub mod query;
pub mod refine;
#[cfg(feature = "serde")]
mod saved;
pub mod tds;
mod triangulation;

pub use bulk::spatial_order;
pub use compact::{Compact, CompactError, CompactSection, Law};
pub use embedded::{Embedded, PointOf};
pub use engine::{ConstrainedEdges, Inserted};
pub use error::{GapError, InputError, MoveError, PointError, RemovalError};
pub use flaw::{Flaw, Level, LinesFlaw};
pub use hierarchy::Hierarchy;
pub use kinds::{
    Basic, Basic2, Basic3, Constrained, Constrained2, ConstraintError, Delaunay, Delaunay2,
    Delaunay3, Regular, Regular2, Regular3,
};
pub use line_id::{LineId, LineTag};
pub use lines::{ConstrainedDelaunay, ConstrainedDelaunay2, OnCrossing, Rounding};
pub use locate::{
    Buckets, Facets, JumpAndWalk, Locate, Location, Near, SpacePassage, StraightLine,
};
pub use query::{
    AlphaShape, AlphaShapes, AlphaState, Boundary, ConflictZone, ConvexHull, Mark, Passage,
    VoronoiCell, VoronoiEdge, VoronoiFacet, VoronoiSolid,
};
pub use triangulation::Triangulation;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
