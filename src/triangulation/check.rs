use crate::geometry::{Geometry, in_sphere};
use crate::num::Sign;
use crate::tds::{self, CellId, VertexId};

use super::{LineId, Triangulation};

/// How far a check goes. Each level assumes the ones before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Cells, neighbors and vertices know each other.
    Links = 1,
    /// The cells form one sphere.
    Manifold = 2,
    /// Every finite cell is positively oriented and the border is convex, which together prove that
    /// the cells tile the convex hull without overlap (Devillers, Liotta, Preparata, Tamassia 1998).
    Orientation = 3,
    /// The kind's own law, ties included.
    Law = 4,
}

/// What a check found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    /// Level 1 or 2.
    Structure(tds::Flaw),
    /// Level 3: a cell that is flat or turned around.
    Orientation(CellId),
    /// Level 3: beyond facet `i` of this infinite cell the hull turns inwards.
    NotConvex(CellId, usize),
    /// Level 4: the vertex beyond facet `i` lies in the cell's circumscribed sphere.
    NotDelaunay(CellId, usize),
    /// Level 4: a hidden point is not in the cell that is said to hide it, or ought to be seen.
    Hidden(VertexId),
    /// Level 4: an edge is constrained on one side only.
    OneSided(CellId, usize),
    /// Level 4: between these two vertices of a line's chain there is no constrained edge.
    Line(LineId, VertexId, VertexId),
    /// Level 4: a piece of a constraint, between these vertices, was left out when its crossings did not come
    /// to an end.
    Missing(VertexId, VertexId),
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Checks up to the level, with exact predicates, and returns all flaws of the first level that has
    /// any. The law is that of a Delaunay triangulation wherever `passes` lets it act.
    pub(super) fn flaws(&self, level: Level, passes: impl Fn(CellId, usize) -> bool) -> Vec<Flaw> {
        let structure = |flaws: Vec<tds::Flaw>| flaws.into_iter().map(Flaw::Structure).collect::<Vec<_>>();
        let checks: [(Level, &dyn Fn() -> Vec<Flaw>); 4] = [
            (Level::Links, &|| structure(self.tds.check_links())),
            (Level::Manifold, &|| structure(self.tds.check_manifold())),
            (Level::Orientation, &|| self.check_orientation()),
            (Level::Law, &|| self.check_empty_spheres(&passes)),
        ];
        let found = checks.iter().filter(|(l, _)| *l <= level).map(|(_, check)| check());
        found.into_iter().find(|flaws| !flaws.is_empty()).unwrap_or_default()
    }

    fn check_orientation(&self) -> Vec<Flaw> {
        let mut flaws = Vec::new();
        if !self.is_full() {
            return flaws;
        }
        for cell in self.tds.cells() {
            let Some(infinite) = self.tds.index_of(cell, VertexId::INFINITE) else {
                if self.geometry.orientation(self.simplex(cell)) != Sign::Positive {
                    flaws.push(Flaw::Orientation(cell));
                }
                continue;
            };
            // The far vertex of every hull facet beside this one must not be in sight.
            for i in (0..N).filter(|&i| i != infinite) {
                let beside = self.tds.neighbor(cell, i);
                let far = self.tds.vertex(beside, self.tds.index_of_neighbor(beside, cell));
                if far != VertexId::INFINITE && self.side_of_facet(cell, infinite, self.point(far)) == Sign::Positive {
                    flaws.push(Flaw::NotConvex(cell, i));
                }
            }
        }
        flaws
    }

    fn check_empty_spheres(&self, passes: &dyn Fn(CellId, usize) -> bool) -> Vec<Flaw> {
        let mut flaws = Vec::new();
        if !self.is_full() {
            return flaws;
        }
        for cell in self.finite_cells() {
            for i in (0..N).filter(|&i| passes(cell, i)) {
                let beside = self.tds.neighbor(cell, i);
                let far = self.tds.vertex(beside, self.tds.index_of_neighbor(beside, cell));
                if far != VertexId::INFINITE && in_sphere(&self.geometry, self.simplex(cell), self.point(far)) {
                    flaws.push(Flaw::NotDelaunay(cell, i));
                }
            }
        }
        flaws
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> super::Delaunay<G, N, V, C> {
    /// Checks up to the level, with exact predicates; no flaw means that the triangulation is what it
    /// claims to be.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        self.flaws(level, |_, _| true)
    }
}
