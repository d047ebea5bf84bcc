//! One file or folder for each format, and what several of them share: the summary of contours, the
//! listing of a surface, world files, escapes of XML.

pub(crate) mod contour_summary;
pub(crate) mod dxf;
pub mod gdal;
pub mod geojson;
pub mod geotiff;
pub mod gpkg;
pub mod las;
pub(crate) mod listing;
pub(crate) mod obj;
pub(crate) mod off;
pub(crate) mod ply;
pub mod png;
pub(crate) mod profile;
pub mod ramp;
pub mod shapefile;
pub(crate) mod stl;
pub mod tetgen;
pub mod text;
pub(crate) mod tin;
pub mod triangle;
pub(crate) mod world_file;
mod xml;
