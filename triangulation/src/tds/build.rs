//! Building a complex from the vertices of its cells: neighbors follow from common facets.

use rustc_hash::FxHashMap;

use super::{CellId, Links, Tds, TdsError, VertexId, face_without};

impl<const N: usize, V, C: Copy + Default> Tds<N, V, C> {
    /// Returns the complex with these cells: a surface of triangles (`N` = 3), or a 3-manifold of
    /// tetrahedra (`N` = 4).
    ///
    /// Vertex `k` gets payload `k`; cell `k` gets number `k` and the default payload, see
    /// [`with_cell_data`](Self::with_cell_data).
    ///
    /// The complex may have any genus and any number of components, but it is closed: each facet is
    /// in exactly two cells, which are oriented alike. So a Klein bottle is refused, however its
    /// cells are given. The link of each vertex is a circle (`N` = 3) or a sphere (`N` = 4). No two
    /// cells have the same vertices. A surface whose border is one circle can be closed by joining
    /// each of its edges to [`VertexId::INFINITE`], as the kinds of triangulations do. Of nothing,
    /// it is the empty complex, of dimension -1.
    ///
    /// ```text
    ///        a---------b       edge b c is in (a, c, b) and in (d, b, c): once from b to c, and once
    ///       / \       / \      from c to b, so the two are oriented alike
    ///      /   \     /   \
    ///     /     \   /     \
    ///    e-------c-------d
    /// ```
    ///
    /// # Errors
    /// The first fault that is found, with the cell, and the facet or vertex, where it is.
    ///
    /// # Complexity
    /// Expected linear time.
    ///
    /// ```
    /// use breakline_triangulation::tds::{CellId, Tds, TdsError, VertexId};
    ///
    /// let tetrahedron = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]].map(|cell| cell.map(VertexId::new));
    /// let names = vec!["north", "east", "south", "west"];
    /// let surface: Tds<3, &str> = Tds::from_cells(names, &tetrahedron)?;
    /// assert_eq!(surface.euler_characteristic(), 2);
    /// assert_eq!(surface.vertices_around(VertexId::new(3)).count(), 3);
    ///
    /// let open = Tds::<3>::from_cells(vec![(); 4], &tetrahedron[..3]);
    /// assert_eq!(open.err(), Some(TdsError::OneCell { cell: CellId::new(0), facet: 1 }));
    /// # Ok::<(), TdsError>(())
    /// ```
    pub fn from_cells(vertex_data: Vec<V>, cells: &[[VertexId; N]]) -> Result<Self, TdsError> {
        const { assert!(N == 3 || N == 4, "links are recognized up to dimension 2") };
        if vertex_data.len() >= VertexId::LIMIT || cells.len() >= CellId::LIMIT {
            return Err(TdsError::TooMany);
        }
        if vertex_data.is_empty() && cells.is_empty() {
            return Ok(Self::new());
        }
        let mut tds = Self::unlinked(
            N as i32 - 1,
            vec![C::default(); cells.len()],
            vertex_data,
            cells.as_flattened(),
        )?;
        tds.link_by_facets()?;
        let faults = [tds.check_links(), tds.check_manifold()];
        faults.into_iter().flatten().next().map_or(Ok(tds), Err)
    }

    /// Returns a complex whose cells are not linked yet. There is a payload for each number of a
    /// vertex.
    pub(super) fn unlinked(
        dimension: i32,
        cell_data: Vec<C>,
        vertex_data: Vec<V>,
        vertices_of_cells: &[VertexId],
    ) -> Result<Self, TdsError> {
        let width = (dimension + 1) as usize;
        let mut tds = Tds {
            dimension,
            cell_data,
            vertex_cell: vec![CellId::NONE; vertex_data.len()],
            vertex_data,
            ..Tds::new()
        };
        tds.links = vec![Links::UNUSED; tds.cell_data.len()];
        for (k, vertices) in vertices_of_cells.chunks_exact(width.max(1)).enumerate() {
            for (i, &vertex) in vertices.iter().enumerate() {
                let exists = vertex == VertexId::INFINITE || vertex.index() < tds.vertex_cell.len();
                if !exists || vertices[..i].contains(&vertex) {
                    return Err(TdsError::Vertex {
                        cell: CellId::new(k),
                        vertex,
                    });
                }
                tds.set_cell_of(vertex, CellId::new(k));
            }
            tds.links[k].vertices[..width].copy_from_slice(vertices);
        }
        Ok(tds)
    }

    /// Makes cells neighbors across each facet that they share. Each facet must be shared by
    /// exactly two.
    pub(super) fn link_by_facets(&mut self) -> Result<(), TdsError> {
        let width = (self.dimension + 1) as usize;
        // The facets by their sorted vertices; `None` once both cells are known.
        let mut open: FxHashMap<[VertexId; N], Option<(CellId, usize)>> = FxHashMap::default();
        let mut waiting = 0;
        for cell in (0..self.links.len()).map(CellId::new) {
            for i in 0..width {
                let facet = face_without(self.links[cell.index()].vertices, i);
                match open.insert(facet, Some((cell, i))) {
                    None => waiting += 1,
                    Some(Some((beside, j))) => {
                        self.link(cell, i, beside, j);
                        open.insert(facet, None);
                        waiting -= 1;
                    }
                    Some(None) => return Err(TdsError::ThreeCells { cell, facet: i }),
                }
            }
        }
        let alone = open.into_values().flatten().min().filter(|_| waiting > 0);
        alone.map_or(Ok(()), |(cell, facet)| {
            Err(TdsError::OneCell { cell, facet })
        })
    }
}
