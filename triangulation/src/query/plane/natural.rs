//! Natural neighbor coordinates.
//!
//! If a point were a vertex, its Voronoi cell would take some area from the cells of its *natural
//! neighbors*: the vertices around its [conflict zone](ConflictZone). Nothing is inserted to
//! compute that: the new corners of cells are circumcenters over the border of the zone, the old
//! ones those of the faces within.
//!
//! | weight of a neighbor | is proportional to |
//! |---|---|
//! | [Sibson](Delaunay::sibson)'s | the area that its cell loses |
//! | [Laplace](Delaunay::laplace)'s | the length of the border with the new cell, over its distance |
//!
//! Both are positive, sum up to 1, and reproduce the point as the weighted mean of its neighbors.
//! So they interpolate, and linear functions exactly. They are continuous. Sibson's are smooth
//! except at the vertices; Laplace's are less smooth and cheaper.

use rustc_hash::FxHashMap;

use crate::geometry::Coordinates;
use crate::kernel;
use crate::kinds::Delaunay;
use crate::locate::Location;
use crate::tds::{CellId, VertexId, ccw};

use crate::query::dual::{minus, plus};

use super::dual::twice_area;
use crate::query::zone::ConflictZone;

/// Vertices with weights.
type VertexWeights = Vec<(VertexId, f64)>;

impl<G: Coordinates<3>, V, C: Copy + Default> Delaunay<G, 3, V, C> {
    /// Returns Sibson's coordinates of a point: vertices, counter-clockwise, with weights that are
    /// not negative, sum up to 1, and whose mean is the point. Rounded: in all tests the mean is
    /// within `1e-11` of the point, for points that are some 10 apart.
    ///
    /// On a vertex, returns that vertex with a weight of exactly 1. On an edge of the hull, and
    /// between two of collinear points, returns both ends in linear proportion, which is the limit
    /// from within. `None` outside of the hull, for a point that the geometry does not
    /// [admit](crate::geometry::Geometry::admits), and where squares of distances overflow or
    /// underflow (distances beyond `1e150` or below `1e-150`). The circles of the geometry must be
    /// circles in its coordinates.
    ///
    /// After Sibson 1981, *A brief description of natural neighbour interpolation*; without
    /// insertion as Watson 1992, *Contouring*.
    ///
    /// # Complexity
    /// A [walk](crate::Triangulation::locate) from a cell nearby, and time
    /// proportional to the size of the conflict zone: some six neighbors.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    /// let (t, _) = Delaunay::from_points(Plane::new(), &points)?;
    /// let weights = t.sibson(&[1.0, 1.0], None).expect("it is inside");
    /// let x: f64 = weights.iter().map(|&(v, weight)| weight * t.point(v)[0]).sum();
    /// assert!((x - 1.0).abs() < 1e-12);
    /// assert_eq!(t.sibson(&[9.0, 1.0], None), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sibson(&self, q: &G::Point, near: Option<CellId>) -> Option<VertexWeights> {
        self.coordinates(q, near, |zone, at, new| {
            // Relative to the point, which all of them surround.
            let center = |&cell: &CellId| {
                let corners = self.tds().corners(cell).map(|v| self.site(v));
                (
                    cell,
                    plus(minus(corners[0], at), kernel::circumcenter(corners)),
                )
            };
            let old: FxHashMap<CellId, [f64; 2]> = zone.cells.iter().map(center).collect();
            let mut lost = Vec::new();
            let weight = |k: usize, vertex: VertexId| {
                // The area that a cell loses: from the first face around the vertex to the last
                // one, then to the new corners.
                let next = (k + 1) % new.len();
                let (mut cell, last) = (zone.border[next].0, zone.border[k].0);
                lost.clear();
                lost.extend(old.get(&cell));
                while cell != last
                    && let Some(i) = self.tds().index_of(cell, vertex)
                {
                    cell = self.tds().neighbor(cell, ccw(i));
                    lost.extend(old.get(&cell));
                }
                lost.extend([new[k], new[next]]);
                twice_area(&lost)
            };
            self.around(zone, weight)
        })
    }

    /// Returns Laplace's coordinates of a point, also called non-Sibsonian. Results and cost are
    /// those of [`sibson`](Self::sibson), except that no face inside of the zone is read.
    ///
    /// After Belikov, Ivanov, Kontorovich, Korytnik and Semenov 1997, *The non-Sibsonian
    /// interpolation*.
    pub fn laplace(&self, q: &G::Point, near: Option<CellId>) -> Option<VertexWeights> {
        self.coordinates(q, near, |zone, at, new| {
            let weight = |k: usize, vertex: VertexId| {
                let length = |[x, y]: [f64; 2]| x.hypot(y);
                length(minus(new[(k + 1) % new.len()], new[k]))
                    / length(minus(self.site(vertex), at))
            };
            self.around(zone, weight)
        })
    }

    /// Returns the weights on the border of a zone; `weight` gets the position there and the vertex
    /// that the edge ends at.
    fn around(
        &self,
        zone: &ConflictZone,
        mut weight: impl FnMut(usize, VertexId) -> f64,
    ) -> VertexWeights {
        let ends = zone
            .border
            .iter()
            .map(|&(cell, i)| self.tds().edge_ends(cell, i)[1]);
        ends.enumerate()
            .map(|(k, vertex)| (vertex, weight(k, vertex).max(0.0)))
            .collect()
    }

    /// Returns weights that sum up to 1, from those that `inside` returns for a point within the
    /// hull. It gets the zone, the point, and the corners of the point's Voronoi cell relative to
    /// it, one for each edge of the border.
    fn coordinates(
        &self,
        q: &G::Point,
        near: Option<CellId>,
        inside: impl FnOnce(&ConflictZone, [f64; 2], &[[f64; 2]]) -> VertexWeights,
    ) -> Option<VertexWeights> {
        let at = crate::query::site_of(&self.geometry, q);
        let location = self.locate(q, near);
        let mut weights = match location {
            Location::Vertex(vertex) => return Some(vec![(vertex, 1.0)]),
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => {
                return None;
            }
            Location::Cell { cell, .. } if self.dimension() == 1 => {
                self.between(self.tds().edge_ends(cell, 2), at)
            }
            Location::Cell { cell, facets } => {
                let on_hull = facets
                    .iter()
                    .find(|&i| self.tds().is_infinite(self.tds().neighbor(cell, i)));
                if let Some(i) = on_hull {
                    self.between(self.tds().edge_ends(cell, i), at)
                } else {
                    let Ok(zone) =
                        crate::query::zone::zone_at(&self.inner, q, location, |_, _| Ok(true));
                    let zone = zone?;
                    let center = |&(cell, i): &(CellId, usize)| {
                        let [a, b] = self.tds().edge_ends(cell, i).map(|v| self.site(v));
                        kernel::circumcenter([at, a, b])
                    };
                    let new: Vec<[f64; 2]> = zone.border.iter().map(center).collect();
                    inside(&zone, at, &new)
                }
            }
        };
        let sum: f64 = weights.iter().map(|&(_, weight)| weight).sum();
        // Lengths whose squares overflow or underflow.
        if !(sum > 0.0 && sum.is_finite()) {
            return None;
        }
        weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
        Some(weights)
    }

    /// Interpolates linearly between two vertices.
    fn between(&self, ends: [VertexId; 2], at: [f64; 2]) -> VertexWeights {
        let [a, b] = ends
            .map(|v| minus(self.site(v), at))
            .map(|[x, y]| x.hypot(y));
        vec![(ends[0], b), (ends[1], a)]
    }
}
