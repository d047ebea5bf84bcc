//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

pub mod las;
pub mod contours;
pub mod geojson;
pub mod layer;
pub mod shapefile;

pub mod mesh;
mod output;
pub mod points;
pub mod text;
mod contain;
pub mod geotiff;
mod output;
pub mod png;
pub mod raster;
mod world_file;

pub use output::Output;
