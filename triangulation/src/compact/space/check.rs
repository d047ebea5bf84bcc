//! The check of a triangulation of space.

use crate::compact::{Compact, CompactError};
use crate::flaw::Level;
use crate::geometry::Geometry;
use crate::tds::{Complex, Parts, Tds, TdsError};

impl From<TdsError> for CompactError {
    fn from(error: TdsError) -> Self {
        match error {
            TdsError::Vertex { cell, .. }
            | TdsError::Neighbor { cell, .. }
            | TdsError::OneCell { cell, .. }
            | TdsError::ThreeCells { cell, .. }
            | TdsError::NotMutual { cell, .. }
            | TdsError::NotOriented { cell, .. } => CompactError::Cell(cell),
            TdsError::CellOfVertex(vertex)
            | TdsError::Isolated(vertex)
            | TdsError::Link(vertex) => CompactError::Vertex(vertex),
            _ => CompactError::Header("the cells are not connected"),
        }
    }
}

impl<G: Geometry<4, Point = [f64; D]>, B: AsRef<[u8]>, const D: usize> Compact<G, B, 4> {
    /// Checks all bytes, up to a level. No error means that they are a triangulation; at
    /// [`Level::Law`], also that it satisfies the law that it claims. Exact, in time and memory
    /// proportional to the number of cells: links are compared with those that the vertices of the
    /// cells demand.
    ///
    /// # Errors
    /// The first damage that is found.
    pub fn check(&self, level: Level) -> Result<(), CompactError> {
        self.check_numbers()?;
        let width = self.width();
        let mut cells = Vec::with_capacity(width * self.cell_count());
        for cell in self.cells() {
            cells.extend(&self.corners(cell)?[..width]);
        }
        let tds: Tds<4> = Tds::from_parts(Parts {
            dimension: self.dimension(),
            cells,
            cell_data: vec![(); self.cell_count()],
            vertex_data: vec![(); self.vertex_count()],
            free: Vec::new(),
        })?;
        if let Some(&alone) = tds.detached_vertices().first() {
            return Err(CompactError::Vertex(alone));
        }
        for cell in self.cells() {
            for i in 0..width {
                let beside = self.neighbor(cell, i)?;
                self.ensure(cell, || beside == tds.neighbor(cell, i))?;
            }
        }
        if level >= Level::Manifold
            && let Some(flaw) = tds.check_sphere().into_iter().next()
        {
            return Err(flaw.into());
        }
        self.check_geometry(level)
    }
}
