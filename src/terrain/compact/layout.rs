//! The sections that a TIN has in its file beside the triangulation, and the bytes of their rows.
//!
//! `docs/formats.md` describes them. Numbers are little-endian.

use crate::data::{EdgeKind, Face};

/// Coordinate system, counts and extent, as JSON.
pub(super) const ATTRIBUTES: [u8; 8] = *b"tin     ";
/// A bit for each cell: set if the whole cell is a face of the surface.
pub(super) const INSIDE: [u8; 8] = *b"inside  ";
/// The coordinates of vertices of fragments that the triangulation does not have.
pub(super) const VERTICES: [u8; 8] = *b"vertices";
/// The fragments of cut triangles.
pub(super) const FRAGMENTS: [u8; 8] = *b"fragment";
/// Edges of triangles that are next to a fragment, or on a line other than a breakline, in order.
pub(super) const SIDES: [u8; 8] = *b"sides   ";

/// The tile and the number of each vertex of the triangulation, in a TIN that is part of a larger
/// surface.
pub(super) const NUMBERS: [u8; 8] = *b"numbers ";
/// A bit for each cell, in such a TIN: set if the whole cell is a triangle of the larger surface
/// before anything was left out of it, and of no other part.
pub(super) const UNDER: [u8; 8] = *b"under   ";

/// Stands for the neighbor of an edge at the rim.
const NONE: u32 = u32::MAX;

/// Bytes of a row of [`VERTICES`].
pub(super) const VERTEX: usize = 24;

/// Bytes of a row of [`NUMBERS`].
pub(super) const NUMBER: usize = 8;

/// Bytes of a row of [`FRAGMENTS`].
pub(super) const FRAGMENT: usize = 28;

/// Bytes of a row of [`SIDES`].
pub(super) const SIDE: usize = 12;

/// A fragment of a cut triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fragment {
    pub(super) corners: [u32; 3],
    /// The face across the edge opposite each corner.
    pub(super) neighbors: [Option<u32>; 3],
    /// The kind of the edge opposite each corner.
    pub(super) edges: [EdgeKind; 3],
}

/// An edge of a whole triangle for which the triangulation alone does not say what is beyond it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OpenSide {
    pub(super) face: u32,
    /// The corner opposite the edge.
    pub(super) corner: u8,
    pub(super) kind: EdgeKind,
    pub(super) neighbor: Option<u32>,
}

impl Fragment {
    pub(super) fn new(face: &Face, neighbors: [Option<u32>; 3]) -> Self {
        Fragment {
            corners: face.corners,
            neighbors,
            edges: face.edges,
        }
    }

    pub(super) fn to_bytes(self) -> [u8; FRAGMENT] {
        let mut bytes = [0; FRAGMENT];
        let numbers = self
            .corners
            .into_iter()
            .chain(self.neighbors.map(|number| number.unwrap_or(NONE)));
        bytes
            .chunks_exact_mut(4)
            .zip(numbers)
            .for_each(|(bytes, n)| bytes.copy_from_slice(&n.to_le_bytes()));
        bytes[24..27].copy_from_slice(&self.edges.map(EdgeKind::number));
        bytes
    }

    /// Reads a row; `None` if a kind does not exist.
    pub(super) fn read(bytes: &[u8; FRAGMENT]) -> Option<Self> {
        let neighbor = |at| Some(number(bytes, at)).filter(|&number| number != NONE);
        Some(Fragment {
            corners: [0, 4, 8].map(|at| number(bytes, at)),
            neighbors: [12, 16, 20].map(neighbor),
            edges: [kind(bytes[24])?, kind(bytes[25])?, kind(bytes[26])?],
        })
    }
}

impl OpenSide {
    pub(super) fn to_bytes(self) -> [u8; SIDE] {
        let mut bytes = [0; SIDE];
        bytes[..4].copy_from_slice(&self.face.to_le_bytes());
        bytes[4..6].copy_from_slice(&[self.corner, self.kind.number()]);
        bytes[8..].copy_from_slice(&self.neighbor.unwrap_or(NONE).to_le_bytes());
        bytes
    }

    /// Reads a row; `None` if its kind does not exist.
    pub(super) fn read(bytes: &[u8; SIDE]) -> Option<Self> {
        let neighbor = Some(number(bytes, 8)).filter(|&number| number != NONE);
        let (face, corner) = OpenSide::key(bytes);
        Some(OpenSide {
            face,
            corner,
            kind: kind(bytes[5])?,
            neighbor,
        })
    }

    /// Returns what rows are sorted by: the face and the corner.
    pub(super) fn key(bytes: &[u8; SIDE]) -> (u32, u8) {
        (number(bytes, 0), bytes[4])
    }
}

fn number(bytes: &[u8], at: usize) -> u32 {
    bytes
        .get(at..)
        .and_then(|rest| rest.first_chunk())
        .map_or(NONE, |bytes| u32::from_le_bytes(*bytes))
}

fn kind(number: u8) -> Option<EdgeKind> {
    EdgeKind::ALL.get(usize::from(number)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_read_as_they_were_written() {
        let [plain, line, clip, rim, ..] = EdgeKind::ALL;
        for (corners, neighbors, edges) in [
            ([0, 1, 2], [None; 3], [rim; 3]),
            (
                [7, 1 << 30, 9],
                [Some(5), None, Some(1 << 31)],
                [line, clip, plain],
            ),
        ] {
            let fragment = Fragment {
                corners,
                neighbors,
                edges,
            };
            assert_eq!(Fragment::read(&fragment.to_bytes()), Some(fragment));
            let side = OpenSide {
                face: corners[1],
                corner: 2,
                kind: edges[0],
                neighbor: neighbors[0],
            };
            assert_eq!(OpenSide::read(&side.to_bytes()), Some(side));
            assert_eq!(OpenSide::key(&side.to_bytes()), (corners[1], 2));
        }
        let mut bytes = Fragment {
            corners: [0, 1, 2],
            neighbors: [None; 3],
            edges: [rim; 3],
        }
        .to_bytes();
        bytes[26] = EdgeKind::ALL.len() as u8;
        assert_eq!(Fragment::read(&bytes), None);
    }

    #[test]
    fn kinds_are_at_their_numbers() {
        assert!(
            EdgeKind::ALL
                .into_iter()
                .enumerate()
                .all(|(at, kind)| usize::from(kind.number()) == at)
        );
    }
}
