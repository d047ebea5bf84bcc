//! Gabriel facets and edges in space (Gabriel and Sokal 1969): those whose smallest sphere is
//! empty.

use crate::geometry::{Geometry, Space, WeightedSpace};
use crate::kernel::{Kernel, side_of_smallest_sphere};
use crate::kinds::{Delaunay, Regular};
use crate::num::Sign;
use crate::tds::space::Edge;
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

/// Returns true if no vertex among those around a simplex is inside of its smallest sphere.
fn is_empty<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
    simplex: &[VertexId],
    mut around: impl Iterator<Item = VertexId>,
    weighted: impl Fn(&G::Point) -> [f64; 4],
) -> bool {
    if simplex.contains(&VertexId::INFINITE) {
        return false;
    }
    let point = |vertex: VertexId| weighted(t.point(vertex));
    let corners: Vec<[f64; 4]> = simplex.iter().map(|&vertex| point(vertex)).collect();
    around.all(|vertex| {
        vertex == VertexId::INFINITE
            || side_of_smallest_sphere(&corners, point(vertex)) != Sign::Positive
    })
}

fn is_gabriel_facet<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
    (cell, i): (CellId, usize),
    weighted: impl Fn(&G::Point) -> [f64; 4],
) -> bool {
    let tds = t.tds();
    if tds.dimension() < 1 || !tds.is_used(cell) || i >= tds.cell_vertices(cell).len() {
        return false;
    }
    let beyond = tds.neighbor(cell, i);
    let mut simplex = tds.cell_vertices(cell).to_vec();
    let opposite = [
        simplex.remove(i),
        tds.vertex(beyond, tds.index_of_neighbor(beyond, cell)),
    ];
    is_empty(t, &simplex, opposite.into_iter(), weighted)
}

fn is_gabriel_edge<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
    (cell, i, j): Edge,
    weighted: impl Fn(&G::Point) -> [f64; 4],
) -> bool {
    let tds = t.tds();
    if !tds.is_used(cell) || i == j || i.max(j) >= tds.cell_vertices(cell).len() {
        return false;
    }
    match t.dimension() {
        2 | 3 => {
            let edge = (cell, i, j);
            is_empty(
                t,
                &tds.edge_ends(edge),
                tds.vertices_around_edge(edge),
                weighted,
            )
        }
        _ => !tds.is_infinite(cell), // on a line, nothing is between the ends
    }
}

impl<K: Kernel, V, C: Copy + Default> Delaunay<Space<K>, 4, V, C> {
    /// Returns true if no vertex lies inside of the smallest sphere through the corners of a facet,
    /// given as a cell and the index of the vertex opposite. On the sphere there may be others.
    /// False for a facet with the infinite vertex, and if there is no such facet. Exact.
    ///
    /// In dimension 2 a facet is an edge. O(1): if a vertex is inside, then so is one of the two
    /// that are opposite the facet.
    pub fn is_gabriel_facet(&self, facet: (CellId, usize)) -> bool {
        is_gabriel_facet(self, facet, |&[x, y, z]| [x, y, z, 0.0])
    }

    /// Returns true if no vertex lies inside of the sphere that has an edge as its diameter. On the
    /// sphere there may be others. False for an edge with the infinite vertex, and if there is no
    /// such edge. Exact.
    ///
    /// # Complexity
    /// Linear in the number of cells around the edge.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Space, Delaunay};
    ///
    /// let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 3.0]];
    /// let (t, _) = Delaunay::from_points(Space::new(), &corners)?;
    /// let others = t.tds().finite_edges().filter(|&edge| !t.is_gabriel_edge(edge));
    /// assert_eq!(others.count(), 1); // [2, 1, 0] is inside of the sphere of the longest
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn is_gabriel_edge(&self, edge: Edge) -> bool {
        is_gabriel_edge(self, edge, |&[x, y, z]| [x, y, z, 0.0])
    }
}

impl<K: Kernel, V, C: Copy + Default> Regular<WeightedSpace<K>, 4, V, C> {
    /// Like [`Delaunay::is_gabriel_facet`](crate::Delaunay::is_gabriel_facet), but for the smallest
    /// sphere that is orthogonal to those of the corners: returns true if no vertex has a negative
    /// power to it.
    pub fn is_gabriel_facet(&self, facet: (CellId, usize)) -> bool {
        is_gabriel_facet(self, facet, |&point| point)
    }

    /// Like [`Delaunay::is_gabriel_edge`](crate::Delaunay::is_gabriel_edge), but for the smallest
    /// sphere that is orthogonal to those of the ends: returns true if no vertex has a negative
    /// power to it.
    pub fn is_gabriel_edge(&self, edge: Edge) -> bool {
        is_gabriel_edge(self, edge, |&point| point)
    }
}
