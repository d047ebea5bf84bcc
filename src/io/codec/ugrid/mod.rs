//! UGRID in NetCDF's classic format: the mesh that QGIS (MDAL), xarray and models of water read.
//!
//! A file consists of a header, which lists dimensions, attributes and variables, and the values of
//! the variables, in big-endian bytes (The NetCDF Classic Format Specification; UGRID 1.0).

mod classic;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::write;
