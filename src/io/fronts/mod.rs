//! What callers use: readers and writers of any format, which find the format in the table.

pub mod contours;
pub mod layer;
pub mod mesh;
pub mod points;
pub mod profiles;
pub mod raster;
