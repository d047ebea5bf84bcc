//! The checks that are the same in the plane and in space.

use crate::geometry::Geometry;
use crate::tds::{CellId, Complex, VertexId, vertices_of};

use crate::embedded::sides::leaves_flat;
use crate::engine::check::{is_convex, is_empty, is_positive};
use crate::flaw::Level;

use super::{Compact, CompactError, Law};

impl<G: Geometry<N, Point = [f64; D]>, B: AsRef<[u8]>, const N: usize, const D: usize>
    Compact<G, B, N>
{
    pub(super) fn cells(&self) -> impl Iterator<Item = CellId> + use<G, B, N, D> {
        (0..self.cell_count()).map(CellId::new)
    }

    /// Checks that every number exists, that every point is admitted, and that no cell has a vertex
    /// twice.
    pub(super) fn check_numbers(&self) -> Result<(), CompactError> {
        let infinite = self
            .cell_of(VertexId::INFINITE)?
            .map(|_| Ok(VertexId::INFINITE));
        for vertex in vertices_of(self).chain(infinite) {
            let vertex = vertex?;
            if vertex != VertexId::INFINITE {
                self.point(vertex)?;
            }
            if let Some(cell) = self.cell_of(vertex)? {
                let has_it = self.index_of(cell, vertex)?.is_some();
                self.ensure(cell, || has_it)?;
            }
        }
        for cell in self.cells() {
            let corners = self.corners(cell)?;
            self.ensure(cell, || {
                (1..self.width()).all(|i| !corners[..i].contains(&corners[i]))
            })?;
        }
        Ok(())
    }

    /// Checks the levels that need points.
    pub(super) fn check_geometry(&self, level: Level) -> Result<(), CompactError> {
        if level >= Level::Orientation {
            self.check_orientation()?;
        }
        // In the plane, no law is claimed below full dimension.
        if level >= Level::Law && self.width() > 2 {
            self.check_law()?;
        }
        Ok(())
    }

    /// Checks that finite cells are positively oriented and the hull is convex, see
    /// [`Level::Orientation`]; below full dimension, that no vertex is outside of the line or plane
    /// of all others.
    fn check_orientation(&self) -> Result<(), CompactError> {
        let width = self.width();
        let mut first = None;
        for cell in self.cells().filter(|_| width > 1) {
            let corners = self.corners(cell)?;
            let Some(infinite) = corners.iter().position(|&v| v == VertexId::INFINITE) else {
                let is_positive = is_positive(self, cell)?;
                self.ensure(cell, || is_positive)?;
                first = first.or(Some(cell));
                continue;
            };
            for i in (0..width).filter(|&i| i != infinite && width > 2) {
                let is_convex = is_convex(self, cell, infinite, i)?;
                self.ensure(cell, || is_convex)?;
            }
        }
        if let Some(first) = first.filter(|_| width < N) {
            for vertex in vertices_of(self) {
                let vertex = vertex?;
                if leaves_flat(self, first, &self.point(vertex)?)? {
                    return Err(CompactError::Vertex(vertex));
                }
            }
        }
        Ok(())
    }

    /// Checks that constraints are set on both sides, and that spheres are empty as far as the law
    /// demands.
    fn check_law(&self) -> Result<(), CompactError> {
        let is_delaunay = matches!(self.law(), Law::Delaunay | Law::ConstrainedDelaunay);
        for cell in self.cells() {
            let is_finite = !self.is_infinite(cell)?;
            for i in 0..self.width() {
                let beside = self.neighbor(cell, i)?;
                let is_constrained = self.is_constrained(cell, i)?;
                let is_other =
                    self.is_constrained(beside, self.index_of_neighbor(beside, cell)?)?;
                self.ensure(cell, || is_constrained == is_other)?;
                let is_lawful =
                    !is_delaunay || !is_finite || is_constrained || is_empty(self, cell, i)?;
                self.ensure(cell, || is_lawful)?;
            }
        }
        Ok(())
    }
}
