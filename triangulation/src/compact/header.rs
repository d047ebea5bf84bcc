//! The header, and the positions of the arrays that follow from it.

use std::io::{self, Write};

use crate::tds::CellId;

use super::error::{CompactError, VERSION};
use super::law::Law;

/// The first bytes of a file. A transfer as text destroys its line ends and its control character.
const MAGIC: [u8; 8] = *b"brkTIN\n\x1a";
pub(super) const HEADER: usize = 48;

/// Stands for the infinite vertex.
pub(super) const INFINITE: u32 = u32::MAX;

/// Stands for vertices and neighbors that a cell does not have below full dimension.
pub(super) const NONE: u32 = u32::MAX - 1;

/// The contents of the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    /// Vertices of a cell at full dimension: 3 in the plane, 4 in space.
    pub(super) full: u32,
    /// Vertices of a cell: the dimension plus one.
    pub(super) width: u32,
    /// Coordinates of a point.
    pub(super) doubles: u32,
    pub(super) law: Law,
    pub(super) vertices: u64,
    pub(super) cells: u64,
    /// A cell that has the infinite vertex.
    pub(super) infinite_cell: u32,
}

/// The offset of each array, and the end of the last.
#[derive(Debug, Clone, Copy)]
pub(super) struct Offsets {
    pub(super) cells_of_vertices: usize,
    pub(super) cells: usize,
    pub(super) constraints: usize,
    pub(super) end: usize,
}

/// Takes the first `W` bytes off a slice; zeros if there are fewer.
pub(super) fn taken<const W: usize>(bytes: &mut &[u8]) -> [u8; W] {
    let (first, rest) = bytes.split_first_chunk().unwrap_or((&[0; W], &[]));
    *bytes = rest;
    *first
}

impl Header {
    pub(super) fn to_bytes(self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        let numbers = [VERSION, self.width, self.doubles, self.law as u32];
        numbers.iter().for_each(|n| bytes.extend(n.to_le_bytes()));
        [self.vertices, self.cells]
            .iter()
            .for_each(|n| bytes.extend(n.to_le_bytes()));
        [self.infinite_cell, self.full - 3]
            .iter()
            .for_each(|n| bytes.extend(n.to_le_bytes()));
        bytes
    }

    /// Reads a header and checks that its numbers are consistent.
    pub(super) fn read(mut bytes: &[u8]) -> Result<Self, CompactError> {
        let found = bytes.len();
        let bytes = &mut bytes;
        if taken(bytes) != MAGIC {
            return Err(CompactError::Foreign);
        }
        if found < HEADER {
            return Err(CompactError::Length {
                expected: HEADER as u64,
                found: found as u64,
            });
        }
        let version = u32::from_le_bytes(taken(bytes));
        if version != VERSION {
            return Err(CompactError::Version(version));
        }
        let [width, doubles, law] = [0; 3].map(|_| u32::from_le_bytes(taken(bytes)));
        let [vertices, cells] = [0; 2].map(|_| u64::from_le_bytes(taken(bytes)));
        let [infinite_cell, is_in_space] = [0; 2].map(|_| u32::from_le_bytes(taken(bytes)));
        let full = match is_in_space {
            0 => 3,
            1 => 4,
            _ => return Err(CompactError::Header("neither the plane nor space")),
        };
        let law = Law::from_number(law).ok_or(CompactError::Header("the law"))?;
        if full == 4 && law.has_constraints() {
            return Err(CompactError::Header("constraints in space"));
        }
        // On a sphere these numbers follow from each other (Euler); in space they do not.
        let fits = match width {
            0 => vertices == 0 && cells == 0,
            1 => vertices == 1 && cells == 2,
            2 => vertices >= 2 && cells.checked_sub(1) == Some(vertices),
            3 => vertices >= 3 && cells.checked_add(2) == vertices.checked_mul(2),
            4 => full == 4 && vertices >= 4 && cells >= 5,
            _ => false,
        };
        if !fits || cells >= CellId::LIMIT as u64 {
            return Err(CompactError::Header(
                "the dimension and the numbers of vertices and cells",
            ));
        }
        let is_cell = u64::from(infinite_cell) < cells || width == 0 && infinite_cell == NONE;
        if !is_cell {
            return Err(CompactError::Header("the cell of the infinite vertex"));
        }
        Ok(Header {
            full,
            width,
            doubles,
            law,
            vertices,
            cells,
            infinite_cell,
        })
    }

    /// Bytes of a cell: its vertices and its neighbors.
    #[inline(always)]
    pub(super) fn bytes_of_cell(&self) -> usize {
        8 * self.full as usize
    }

    /// Returns the offsets of the arrays; `None` if they exceed the address space of this machine.
    pub(super) fn offsets(&self) -> Option<Offsets> {
        let points = self
            .vertices
            .checked_mul(8)?
            .checked_mul(self.doubles.into())?;
        let cells_of_vertices = points.checked_add(HEADER as u64)?;
        let cells = cells_of_vertices.checked_add(padded(self.vertices.checked_mul(4)?)?)?;
        let constraints = cells.checked_add(self.bytes_of_cell() as u64 * self.cells)?;
        let end = constraints.checked_add(if self.law.has_constraints() {
            padded(self.cells)?
        } else {
            0
        })?;
        let [cells_of_vertices, cells, constraints] =
            [cells_of_vertices, cells, constraints].map(usize::try_from);
        Some(Offsets {
            cells_of_vertices: cells_of_vertices.ok()?,
            cells: cells.ok()?,
            constraints: constraints.ok()?,
            end: usize::try_from(end).ok()?,
        })
    }
}

/// Rounds up to the next multiple of 8; `None` if that is more than 64 bits hold.
pub(super) fn padded(bytes: u64) -> Option<u64> {
    bytes.checked_next_multiple_of(8)
}

/// Writes zeros up to a multiple of 8 bytes.
pub(super) fn pad(out: &mut impl Write, written: usize) -> io::Result<()> {
    out.write_all(&[0; 8][..written.next_multiple_of(8) - written])
}
