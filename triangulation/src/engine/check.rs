use std::borrow::Borrow;

use crate::embedded::Embedded;
use crate::embedded::sides::{in_conflict, leaves_flat, points_with, side_of_facet, simplex};
use crate::flaw::{Flaw, Level};
use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{self, CellId, Complex, VertexId};
use crate::triangulation::Triangulation;

/// Returns true if a finite cell is positively oriented, below full dimension in the line or plane
/// of all points.
pub(crate) fn is_positive<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
) -> Result<bool, T::Error> {
    if t.complex().width() < N {
        let first = t.point(t.complex().vertex(cell, 0)?)?;
        let points = points_with(t, cell, 0, first.borrow())?;
        return Ok(t
            .geometry()
            .orientation_in_flat(&points.iter().collect::<Vec<_>>())
            == Sign::Positive);
    }
    let simplex = simplex(t, cell)?;
    Ok(t.geometry()
        .orientation(simplex.each_ref().map(Borrow::borrow))
        == Sign::Positive)
}

/// Returns true if the hull is convex between two infinite cells: one whose vertex at `infinite` is
/// the infinite one, and the one beyond its facet `i`.
pub(crate) fn is_convex<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    infinite: usize,
    i: usize,
) -> Result<bool, T::Error> {
    let far = vertex_beyond(t, cell, i)?;
    Ok(far == VertexId::INFINITE
        || side_of_facet(t, cell, infinite, t.point(far)?.borrow())? != Sign::Positive)
}

/// Returns true if the sphere of a finite cell does not contain the vertex beyond its facet `i`,
/// ties decided.
pub(crate) fn is_empty<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    i: usize,
) -> Result<bool, T::Error> {
    let far = vertex_beyond(t, cell, i)?;
    Ok(far == VertexId::INFINITE || !in_conflict(t, cell, t.point(far)?.borrow())?)
}

fn vertex_beyond<const N: usize, T: Embedded<N>>(
    t: &T,
    cell: CellId,
    i: usize,
) -> Result<VertexId, T::Error> {
    let neighbor = t.complex().neighbor(cell, i)?;
    t.complex()
        .vertex(neighbor, t.complex().index_of_neighbor(neighbor, cell)?)
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Checks up to the given level, with exact predicates, and returns all flaws of the first
    /// level that has any. The law is that of a Delaunay triangulation, tested at the facets that
    /// `passes` accepts.
    pub(crate) fn flaws(&self, level: Level, passes: impl Fn(CellId, usize) -> bool) -> Vec<Flaw> {
        let structure =
            |flaws: Vec<tds::TdsError>| flaws.into_iter().map(Flaw::Structure).collect::<Vec<_>>();
        let checks: [(Level, &dyn Fn() -> Vec<Flaw>); 4] = [
            (Level::Links, &|| structure(self.tds.check_links())),
            (Level::Manifold, &|| structure(self.tds.check_sphere())),
            (Level::Orientation, &|| self.check_orientation()),
            (Level::Law, &|| self.check_empty_spheres(&passes)),
        ];
        let found = checks
            .iter()
            .filter(|(l, _)| *l <= level)
            .map(|(_, check)| check());
        found
            .into_iter()
            .find(|flaws| !flaws.is_empty())
            .unwrap_or_default()
    }

    /// Returns the flaws of the tiling of the convex hull, with exact predicates. Checks
    /// [`Level::Links`], [`Level::Manifold`] and [`Level::Orientation`], which hold for every kind;
    /// for the law, use the `check` of the kind.
    #[must_use]
    pub fn check_tiling(&self) -> Vec<Flaw> {
        self.flaws(Level::Orientation, |_, _| false)
    }

    fn check_orientation(&self) -> Vec<Flaw> {
        let width = self.tds.width();
        let mut flaws = Vec::new();
        if width < 2 {
            return flaws;
        }
        if let Some(cell) = self.finite_cells().next().filter(|_| !self.is_full()) {
            flaws.extend(self.tds.vertices().filter_map(|vertex| {
                let Ok(leaves) = leaves_flat(self, cell, self.point(vertex));
                leaves.then_some(Flaw::NotInFlat(vertex))
            }));
        }
        for cell in self.tds.cells() {
            let Some(infinite) = self.tds.index_of(cell, VertexId::INFINITE) else {
                let Ok(is_positive) = is_positive(self, cell);
                flaws.extend((!is_positive).then_some(Flaw::Orientation(cell)));
                continue;
            };
            // The far vertex of every adjacent hull facet must not see this one.
            // On a line, where each edge runs upward, none does.
            for i in (0..width).filter(|&i| i != infinite && width > 2) {
                let Ok(is_convex) = is_convex(self, cell, infinite, i);
                flaws.extend((!is_convex).then_some(Flaw::NotConvex(cell, i)));
            }
        }
        flaws
    }

    /// Works below full dimension, too: on a line, a point that should be hidden lies in the sphere
    /// of an adjacent edge.
    fn check_empty_spheres(&self, passes: &dyn Fn(CellId, usize) -> bool) -> Vec<Flaw> {
        let mut flaws = Vec::new();
        for cell in self.finite_cells() {
            for i in (0..self.tds.cell_vertices(cell).len()).filter(|&i| passes(cell, i)) {
                let Ok(is_empty) = is_empty(self, cell, i);
                flaws.extend((!is_empty).then_some(Flaw::NotDelaunay(cell, i)));
            }
        }
        flaws
    }
}
