//! The nodes of a COPC file's octree, and what its reader and its writer know of the bytes (COPC
//! 1.0).

use std::fmt;

use crate::io::bytes::little_endian::u32_at;

/// Bytes of the record "copc", 1, which describes the octree.
pub(super) const INFO: usize = 160;

/// Bytes of an entry of the hierarchy.
pub(super) const ENTRY: usize = 32;

/// The deepest level that a file may have: coordinates of nodes are positive numbers of 32 bits.
pub(super) const DEEPEST: u32 = 31;

/// A node: its level, and which cube of that level it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Key {
    pub(super) level: u32,
    pub(super) at: [u32; 3],
}

impl Key {
    pub(super) const ROOT: Key = Key {
        level: 0,
        at: [0; 3],
    };

    /// Returns the node at the beginning of an entry; `None` if its level has no such cube.
    pub(super) fn of(entry: &[u8]) -> Option<Self> {
        let level = u32_at(entry, 0);
        let at = [4, 8, 12].map(|start| u32_at(entry, start));
        let is_cube = level <= DEEPEST && at.iter().all(|&at| u64::from(at) < 1 << level);
        is_cube.then_some(Key { level, at })
    }

    /// Returns an entry of the hierarchy; -1 points mean that the bytes are a page.
    pub(super) fn entry(self, start: u64, bytes: u32, points: i32) -> [u8; ENTRY] {
        let [x, y, z] = self.at.map(u32::to_le_bytes);
        let mut entry = [0; ENTRY];
        let fields: [&[u8]; 7] = [
            &self.level.to_le_bytes(),
            &x,
            &y,
            &z,
            &start.to_le_bytes(),
            &bytes.to_le_bytes(),
            &points.to_le_bytes(),
        ];
        let bytes = fields.iter().copied().flatten();
        entry
            .iter_mut()
            .zip(bytes)
            .for_each(|(slot, &byte)| *slot = byte);
        entry
    }

    /// Returns one of the eight nodes below this one: a bit for each axis, x first.
    pub(super) fn below(self, octant: usize) -> Self {
        Key {
            level: self.level + 1,
            at: [0, 1, 2].map(|k| self.at[k] << 1 | (octant as u32 >> k & 1)),
        }
    }

    /// Returns the node of another level, not a deeper one, that this one is part of.
    pub(super) fn on(self, level: u32) -> Self {
        let up = self.level - level;
        Key {
            level,
            at: self.at.map(|at| at >> up),
        }
    }

    pub(super) fn is_part_of(self, other: Self) -> bool {
        self.level >= other.level && self.on(other.level) == other
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.at;
        write!(f, "{}-{x}-{y}-{z}", self.level)
    }
}
