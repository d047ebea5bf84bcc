//! Removal of a vertex in space, from a triangulation of any dimension.
//!
//! The cells around the vertex leave a hole, and the triangulation of the other vertices has the
//! same cells outside of it. Within the hull, the hole is nearly always filled cell by cell
//! ([`wrap`](super::wrap)). Points that a regular triangulation hides are inserted afterwards.
//!
//! *Otherwise*: the cells within have vertices of its border only, and each of them is also a cell
//! of the triangulation of these vertices alone; there they are the conflict zone of the removed
//! point. So a small triangulation of the neighbors is built by insertion, and the zone is copied
//! into the hole (Devillers and Teillaud 2003: with ties broken by a rule that depends on the
//! points only, it fits).
//!
//! *Neighbors of a lower dimension.* If they lie in a plane and there are other vertices, then
//! these are on the far side of that plane, and the removed point was a corner of the hull: each
//! facet that it was joined to becomes one of the hull. If there are no other vertices, the
//! dimension sinks, and the small triangulation is the result. The same holds in a plane and on a
//! line.
//!
//! *Where nothing fits.* With predicates that contradict each other (the kernel
//! [`Fast`](crate::kernel::Fast)), or without the law, the zone may have another border than the
//! hole. All other vertices are then inserted again, each by a split of what it lies on, which
//! needs no law.

use crate::geometry::Geometry;
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

use super::wrap::{Filling, filling};

/// A triangulation of some of the vertices, which are its payloads.
type Local<'a, G> = Triangulation<&'a G, 4, VertexId>;

impl<G: Geometry<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Removes a vertex, and restores the law of the geometry. Returns true if all cells were
    /// replaced, because the dimension is lower now or nothing else fitted; otherwise only the
    /// cells at the vertex were.
    ///
    /// # Complexity
    /// A product: of the number of neighbors, and of the cells that fill the hole. On the hull, or
    /// with many neighbors, that of inserting these, one by one, into a triangulation of their own.
    pub(crate) fn remove_vertex_in_space(&mut self, vertex: VertexId) -> bool {
        let star = self.tds.cells_around(vertex);
        let is_filled = match filling(self, vertex, &star) {
            Some(Filling { cells, sides }) => {
                self.tds.refill_star(&star, &cells, &sides);
                true
            }
            None => {
                let hole = self.cells_without(vertex, &star);
                hole.is_some_and(|cells| self.tds.replace_star(&star, &cells))
            }
        };
        if !is_filled {
            self.replace_all_without(vertex);
        }
        self.tds.remove_vertex(vertex);
        self.last = self.tds.cell_of(VertexId::INFINITE);
        !is_filled
    }

    /// Returns the cells that fill the hole; `None` if the dimension changes.
    pub(super) fn cells_without(
        &self,
        vertex: VertexId,
        star: &[(CellId, usize)],
    ) -> Option<Vec<[VertexId; 4]>> {
        let mut neighbors = self.tds.vertices_around(vertex);
        neighbors.retain(|&v| v != VertexId::INFINITE);
        let mut local = self.local(&neighbors, |t, beyond, p| t.in_conflict(beyond, p));
        if local.dimension() == self.dimension() {
            let p = self.point(vertex);
            let location = local.locate(p, None);
            let zone = local.collect(location, |t, _, _, beyond| t.in_conflict(beyond, p))?;
            return Some(
                zone.cells()
                    .iter()
                    .map(|&cell| corners(&local, cell))
                    .collect(),
            );
        }
        if neighbors.len() + 1 == self.vertex_count() {
            return None;
        }
        let finite = star
            .iter()
            .filter(|&&(cell, _)| !self.tds.is_infinite(cell));
        let to_infinity = finite.map(|&(cell, i)| {
            let mut corners = *self.tds.corners(cell);
            corners[i] = VertexId::INFINITE;
            corners
        });
        Some(to_infinity.collect())
    }

    /// Replaces all cells by those of a triangulation of the other vertices: by the law if that
    /// contains them all, otherwise by splits.
    fn replace_all_without(&mut self, vertex: VertexId) {
        let others: Vec<VertexId> = self.tds.vertices().filter(|&v| v != vertex).collect();
        let mut dimension = self.dimension();
        let mut cells: Vec<[VertexId; 4]> = Vec::new();
        for by_law in [true, false] {
            let local = self.local(&others, |t, beyond, p| {
                if by_law {
                    t.in_conflict(beyond, p)
                } else {
                    t.is_split_by(beyond, p)
                }
            });
            if local.vertex_count() == others.len()
                && local.tds.vertices().all(|v| has_cell(&local, v))
            {
                dimension = local.dimension();
                cells = local
                    .tds
                    .cells()
                    .map(|cell| corners(&local, cell))
                    .collect();
                break;
            }
        }
        let is_whole = self.tds.replace_all(dimension, &cells);
        debug_assert!(is_whole, "cells of a complex fit together");
    }

    /// Returns the triangulation of some vertices. `takes` decides which cells a point replaces.
    fn local(
        &self,
        vertices: &[VertexId],
        takes: impl Fn(&Local<G>, CellId, &G::Point) -> bool,
    ) -> Local<'_, G> {
        let mut local = Triangulation::new(&self.geometry);
        for &vertex in vertices {
            let p = self.point(vertex);
            let location = local.locate(p, None);
            local.insert_at(
                *p,
                location,
                vertex,
                |t, _, _, beyond| takes(t, beyond, p),
                |(), _| (),
            );
        }
        local
    }
}

/// Returns true if a vertex is in the cell that is stored for it, so that no insertion of another
/// one has removed it from the complex.
fn has_cell<G: Geometry<4>>(local: &Local<G>, vertex: VertexId) -> bool {
    local
        .tds
        .cell_of(vertex)
        .is_some_and(|cell| local.tds.is_used(cell) && local.tds.index_of(cell, vertex).is_some())
}

/// Returns the vertices of a cell of a small triangulation, by their numbers in the large one.
fn corners<G: Geometry<4>>(local: &Local<G>, cell: CellId) -> [VertexId; 4] {
    let mut corners = [VertexId::NONE; 4];
    for (corner, &v) in corners.iter_mut().zip(local.tds.cell_vertices(cell)) {
        *corner = if v == VertexId::INFINITE {
            v
        } else {
            *local.tds.vertex_data(v)
        };
    }
    corners
}
