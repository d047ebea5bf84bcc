//! Terrain as 3D Tiles 1.1: a tree of tiles that viewers know by a rule (implicit tiling), each in
//! a GLB file.
//!
//! `tileset.json` names the root of the tree, whose tiles are squares of degrees. Files of subtrees
//! say which tiles exist, [`SUBTREE_LEVELS`] levels at a time. A tile replaces the one above it.
//! Positions are X, Y and Z from the center of the earth, relative to an origin in the tile's node,
//! turned so that Y is up, as glTF wants it. Each border has a skirt, which hides the gap to a
//! tile of another level.
//!
//! See <https://github.com/CesiumGS/3d-tiles>.

mod content;
mod subtree;
#[cfg(test)]
mod tests;
mod tileset;

pub use content::content;
pub use subtree::subtrees;
pub use tileset::{TilesetRoot, roots, tileset_json};

/// The levels in a file of a subtree.
pub const SUBTREE_LEVELS: u8 = 6;
