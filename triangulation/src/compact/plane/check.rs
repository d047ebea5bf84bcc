//! The check of a triangulation of the plane.

use crate::compact::{Compact, CompactError};
use crate::flaw::Level;
use crate::geometry::Geometry;
use crate::tds::{Complex, Star, VertexId, vertices_of};

impl<G: Geometry<3, Point = [f64; D]>, B: AsRef<[u8]>, const D: usize> Compact<G, B> {
    /// Checks all bytes, up to a level. No error means that they are a triangulation; at
    /// [`Level::Law`], also that it satisfies the law that it claims. Exact, in time proportional
    /// to the number of cells, and in constant memory.
    ///
    /// # Errors
    /// The first damage that is found.
    pub fn check(&self, level: Level) -> Result<(), CompactError> {
        self.check_numbers()?;
        self.check_links()?;
        if level >= Level::Manifold {
            self.check_manifold()?;
        }
        self.check_geometry(level)
    }

    /// Checks that neighbors know each other and share their facet with opposite orientations.
    fn check_links(&self) -> Result<(), CompactError> {
        let width = self.width();
        for cell in self.cells() {
            let corners = self.corners(cell)?;
            for i in 0..width {
                let beside = self.neighbor(cell, i)?;
                let j = self.index_of_neighbor(beside, cell)?;
                let others = self.corners(beside)?;
                // Once around from the vertex opposite the facet: in mirrored order on the other
                // side.
                let is_shared =
                    (1..width).all(|k| corners[(i + k) % width] == others[(j + width - k) % width]);
                let is_turned = width != 2 || i != j;
                self.ensure(cell, || beside != cell && is_shared && is_turned)?;
            }
        }
        Ok(())
    }

    /// Checks that the cells met around each vertex are all that contain it. With Euler's formula,
    /// which the header satisfies, and the orientation check only a sphere remains.
    fn check_manifold(&self) -> Result<(), CompactError> {
        if self.dimension() < 1 {
            return Ok(());
        }
        let mut corners = 0;
        for vertex in vertices_of(self).chain([Ok(VertexId::INFINITE)]) {
            for cell in Star::new(self, vertex?, 1)? {
                cell?;
                corners += 1;
            }
        }
        if corners == self.width() * self.cell_count() {
            Ok(())
        } else {
            Err(CompactError::Header("the cells are not connected"))
        }
    }
}
