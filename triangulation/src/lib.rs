//! Triangulations: geometry times combinatorics.
//!
//! A [geometry](crate::geometry::Geometry) says what a point is and answers questions about a few of them, with the arithmetic of a
//! [kernel](crate::kernel). A [`Tds`](crate::tds::Tds) knows which cells are neighbors, and no coordinates. One engine,
//! [`Triangulation`], joins them: it locates points, grows the zone that a new point is in conflict with, and replaces
//! it by the point's star. It knows neither the dimension nor the law. The kinds are thin: each owns an engine, and
//! derefs to it for reading.
//!
//! | kind | law | |
//! |---|---|---|
//! | [`Basic`] | none: a point splits what it lies on | plane, space |
//! | [`Delaunay`] | no vertex inside of a cell's circumscribed sphere | plane, space |
//! | [`Regular`] | the same with weights; points of too little weight are hidden | plane |
//! | [`Constrained`] | some edges are forced, and do not cross | plane |
//! | [`ConstrainedDelaunay`] | Delaunay among vertices that see each other past lines, which may cross | plane |
//!
//! [`Compact`] is read where it lies, in a file mapped to memory, say: what the kinds write with `write_compact`.
//! Questions are the same there, and are written once, over [`Embedded`].
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
//! The geometry says what a point is: [`Plane::new()`](crate::geometry::Plane::new) is that of `[x, y]`,
//! [`Space::new()`](crate::geometry::Space::new) that of `[x, y, z]`. To name the type, say [`Delaunay2`] or
//! [`Delaunay3`], and so on: `Delaunay2<u32>` has a number at each vertex.
//!
//! **Dimensions.** Without points the dimension is -1, with one it is 0, 1 while all are collinear, 2 in the plane or
//! while all are coplanar, and 3 in space. Each is a state of the same structure: it is traversed, asked and checked,
//! grows by insertion and, in the plane, shrinks by removal.
//!
//! **Infinity.** Beyond each facet of the convex hull there is a cell that ends in one vertex,
//! [`VertexId::INFINITE`](crate::tds::VertexId::INFINITE). So every cell has all its neighbors. What is called *finite* leaves these out.
//!
//! **One answer.** Where points lie on a common empty sphere, a symbolic perturbation chooses among the triangulations,
//! so that each is a function of the set of points (and constraints): the order of insertion does not show in the
//! cells. The core cannot fail on points that it admitted; [`PointError`] and [`InputError`] say which are not.
//!
//! | to | use |
//! |---|---|
//! | triangulate many points at once | [`Delaunay::from_points`], [`Regular::from_points`], [`ConstrainedDelaunay::from_points`] |
//! | add points one by one | `insert`; points near each other should come near each other, see [`spatial_order`] |
//! | remove points again, or move them | `remove`, `move_to`; in the plane |
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
//! | ask the same of a structure of your own | [`query`], over [`Embedded`] |
//! | build and edit a surface of any genus | [`tds::Tds::from_cells`] |
//! | prove it right | [`Delaunay::check`], [`ConstrainedDelaunay::check`], to a [`Level`] |
//!
//! All questions take `&self`. In space points cannot be removed, and there are the basic and the Delaunay kind.
//!
//! A walk starts where the last insertion was, if nothing else is said. [`Near`] a cell, [`JumpAndWalk`], [`Buckets`]
//! and [`Hierarchy`] say from where, [`StraightLine`] which way: a place has one answer with all of them.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `parallel` | yes | bulk construction and arrangements run on all threads, by rayon; the results are the same without it |
//! | `serde` | no | triangulations are saved and read with serde |
//!
//! # The rooms
//!
//! Each module uses only those above it in this list; what stands at the root, all.
//!
//! | module | holds |
//! |---|---|
//! | [`num`] | number types with exact signs |
//! | [`kernel`] | predicates: formula times number |
//! | [`geometry`] | what a triangulation asks of points |
//! | [`tds`] | combinatorics, without coordinates |
//! | [`arrangement`] | segments that cross, rounded so that they meet at common ends only |
//!
//! The [guides](crate::guide) show the calls of other packages beside ours.
//!
//! Below: what a new point, the dot, is in conflict with; the edges that its star will stand on are red.
//!
#![doc = "<div style=\"max-width: 24em\">"]
#![doc = include_str!("../docs/pictures/conflict-zone.svg")]
#![doc = "</div>"]

pub mod arrangement;
pub mod geometry;
pub mod guide;
pub mod kernel;
pub mod num;
mod parallel;
pub mod tds;
mod triangulation;

pub use triangulation::*;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
