//! Binary glTF 2.0 (GLB): triangles for viewers and game engines, in 32-bit floats.
//!
//! A JSON text describes arrays in the bytes behind it: positions, normals and colors of the
//! vertices, and the corners of the triangles. Axes are x to the east, y up, z to the south. The
//! positions are relative to a local origin, which is the translation of the only node, and in the
//! `extras` of the asset with the coordinate system.

mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::{head, write};

/// The first bytes, and the types of the two chunks.
const MAGIC: &[u8; 4] = b"glTF";
const VERSION: u32 = 2;
const JSON: &[u8; 4] = b"JSON";
const BIN: &[u8; 4] = b"BIN\0";

/// Numbers of glTF: 32-bit floats, bytes, 16-bit and 32-bit numbers.
pub(crate) const FLOAT: u64 = 5126;
const BYTE: u64 = 5121;
const SHORT: u64 = 5123;
pub(crate) const INT: u64 = 5125;

/// The name in `extras` under which the origin and the coordinate system are.
const EXTRAS: &str = "breakline";
