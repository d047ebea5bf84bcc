//! Voronoi diagrams, as the dual of Delaunay triangulations, and what they share with [power
//! diagrams](super::power).
//!
//! The circles of the [geometry](crate::geometry::Coordinates) must be circles in its coordinates,
//! as they are for [`Plane`](crate::geometry::Plane), [`Terrain`](crate::geometry::Terrain) and
//! [`Steps`](crate::geometry::Steps). Results are rounded; lengths are in the unit of the
//! coordinates.

use crate::geometry::Coordinates;
use crate::kernel;
use crate::tds::{CellId, VertexId};

use super::super::{Delaunay, Triangulation};

/// An edge of a Voronoi or power diagram: the points that both ends of an edge are nearest to, or
/// in space (`D = 3`) all corners of a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VoronoiEdge<const D: usize = 2> {
    /// Between the centers of the two cells at an edge (facet); of length zero if these are equal,
    /// as when all corners lie on one circle (sphere).
    Segment([[f64; D]; 2]),
    /// From the center of the only cell at an edge (facet) of the hull, outward.
    Ray {
        /// The start of the ray.
        from: [f64; D],
        /// The direction: perpendicular to the edge, and as long; in space to the facet, and as
        /// long as twice its area is large.
        direction: [f64; D],
    },
    /// Between two neighbors among collinear vertices; in space, of a face among coplanar ones.
    Line {
        /// A point on the line through both; halfway between them if their weights are equal. In
        /// space, the center of the face in its plane.
        through: [f64; D],
        /// The direction, as that of a ray.
        direction: [f64; D],
    },
}

/// The part of a convex polygon that is nearest to one vertex.
#[derive(Debug, Clone, PartialEq)]
pub struct VoronoiCell {
    /// The corners, counter-clockwise; none if the cell lies outside of the polygon.
    pub corners: Vec<[f64; 2]>,
    /// The area, in square units of the coordinates.
    pub area: f64,
}

/// The points whose product with `normal` is at most `offset`: a half plane, or half of space.
pub(super) struct HalfSpace<const D: usize> {
    pub(super) normal: [f64; D],
    pub(super) offset: f64,
}

impl<const D: usize> HalfSpace<D> {
    /// Returns the points nearer to the origin than to `p`.
    fn nearer_than(p: [f64; D]) -> Self {
        Self::of_less_power(p, 0.0)
    }

    /// Returns the points of less power to the origin than to `p`, where the weight of the origin
    /// is larger `by` this much.
    pub(super) fn of_less_power(p: [f64; D], by: f64) -> Self {
        HalfSpace { normal: p, offset: (dot(p, p) + by) / 2.0 }
    }

    /// Returns how far a point lies beyond the border, times the length of the normal.
    pub(super) fn excess(&self, p: [f64; D]) -> f64 {
        dot(self.normal, p) - self.offset
    }

    /// Returns the part of a convex polygon in the half space.
    pub(super) fn clip(&self, polygon: Vec<[f64; D]>) -> Vec<[f64; D]> {
        self.clip_with_sides(polygon, |_| ())
    }

    /// Returns the part of a convex polygon in the half space, and reports its new sides, which run
    /// along the border (Sutherland and Hodgman 1974, for one line). Polygons that share a side are
    /// cut at the same point of it.
    pub(super) fn clip_with_sides(
        &self,
        polygon: Vec<[f64; D]>,
        mut new_side: impl FnMut([[f64; D]; 2]),
    ) -> Vec<[f64; D]> {
        if polygon.iter().all(|&p| self.excess(p) <= 0.0) {
            return polygon;
        }
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        // Where the polygon leaves the half space, and where it returned before it ever left.
        let (mut exit, mut first_return) = (None, None);
        for (k, &p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            let (at_p, at_q) = (self.excess(p), self.excess(q));
            if at_p <= 0.0 {
                clipped.push(p);
            }
            if at_p <= 0.0 && at_q > 0.0 {
                let border = between((p, at_p), (q, at_q));
                if at_p < 0.0 {
                    clipped.push(border);
                }
                exit = Some(border);
            } else if at_p > 0.0 && at_q <= 0.0 {
                let border = between((q, at_q), (p, at_p));
                if at_q < 0.0 {
                    clipped.push(border);
                }
                match exit.take() {
                    Some(exit) => new_side([exit, border]),
                    None => first_return = Some(border),
                }
            }
        }
        if let (Some(exit), Some(border)) = (exit, first_return) {
            new_side([exit, border]);
        }
        clipped
    }
}

/// Returns the point of a segment on the border of a half space, given how far a point within and
/// one beyond it lie beyond the border. The direction is fixed, so that it is one point for all
/// polygons with this side.
fn between<const D: usize>((inside, below): ([f64; D], f64), (beyond, above): ([f64; D], f64)) -> [f64; D] {
    if below == 0.0 {
        return inside;
    }
    let along = below / (below - above);
    plus(inside, minus(beyond, inside).map(|x| along * x))
}

pub(super) fn dot<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (1..D).fold(p[0] * q[0], |sum, k| sum + p[k] * q[k])
}

pub(super) fn minus<const D: usize>(p: [f64; D], q: [f64; D]) -> [f64; D] {
    std::array::from_fn(|k| p[k] - q[k])
}

pub(super) fn plus<const D: usize>(p: [f64; D], q: [f64; D]) -> [f64; D] {
    std::array::from_fn(|k| p[k] + q[k])
}

/// Returns twice the area of a polygon, positive if it is counter-clockwise.
pub(super) fn twice_area(polygon: &[[f64; 2]]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum()
}

/// Returns the cell of a site: the part of a convex polygon in half planes that are given relative
/// to the site.
pub(super) fn cell_of(
    site: [f64; 2],
    half_planes: impl Iterator<Item = HalfSpace<2>>,
    within: &[[f64; 2]],
) -> VoronoiCell {
    let is_polygon = within.as_flattened().iter().all(|x| x.is_finite());
    let polygon = within.iter().filter(|_| is_polygon).map(|&p| minus(p, site)).collect();
    let cell: Vec<[f64; 2]> = half_planes.fold(polygon, |polygon, half_plane| half_plane.clip(polygon));
    if cell.len() < 3 {
        return VoronoiCell { corners: Vec::new(), area: 0.0 };
    }
    VoronoiCell { area: twice_area(&cell) / 2.0, corners: cell.into_iter().map(|p| plus(p, site)).collect() }
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
            return Some(VoronoiEdge::Line { through: between(ends), direction: [-dy, dx] });
        }
        Some(match [cell, self.tds().neighbor(cell, i)].map(center) {
            [Some(from), Some(to)] => VoronoiEdge::Segment([from, to]),
            // The face lies to the left of `a b`, or to its right.
            [Some(from), None] => VoronoiEdge::Ray { from, direction: [dy, -dx] },
            [None, from] => VoronoiEdge::Ray { from: from?, direction: [-dy, dx] },
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
            return VoronoiCell { corners: Vec::new(), area: 0.0 };
        }
        let site = self.site(vertex);
        let neighbors = self.tds().vertices_around(vertex).filter(|&v| v != VertexId::INFINITE);
        cell_of(site, neighbors.map(|v| HalfSpace::nearer_than(minus(self.site(v), site))), within)
    }
}
