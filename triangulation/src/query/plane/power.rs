//! Power diagrams: the dual of regular triangulations (Aurenhammer 1987).

use std::convert::Infallible;

use crate::geometry::{Metric, Weighted};
use crate::kernel::{self, Kernel};
use crate::kinds::Regular;
use crate::tds::{CellId, Neighbors, Tds, VertexId};

use crate::query::dual::{HalfSpace, VoronoiEdge, dot, minus, plus};

use super::dual::{VoronoiCell, cell_of};
use crate::query::nearest::nearest;

impl<G: Metric<N>, const N: usize, V, C: Copy + Default> Regular<G, N, V, C>
where
    Tds<N, V, C>: Neighbors<N, Error = Infallible>,
{
    /// Returns the vertex of the least power at a point, which is its squared distance less its
    /// weight; of several, the first in the [order](crate::geometry::Geometry::compare) of the
    /// geometry.
    ///
    /// Never returns a hidden point: such a point has nowhere less power than all vertices,
    /// although it may have the same. `None` if there are no points, or if the geometry does not
    /// [admit](crate::geometry::Geometry::admits) the point; otherwise the weight of the point does
    /// not matter. Exact.
    ///
    /// # Complexity
    /// That of [`Delaunay::nearest`](crate::Delaunay::nearest).
    pub fn nearest(&self, q: &G::Point) -> Option<VertexId> {
        let Ok(nearest) = nearest(&**self, q, self.start(None));
        nearest
    }
}

impl<K: Kernel, V, C: Copy + Default> Regular<Weighted<K>, 3, V, C> {
    /// Returns the point that has the same power with the corners of a finite face, and less with
    /// no other point: the corner of the power diagram, and the center of the circle that is
    /// orthogonal to those of the three corners. `None` if the cell is not a finite face. As
    /// accurate as a [circumcenter](crate::Triangulation::circumcenter), which it is
    /// if all weights are equal. O(1).
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Weighted, Regular, VoronoiEdge};
    ///
    /// let mut t = Regular::new(Weighted::new());
    /// for p in [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 8.0]] {
    ///     t.insert(p)?;
    /// }
    /// let face = t.finite_cells().next().unwrap();
    /// assert_eq!(t.power_center(face), Some([2.0, 1.0])); // without weights [2.0, 2.0]
    /// for (cell, i) in t.tds().finite_edges() {
    ///     assert!(matches!(t.power_edge(cell, i), Some(VoronoiEdge::Ray { from: [2.0, 1.0], .. })));
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn power_center(&self, cell: CellId) -> Option<[f64; 2]> {
        let corners = self.finite_face(cell)?.map(|v| *self.point(v));
        let [x, y, _] = corners[0];
        Some(plus([x, y], kernel::power_center(corners)))
    }

    /// Returns the edge of the power diagram between the cells of the ends of an edge: the points
    /// that have the same power with both ends, and less with no other point.
    ///
    /// The edge is given as in [`Tds::edges`](crate::tds::Tds::edges). A segment runs from the
    /// center of `cell` to that of the other face. `None` for edges with the infinite vertex, and
    /// if there is no such edge: in dimension 1 an edge has index 2, below that there are none.
    /// O(1).
    pub fn power_edge(&self, cell: CellId, i: usize) -> Option<VoronoiEdge> {
        let between = |ends: [VertexId; 2]| {
            let [[x, y, weight], [u, w, other]] = ends.map(|v| *self.point(v));
            let offset = minus([u, w], [x, y]);
            let along = 0.5 + (weight - other) / dot(offset, offset) / 2.0;
            plus([x, y], offset.map(|d| along * d))
        };
        self.dual_edge(cell, i, |cell| self.power_center(cell), between)
    }

    /// Returns the cell of a vertex in the power diagram, clipped to a convex polygon, which is
    /// given counter-clockwise: the points that have no less power with any other vertex.
    ///
    /// The cells of all points tile the polygon; that of a hidden point has no corners, and none
    /// has if a corner of the polygon is not finite. Results are rounded.
    ///
    /// # Complexity
    /// The degree of the vertex times the number of corners of the polygon and the cell.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Weighted, Regular};
    ///
    /// let mut t = Regular::new(Weighted::new());
    /// let [light, heavy] = [[1.0, 1.0, 0.0], [3.0, 1.0, 2.0]].map(|p| t.insert(p).unwrap());
    /// let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];
    /// let [light, heavy] = [light, heavy].map(|v| t.power_cell(v, &square).area);
    /// assert_eq!((light, heavy), (3.0, 5.0)); // without weights each would have half
    /// ```
    pub fn power_cell(&self, vertex: VertexId, within: &[[f64; 2]]) -> VoronoiCell {
        if !self.tds().is_vertex(vertex) {
            return VoronoiCell {
                corners: Vec::new(),
                area: 0.0,
            };
        }
        let [x, y, weight] = *self.point(vertex);
        let half_plane = |v: VertexId| {
            let [u, w, other] = *self.point(v);
            HalfSpace::of_less_power(minus([u, w], [x, y]), weight - other)
        };
        let neighbors = self
            .tds()
            .vertices_around(vertex)
            .filter(|&v| v != VertexId::INFINITE);
        cell_of([x, y], neighbors.map(half_plane), within)
    }
}
