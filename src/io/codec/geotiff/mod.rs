//! GeoTIFF: reads heights, writes heights, hillshades and colors.
//!
//! Reading takes three layers: `ifd` fetches raw tags and trusts no offset; `layout` checks and
//! bounds what they say about blocks; `block` turns one block into values with the decoders of the
//! `tiff` crate. `georeference` and `nodata` give the numbers their meaning. Writing is [`write()`]
//! on top of `image` (one per level, the raster or an overview), `directory` (the header) and
//! `tile` (the cells).
//!
//! Conventions:
//! - Band 1 of the first image is read.
//! - Missing values are NaN: nodata by tag 42113, compared in the sample type of the file; blocks
//!   left out of a sparse file; infinities.
//! - Scale and offset (tag 42112) are applied.
//! - The transform is that of cell corners, even if the file is PixelIsPoint.
//!
//! Supported are integers of 1 to 64 bits and floats of 16, 32 and 64 bits, strips and tiles, both
//! byte orders, BigTIFF, compressions none, LZW, DEFLATE, PackBits, ZSTD and JPEG (without YCbCr),
//! predictors 2 and 3, interleaved and separate bands. The error for anything else names what is
//! not supported.

mod block;
mod cell_format;
mod directory;
mod georeference;
mod ifd;
mod image;
mod kept;
mod layout;
mod nodata;
mod overview;
mod read;
mod tags;
mod tile;
mod write;

pub use cell_format::CellFormat;
pub use ifd::ByteOrder;
pub use image::RasterSummary;
pub use kept::KeptBlocks;
pub use layout::{SampleKind, SampleType};
pub use read::{Extremes, GeoTiffInfo, GeoTiffReader, open};
pub use write::{Overviews, WriteOptions, cells_written, write};

/// Creation options of GDAL that describe how a GeoTIFF is always written.
pub(crate) const AS_WRITTEN: &[&str] = &[
    "TILED=YES",
    "COMPRESS=DEFLATE",
    "PREDICTOR=3",
    "BLOCKXSIZE=256",
    "BLOCKYSIZE=256",
    "SPARSE_OK=TRUE",
    "SPARSE_OK=YES",
    "BIGTIFF=IF_NEEDED",
    "BIGTIFF=IF_SAFER",
    "NUM_THREADS=ALL_CPUS",
    "PREDICTOR=YES",
    "OVERVIEWS=AUTO",
    "OVERVIEW_RESAMPLING=AVERAGE",
];

/// Limit for the cells of one read (4 GiB of values).
pub const MAX_CELLS: usize = 1 << 29;

/// Limit for the bytes of a decoded block: a 16-bit strip of 16384 x 16384 cells.
pub const MAX_BLOCK_BYTES: u64 = 1 << 29;

/// Limit for the blocks of a file: enough for a million by a million cells in tiles of 256 x 256.
pub const MAX_BLOCKS: u64 = 1 << 24;
