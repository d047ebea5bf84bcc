//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.
//!
//! | I have, or want | of any format | one format |
//! |---|---|---|
//! | points | [`points::open`] | [`las::open`], [`text::open`], [`points::from_layer`] |
//! | to write points | [`points::create`] | [`las::create`], [`text::create`] |
//! | lines and polygons | [`layer::read`] | [`shapefile::read_layer`], [`geojson::read_layer`], [`gdal::read_layer`] |
//! | a raster | [`raster::open`] | [`geotiff::open`], [`gdal::open_raster`] |
//! | to write a raster | | [`geotiff::write()`]; a picture: [`png::write_gray`] |
//! | a mesh, to read or to write | [`mesh::read`], [`mesh::write`] | |
//! | points and segments in the plane, triangulated: Triangle's files | | [`triangle::read`], [`triangle::write`] |
//! | to write contours | [`contours::write`] | [`shapefile::write_contours`], [`geojson::write_contours`] |
//! | to write other shapes | | [`shapefile::write_layer`] |
//! | other coordinates | | [`proj::transform`] |
//!
//! All formats, and what can be read and written of each, are in one table: [`formats`].
//!
//! # Conventions
//!
//! - x is the easting or longitude, y the northing or latitude, whatever the axis order of the coordinate
//!   system; z is the height. Units are those of the file; nothing is converted unasked.
//! - A height that is not there is NaN. Nothing is made up for it.
//! - What is odd but can be read is a warning in what is returned; damage is an
//!   [`Error`](crate::Error) that names file, place and value. The tables on the formats' pages say which is
//!   which.
//! - Counts and offsets in a file are never trusted: what they claim is held against the bytes that are
//!   there before anything is allocated. A decoder from another crate that panics gives an error.
//! - A file that is written appears whole or not at all, see [`Output`]; several together, see [`OutputSet`]. The same data gives the same
//!   bytes, whatever the number of threads.
//!
//! # What it does not do
//!
//! The readers of any format choose among those of this crate. GDAL's are called by name, in a build with the
//! feature `gdal`; reprojection needs the feature `proj`. Without them these functions are there and return
//! an error that says so.

mod contain;
mod contour_summary;
pub mod contours;
mod decimal;
mod field;
pub mod formats;
pub mod gdal;
pub mod geojson;
pub mod geotiff;
pub mod las;
pub mod layer;
mod listing;
pub mod mesh;
mod obj;
mod off;
mod output;
mod ply;
pub mod png;
mod point_options;
pub mod points;
pub mod proj;
pub mod raster;
mod rows;
pub mod shapefile;
mod stl;
pub mod text;
pub mod triangle;
mod world_file;

pub(crate) use contain::contain;
pub use output::{Abandoned, Destination, Output, OutputSet, abandon_outputs, is_stream, probe};
