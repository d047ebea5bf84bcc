//! Checks of a complex, written independently: nothing here is used to build one.

use std::collections::HashSet;

use super::{CellId, Tds, TdsError, VertexId};

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Returns the faults of links: level 1.
    ///
    /// In a sound complex each cell has distinct, existing vertices and neighbors; neighbors are
    /// mutual and share their facet with opposite orientation; and each vertex refers to a cell
    /// that has it.
    ///
    /// # Complexity
    /// Linear in the cells.
    #[must_use]
    pub fn check_links(&self) -> Vec<TdsError> {
        let mut faults = Vec::new();
        let mut has_infinite = false;
        for cell in self.cells() {
            let (vertices, neighbors) = (self.cell_vertices(cell), self.cell_neighbors(cell));
            let exists = |v: VertexId| v == VertexId::INFINITE || self.is_vertex(v);
            for (i, &vertex) in vertices.iter().enumerate() {
                has_infinite |= vertex == VertexId::INFINITE;
                if !exists(vertex) || vertices[..i].contains(&vertex) {
                    faults.push(TdsError::Vertex { cell, vertex });
                }
            }
            for (facet, &beside) in neighbors.iter().enumerate() {
                if !self.is_used(beside) || beside == cell || neighbors[..facet].contains(&beside) {
                    faults.push(TdsError::Neighbor { cell, facet });
                }
            }
        }
        if !faults.is_empty() {
            return faults; // the rest would stumble
        }
        for cell in self.cells() {
            for (i, &beside) in self.cell_neighbors(cell).iter().enumerate() {
                match self.shared_facet(cell, i, beside) {
                    None => faults.push(TdsError::NotMutual { cell, facet: i }),
                    Some(false) => faults.push(TdsError::NotOriented { cell, facet: i }),
                    Some(true) => {}
                }
            }
        }
        let mut detached = self.detached;
        let holes: HashSet<VertexId> = self.unused_vertices.iter().copied().collect();
        for vertex in (0..self.vertex_slots())
            .map(VertexId::new)
            .chain([VertexId::INFINITE])
        {
            match self.cell_of(vertex) {
                Some(cell) => {
                    if !self.is_used(cell)
                        || !self.cell_vertices(cell).contains(&vertex)
                        || holes.contains(&vertex)
                    {
                        faults.push(TdsError::CellOfVertex(vertex));
                    }
                }
                None if vertex == VertexId::INFINITE => {
                    faults.extend(has_infinite.then_some(TdsError::CellOfVertex(vertex)))
                }
                None if holes.contains(&vertex) => {}
                None if detached > 0 => detached -= 1,
                None => faults.push(TdsError::Isolated(vertex)),
            }
        }
        faults
    }

    /// Returns `None` unless both cells have the same facet there; else, true if they are oriented
    /// alike.
    ///
    /// They are if the neighbor's vertices, with its opposite vertex replaced by ours, are an odd
    /// permutation of ours.
    fn shared_facet(&self, cell: CellId, i: usize, beside: CellId) -> Option<bool> {
        let width = self.cell_vertices(cell).len();
        let j = (0..width).find(|&j| {
            self.neighbor(beside, j) == cell
                && (0..width).filter(|&k| k != j).all(|k| {
                    self.index_of(cell, self.vertex(beside, k))
                        .is_some_and(|at| at != i)
                })
        })?;
        // The index in this cell of each vertex of the neighbor; its opposite one stands for ours.
        let index = |k| {
            if k == j || k >= width {
                None
            } else {
                self.index_of(cell, self.vertex(beside, k))
            }
        };
        let mut indices: [usize; N] =
            std::array::from_fn(|k| index(k).unwrap_or(if k == j { i } else { k }));
        let mut swaps = 0;
        for k in 0..width {
            while indices[k] != k {
                let other = indices[k];
                indices.swap(k, other);
                swaps += 1;
            }
        }
        Some(swaps % 2 == 1 || width == 1)
    }

    /// Returns the vertices whose links are not spheres: level 2.
    ///
    /// If there are none, and no faults of [links](Self::check_links), which are assumed to be
    /// sound, the complex is a closed manifold. Links are recognized up to dimension 2.
    ///
    /// # Complexity
    /// Linear in the cells.
    #[must_use]
    pub fn check_manifold(&self) -> Vec<TdsError> {
        let width = (self.dimension() + 1) as usize;
        if width < 2 {
            return Vec::new();
        }
        let mut faults = Vec::new();
        let mut degree = vec![0u32; self.vertex_slots() + 1];
        let slot = |v: VertexId| {
            if v == VertexId::INFINITE {
                self.vertex_slots()
            } else {
                v.index()
            }
        };
        for cell in self.cells() {
            for &vertex in self.cell_vertices(cell) {
                degree[slot(vertex)] += 1;
            }
        }
        // For each cell and vertex, the round in which it was reached last.
        let mut cell_rounds = vec![0u32; self.cell_slots()];
        let mut vertex_rounds = vec![0u32; self.vertex_slots() + 1];
        let mut star: Vec<CellId> = Vec::new();
        for (round, vertex) in (1..).zip(self.vertices().chain([VertexId::INFINITE])) {
            star.clear();
            star.extend(self.cell_of(vertex));
            star.iter()
                .for_each(|cell| cell_rounds[cell.index()] = round);
            let mut next = 0;
            while let Some(&cell) = star.get(next) {
                next += 1;
                for (i, &beside) in self.cell_neighbors(cell).iter().enumerate() {
                    if self.vertex(cell, i) != vertex
                        && std::mem::replace(&mut cell_rounds[beside.index()], round) != round
                    {
                        star.push(beside);
                    }
                }
            }
            let mut is_sphere = star.len() as u32 == degree[slot(vertex)];
            if width == 4 && !star.is_empty() {
                // The link is a connected surface with as many triangles as there are cells. It is
                // a sphere if it has the Euler characteristic of one: that of others is smaller,
                // also if vertices of the surface coincide.
                let corners = star.iter().flat_map(|&cell| self.cell_vertices(cell));
                let new = |v: &&VertexId| {
                    std::mem::replace(&mut vertex_rounds[slot(**v)], round) != round
                };
                let in_star = corners.filter(new).count();
                is_sphere &= 2 * (in_star - 1) == star.len() + 4;
            }
            if !is_sphere {
                faults.push(TdsError::Link(vertex));
            }
        }
        faults
    }

    /// Returns the reasons why the complex is not a sphere that contains the infinite vertex, as
    /// the kinds of triangulations need it.
    ///
    /// These are the faults of a [manifold](Self::check_manifold); and if there are none, a second
    /// component, or an Euler characteristic that is not that of a sphere. That of a closed
    /// 3-manifold is always 0 and shows nothing.
    ///
    /// # Complexity
    /// Expected linear time.
    #[must_use]
    pub fn check_sphere(&self) -> Vec<TdsError> {
        let mut faults = self.check_manifold();
        if self.dimension() >= 0 && self.cell_of(VertexId::INFINITE).is_none() {
            faults.push(TdsError::Isolated(VertexId::INFINITE));
        }
        if self.dimension() < 0 || !faults.is_empty() {
            return faults;
        }
        let mut reached = vec![false; self.cell_slots()];
        let mut stack: Vec<CellId> = self.cells().next().into_iter().collect();
        while let Some(cell) = stack.pop() {
            if !std::mem::replace(&mut reached[cell.index()], true) {
                stack.extend(self.cell_neighbors(cell));
            }
        }
        faults.extend(
            self.cells()
                .find(|cell| !reached[cell.index()])
                .map(TdsError::NotConnected),
        );
        let euler = self.euler_characteristic();
        if euler != 1 + sign(self.dimension() as usize) {
            faults.push(TdsError::Euler(euler));
        }
        faults
    }

    /// Returns the Euler characteristic: the number of vertices, less that of edges, plus that of
    /// triangles, and so on; the infinite ones included.
    ///
    /// A connected surface of genus `g` has `2 - 2 g`; a closed 3-manifold has 0. Assumes sound
    /// [links](Self::check_links).
    ///
    /// # Complexity
    /// Expected linear time.
    pub fn euler_characteristic(&self) -> i64 {
        let width = (self.dimension() + 1) as usize;
        let mut faces = vec![HashSet::new(); width.saturating_sub(1)];
        for cell in self.cells() {
            let mut vertices = self.cell_vertices(cell).to_vec();
            vertices.sort_unstable();
            for subset in 1u32..(1 << width) - 1 {
                if subset.count_ones() > 1 {
                    let face: Vec<_> = (0..width)
                        .filter(|&k| subset >> k & 1 == 1)
                        .map(|k| vertices[k])
                        .collect();
                    faces[face.len() - 1].insert(face);
                }
            }
        }
        let middle: i64 = faces
            .iter()
            .enumerate()
            .skip(1)
            .map(|(k, set)| sign(k) * set.len() as i64)
            .sum();
        let vertices =
            self.vertex_count() + usize::from(self.cell_of(VertexId::INFINITE).is_some());
        match width {
            0 | 1 => vertices as i64,
            _ => vertices as i64 + middle + sign(width - 1) * self.cell_count() as i64,
        }
    }
}

/// Returns the sign with which faces of a dimension count in the Euler characteristic.
fn sign(dimension: usize) -> i64 {
    if dimension.is_multiple_of(2) { 1 } else { -1 }
}
