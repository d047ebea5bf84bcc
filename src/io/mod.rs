//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

pub mod contours;
pub mod geojson;
pub mod layer;
pub mod shapefile;

mod output;

pub use output::Output;
