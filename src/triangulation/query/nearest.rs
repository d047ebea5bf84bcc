//! The vertices of a Delaunay triangulation by their distance from a place.
//!
//! All follows from one fact: a vertex that is not nearest to a place has a neighbor that is nearer, because its Voronoi
//! cell, bounded by bisectors with neighbors, does not hold the place. So a walk to nearer neighbors ends at a nearest
//! vertex; and each vertex is a neighbor of one that comes before it in the order of distance, so that none is missed if
//! the nearest of all neighbors of what has been found comes next.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use rustc_hash::FxHashSet;

use crate::geometry::Metric;
use crate::tds::{CellId, VertexId};

use super::super::{Delaunay, Location};

/// A vertex found, but not yet told: the nearest is the greatest.
struct Candidate<'a, G: Metric, V> {
    delaunay: &'a Delaunay<G, 3, V>,
    q: G::Point,
    vertex: VertexId,
}

impl<G: Metric, V> Ord for Candidate<'_, G, V> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.delaunay.by_distance(&self.q, other.vertex, self.vertex)
    }
}

impl<G: Metric, V> PartialOrd for Candidate<'_, G, V> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<G: Metric, V> PartialEq for Candidate<'_, G, V> {
    fn eq(&self, other: &Self) -> bool {
        self.vertex == other.vertex
    }
}

impl<G: Metric, V> Eq for Candidate<'_, G, V> {}

impl<G: Metric, V> Delaunay<G, 3, V> {
    /// The vertex nearest to a place; of several, the first in the [order](crate::geometry::Geometry::compare) of the
    /// geometry. `None` if there are no vertices. Exact. The place must be one that the geometry admits.
    ///
    /// # Complexity
    /// A [walk](crate::triangulation::Triangulation::locate) from a cell nearby, and the degrees of a few vertices. From
    /// beyond the hull, and on a line, the walk may lead along all vertices there.
    ///
    /// ```
    /// use breakline::{geometry::Plane, triangulation::Delaunay};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
    /// let (t, v) = Delaunay::from_points(Plane::<breakline::kernel::Adaptive>::default(), &points)?;
    /// assert_eq!(t.nearest(&[4.0, 2.0], None), Some(v[2]));
    /// assert!(t.nearest_first(&[4.0, 2.0], None).take(2).eq([v[2], v[1]]));
    /// assert!(t.within(&[4.0, 2.0], &[4.0, 0.0]).eq([v[2], v[1]]));
    /// # Ok::<(), breakline::triangulation::Refused>(())
    /// ```
    pub fn nearest(&self, q: &G::Point, near: Option<CellId>) -> Option<VertexId> {
        self.all_nearest(q, near).into_iter().min_by(|&u, &v| self.geometry().compare(self.point(u), self.point(v)))
    }

    /// All vertices from the nearest to the furthest: [`take`](Iterator::take) as many as are wanted. Those that are
    /// equally far come in the order of the geometry. Exact.
    ///
    /// # Complexity
    /// As [`nearest`](Self::nearest), and O(d log k) for the `k`-th, of degree `d`.
    pub fn nearest_first<'a>(
        &'a self,
        q: &G::Point,
        near: Option<CellId>,
    ) -> impl Iterator<Item = VertexId> + use<'a, G, V> {
        let q = *q;
        let first = self.all_nearest(&q, near);
        let mut found: FxHashSet<VertexId> = first.iter().copied().collect();
        let candidate = move |vertex| Candidate { delaunay: self, q, vertex };
        let mut next: BinaryHeap<_> = first.into_iter().map(candidate).collect();
        std::iter::from_fn(move || {
            let vertex = next.pop()?.vertex;
            next.extend(self.finite_neighbors(vertex).filter(|&v| found.insert(v)).map(candidate));
            Some(vertex)
        })
    }

    /// The vertices no further from a place than `rim` is, nearest first. Exact: the circle is given by a point on it, as
    /// the length of a radius is rounded.
    ///
    /// # Complexity
    /// As [`nearest_first`](Self::nearest_first).
    pub fn within<'a>(&'a self, center: &G::Point, rim: &G::Point) -> impl Iterator<Item = VertexId> + use<'a, G, V> {
        let (from, rim) = (*center, *rim);
        let is_within = move |&v: &VertexId| self.geometry().compare_distance(&from, self.point(v), &rim).is_le();
        self.nearest_first(center, None).take_while(is_within)
    }

    fn by_distance(&self, q: &G::Point, u: VertexId, v: VertexId) -> Ordering {
        let (u, v) = (self.point(u), self.point(v));
        self.geometry().compare_distance(q, u, v).then_with(|| self.geometry().compare(u, v))
    }

    fn finite_neighbors(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.tds().vertices_around(vertex).filter(|&v| v != VertexId::INFINITE)
    }

    /// All vertices that no other is nearer than. They lie on an empty circle around the place, on whose chords edges
    /// join them all.
    fn all_nearest(&self, q: &G::Point, near: Option<CellId>) -> Vec<VertexId> {
        let start = match self.locate(q, near) {
            Location::Vertex(vertex) => return vec![vertex],
            Location::Cell { cell, .. } | Location::OutsideHull { cell } => {
                self.tds().cell_vertices(cell).iter().copied().find(|&v| v != VertexId::INFINITE)
            }
            Location::OutsideAffineHull => self.tds().vertices().next(),
        };
        let mut nearest: Vec<VertexId> = start.into_iter().collect();
        let mut next = 0;
        while next < nearest.len() {
            let vertex = nearest[next];
            next += 1;
            for v in self.finite_neighbors(vertex) {
                match self.geometry().compare_distance(q, self.point(v), self.point(vertex)) {
                    Ordering::Less => {
                        nearest = vec![v];
                        next = 0;
                        break;
                    }
                    Ordering::Equal if !nearest.contains(&v) => nearest.push(v),
                    _ => {}
                }
            }
        }
        nearest
    }
}
