//! Files: opened, in which coordinate systems they are, and surfaces in parts.

pub(crate) mod checksum;
pub(crate) mod extents;
pub(crate) mod file_extent;
pub(crate) mod narrowed;
pub(crate) mod open;
pub(crate) mod point_files;
pub mod proj;
pub(crate) mod raster_file;
pub(crate) mod systems;
pub(crate) mod tin_parts;
pub(crate) mod transforms;
