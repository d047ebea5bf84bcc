//! New payloads of all vertices or cells.

use crate::geometry::Geometry;
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Returns the triangulation with new payloads of all vertices, in order of their numbers.
    pub(crate) fn with_vertex_data<W>(
        self,
        data: impl FnMut(VertexId) -> W,
    ) -> Triangulation<G, N, W, C> {
        let data = (0..self.tds.vertex_slots())
            .map(VertexId::new)
            .map(data)
            .collect();
        self.with_data_of_all(data)
    }

    fn with_data_of_all<W>(self, data: Vec<W>) -> Triangulation<G, N, W, C> {
        let Triangulation {
            geometry,
            tds,
            points,
            zone,
            last,
        } = self;
        Triangulation {
            geometry,
            tds: tds.with_vertex_data(data),
            points,
            zone,
            last,
        }
    }

    /// Returns the triangulation with payloads of points, given the vertex of each point. `data` is
    /// called once for each vertex, with the position of its first point, in increasing order. Each
    /// vertex must have a point.
    pub(crate) fn with_data_of_points<W>(
        self,
        vertices: &[VertexId],
        data: impl FnMut(usize) -> W,
    ) -> Triangulation<G, N, W, C> {
        let data = data_of_points(self.tds.vertex_slots(), vertices, data);
        self.with_data_of_all(data.into_iter().flatten().collect())
    }

    /// Like [`with_data_of_points`](Self::with_data_of_points), but vertices without a point have
    /// the default payload.
    pub(crate) fn with_data_of_some<W: Default>(
        self,
        vertices: &[VertexId],
        data: impl FnMut(usize) -> W,
    ) -> Triangulation<G, N, W, C> {
        let data = data_of_points(self.tds.vertex_slots(), vertices, data);
        self.with_data_of_all(data.into_iter().map(Option::unwrap_or_default).collect())
    }

    /// Returns the triangulation with new payloads of all cells, in order of their numbers.
    pub(crate) fn with_cell_data<D: Copy + Default>(
        self,
        mut data: impl FnMut(CellId) -> D,
    ) -> Triangulation<G, N, V, D> {
        self.map_cell_data(|cell, _| data(cell))
    }

    /// Returns the triangulation with new payloads of cells, computed from the old ones.
    pub(crate) fn map_cell_data<D: Copy + Default>(
        self,
        data: impl FnMut(CellId, &C) -> D,
    ) -> Triangulation<G, N, V, D> {
        let Triangulation {
            geometry,
            tds,
            points,
            zone,
            last,
        } = self;
        Triangulation {
            geometry,
            tds: tds.map_cell_data(data),
            points,
            zone,
            last,
        }
    }
}

/// Returns the payload of each vertex that has a point, by number. `data` is called with the
/// position of the vertex's first point, in increasing order.
fn data_of_points<V>(
    slots: usize,
    vertices: &[VertexId],
    mut data: impl FnMut(usize) -> V,
) -> Vec<Option<V>> {
    let mut payloads: Vec<Option<V>> = Vec::new();
    payloads.resize_with(slots, || None);
    for (position, vertex) in vertices.iter().enumerate() {
        payloads[vertex.index()].get_or_insert_with(|| data(position));
    }
    payloads
}
