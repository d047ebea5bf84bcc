//! Plain records that stand between formats and algorithms.
//!
//! [`io`](crate::io) turns bytes into these and these into bytes; [`terrain`](crate::terrain) turns
//! these into each other. Neither knows the other. A verb returns a *source* (a surface, an iterator
//! of lines, a filler of raster blocks) and a writer takes one, so that nothing has to be whole in
//! memory because of the border between them.
//!
//! | what | record | stream |
//! |---|---|---|
//! | points | [`PointBatch`] (columns), [`PointInfo`], [`Columns`], [`Lattice`], [`LasHead`] | [`PointSource`], [`PointSink`] |
//! | lines, polygons, points of a vector file | [`Shape`], [`Layer`] | |
//! | contours | [`ContourLine`] | `Iterator<Item = ContourLine>` |
//! | rasters | [`Grid`], with its place: [`Frame`] | [`BlockSource`], asked by [`Window`] |
//! | triangles | [`Triangles`] as a file lists them, [`Mesh`] linked | [`Surface`] |
//! | a box | [`Bounds`] | |
//!
//! Conventions: x to the east, y to the north, z up, in the units of the coordinate system that comes
//! along (`crs`, where it is known); NaN is a height, or a cell, without a value; faces are
//! counter-clockwise in plan; rasters have their transform in GDAL's order, for the corners of cells.
//! Nothing here reads, writes or computes a result. `geo`, behind the feature of that name, converts to the types of
//! the crate of that name.

mod bounds;
mod contour_line;
mod frame;
#[cfg(feature = "geo")]
pub mod geo;
mod grid;
mod las_head;
mod lattice;
mod mesh;
mod points;
mod shape;
mod surface;
mod triangles;

pub use bounds::Bounds;
pub use contour_line::ContourLine;
pub use frame::{Frame, MAX_SIDE, ToPixels, Window};
pub use grid::{BlockSource, Grid};
pub use las_head::LasHead;
pub use lattice::{Embedding, Lattice};
pub use mesh::Mesh;
pub(crate) use mesh::{not_finite, orientation};
pub use points::{Columns, PointBatch, PointFlags, PointInfo, PointSink, PointSource, PointSummary};
pub use shape::{Layer, Shape, ShapeKind};
pub use surface::{EdgeKind, Face, Surface};
pub(crate) use surface::{corners, faces};
pub use triangles::{LinkFlaw, Triangles};
