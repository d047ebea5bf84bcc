//! File formats: maps bytes to [`data`](crate::data) and data to bytes. Independent of
//! triangulations.
//!
//! | task | any format | one format |
//! |---|---|---|
//! | read points | [`points::open`] | [`las::open`], [`text::open`], [`points::from_layer`] |
//! | write points | [`points::create`] | [`las::create`], [`text::create`] |
//! | read lines and polygons | [`layer::read`] | [`shapefile::read_layer`], [`geojson::read_layer`], [`gpkg::read_layer_with`], [`flatgeobuf::read_layer_with`], [`gdal::read_layer`] |
//! | read a raster | [`raster::open`] | [`geotiff::open`], [`ascii_grid::open`], [`gdal::open_raster`] |
//! | write a raster | | [`geotiff::write()`]; as a picture: [`png::write_gray`], [`png::write_colors`] |
//! | read a color ramp | | [`ramp::read`] |
//! | read or write a mesh | [`mesh::read`], [`mesh::write`] | |
//! | map a TIN to memory | [`mapped::open`], for a [`CompactTin`](crate::terrain::CompactTin) | |
//! | read or write Triangle's files: points and segments in the plane, and their triangulation | | [`triangle::read`], [`triangle::write`] |
//! | read or write triangulations in space: files of TetGen, MEDIT, VTK | | [`tetgen::read`], [`tetgen::write`] |
//! | write contours | [`contours::write`] | [`shapefile::write_contours`], [`geojson::write_contours`], [`gpkg::write_contours`], [`flatgeobuf::write_contours`] |
//! | read or write terrain tiles for viewers of the earth | | [`quantized_mesh::decode`], [`quantized_mesh::encode`]; [`tiles_3d::content`] |
//! | write other shapes | | [`shapefile::write_layer`] |
//!
//! One table lists all formats, and what can be read and written in each: [`formats`].
//!
//! # Conventions
//!
//! - x is the easting or longitude, y the northing or latitude, whatever the axis order of the
//!   coordinate system; z is the height. Units are those of the file; nothing is converted unless
//!   requested.
//! - A missing height is NaN. No height is ever invented.
//! - Unusual input that can be read leads to a warning, which is returned with the data; damaged
//!   input leads to an [`Error`](crate::Error) that names the file, the position and the value. The
//!   tables on the formats' pages say which is which.
//! - Counts and offsets in a file are never trusted: they are checked against the size of the file
//!   before anything is allocated. A panic in a decoder from another crate becomes an error.
//! - An output file appears complete or not at all, see [`Output`]; several files appear together,
//!   see [`OutputSet`]. The same data gives the same bytes, whatever the number of threads.
//!
//! # Limits
//!
//! The readers that accept any format choose among the readers of this crate. GDAL's are called by
//! name, in a build with the feature `gdal`; reprojection needs the feature `proj`. Without these
//! features the functions exist and return an error that says so.

mod bytes;
mod codec;
pub mod formats;
mod fronts;
mod options;

pub(crate) use bytes::contain::contain;
pub use bytes::contain::is_contained;
pub(crate) use bytes::csv::csv_field;
pub(crate) use bytes::field::no_such_field;
pub use bytes::mapped;
pub use bytes::output::{
    Abandoned, Destination, DriverOptions, Output, OutputSet, abandon_outputs, is_standard_output,
    is_stream, probe, remove_abandoned, require_absent,
};
pub(crate) use bytes::output::{FolderKind, OutputDriver, OutputFolder, Temporary, followed};
pub use bytes::watch::Watch;
pub(crate) use codec::prj;
pub use codec::{
    ascii_grid, flatgeobuf, gdal, geojson, geotiff, gpkg, las, png, quantized_mesh, ramp,
    shapefile, tetgen, text, tiles_3d, triangle,
};
pub use fronts::{contours, layer, mesh, points, profiles, raster};
pub use options::cut::OnDamage;
