//! GeoJSON (RFC 7946, and the 2008 draft with its `crs` member), and GeoJSON lines (RFC 8142): a
//! feature on each line of the file.

mod append;
mod read;
mod shape;
#[cfg(test)]
mod tests;
mod write;

pub use append::PointFeatures;
pub use read::{read_layer, read_layer_with, read_lines_with};
pub use write::{write_contour_lines, write_contours, write_line_records, write_lines};

/// Longitude and latitude on WGS 84, the default of GeoJSON.
const WGS_84: u32 = 4326;

/// The separator of records in RFC 8142.
const RECORD: u8 = 0x1e;
