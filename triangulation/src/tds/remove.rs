//! Removal of vertices, and complexes that shrink to a line, to a point, or to nothing.

use super::{CellId, Links, Tds, VertexId};

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Frees the number of a vertex that is in no cell any more. Its payload stays until the number
    /// is reused.
    pub(crate) fn remove_vertex(&mut self, vertex: VertexId) {
        self.vertex_cell[vertex.index()] = CellId::NONE;
        self.unused_vertices.push(vertex);
    }

    /// Reuses the number that was freed last, with its payload, and returns it.
    pub(crate) fn restore_vertex(&mut self) -> Option<VertexId> {
        self.unused_vertices.pop()
    }

    /// Replaces the complex by that of vertices along a line, in this order: of dimension 1, or 0
    /// for one vertex, and -1 for none. All cells are replaced.
    pub(crate) fn set_line(&mut self, line: &[VertexId]) {
        self.links.clear();
        self.cell_data.clear();
        self.unused.clear();
        self.infinite_cell = CellId::NONE;
        self.dimension = line.len().min(2) as i32 - 1;
        if line.is_empty() {
            return;
        }
        // The line is closed at infinity: a ring whose cells join each vertex to the next.
        let ring: Vec<VertexId> = line.iter().copied().chain([VertexId::INFINITE]).collect();
        for (k, &from) in ring.iter().enumerate() {
            let mut vertices = [VertexId::NONE; N];
            vertices[0] = from;
            if self.dimension == 1 {
                vertices[1] = ring[(k + 1) % ring.len()];
            }
            let cell = self.add_cell(Links::alone(vertices), C::default());
            self.set_cell_of(from, cell);
        }
        let last = CellId::new(ring.len() - 1);
        match self.dimension {
            0 => self.link(CellId::new(0), 0, last, 0),
            _ => {
                (1..ring.len()).for_each(|k| self.link(CellId::new(k - 1), 0, CellId::new(k), 1));
                self.link(last, 0, CellId::new(0), 1);
            }
        }
    }

    /// Replaces the two cells at a vertex by one, in a complex of dimension 1 that has at least two
    /// other vertices.
    pub(crate) fn skip(&mut self, vertex: VertexId) {
        let Some(cell) = self.cell_of(vertex) else {
            return;
        };
        let (before, after) = match self.index_of(cell, vertex) {
            Some(1) => (cell, self.neighbor(cell, 0)),
            _ => (self.neighbor(cell, 1), cell),
        };
        let (to, beyond) = (self.vertex(after, 1), self.neighbor(after, 0));
        self.links[before.index()].vertices[1] = to;
        self.cell_data[before.index()] = C::default();
        self.link(before, 0, beyond, 1);
        self.set_cell_of(to, before);
        self.remove_cell(after);
    }
}
