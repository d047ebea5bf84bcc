//! breakline: lidar and breaklines to TIN, DEM, contours and mesh.

pub mod crs;
pub mod data;
pub mod error;
pub mod geometry;
pub mod io;
pub mod kernel;
pub mod num;
pub mod tds;
pub mod terrain;
pub mod triangulation;

pub mod cli;

pub use error::{Error, Result};
