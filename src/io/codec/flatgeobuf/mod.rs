//! FlatGeobuf, version 3: one layer of points, lines and polygons with typed attributes and an
//! index of the extents of its records (a packed R-tree along a Hilbert curve).
//!
//! Header and records are tables of FlatBuffers (`buffer`), whose offsets are never trusted.

mod buffer;
mod builder;
mod index;
mod read;
mod schema;
#[cfg(test)]
mod tests;
mod write;

pub use read::read_layer_with;
pub use write::{write_contours, write_lines};
