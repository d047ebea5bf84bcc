//! Voronoi diagrams, as the dual of Delaunay triangulations, and what they share with [power
//! diagrams](super::power).
//!
//! The circles of the [geometry](crate::geometry::Coordinates) must be circles in its coordinates,
//! as they are for [`Plane`](crate::geometry::Plane), [`Terrain`](crate::geometry::Terrain) and
//! [`Steps`](crate::geometry::Steps). Results are rounded; lengths are in the unit of the
//! coordinates.

use crate::geometry::Coordinates;
use crate::kernel;
use crate::kinds::Delaunay;
use crate::num::unsigned_zero;
use crate::query::dual::{HalfSpace, VoronoiEdge, minus, plus};
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

/// The part of a convex polygon that is nearest to one vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct VoronoiCell {
    /// The corners, counter-clockwise; none if the cell lies outside of the polygon.
    pub corners: Vec<[f64; 2]>,
    /// The area, in square units of the coordinates.
    pub area: f64,
}

/// Returns twice the area of a polygon, positive if it is counter-clockwise.
pub(super) fn twice_area(polygon: &[[f64; 2]]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon
        .iter()
        .zip(next)
        .map(|(p, q)| p[0] * q[1] - p[1] * q[0])
        .sum()
}

/// Returns the cell of a site: the part of a convex polygon in half planes that are given relative
/// to the site.
pub(super) fn cell_of(
    site: [f64; 2],
    half_planes: impl Iterator<Item = HalfSpace<2>>,
    within: &[[f64; 2]],
) -> VoronoiCell {
    let is_polygon = within.as_flattened().iter().all(|x| x.is_finite());
    let polygon = within
        .iter()
        .filter(|_| is_polygon)
        .map(|&p| minus(p, site))
        .collect();
    let cell: Vec<[f64; 2]> =
        half_planes.fold(polygon, |polygon, half_plane| half_plane.clip(polygon));
    if cell.len() < 3 {
        return VoronoiCell {
            corners: Vec::new(),
            area: 0.0,
        };
    }
    VoronoiCell {
        area: unsigned_zero(twice_area(&cell) / 2.0),
        corners: cell.into_iter().map(|p| plus(p, site)).collect(),
    }
}

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns the center of the circle around a finite face, ignoring weights; `None` if the cell
    /// is not a finite face. Accurate to a few units in the last place of the larger of its
    /// coordinates and its [distance](kernel::power_center) from the corners. O(1).
    pub fn circumcenter(&self, cell: CellId) -> Option<[f64; 2]> {
        let corners = self.finite_face(cell)?.map(|v| self.site(v));
        Some(plus(corners[0], kernel::circumcenter(corners)))
    }

    /// Returns the corners of a finite face; `None` if the cell is not one.
    pub(super) fn finite_face(&self, cell: CellId) -> Option<[VertexId; 3]> {
        let is_face = self.is_full() && self.tds().is_used(cell) && !self.tds().is_infinite(cell);
        is_face.then(|| *self.tds().corners(cell))
    }

    /// Returns the ends of a finite edge, given as in [`Tds::edges`](crate::tds::Tds::edges);
    /// `None` if it is not one.
    pub(super) fn finite_edge(&self, cell: CellId, i: usize) -> Option<[VertexId; 2]> {
        let is_edge = match self.dimension() {
            2 => i < 3,
            1 => i == 2,
            _ => false,
        };
        let ends = (is_edge && self.tds().is_used(cell)).then(|| self.tds().edge_ends(cell, i))?;
        (!ends.contains(&VertexId::INFINITE)).then_some(ends)
    }

    /// Returns the dual of a finite edge; `None` if it is not one. `center` returns the center of a
    /// finite face, `between` the point between two collinear vertices that belongs to both cells.
    pub(super) fn dual_edge(
        &self,
        cell: CellId,
        i: usize,
        center: impl Fn(CellId) -> Option<[f64; 2]>,
        between: impl Fn([VertexId; 2]) -> [f64; 2],
    ) -> Option<VoronoiEdge> {
        let ends = self.finite_edge(cell, i)?;
        let [a, b] = ends.map(|v| self.site(v));
        let [dx, dy] = minus(b, a);
        if self.dimension() == 1 {
            return Some(VoronoiEdge::Line {
                through: between(ends),
                direction: [-dy, dx],
            });
        }
        Some(match [cell, self.tds().neighbor(cell, i)].map(center) {
            [Some(from), Some(to)] => VoronoiEdge::Segment([from, to]),
            // The face lies to the left of `a b`, or to its right.
            [Some(from), None] => VoronoiEdge::Ray {
                from,
                direction: [dy, -dx],
            },
            [None, from] => VoronoiEdge::Ray {
                from: from?,
                direction: [-dy, dx],
            },
        })
    }
}

impl<G: Coordinates<3>, V, C: Copy + Default> Delaunay<G, 3, V, C> {
    /// Returns the Voronoi edge between the ends of an edge, which is given as in
    /// [`Tds::edges`](crate::tds::Tds::edges).
    ///
    /// A segment runs from the center of `cell` to that of the other face. `None` for edges with
    /// the infinite vertex, and if there is no such edge: in dimension 1 an edge has index 2, below
    /// that there are none. O(1).
    pub fn voronoi_edge(&self, cell: CellId, i: usize) -> Option<VoronoiEdge> {
        let middle = |ends: [VertexId; 2]| {
            let [a, b] = ends.map(|v| self.site(v));
            [0, 1].map(|k| a[k] / 2.0 + b[k] / 2.0)
        };
        self.dual_edge(cell, i, |cell| self.circumcenter(cell), middle)
    }

    /// Returns the Voronoi cell of a finite vertex, clipped to a convex polygon, which is given
    /// counter-clockwise.
    ///
    /// The cells of all vertices tile the polygon, in every dimension, as long as squares of
    /// distances neither overflow nor underflow (distances between about `1e-150` and `1e150`). The
    /// cell has no corners if the vertex does not exist or a corner of the polygon is not finite.
    ///
    /// # Complexity
    /// The degree of the vertex times the number of corners of the polygon and the cell.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay};
    ///
    /// let points = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0], [2.0, 2.0]];
    /// let (t, v) = Delaunay::from_points(Plane::new(), &points)?;
    /// let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    /// let [corner, middle] = [v[0], v[4]].map(|v| t.voronoi_cell(v, &square));
    /// assert_eq!((corner.area, middle.area), (3.5, 2.0));
    /// assert_eq!(middle.corners.len(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn voronoi_cell(&self, vertex: VertexId, within: &[[f64; 2]]) -> VoronoiCell {
        if !self.tds().is_vertex(vertex) {
            return VoronoiCell {
                corners: Vec::new(),
                area: 0.0,
            };
        }
        let site = self.site(vertex);
        let neighbors = self
            .tds()
            .vertices_around(vertex)
            .filter(|&v| v != VertexId::INFINITE);
        cell_of(
            site,
            neighbors.map(|v| HalfSpace::nearer_than(minus(self.site(v), site))),
            within,
        )
    }
}
