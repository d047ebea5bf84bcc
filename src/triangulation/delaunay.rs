use std::ops::Deref;

use crate::geometry::{Coordinates, Geometry};
use crate::tds::VertexId;

use super::{Refused, Triangulation, spatial_order};

/// A Delaunay triangulation, of triangles in the plane or of tetrahedra in space: `N` follows from the
/// geometry.
///
/// Ties between cospherical points are broken by a rule on the points alone, so that equal sets of
/// points have equal triangulations.
#[derive(Debug, Clone)]
pub struct Delaunay<G: Geometry<N>, const N: usize, V = ()> {
    pub(super) inner: Triangulation<G, N, V>,
}

impl<G: Geometry<N>, const N: usize, V> Deref for Delaunay<G, N, V> {
    type Target = Triangulation<G, N, V>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<N>, const N: usize, V> Delaunay<G, N, V> {
    /// Without points.
    pub fn new(geometry: G) -> Self {
        Delaunay { inner: Triangulation::new(geometry) }
    }

    /// Adds a point with a payload; the vertex that is there already, with the payload it has, if the
    /// site is taken.
    ///
    /// # Errors
    /// If a coordinate is not finite or out of range; nothing has changed then.
    ///
    /// # Complexity
    /// A walk from the last insertion, and time proportional to the number of cells replaced: constant
    /// on average for points in spatial order.
    pub fn insert_with(&mut self, p: G::Point, data: V) -> Result<VertexId, Refused> {
        self.inner.admit(&p)?;
        let location = self.inner.locate(&p, None);
        Ok(self.inner.insert_at(p, location, data, |_, _, _| true, |_, _| ()))
    }
}

impl<G: Geometry<N>, const N: usize> Delaunay<G, N> {
    /// Adds a point; the vertex that is there already, if the site is taken.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    pub fn insert(&mut self, p: G::Point) -> Result<VertexId, Refused> {
        self.insert_with(p, ())
    }
}

impl<G: Coordinates<N>, const N: usize> Delaunay<G, N> {
    /// Triangulates many points, taken in spatial order. Returns the vertex of each point beside;
    /// points on one site share theirs.
    ///
    /// # Errors
    /// The first point that is refused, by its position.
    ///
    /// # Complexity
    /// O(n log n) to sort; linear in practice to insert.
    pub fn from_points(geometry: G, points: &[G::Point]) -> Result<(Self, Vec<VertexId>), Refused> {
        if let Some(bad) = points.iter().position(|p| !geometry.admits(p)) {
            return Err(Refused::Coordinate(bad));
        }
        let order = spatial_order(points.len(), |i| geometry.coordinates(&points[i]))?;
        let mut triangulation = Self::new(geometry);
        triangulation.inner.points.reserve_exact(points.len());
        triangulation.inner.tds.reserve(points.len());
        let mut vertices = vec![VertexId::INFINITE; points.len()];
        for index in order {
            vertices[index as usize] = triangulation.insert(points[index as usize])?;
        }
        Ok((triangulation, vertices))
    }
}
