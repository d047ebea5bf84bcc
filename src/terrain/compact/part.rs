//! A TIN that is part of a larger surface: its vertices have numbers that hold in all parts.

use std::ops::Range;
use std::path::Path;

use super::CompactTin;
use super::layout::NUMBER;
use crate::data::{BaseFace, Surface, SurfaceFacts, faces_under};
use crate::error::{Error, Result};

/// What a cell of a part is in the larger surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartCell {
    /// A face.
    Face,
    /// A triangle under the surface that the rim or a clip has left out of the surface. Methods of
    /// interpolation other than linear use it.
    Under,
    /// No triangle of the larger surface, or one that another part has.
    Elsewhere,
}

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

impl<B: AsRef<[u8]> + Sync> CompactTin<B> {
    /// Returns the triangles of the larger surface that this part has, in order, be they faces or
    /// not: together, those of all parts are the triangulation under the surface.
    ///
    /// What is damaged is left out; see [`Surface::ensure_intact`].
    ///
    /// # Complexity
    /// Constant for each cell.
    pub fn faces_under_whole(&self) -> impl Iterator<Item = BaseFace> + '_ {
        faces_under(self).filter(|face| self.has_bit(&self.under, face.number as usize))
    }

    /// Returns true if the part has a face, or a triangle under the surface.
    ///
    /// # Complexity
    /// Linear in the cells, of which a bit each is read.
    pub fn has_triangles(&self) -> bool {
        let bytes = self.triangulation.bytes();
        let has_bits = |range: &Range<usize>| {
            bytes
                .get(range.clone())
                .unwrap_or_default()
                .iter()
                .any(|bits| *bits != 0)
        };
        self.has_fragments() || has_bits(&self.inside) || has_bits(&self.under)
    }
}

impl CompactTin<Vec<u8>> {
    /// Opens a part of which some cells were undecided when its bytes were written: each is what is
    /// stated here. Counts and extent are found anew.
    ///
    /// # Errors
    /// If the bytes cannot be [opened](Self::open), or one of the numbers is not that of a cell.
    ///
    /// # Complexity
    /// Linear.
    pub fn open_with_cells(
        mut bytes: Vec<u8>,
        path: impl AsRef<Path>,
        cells: &[(u32, PartCell)],
    ) -> Result<Self> {
        let path = path.as_ref();
        let opened = CompactTin::open(bytes.as_slice(), path)?;
        let (inside, under, count) = (
            opened.inside.clone(),
            opened.under.clone(),
            opened.triangulation.cell_count(),
        );
        for &(cell, decided) in cells {
            let at = cell as usize;
            if at >= count || under.is_empty() {
                return Err(Error::format(format!(
                    "there is no cell {cell} of a part: there are {count}"
                ))
                .in_file(path));
            }
            bytes[inside.start + at / 8] |= u8::from(decided == PartCell::Face) << (at % 8);
            bytes[under.start + at / 8] |= u8::from(decided != PartCell::Elsewhere) << (at % 8);
        }
        let mut tin = Self::open(bytes, path)?;
        tin.attributes.facts = SurfaceFacts::of(&tin);
        tin.ensure_intact()?;
        Ok(tin)
    }
}
