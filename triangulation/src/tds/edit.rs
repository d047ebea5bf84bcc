//! Edits of a complex that stands alone: splits, flips, stars of holes, collapses.
//!
//! Each edit first checks that the complex remains a closed manifold of the same topological type.
//! If not, it returns an [`EditError`] and changes nothing. Edits look at the cells around a few
//! vertices; no cost depends on the size of the complex. Coordinates play no part: the caller
//! decides if the result can be drawn with straight edges.
//!
//! Where a cell is split or a hole is filled, each new cell gets the payload of the old one that
//! had the facet opposite the new vertex. Cells that a flip creates get the default payload. Those
//! that remain after a collapse keep theirs.

use rustc_hash::{FxHashMap, FxHashSet};

use super::{CellId, EditError, Links, Tds, VertexId, face_without};

/// A facet of a cell, or another face of it: its vertices in order, then `NONE`.
type Face<const N: usize> = [VertexId; N];

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Splits a cell into `N` around a new vertex in it, and returns the vertex.
    ///
    /// ```text
    ///          c                    c
    ///         / \                  /|\
    ///        /   \                / | \
    ///       /     \     ->       /  v  \
    ///      /       \            / /   \ \
    ///     /         \          //       \\
    ///    a-----------b        a-----------b
    /// ```
    ///
    /// # Errors
    /// If there is no such cell, or numbers are used up.
    ///
    /// # Complexity
    /// O(1).
    pub fn split_cell(&mut self, cell: CellId, data: V) -> Result<VertexId, EditError> {
        self.ensure_cell(cell)?;
        self.fill(&[cell], data)
    }

    /// Splits the facet opposite vertex `i` of a cell around a new vertex on it, and returns the
    /// vertex. The cells on both sides are split with it. In a surface the facet is an edge.
    ///
    /// ```text
    ///          c                    c
    ///         / \                  /|\
    ///        /   \                / | \
    ///       /     \              /  |  \
    ///      a-------b    ->      a---v---b
    ///       \     /              \  |  /
    ///        \   /                \ | /
    ///          d                    d
    /// ```
    ///
    /// # Errors
    /// If there is no such facet, or numbers are used up.
    ///
    /// # Complexity
    /// O(1).
    pub fn split_facet(&mut self, cell: CellId, i: usize, data: V) -> Result<VertexId, EditError> {
        let beside = self.across(cell, i)?;
        self.fill(&[cell, beside], data)
    }

    /// Splits the edge between two vertices at a new vertex on it, and returns the vertex. All
    /// cells around the edge are split with it.
    ///
    /// ```text
    ///      cells around a b, in space, seen along the edge; each becomes two, one from a to v and one from v to b
    ///
    ///       c-------d                 c-------d
    ///        \  .  /                   \  .  /
    ///         \ . /                     \ . /
    ///          a b      ->             a  v  b
    ///         / . \                     / . \
    ///        e-----f                   e-----f
    /// ```
    ///
    /// # Errors
    /// If there is no such edge, or numbers are used up.
    ///
    /// # Complexity
    /// Linear in the degree of the first vertex.
    pub fn split_edge(&mut self, ends: [VertexId; 2], data: V) -> Result<VertexId, EditError> {
        let star = self.star_of_edge(ends)?;
        self.fill(&star, data)
    }

    /// Replaces the cells of a hole by the star of a new vertex, one cell for each facet of the
    /// hole's border, and returns the vertex. Vertices in the hole that are not on its border are
    /// removed.
    ///
    /// ```text
    ///      c-------d                c-------d
    ///     / \     / \              / \     / \
    ///    /   \   /   \            /    \ /    \
    ///   b-----x-----e     ->     b------v------e
    ///    \   / \   /              \    / \    /
    ///     \ /   \ /                \ /     \ /
    ///      a-----f                  a-------f
    /// ```
    ///
    /// The hole is connected across facets. In a surface it is a disc. Among tetrahedra its border
    /// is a sphere. That the hole is a ball is not checked: any other topology within it is lost.
    ///
    /// # Errors
    /// If a cell does not exist or is given twice, if the hole is of another shape, or numbers are
    /// used up.
    ///
    /// # Complexity
    /// Expected time linear in the number of cells of the hole.
    pub fn star_hole(&mut self, cells: &[CellId], data: V) -> Result<VertexId, EditError> {
        cells.iter().try_for_each(|&cell| self.ensure_cell(cell))?;
        let hole: FxHashSet<CellId> = cells.iter().copied().collect();
        let mut reached = FxHashSet::from_iter(cells.first().copied());
        let mut stack: Vec<CellId> = cells.first().copied().into_iter().collect();
        while let Some(cell) = stack.pop() {
            let beside = self.links[cell.index()].neighbors;
            stack.extend(
                beside
                    .into_iter()
                    .filter(|&c| hole.contains(&c) && reached.insert(c)),
            );
        }
        let border = self.border(cells);
        let facets = border
            .iter()
            .map(|&(cell, i)| self.facet(cell, i))
            .collect::<Vec<_>>();
        let vertices: FxHashSet<VertexId> =
            cells.iter().flat_map(|&cell| *self.corners(cell)).collect();
        // Euler's relation for a disc.
        let is_disc = || vertices.len() * 2 == cells.len() + border.len() + 2;
        if reached.len() != cells.len() || !is_sphere(&facets) || N == 3 && !is_disc() {
            return Err(EditError::Hole);
        }
        self.fill(cells, data)
    }

    /// Replaces the facet opposite vertex `i` of a cell by the edge between the vertices on both
    /// sides, and returns the new cells: two triangles become two others, two tetrahedra three.
    ///
    /// ```text
    ///          c                    c
    ///         / \                  /|\
    ///        /   \                / | \
    ///       /     \              /  |  \
    ///      a-------b    ->      a   |   b
    ///       \     /              \  |  /
    ///        \   /                \ | /
    ///          d                    d
    /// ```
    ///
    /// # Errors
    /// If there is no such facet, if these vertices are joined by an edge already, or numbers are
    /// used up.
    ///
    /// # Complexity
    /// Linear in the degree of vertex `i`, to search for such an edge.
    pub fn flip(&mut self, cell: CellId, i: usize) -> Result<Vec<CellId>, EditError> {
        let beside = self.across(cell, i)?;
        let far = self.vertex(beside, self.index_of_neighbor(beside, cell));
        let inner: Vec<VertexId> = (0..N)
            .filter(|&k| k != i)
            .map(|k| self.vertex(cell, k))
            .collect();
        self.exchange(&inner, &[(cell, far), (beside, self.vertex(cell, i))])
    }

    /// Replaces an edge by the face that the vertices around it span, and returns the new cells:
    /// two triangles become two others, as by [`flip`](Self::flip); three tetrahedra become two,
    /// the inverse of `flip`.
    ///
    /// ```text
    ///      three tetrahedra, seen along their edge a b; then two, on both sides of the facet c d e
    ///
    ///            c                      c
    ///           /|\                    / \
    ///          / | \                  /   \
    ///         / a b \       ->       /     \
    ///        / /   \ \              /       \
    ///       d---------e            d---------e
    /// ```
    ///
    /// # Errors
    /// If there is no such edge, if more cells have it, if the new face exists already, or numbers
    /// are used up.
    ///
    /// # Complexity
    /// Linear in the degrees of the first vertex and of one next to the edge.
    pub fn flip_edge(&mut self, ends: [VertexId; 2]) -> Result<Vec<CellId>, EditError> {
        let star = self.star_of_edge(ends)?;
        self.exchange_star(&ends, star)
    }

    /// Removes a vertex that exactly `N` cells have, and returns the one cell that these become:
    /// the inverse of [`split_cell`](Self::split_cell).
    ///
    /// ```text
    ///          c                    c
    ///         /|\                  / \
    ///        / | \                /   \
    ///       /  v  \     ->       /     \
    ///      / /   \ \            /       \
    ///     //       \\          /         \
    ///    a-----------b        a-----------b
    /// ```
    ///
    /// # Errors
    /// If there is no such vertex, if more cells have it, or if the new cell exists already.
    ///
    /// # Complexity
    /// Linear in the degrees of the vertex and of one next to it.
    pub fn unsplit_cell(&mut self, vertex: VertexId) -> Result<CellId, EditError> {
        let star = self.star_of(vertex)?;
        Ok(self.exchange_star(&[vertex], star)?[0])
    }

    /// Collapses the edge between two vertices: `from` is replaced by `into`, and the cells at the
    /// edge vanish.
    ///
    /// ```text
    ///       d-------c              d-------c
    ///      / \     / \              \     / \
    ///     /   \   /   \              \   /   \
    ///    e---from--into     ->   e-----into   |
    ///     \   /   \   /              /   \   /
    ///      \ /     \ /              /     \ /
    ///       f-------g              f-------g
    /// ```
    ///
    /// The complex keeps its topological type: the edge is collapsed only if the links of its ends
    /// have nothing in common but the link of the edge (Dey, Edelsbrunner, Guha and Nekhayev 1999).
    ///
    /// # Errors
    /// If there is no such edge, or if the links have more in common.
    ///
    /// # Complexity
    /// Expected time linear in the degrees of both vertices.
    pub fn collapse(&mut self, from: VertexId, into: VertexId) -> Result<(), EditError> {
        let vanishing = self.star_of_edge([from, into])?;
        let [star, other] = [self.star_of(from)?, self.star_of(into)?];
        let common = self.faces_without(&vanishing, &[from, into]);
        let of_into = self.faces_without(&other, &[into]);
        if self
            .faces_without(&star, &[from])
            .iter()
            .any(|face| of_into.contains(face) && !common.contains(face))
        {
            return Err(EditError::Links([from, into]));
        }
        let mut changed: Vec<CellId> = star
            .into_iter()
            .filter(|cell| !vanishing.contains(cell))
            .collect();
        for cell in &changed {
            let corners = &mut self.links[cell.index()].vertices;
            corners
                .iter_mut()
                .filter(|v| **v == from)
                .for_each(|v| *v = into);
        }
        for &cell in &vanishing {
            // The facets without `from` and without `into` become one; these are the cells beyond
            // them.
            let beyond = [from, into].map(|v| {
                let outside = self.neighbor(cell, self.index_of(cell, v).unwrap_or(0));
                (outside, self.index_of_neighbor(outside, cell))
            });
            let [(a, i), (b, j)] = beyond;
            self.link(a, i, b, j);
            changed.push(a);
        }
        vanishing
            .into_iter()
            .for_each(|cell| self.remove_cell(cell));
        self.drop_vertex(from);
        changed
            .into_iter()
            .for_each(|cell| self.set_corners(cell, *self.corners(cell)));
        Ok(())
    }

    fn ensure_cell(&self, cell: CellId) -> Result<(), EditError> {
        if self.dimension + 1 != N as i32 {
            return Err(EditError::NotFull);
        }
        if self.is_used(cell) {
            Ok(())
        } else {
            Err(EditError::Cell(cell))
        }
    }

    /// Returns the cell across a facet.
    fn across(&self, cell: CellId, i: usize) -> Result<CellId, EditError> {
        self.ensure_cell(cell)?;
        if i < N {
            Ok(self.neighbor(cell, i))
        } else {
            Err(EditError::Facet { cell, facet: i })
        }
    }

    /// Returns the cells with a vertex.
    fn star_of(&self, vertex: VertexId) -> Result<Vec<CellId>, EditError> {
        let first = self.cell_of(vertex).ok_or(EditError::Vertex(vertex))?;
        self.ensure_cell(first)?;
        let (mut star, mut reached) = (vec![first], FxHashSet::from_iter([first]));
        let mut next = 0;
        while next < star.len() {
            let links = self.links[star[next].index()];
            next += 1;
            let beside = links.vertices.into_iter().zip(links.neighbors);
            star.extend(
                beside
                    .filter(|&(v, cell)| v != vertex && reached.insert(cell))
                    .map(|(_, cell)| cell),
            );
        }
        Ok(star)
    }

    /// Returns the cells with an edge.
    fn star_of_edge(&self, [a, b]: [VertexId; 2]) -> Result<Vec<CellId>, EditError> {
        let mut star = self.star_of(a)?;
        star.retain(|&cell| a != b && self.corners(cell).contains(&b));
        if star.is_empty() {
            Err(EditError::Edge([a, b]))
        } else {
            Ok(star)
        }
    }

    /// Returns all faces of some cells that have none of these vertices.
    fn faces_without(&self, cells: &[CellId], vertices: &[VertexId]) -> FxHashSet<Face<N>> {
        let mut faces = FxHashSet::default();
        for &cell in cells {
            for subset in 1u32..1 << N {
                let chosen = |k: usize| subset >> k & 1 == 1;
                let corners = self.corners(cell);
                if !(0..N).any(|k| chosen(k) && vertices.contains(&corners[k])) {
                    let mut face = std::array::from_fn(|k| {
                        if chosen(k) {
                            corners[k]
                        } else {
                            VertexId::NONE
                        }
                    });
                    face.sort_unstable();
                    faces.insert(face);
                }
            }
        }
        faces
    }

    /// Returns the facets of some cells that they do not share with each other.
    fn border(&self, cells: &[CellId]) -> Vec<(CellId, usize)> {
        let hole: FxHashSet<CellId> = cells.iter().copied().collect();
        let facets = cells
            .iter()
            .flat_map(|&cell| (0..N).map(move |i| (cell, i)));
        facets
            .filter(|&(cell, i)| !hole.contains(&self.neighbor(cell, i)))
            .collect()
    }

    fn facet(&self, cell: CellId, i: usize) -> Face<N> {
        face_without(*self.corners(cell), i)
    }

    /// Returns an error unless this many new cells, and one vertex, can be numbered.
    fn ensure_numbers(&self, cells: usize) -> Result<(), EditError> {
        let new_slots = cells.saturating_sub(self.unused.len());
        let has_vertex =
            !self.unused_vertices.is_empty() || self.vertex_cell.len() < VertexId::LIMIT;
        if has_vertex && self.links.len() + new_slots <= CellId::LIMIT {
            Ok(())
        } else {
            Err(EditError::TooMany)
        }
    }

    /// Replaces cells that form a ball by the star of a new vertex, and returns the vertex.
    fn fill(&mut self, cells: &[CellId], data: V) -> Result<VertexId, EditError> {
        let border = self.border(cells);
        self.ensure_numbers(border.len())?;
        let apex = self.add_vertex(data);
        // The vertices in the hole that no cell will have.
        let mut inner: FxHashSet<VertexId> =
            cells.iter().flat_map(|&cell| *self.corners(cell)).collect();
        // New cells share a facet for each ridge of the border; the first of the two waits here.
        let mut waiting: FxHashMap<Face<N>, (CellId, usize)> = FxHashMap::default();
        let new_cells: Vec<(Links<N>, C, usize)> = border
            .iter()
            .map(|&(cell, i)| {
                let mut links = self.links[cell.index()];
                links.vertices[i] = apex;
                for vertex in &links.vertices {
                    inner.remove(vertex);
                }
                (
                    links,
                    self.cell_data[cell.index()],
                    self.index_of_neighbor(links.neighbors[i], cell),
                )
            })
            .collect();
        cells.iter().for_each(|&cell| self.remove_cell(cell));
        for ((links, payload, back), (_, i)) in new_cells.into_iter().zip(border) {
            let new = self.add_cell(Links::alone(links.vertices), payload);
            self.link(new, i, links.neighbors[i], back);
            for ridge in (0..N).filter(|&k| k != i) {
                if let Some((other, k)) = waiting.insert(self.facet(new, ridge), (new, ridge)) {
                    self.link(new, ridge, other, k);
                }
            }
            links
                .vertices
                .iter()
                .for_each(|&v| self.set_cell_of(v, new));
        }
        inner
            .into_iter()
            .for_each(|vertex| self.drop_vertex(vertex));
        Ok(apex)
    }

    /// Flips the face of these vertices, given its star, and returns the new cells.
    fn exchange_star(
        &mut self,
        inner: &[VertexId],
        star: Vec<CellId>,
    ) -> Result<Vec<CellId>, EditError> {
        if star.len() != N + 1 - inner.len() {
            return Err(EditError::Star { cells: star.len() });
        }
        let around: FxHashSet<VertexId> =
            star.iter().flat_map(|&cell| *self.corners(cell)).collect();
        let missing = |cell: CellId| {
            around
                .iter()
                .copied()
                .find(|v| !self.corners(cell).contains(v))
        };
        let star: Vec<_> = star
            .iter()
            .filter_map(|&cell| Some((cell, missing(cell)?)))
            .collect();
        self.exchange(inner, &star)
    }

    /// Performs a bistellar flip (Pachner 1991), and returns the new cells.
    ///
    /// Of `N + 1` vertices, the `inner` ones span a face. Its star consists of the cells that lack
    /// one of the other vertices each. They are replaced by the cells that lack one of the inner
    /// vertices each.
    ///
    /// The new cell without `a` has the facets of the old ones that lay opposite `a`, and shares a
    /// facet with each of the other new ones.
    fn exchange(
        &mut self,
        inner: &[VertexId],
        star: &[(CellId, VertexId)],
    ) -> Result<Vec<CellId>, EditError> {
        let outer: Vec<VertexId> = star.iter().map(|&(_, missing)| missing).collect();
        let around = self.star_of(outer[0])?;
        if around
            .iter()
            .any(|&cell| outer.iter().all(|v| self.corners(cell).contains(v)))
        {
            return Err(EditError::Exists);
        }
        self.ensure_numbers(inner.len())?;
        let (base, gained) = (*self.corners(star[0].0), star[0].1);
        let slot = |vertex: VertexId| base.iter().position(|&v| v == vertex).unwrap_or(0);
        // The cells beyond the facet opposite `a` of each cell of the star, and the index of the
        // facet in them.
        let beyond = |tds: &Self, a: VertexId| -> Vec<(CellId, usize)> {
            let facet = |cell| tds.neighbor(cell, tds.index_of(cell, a).unwrap_or(0));
            star.iter()
                .map(|&(cell, _)| (facet(cell), tds.index_of_neighbor(facet(cell), cell)))
                .collect()
        };
        let outside: Vec<_> = inner.iter().map(|&a| beyond(self, a)).collect();
        star.iter().for_each(|&(cell, _)| self.remove_cell(cell));
        let mut new_cells: Vec<CellId> = Vec::with_capacity(inner.len());
        for (&a, outside) in inner.iter().zip(outside) {
            let mut vertices = base;
            vertices[slot(a)] = gained;
            let new = self.add_cell(Links::alone(vertices), C::default());
            for (&b, (cell, back)) in outer.iter().zip(outside) {
                self.link(new, if b == gained { slot(a) } else { slot(b) }, cell, back);
            }
            for (&other, &old) in inner.iter().zip(&new_cells) {
                self.link(new, slot(other), old, slot(a));
            }
            vertices.into_iter().for_each(|v| self.set_cell_of(v, new));
            new_cells.push(new);
        }
        if let [vertex] = *inner {
            self.drop_vertex(vertex);
        }
        Ok(new_cells)
    }

    /// Removes a vertex that is in no cell any more.
    fn drop_vertex(&mut self, vertex: VertexId) {
        if vertex == VertexId::INFINITE {
            self.infinite_cell = CellId::NONE;
        } else {
            self.remove_vertex(vertex);
        }
    }
}

/// Returns true if facets form a circle or a sphere: each ridge is in two of them, all are
/// connected across ridges, and a surface has the Euler characteristic of a sphere.
fn is_sphere<const N: usize>(facets: &[Face<N>]) -> bool {
    let mut on: FxHashMap<Face<N>, Vec<usize>> = FxHashMap::default();
    let ridges = |facet: &Face<N>| {
        let facet = *facet;
        (0..N)
            .filter(move |&k| facet[k] != VertexId::NONE)
            .map(move |k| face_without(facet, k))
    };
    for (k, facet) in facets.iter().enumerate() {
        ridges(facet).for_each(|ridge| on.entry(ridge).or_default().push(k));
    }
    let distinct: FxHashSet<&Face<N>> = facets.iter().collect();
    if facets.is_empty()
        || distinct.len() != facets.len()
        || on.values().any(|sides| sides.len() != 2)
    {
        return false;
    }
    let (mut reached, mut stack) = (FxHashSet::from_iter([0]), vec![0]);
    while let Some(k) = stack.pop() {
        stack.extend(
            ridges(&facets[k])
                .flat_map(|ridge| &on[&ridge])
                .filter(|&&k| reached.insert(k)),
        );
    }
    let vertices: FxHashSet<VertexId> = facets
        .as_flattened()
        .iter()
        .copied()
        .filter(|&v| v != VertexId::NONE)
        .collect();
    // A surface has three edges for two triangles.
    reached.len() == facets.len() && (N != 4 || 2 * vertices.len() == facets.len() + 4)
}
