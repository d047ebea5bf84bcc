//! Plain records that formats and algorithms share.
//!
//! [`io`](crate::io) converts between bytes and these records; [`terrain`](crate::terrain) computes
//! one record from another. Neither depends on the other. A verb returns a *source* (a surface, an
//! iterator of lines, a filler of raster blocks) and a writer accepts one, so that results need not
//! fit into memory.
//!
//! | what | record | stream |
//! |---|---|---|
//! | points | [`PointBatch`] (columns), [`Return`], [`PointInfo`], [`Columns`], [`Lattice`], [`LasHead`] | [`PointSource`], [`PointSink`] |
//! | lines, polygons, points of a vector file | [`Shape`], [`Layer`], [`Column`], [`Attributes`] | |
//! | heights along lines | [`Profiles`] of [`LinePoint`] | |
//! | contours | [`ContourLine`] | `Iterator<Item = ContourLine>` |
//! | rasters | [`Grid`], georeferenced by its [`Frame`] | [`BlockSource`], read by [`Window`] |
//! | colors of heights | [`ColorRamp`], [`Colors`] | |
//! | triangles | [`Triangles`] as a file lists them, [`Mesh`] linked, [`SurfaceFacts`] counted | [`Surface`], also [`WithoutLines`] |
//! | levels of triangles, in squares of the earth | [`TerrainTile`], at a [`TilePosition`] of a [`Tiling`] | |
//! | a box | [`Bounds`] | |
//!
//! # Conventions
//!
//! - x to the east, y to the north, z up, in the units of the coordinate system (`crs`, where it is
//!   known).
//! - NaN is a missing height, or a nodata cell.
//! - Faces are counter-clockwise in plan.
//! - The transform of a raster is in GDAL's order, and refers to the corners of cells.
//!
//! Nothing here reads, writes or computes a result. With the feature `geo`, the module `geo`
//! converts to and from the types of the crate `geo`.

mod attributes;
mod bounds;
pub mod classes;
mod columns;
mod contour_line;
mod frame;
#[cfg(feature = "geo")]
pub mod geo;
mod grid;
mod las_head;
mod lattice;
mod mesh;
mod multiples;
mod named;
mod normals;
mod points;
mod profile;
mod ramp;
pub mod returns;
mod same_faces;
mod shape;
mod surface;
mod surface_facts;
mod terrain_tile;
mod triangles;
mod water_mask;
mod without_lines;

pub(crate) use attributes::ValueKind;
pub use attributes::{Attributes, Value};
pub use bounds::Bounds;
pub(crate) use bounds::{AT_ONCE, higher, lower, lowest_and_highest};
pub use columns::Columns;
pub use contour_line::ContourLine;
pub(crate) use frame::GridLines;
pub use frame::{Frame, MAX_SIDE, ToPixels, Window};
pub(crate) use grid::cells_of_rows;
pub(crate) use grid::range_of_finite;
pub use grid::{BlockSource, Grid, cells, range_of};
pub use las_head::LasHead;
pub use lattice::{Embedding, Lattice};
pub use mesh::Mesh;
pub(crate) use mesh::{area_of, not_finite, orientation};
pub(crate) use multiples::{EXACT, Multiples, in_decimals};
pub(crate) use named::named;
pub(crate) use normals::{unit, vertex_normals};
pub use points::{
    PartRead, PointBatch, PointFlags, PointInfo, PointSink, PointSource, PointSummary,
};
pub use profile::{LinePoint, Profile, Profiles, Station, Stretch};
pub use ramp::{ColorMatch, ColorRamp, ColorStop, Colors, Rgba, StopAt};
pub use returns::Return;
pub(crate) use same_faces::same_faces;
pub use shape::{Column, Layer, Shape, ShapeKind};
pub(crate) use shape::{doubled_area, oriented, polygons};
pub use surface::{BaseFace, Census, EdgeKind, Face, FaceAcross, LineEdges, Surface};
pub(crate) use surface::{across, bounds_of_faces, corners, faces, faces_under, map_batches};
pub use surface_facts::SurfaceFacts;
pub use terrain_tile::{TerrainTile, TilePosition, Tiling};
pub use triangles::{LinkFlaw, Triangles};
pub use water_mask::WaterMask;
pub use without_lines::WithoutLines;
