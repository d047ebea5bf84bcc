//! Power diagrams: the dual of regular triangulations (Aurenhammer 1987).

use crate::geometry::{Metric, Weighted};
use crate::kernel::Kernel;
use crate::tds::VertexId;

use super::super::Regular;
use super::dual::{HalfPlane, VoronoiCell, cell_of, minus};
use super::nearest::nearest;

impl<G: Metric, V> Regular<G, V> {
    /// The point of the least power at a place, its squared distance less its weight; of several, the first in the
    /// [order](crate::geometry::Geometry::compare) of the geometry. Never a hidden one, nowhere; of these there may be
    /// one of the same power. `None` if there are no points. Exact. The place must be one that the geometry admits; its
    /// weight does not count.
    ///
    /// # Complexity
    /// As [`Delaunay::nearest`](crate::triangulation::Delaunay::nearest).
    pub fn nearest(&self, q: &G::Point) -> Option<VertexId> {
        let Ok(nearest) = nearest(&**self, q, self.locate(q, None));
        nearest
    }
}

impl<K: Kernel, V> Regular<Weighted<K>, V> {
    /// What of a convex polygon, counter-clockwise, has no less power with any other point than with this one. The
    /// cells of all points tile it; that of a hidden point has no corners. What is computed is rounded.
    ///
    /// # Complexity
    /// The degree of the vertex times the corners of the polygon and the cell.
    ///
    /// ```
    /// use breakline::{geometry::Weighted, triangulation::Regular};
    ///
    /// let mut t: Regular<Weighted> = Regular::new(Weighted::default());
    /// let [light, heavy] = [[1.0, 1.0, 0.0], [3.0, 1.0, 2.0]].map(|p| t.insert(p).unwrap());
    /// let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];
    /// let [light, heavy] = [light, heavy].map(|v| t.power_cell(v, &square).area);
    /// assert_eq!((light, heavy), (3.0, 5.0)); // without weights each would have half
    /// ```
    pub fn power_cell(&self, vertex: VertexId, within: &[[f64; 2]]) -> VoronoiCell {
        if !self.tds().is_vertex(vertex) {
            return VoronoiCell { corners: Vec::new(), area: 0.0 };
        }
        let [x, y, weight] = *self.point(vertex);
        let half_plane = |v: VertexId| {
            let [u, w, other] = *self.point(v);
            HalfPlane::of_less_power(minus([u, w], [x, y]), weight - other)
        };
        let neighbors = self.tds().vertices_around(vertex).filter(|&v| v != VertexId::INFINITE);
        cell_of([x, y], neighbors.map(half_plane), within)
    }
}
