//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

pub mod geotiff;
mod output;
pub mod raster;
mod world_file;

pub use output::Output;
