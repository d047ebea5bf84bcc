//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

mod contain;
pub mod geotiff;
mod output;
pub mod png;
pub mod raster;
mod world_file;

pub use output::Output;
