//! One file or folder for each format, and what several of them share: the summary of contours, the
//! listing of a surface, rows of cells as text, world files, escapes of XML.

pub mod ascii_grid;
mod cell_rows;
pub(crate) mod cityjson;
pub(crate) mod contour_summary;
pub(crate) mod dxf;
pub mod flatgeobuf;
pub mod gdal;
pub mod geojson;
pub mod geotiff;
pub(crate) mod glb;
pub mod gpkg;
pub(crate) mod landxml;
pub mod las;
pub(crate) mod listing;
pub(crate) mod mesh2dm;
pub(crate) mod obj;
pub(crate) mod off;
pub(crate) mod ply;
pub mod png;
pub(crate) mod prj;
pub(crate) mod profile;
pub mod quantized_mesh;
pub mod ramp;
pub mod shapefile;
pub(crate) mod stated_system;
pub(crate) mod stl;
pub mod tetgen;
pub mod text;
pub mod tiles_3d;
pub(crate) mod tin;
pub mod triangle;
pub(crate) mod ugrid;
pub(crate) mod world_file;
mod xml;
pub(crate) mod xyz_grid;
pub(crate) mod zipped;
