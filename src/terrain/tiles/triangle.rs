//! What tasks find: triangles, whose vertices have numbers that hold everywhere.

use crate::data::EdgeKind;

/// A vertex, with numbers that stand for it everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileVertex {
    /// The number of its tile.
    pub tile: u32,
    /// The index of its point among those of the tile.
    pub number: u32,
    /// Its position and its height, in the units of the data.
    pub position: [f64; 3],
    /// True if an edge here may bend where it is cut, because a vertex or another edge is next to
    /// it. A [clip](super::TileClip) needs all triangles around such a vertex.
    pub is_tight: bool,
}

impl TileVertex {
    /// Returns true for a vertex that a cut has added: no tile has it.
    pub fn is_added(&self) -> bool {
        self.tile == u32::MAX
    }

    /// Returns one number for both of its numbers.
    pub fn key(&self) -> u64 {
        u64::from(self.tile) << 32 | u64::from(self.number)
    }

    pub(super) fn site(&self) -> [f64; 2] {
        [self.position[0], self.position[1]]
    }
}

/// A triangle that is final.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileTriangle {
    /// The corners, counter-clockwise.
    pub corners: [TileVertex; 3],
    /// The kind of the edge opposite each corner.
    pub edges: [EdgeKind; 3],
}
