//! Terrain for viewers of the earth: tiles in the format quantized-mesh 1.0, and `layer.json`,
//! which lists them.
//!
//! A tile is a header of 88 bytes with its center, range of heights, bounding sphere and the point
//! by which viewers find that it is below the horizon; then the vertices, as differences from the
//! one before; the triangles, each vertex counted from the highest one so far; the vertices on the
//! four borders, from which viewers hang skirts; and extensions.
//!
//! | | written | read |
//! |---|---|---|
//! | vertices, triangles, borders | yes | yes |
//! | normals of vertices (extension 1) | yes | as bytes |
//! | water (extension 2) | yes | yes |
//! | tiles that exist below this one (extension 4) | yes | as text |
//!
//! See <https://github.com/CesiumGS/quantized-mesh>.

mod header;
mod layer;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub use layer::{LayerOptions, layer_json, tiles_below};
pub use read::{DecodedTile, decode};
pub use write::{Extensions, encode};

/// The bytes of the header.
const HEADER: usize = 88;

/// Up to so many vertices, their numbers are written in 16 bits.
const SHORT: usize = 65_536;

/// The numbers of the extensions with normals, with water, and with what is known of a tile.
const NORMALS: u8 = 1;
const WATER: u8 = 2;
const METADATA: u8 = 4;
