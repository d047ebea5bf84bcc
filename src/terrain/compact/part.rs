//! A TIN that is part of a larger surface: its vertices have numbers that hold in all parts.

use std::path::Path;

use super::CompactTin;
use super::layout::NUMBER;
use crate::data::{Surface, SurfaceFacts};
use crate::error::{Error, Result};

impl<B: AsRef<[u8]>> CompactTin<B> {
    /// Returns true if the TIN is part of a larger surface: a
    /// [`TinPart`](crate::terrain::tiles::TinPart) has written it.
    pub fn is_part(&self) -> bool {
        !self.numbers.is_empty()
    }

    /// Returns the number of the tile of a vertex, and the number of the vertex in that tile. A
    /// vertex that several parts of a surface share has the same two numbers in each of them.
    ///
    /// Returns `None` if the vertex does not exist, or the file is not a part of a larger surface.
    pub fn number_in_parts(&self, vertex: u32) -> Option<[u32; 2]> {
        // Vertices of fragments are in no other part.
        if let Some(added) = (vertex as usize).checked_sub(self.triangulation.vertex_count()) {
            let is_there = self.is_part() && (vertex as usize) < self.vertex_numbers();
            return is_there.then_some([u32::MAX, added as u32]);
        }
        let row: &[u8; NUMBER] = self.row(&self.numbers, vertex as usize)?;
        Some([0, 4].map(|at| u32::from_le_bytes(std::array::from_fn(|i| row[at + i]))))
    }
}

impl CompactTin<Vec<u8>> {
    /// Opens a TIN with more faces than its bytes state: the whole cells with these numbers. Its
    /// counts and its extent are found anew.
    ///
    /// # Errors
    /// If the bytes cannot be [opened](Self::open), or one of the numbers is not that of a cell.
    ///
    /// # Complexity
    /// Linear.
    pub fn open_with_faces(mut bytes: Vec<u8>, path: impl AsRef<Path>, faces: &[u32]) -> Result<Self> {
        let path = path.as_ref();
        let opened = CompactTin::open(bytes.as_slice(), path)?;
        let (inside, count) = (opened.inside.clone(), opened.triangulation.cell_count());
        for &face in faces {
            if face as usize >= count {
                return Err(Error::format(format!("there is no cell {face}: there are {count}")).in_file(path));
            }
            bytes[inside.start + face as usize / 8] |= 1 << (face % 8);
        }
        let mut tin = Self::open(bytes, path)?;
        tin.attributes.facts = SurfaceFacts::of(&tin);
        tin.ensure_intact()?;
        Ok(tin)
    }
}
