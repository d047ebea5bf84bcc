//! Removal of a vertex from a Delaunay triangulation in space, of any dimension.
//!
//! The cells around the vertex leave a hole, and the triangulation of the other points has the same
//! cells outside of it. Those within have vertices of its border only, and each of them is also a
//! cell of the triangulation of these vertices alone; there they are the conflict zone of the
//! removed point. So a small triangulation of the neighbors is built by insertion, and the zone is
//! copied into the hole (Devillers and Teillaud 2003: with ties broken by a rule that depends on
//! the points only, it fits).
//!
//! *Neighbors of a lower dimension.* If they lie in a plane and there are other points, then on the
//! far side of that plane, and the removed point was a corner of the hull: each facet that it was
//! joined to becomes one of the hull. If there are no other points, the dimension sinks, and the
//! small triangulation is the result. The same holds in a plane and on a line.

use crate::geometry::Geometry;
use crate::tds::{CellId, VertexId};

use super::super::Triangulation;

/// What replaces the cells around a vertex.
enum Filling {
    /// Cells in the hole.
    Hole(Vec<[VertexId; 4]>),
    /// All cells, of a lower dimension.
    All(i32, Vec<[VertexId; 4]>),
}

impl<G: Geometry<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Removes a vertex and restores the Delaunay law. Only the cells at the vertex are replaced;
    /// all if the dimension becomes lower.
    ///
    /// # Complexity
    /// That of inserting the neighbors, one by one, into a triangulation of their own.
    pub(in super::super) fn remove_vertex_in_space(&mut self, vertex: VertexId) {
        let star = self.tds.cells_around(vertex);
        match self.filling(vertex) {
            Filling::Hole(cells) => self.tds.replace_star(&star, &cells),
            Filling::All(dimension, cells) => self.tds.replace_all(dimension, &cells),
        }
        self.tds.remove_vertex(vertex);
        self.last = self.tds.cell_of(VertexId::INFINITE);
    }

    fn filling(&self, vertex: VertexId) -> Filling {
        let mut neighbors = self.tds.vertices_around(vertex);
        neighbors.retain(|&v| v != VertexId::INFINITE);
        let mut local: Triangulation<&G, 4, VertexId> = Triangulation::new(&self.geometry);
        for &neighbor in &neighbors {
            let p = self.point(neighbor);
            let location = local.locate(p, None);
            local.insert_at(*p, location, neighbor, |t, _, _, beyond| t.in_conflict(beyond, p), |(), _| ());
        }
        if local.dimension() < self.dimension() {
            if neighbors.len() + 1 == self.vertex_count() {
                return Filling::All(local.dimension(), local.tds.cells().map(|cell| corners(&local, cell)).collect());
            }
            let star = self.tds.cells_around(vertex).into_iter();
            let facets = star.filter(|&(cell, _)| !self.tds.is_infinite(cell)).map(|(cell, i)| {
                let mut corners = *self.tds.corners(cell);
                corners[i] = VertexId::INFINITE;
                corners
            });
            return Filling::Hole(facets.collect());
        }
        let p = self.point(vertex);
        let location = local.locate(p, None);
        let zone = local.collect(location, |t, _, _, beyond| t.in_conflict(beyond, p)).unwrap_or_default();
        Filling::Hole(zone.cells().iter().map(|&cell| corners(&local, cell)).collect())
    }
}

/// Returns the vertices of a cell of the small triangulation, by their numbers in the large one.
fn corners<G: Geometry<4>>(local: &Triangulation<&G, 4, VertexId>, cell: CellId) -> [VertexId; 4] {
    let mut corners = [VertexId::NONE; 4];
    for (corner, &v) in corners.iter_mut().zip(local.tds.cell_vertices(cell)) {
        *corner = if v == VertexId::INFINITE { v } else { *local.tds.vertex_data(v) };
    }
    corners
}
