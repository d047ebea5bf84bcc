//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

mod contain;
pub mod contours;
pub mod gdal;
pub mod geojson;
pub mod geotiff;
pub mod las;
pub mod layer;
pub mod mesh;
mod output;
pub mod png;
pub mod points;
pub mod proj;
pub mod raster;
pub mod shapefile;
pub mod text;
mod world_file;

pub use output::Output;
