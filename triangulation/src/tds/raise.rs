//! The dimension of a complex rises when a vertex leaves the flat that the others span.

use super::{CellId, Links, Tds, VertexId};

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Adds a vertex outside of the flat that the others span, which raises the dimension by one.
    ///
    /// The new sphere is the suspension of the old one: every cell joined to the new vertex, and
    /// every finite cell joined to the infinite one. All cells are replaced.
    ///
    /// Linear in the number of cells; happens at most `N` times.
    pub(crate) fn raise_dimension(&mut self, apex: VertexId) {
        assert!(
            self.dimension + 1 < N as i32,
            "the complex is full-dimensional"
        );
        let old = std::mem::take(&mut self.links);
        self.cell_data.clear();
        self.unused.clear();
        self.dimension += 1;
        if self.dimension == 0 {
            return self.join_first(apex);
        }
        // Cell `c` joined to the apex keeps its number; joined to infinity it gets a new one.
        let to_infinity = self.add_suspension(&old, apex);
        self.link_suspension(&old, &to_infinity);
        if self.dimension == 1 {
            // The two points of a sphere of dimension 0 are opposite, but one vertex has no
            // orientation to show it.
            (0..old.len())
                .filter(|&c| !is_finite(&old[c]))
                .for_each(|c| self.mirror(CellId::new(c)));
        }
        // The two halves of the suspension are mirror images.
        for above in to_infinity.into_iter().filter(|&c| c != CellId::NONE) {
            self.mirror(above);
        }
        for index in 0..self.links.len() {
            for slot in 0..N {
                let vertex = self.links[index].vertices[slot];
                if vertex != VertexId::NONE {
                    self.set_cell_of(vertex, CellId::new(index));
                }
            }
        }
    }

    /// Adds the two cells of a complex with one finite vertex.
    fn join_first(&mut self, only: VertexId) {
        let mut vertices = [VertexId::NONE; N];
        for vertex in [only, VertexId::INFINITE] {
            vertices[0] = vertex;
            let cell = self.add_cell(Links::alone(vertices), C::default());
            self.set_cell_of(vertex, cell);
        }
        self.link(CellId::new(0), 0, CellId::new(1), 0);
    }

    /// Adds all cells joined to the apex, under their numbers, then the finite ones joined to
    /// infinity; returns the numbers of these, by the old ones. Their neighbors are not known yet.
    fn add_suspension(&mut self, old: &[Links<N>], apex: VertexId) -> Vec<CellId> {
        let slot = self.dimension as usize; // of the vertex that each cell gains
        for (index, links) in old.iter().enumerate() {
            let mut vertices = links.vertices;
            vertices[slot] = apex;
            self.add_cell(Links::alone(vertices), C::default());
            if links.vertices[0] == VertexId::NONE {
                self.links[index] = Links::UNUSED;
            }
        }
        let mut to_infinity = vec![CellId::NONE; old.len()];
        for (index, links) in old.iter().enumerate().filter(|(_, links)| is_finite(links)) {
            let mut vertices = links.vertices;
            vertices[slot] = VertexId::INFINITE;
            to_infinity[index] = self.add_cell(Links::alone(vertices), C::default());
        }
        to_infinity
    }

    /// Links the cells of the suspension.
    fn link_suspension(&mut self, old: &[Links<N>], to_infinity: &[CellId]) {
        let slot = self.dimension as usize;
        for (index, links) in old.iter().enumerate() {
            let cell = CellId::new(index);
            if links.vertices[0] == VertexId::NONE {
                self.unused.push(cell);
                continue;
            }
            self.links[index].neighbors[..slot].copy_from_slice(&links.neighbors[..slot]);
            if is_finite(links) {
                let above = to_infinity[index];
                self.links[index].neighbors[slot] = above;
                self.links[above.index()].neighbors[slot] = cell;
                for i in 0..slot {
                    let beside = links.neighbors[i];
                    let is_joined = is_finite(&old[beside.index()]);
                    self.links[above.index()].neighbors[i] = if is_joined {
                        to_infinity[beside.index()]
                    } else {
                        beside
                    };
                }
            } else {
                // The facet without the apex is that of the neighboring finite cell, joined to
                // infinity.
                let at_infinity = links
                    .vertices
                    .iter()
                    .position(|&v| v == VertexId::INFINITE)
                    .unwrap_or(0);
                self.links[index].neighbors[slot] =
                    to_infinity[links.neighbors[at_infinity].index()];
            }
        }
    }

    /// Reverses the orientation of a cell.
    fn mirror(&mut self, cell: CellId) {
        let links = &mut self.links[cell.index()];
        links.vertices.swap(0, 1);
        links.neighbors.swap(0, 1);
    }

    /// Reverses the orientation of every cell, from dimension 1 on.
    pub(crate) fn mirror_all(&mut self) {
        for index in 0..self.links.len() {
            self.mirror(CellId::new(index));
        }
    }
}

/// Returns true for a cell in use without the infinite vertex.
fn is_finite<const N: usize>(links: &Links<N>) -> bool {
    links.vertices[0] != VertexId::NONE && !links.vertices.contains(&VertexId::INFINITE)
}
