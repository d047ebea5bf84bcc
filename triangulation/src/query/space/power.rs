//! Power diagrams in space: the dual of regular triangulations (Aurenhammer 1987).

use crate::geometry::WeightedSpace;
use crate::kernel::Kernel;
use crate::kinds::Regular;
use crate::query::dual::VoronoiEdge;
use crate::tds::space::Edge;
use crate::tds::{CellId, VertexId};

use super::dual::{Diagram, VoronoiFacet, VoronoiSolid};

impl<K: Kernel, V, C: Copy + Default> Regular<WeightedSpace<K>, 4, V, C> {
    /// Returns the point that has the same power to the corners of a finite cell of dimension 3,
    /// and less to no other point: the vertex of the power diagram. `None` if the cell is not one.
    /// As accurate as a circumcenter, which it is if all weights are equal. O(1).
    ///
    /// ```
    /// use breakline_triangulation::{geometry::WeightedSpace, Regular};
    ///
    /// let corners = [[0.0, 0.0, 0.0, 0.0], [4.0, 0.0, 0.0, 0.0], [0.0, 4.0, 0.0, 0.0], [0.0, 0.0, 4.0, 8.0]];
    /// let (t, _) = Regular::from_points(WeightedSpace::new(), &corners)?;
    /// let cell = t.finite_cells().next().unwrap();
    /// assert_eq!(t.power_center(cell), Some([2.0, 2.0, 1.0])); // without weights [2.0, 2.0, 2.0]
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn power_center(&self, cell: CellId) -> Option<[f64; 3]> {
        self.diagram().center(cell)
    }

    /// Returns the edge of the power diagram at which the cells of the corners of a facet meet,
    /// given as a cell and the index of the vertex opposite: the points that have the same power to
    /// these, and less to no other point.
    ///
    /// A segment runs from the center of the cell to that of the other one. `None` for facets with
    /// the infinite vertex, and if there is no such facet: in dimension 2 a face has index 3, below
    /// that there are none. O(1).
    pub fn power_edge(&self, facet: (CellId, usize)) -> Option<VoronoiEdge<3>> {
        self.diagram().edge(facet)
    }

    /// Returns the facet of the power diagram between the cells of the ends of an edge, clipped to
    /// a box, which is given by two opposite corners. Result and cost are those of
    /// [`Delaunay::voronoi_facet`](crate::Delaunay::voronoi_facet).
    pub fn power_facet(&self, edge: Edge, within: [[f64; 3]; 2]) -> Option<VoronoiFacet> {
        self.diagram().facet_within(edge, within)
    }

    /// Returns the cell of a vertex in the power diagram, clipped to a box, which is given by two
    /// opposite corners: the points that have no less power to any other vertex.
    ///
    /// The cells of all points fill the box; that of a hidden point has no facets, and none has if
    /// a corner of the box is not finite. Results are rounded. The cost is that of
    /// [`Delaunay::voronoi_cell`](crate::Delaunay::voronoi_cell).
    ///
    /// ```
    /// use breakline_triangulation::{geometry::WeightedSpace, Regular};
    ///
    /// let points = [[1.0, 1.0, 1.0, 0.0], [3.0, 1.0, 1.0, 2.0]];
    /// let (t, v) = Regular::from_points(WeightedSpace::new(), &points)?;
    /// let volumes = v.iter().map(|&v| t.power_cell(v, [[0.0, 0.0, 0.0], [4.0, 2.0, 2.0]]).volume);
    /// assert!(volumes.zip([6.0, 10.0]).all(|(found, expected): (f64, f64)| (found - expected).abs() < 1e-12));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn power_cell(&self, vertex: VertexId, within: [[f64; 3]; 2]) -> VoronoiSolid {
        self.diagram().cell(vertex, within)
    }

    fn diagram(&self) -> Diagram<'_, WeightedSpace<K>, V, C, impl Fn(&[f64; 4]) -> [f64; 4]> {
        Diagram {
            t: self,
            weighted: |point: &[f64; 4]| *point,
        }
    }
}
