use std::collections::HashSet;

use super::{CellId, Tds, VertexId};

/// What is wrong with a complex of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flaw {
    /// A cell names a vertex or a neighbor that does not exist, or one twice.
    Links(CellId),
    /// The neighbor across facet `i` does not know this cell, or has another facet there.
    NotMutual(CellId, usize),
    /// Two neighbors are not oriented alike.
    NotOriented(CellId, usize),
    /// The cell that a vertex names does not have it.
    CellOfVertex(VertexId),
    /// The cells around a vertex do not form one piece.
    NotManifold(VertexId),
    /// The numbers of vertices, edges, faces and cells are not those of a sphere; the
    /// characteristic is given.
    Euler(i64),
}

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Level 1: links. Every cell has distinct, existing vertices and neighbors, neighbors know each
    /// other and share their facet with opposite orientation, and vertices know a cell of theirs.
    #[must_use]
    pub fn check_links(&self) -> Vec<Flaw> {
        let mut flaws = Vec::new();
        for cell in self.cells() {
            let vertices = self.cell_vertices(cell);
            let exists = |v: VertexId| v == VertexId::INFINITE || self.is_vertex(v);
            let sound = vertices.iter().enumerate().all(|(i, &v)| exists(v) && !vertices[..i].contains(&v))
                && self.cell_neighbors(cell).iter().all(|&n| self.is_used(n) && n != cell);
            if !sound {
                flaws.push(Flaw::Links(cell));
            }
        }
        if !flaws.is_empty() {
            return flaws; // the rest would stumble
        }
        for cell in self.cells() {
            for (i, &beside) in self.cell_neighbors(cell).iter().enumerate() {
                match self.shared_facet(cell, i, beside) {
                    None => flaws.push(Flaw::NotMutual(cell, i)),
                    Some(false) => flaws.push(Flaw::NotOriented(cell, i)),
                    Some(true) => {}
                }
            }
        }
        let mut detached = self.detached;
        let holes: HashSet<VertexId> = self.unused_vertices.iter().copied().collect();
        for vertex in (0..self.vertex_slots()).map(VertexId::new).chain([VertexId::INFINITE]) {
            let sound = match self.cell_of(vertex) {
                Some(cell) => {
                    self.is_used(cell) && self.cell_vertices(cell).contains(&vertex) && !holes.contains(&vertex)
                }
                None if vertex == VertexId::INFINITE => self.dimension() == -1,
                None if holes.contains(&vertex) => true,
                None => {
                    let is_detached = detached > 0;
                    detached -= usize::from(is_detached);
                    is_detached
                }
            };
            if !sound {
                flaws.push(Flaw::CellOfVertex(vertex));
            }
        }
        flaws
    }

    /// Whether the facet is the same on both sides, and if so, whether the orientations fit: that of
    /// the neighbor, with its opposite vertex put in place of ours, is the odd permutation.
    fn shared_facet(&self, cell: CellId, i: usize, beside: CellId) -> Option<bool> {
        let width = self.cell_vertices(cell).len();
        let j = (0..width).find(|&j| {
            self.neighbor(beside, j) == cell
                && (0..width)
                    .filter(|&k| k != j)
                    .all(|k| self.index_of(cell, self.vertex(beside, k)).is_some_and(|at| at != i))
        })?;
        // Where each vertex of the neighbor stands in this cell; its opposite one stands for ours.
        let mut places: Vec<usize> = (0..width)
            .map(|k| if k == j { i } else { self.index_of(cell, self.vertex(beside, k)).unwrap_or(i) })
            .collect();
        let mut swaps = 0;
        for k in 0..width {
            while places[k] != k {
                let other = places[k];
                places.swap(k, other);
                swaps += 1;
            }
        }
        Some(swaps % 2 == 1 || width == 1)
    }

    /// Level 2: manifold and Euler. The cells around each vertex hang together, and so do all; the
    /// characteristic is that of a sphere. Assumes level 1.
    #[must_use]
    pub fn check_manifold(&self) -> Vec<Flaw> {
        let width = (self.dimension() + 1) as usize;
        if width < 2 {
            return Vec::new();
        }
        let mut flaws = Vec::new();
        let mut degree = vec![0u32; self.vertex_slots() + 1];
        let slot = |v: VertexId| if v == VertexId::INFINITE { self.vertex_slots() } else { v.index() };
        for cell in self.cells() {
            for &vertex in self.cell_vertices(cell) {
                degree[slot(vertex)] += 1;
            }
        }
        let mut reached = HashSet::new();
        let mut stack = Vec::new();
        for vertex in self.vertices().chain([VertexId::INFINITE]) {
            reached.clear();
            stack.extend(self.cell_of(vertex));
            reached.extend(stack.iter().copied());
            while let Some(cell) = stack.pop() {
                for (i, &beside) in self.cell_neighbors(cell).iter().enumerate() {
                    if self.vertex(cell, i) != vertex && reached.insert(beside) {
                        stack.push(beside);
                    }
                }
            }
            if reached.len() as u32 != degree[slot(vertex)] {
                flaws.push(Flaw::NotManifold(vertex));
            }
        }
        let mut faces = vec![HashSet::new(); width - 1];
        if width > 2 {
            for cell in self.cells() {
                let mut vertices = self.cell_vertices(cell).to_vec();
                vertices.sort_unstable();
                for subset in 1u32..(1 << width) - 1 {
                    if subset.count_ones() > 1 {
                        let face: Vec<_> = (0..width).filter(|&k| subset >> k & 1 == 1).map(|k| vertices[k]).collect();
                        faces[face.len() - 1].insert(face);
                    }
                }
            }
        }
        let sign = |k: usize| if k.is_multiple_of(2) { 1 } else { -1 };
        let middle: i64 = faces.iter().enumerate().skip(1).map(|(k, set)| sign(k) * set.len() as i64).sum();
        let euler = self.vertex_count() as i64 + 1 + middle + sign(width - 1) * self.cell_count() as i64;
        if euler != 1 + sign(width - 1) {
            flaws.push(Flaw::Euler(euler));
        }
        flaws
    }
}
