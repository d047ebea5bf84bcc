//! The vertices of a Delaunay or regular triangulation by their distance from a point.
//!
//! All of it follows from one fact: a vertex that is not nearest to a point has a neighbor that is
//! nearer, because its Voronoi cell, bounded by bisectors with neighbors, does not contain the
//! point. So a walk to nearer neighbors ends at a nearest vertex. And each vertex is a neighbor of
//! one that precedes it in the order of distance, so that none is missed if the next is always the
//! nearest of all neighbors of those found. The same holds for a regular triangulation, with power
//! for distance and the cells of its power diagram.

use std::borrow::Borrow;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::convert::Infallible;

use rustc_hash::FxHashSet;

use crate::embedded::{Embedded, PointOf};
use crate::geometry::{Geometry, Metric};
use crate::kinds::Delaunay;
use crate::locate::Location;
use crate::locate::locate;
use crate::tds::{CellId, Complex, Neighbors, Tds, VertexId, vertices_of};

/// A vertex that was found but not yet returned: the nearest is the greatest.
struct VertexByDistance<'t, T: Embedded<N>, const N: usize> {
    t: &'t T,
    q: PointOf<T, N>,
    vertex: VertexId,
    point: T::PointRef<'t>,
}

impl<T: Embedded<N, Geometry: Metric<N>>, const N: usize> VertexByDistance<'_, T, N> {
    /// Returns true if the vertex is no further from the point than `rim` is.
    fn is_within(&self, rim: &PointOf<T, N>) -> bool {
        self.t
            .geometry()
            .compare_distance(&self.q, self.point.borrow(), rim)
            .is_le()
    }
}

impl<T: Embedded<N, Geometry: Metric<N>>, const N: usize> Ord for VertexByDistance<'_, T, N> {
    fn cmp(&self, other: &Self) -> Ordering {
        let (geometry, ours, theirs) =
            (self.t.geometry(), self.point.borrow(), other.point.borrow());
        geometry
            .compare_distance(&self.q, theirs, ours)
            .then_with(|| geometry.compare(theirs, ours))
    }
}

impl<T: Embedded<N, Geometry: Metric<N>>, const N: usize> PartialOrd
    for VertexByDistance<'_, T, N>
{
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T: Embedded<N, Geometry: Metric<N>>, const N: usize> PartialEq for VertexByDistance<'_, T, N> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<T: Embedded<N, Geometry: Metric<N>>, const N: usize> Eq for VertexByDistance<'_, T, N> {}

/// Iterates over the vertices of a Delaunay triangulation by their distance from a point.
struct NearestFirst<'t, T: Embedded<N, Geometry: Metric<N>>, const N: usize> {
    t: &'t T,
    q: PointOf<T, N>,
    found: FxHashSet<VertexId>,
    next: BinaryHeap<VertexByDistance<'t, T, N>>,
}

impl<'t, T: Embedded<N, Geometry: Metric<N>, Complex: Neighbors<N>>, const N: usize>
    NearestFirst<'t, T, N>
{
    /// Starts at the location of the point.
    fn new(t: &'t T, q: &PointOf<T, N>, location: Location) -> Result<Self, T::Error> {
        let mut nearest = NearestFirst {
            t,
            q: *q,
            found: FxHashSet::default(),
            next: BinaryHeap::new(),
        };
        all_nearest(t, q, location)?
            .into_iter()
            .try_for_each(|vertex| nearest.find(vertex))?;
        Ok(nearest)
    }

    fn find(&mut self, vertex: VertexId) -> Result<(), T::Error> {
        if self.found.insert(vertex) {
            self.next.push(VertexByDistance {
                t: self.t,
                q: self.q,
                vertex,
                point: self.t.point(vertex)?,
            });
        }
        Ok(())
    }
}

impl<'t, T: Embedded<N, Geometry: Metric<N>, Complex: Neighbors<N>>, const N: usize> Iterator
    for NearestFirst<'t, T, N>
{
    type Item = Result<VertexByDistance<'t, T, N>, T::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let nearest = self.next.pop()?;
        let around = finite_neighbors(self.t, nearest.vertex);
        let all_found =
            around.and_then(|mut around| around.try_for_each(|vertex| self.find(vertex?)));
        Some(match all_found {
            Ok(()) => Ok(nearest),
            Err(error) => {
                self.next.clear();
                Err(error)
            }
        })
    }
}

fn finite_neighbors<T: Embedded<N, Complex: Neighbors<N>>, const N: usize>(
    t: &T,
    vertex: VertexId,
) -> Result<impl Iterator<Item = Result<VertexId, T::Error>> + use<'_, T, N>, T::Error> {
    let around = t.complex().neighbors_of(vertex)?;
    Ok(around.filter(|v| !v.as_ref().is_ok_and(|&v| v == VertexId::INFINITE)))
}

/// Returns the vertex nearest to a point; of several, the first in the [order](Geometry::compare)
/// of the geometry. `None` if there are no vertices, or if the geometry does not
/// [admit](Geometry::admits) the point.
///
/// Exact in a Delaunay triangulation, and in a regular one (by power); the walk to the point starts
/// at a cell nearby. In other triangulations the result may not be the nearest.
///
/// # Errors
/// If links of the structure contradict each other.
///
/// # Complexity
/// That of [`locate`](super::locate), and the degrees of a few vertices.
pub fn nearest<T: Embedded<N, Geometry: Metric<N>, Complex: Neighbors<N>>, const N: usize>(
    t: &T,
    q: &PointOf<T, N>,
    near: Option<CellId>,
) -> Result<Option<VertexId>, T::Error> {
    let location = locate(t, q, near)?;
    let mut first: Option<(VertexId, T::PointRef<'_>)> = None;
    for vertex in all_nearest(t, q, location)? {
        let point = t.point(vertex)?;
        if first.is_none_or(|(_, best)| t.geometry().compare(point.borrow(), best.borrow()).is_lt())
        {
            first = Some((vertex, point));
        }
    }
    Ok(first.map(|(vertex, _)| vertex))
}

/// Returns all vertices of a Delaunay triangulation, nearest first; vertices at equal distances are
/// in the order of the geometry. Empty where [`nearest`] returns `None`. Ends at the first error.
///
/// # Errors
/// If links of the structure contradict each other.
///
/// # Complexity
/// That of [`nearest`], and `O(d log k)` for the `k`-th vertex, of degree `d`.
pub fn nearest_first<
    't,
    T: Embedded<N, Geometry: Metric<N>, Complex: Neighbors<N>>,
    const N: usize,
>(
    t: &'t T,
    q: &PointOf<T, N>,
    near: Option<CellId>,
) -> Result<impl Iterator<Item = Result<VertexId, T::Error>> + use<'t, T, N>, T::Error> {
    let nearest = NearestFirst::new(t, q, locate(t, q, near)?)?;
    Ok(nearest.map(|candidate| Ok(candidate?.vertex)))
}

/// Returns the vertices of a Delaunay triangulation that are no further from a center than `rim`
/// is, nearest first. Empty if the geometry does not [admit](Geometry::admits) the center or the
/// rim. Ends at the first error.
///
/// # Errors
/// If links of the structure contradict each other.
///
/// # Complexity
/// That of [`nearest_first`].
pub fn within<'t, T: Embedded<N, Geometry: Metric<N>, Complex: Neighbors<N>>, const N: usize>(
    t: &'t T,
    center: &PointOf<T, N>,
    rim: &PointOf<T, N>,
    near: Option<CellId>,
) -> Result<impl Iterator<Item = Result<VertexId, T::Error>> + use<'t, T, N>, T::Error> {
    let location = if t.geometry().admits(rim) {
        locate(t, center, near)?
    } else {
        Location::Nowhere
    };
    let nearest = NearestFirst::new(t, center, location)?;
    let rim = *rim;
    let is_within = move |candidate: &Result<VertexByDistance<'t, T, N>, T::Error>| {
        candidate
            .as_ref()
            .map_or(true, |candidate| candidate.is_within(&rim))
    };
    Ok(nearest
        .take_while(is_within)
        .map(|candidate| Ok(candidate?.vertex)))
}

/// Returns the first of the vertices that none of the others is nearer than.
fn nearest_of<T: Embedded<N, Geometry: Metric<N>>, const N: usize>(
    t: &T,
    q: &PointOf<T, N>,
    vertices: &[VertexId],
) -> Result<Option<VertexId>, T::Error> {
    let mut nearest: Option<(VertexId, T::PointRef<'_>)> = None;
    for &vertex in vertices {
        let point = t.point(vertex)?;
        if nearest.is_none_or(|(_, best)| {
            t.geometry()
                .compare_distance(q, point.borrow(), best.borrow())
                .is_lt()
        }) {
            nearest = Some((vertex, point));
        }
    }
    Ok(nearest.map(|(vertex, _)| vertex))
}

/// Returns all vertices at the smallest distance. They lie on an empty circle or sphere around the
/// point, and edges along its chords connect them all.
fn all_nearest<T: Embedded<N, Geometry: Metric<N>, Complex: Neighbors<N>>, const N: usize>(
    t: &T,
    q: &PointOf<T, N>,
    location: Location,
) -> Result<Vec<VertexId>, T::Error> {
    let complex = t.complex();
    let start = match location {
        Location::Vertex(vertex) => Some(vertex), // with weights, another may be nearer
        Location::Cell { cell, .. } | Location::OutsideHull { cell } => {
            let mut corners = complex.corners(cell)?[..complex.width()].to_vec();
            corners.retain(|&v| v != VertexId::INFINITE);
            nearest_of(t, q, &corners)?
        }
        Location::OutsideAffineHull => vertices_of::<N, T::Complex>(complex).next().transpose()?,
        Location::Nowhere => None,
    };
    let mut nearest: Vec<VertexId> = start.into_iter().collect();
    // All of these except the first.
    let mut found = FxHashSet::default();
    let mut next = 0;
    while next < nearest.len() {
        let vertex = nearest[next];
        let point = t.point(vertex)?;
        next += 1;
        for v in finite_neighbors(t, vertex)? {
            let v = v?;
            match t
                .geometry()
                .compare_distance(q, t.point(v)?.borrow(), point.borrow())
            {
                Ordering::Less => {
                    nearest = vec![v];
                    found.clear();
                    next = 0;
                    break;
                }
                Ordering::Equal if v != nearest[0] && found.insert(v) => nearest.push(v),
                _ => {}
            }
        }
    }
    Ok(nearest)
}

impl<G: Metric<N>, const N: usize, V, C: Copy + Default> Delaunay<G, N, V, C>
where
    Tds<N, V, C>: Neighbors<N, Error = Infallible>,
{
    /// Returns the vertex nearest to a point; of several, the first in the
    /// [order](crate::geometry::Geometry::compare) of the geometry. `None` if there are no
    /// vertices, or if the geometry does not [admit](crate::geometry::Geometry::admits) the point;
    /// with the kernel [`Wide`](crate::kernel::Wide) it admits every finite one. Exact.
    ///
    /// # Complexity
    /// A [walk](crate::Triangulation::locate) from a cell nearby, and the degrees of
    /// a few vertices. From outside of the hull, and on a line, the walk may visit all vertices
    /// there. If the points are far apart, give the cell at the location that a
    /// [`Hierarchy`](crate::Hierarchy) returns.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
    /// let (t, v) = Delaunay::from_points(Plane::new(), &points)?;
    /// assert_eq!(t.nearest(&[4.0, 2.0], None), Some(v[2]));
    /// assert!(t.nearest_first(&[4.0, 2.0], None).take(2).eq([v[2], v[1]]));
    /// assert!(t.within(&[4.0, 2.0], &[4.0, 0.0]).eq([v[2], v[1]]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nearest(&self, q: &G::Point, near: Option<CellId>) -> Option<VertexId> {
        let Ok(nearest) = nearest(&self.inner, q, self.start(near));
        nearest
    }

    /// Returns all vertices, nearest first: [`take`](Iterator::take) as many as you need. Vertices
    /// at equal distances are in the order of the geometry. Empty where [`nearest`](Self::nearest)
    /// returns `None`. Exact.
    ///
    /// # Complexity
    /// That of [`nearest`](Self::nearest), and O(d log k) for the `k`-th vertex, of degree `d`.
    pub fn nearest_first<'a>(
        &'a self,
        q: &G::Point,
        near: Option<CellId>,
    ) -> impl Iterator<Item = VertexId> + use<'a, G, N, V, C> {
        let Ok(nearest) = nearest_first(&self.inner, q, self.start(near));
        nearest.map(|Ok(vertex)| vertex)
    }

    /// Returns the vertices that are no further from a center than `rim` is, nearest first. Exact:
    /// a point on the circle or sphere gives the radius, because a length would be rounded. Empty
    /// if the geometry does not [admit](crate::geometry::Geometry::admits) the center or the rim.
    ///
    /// # Complexity
    /// That of [`nearest_first`](Self::nearest_first).
    pub fn within<'a>(
        &'a self,
        center: &G::Point,
        rim: &G::Point,
    ) -> impl Iterator<Item = VertexId> + use<'a, G, N, V, C> {
        let Ok(within) = within(&self.inner, center, rim, self.start(None));
        within.map(|Ok(vertex)| vertex)
    }
}
