//! GeoTIFF: heights in, heights and hillshades out.
//!
//! Reading goes in three layers: `ifd` fetches raw tags and trusts no offset, `layout` checks
//! and bounds what they say about blocks, `block` turns one block into values with the decoders
//! of the `tiff` crate. `georeference` and `nodata` give the numbers their meaning. Writing is
//! [`write()`] over `directory` (the header) and `tile` (the cells).
//!
//! Conventions: band 1 of the first image is read; a value that is not there is NaN (nodata by tag
//! 42113, compared in the sample type of the file; blocks left out of a sparse file; infinities);
//! scale and offset (tag 42112) are applied; the transform is that of cell corners, whatever the
//! file calls its cells.
//!
//! Read are 1 to 64-bit integers and 16, 32 and 64-bit floats, strips and tiles, both byte orders,
//! BigTIFF, compressions none, LZW, DEFLATE, PackBits, ZSTD and JPEG (without YCbCr), predictors 2
//! and 3, bands interleaved or apart. What is not supported is refused by name.

mod block;
mod cell_format;
mod directory;
mod georeference;
mod ifd;
mod layout;
mod nodata;
mod read;
mod tags;
mod tile;
mod write;

pub use cell_format::CellFormat;
pub use ifd::ByteOrder;
pub use layout::{SampleKind, SampleType};
pub use read::{Extremes, GeoTiffInfo, GeoTiffReader, open};
pub use write::{RasterSummary, WriteOptions, write};

/// Most cells that one read brings into memory (4 GiB of values).
pub const MAX_CELLS: usize = 1 << 29;

/// Largest block that is decoded, in bytes: what a 16-bit strip of 16384 x 16384 cells takes.
pub const MAX_BLOCK_BYTES: u64 = 1 << 29;

/// Most blocks of one file: enough for a million by a million cells in tiles of 256 x 256.
pub const MAX_BLOCKS: u64 = 1 << 24;
