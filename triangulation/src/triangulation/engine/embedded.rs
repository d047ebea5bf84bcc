use std::borrow::Borrow;
use std::convert::Infallible;

use crate::geometry::Geometry;
use crate::tds::{Complex, Tds, VertexId};

use super::super::Triangulation;

/// A complex whose vertices have points: what the editable [`Triangulation`] and the read-only
/// [`Compact`](crate::Compact) have in common. Location and the other questions are written once over this trait.
///
/// # Laws
/// - Points that are no error are such as the geometry [admits](Geometry::admits).
///
/// # Models
/// [`Triangulation`], [`Compact`](crate::Compact).
pub trait Embedded<const N: usize> {
    /// What is asked of points.
    type Geometry: Geometry<N>;
    /// Who is whose neighbor.
    type Complex: Complex<N, Error = Self::Error>;
    /// What becomes of a link, or of a point, that cannot be.
    type Error;
    /// A point where it is kept, or a copy of it.
    type Held<'a>: Borrow<PointOf<Self, N>> + Copy
    where
        Self: 'a;

    /// The geometry.
    fn geometry(&self) -> &Self::Geometry;

    /// The combinatorics.
    fn complex(&self) -> &Self::Complex;

    /// The point of a finite vertex.
    ///
    /// # Errors
    /// If there is none, or the geometry does not admit it.
    fn point(&self, vertex: VertexId) -> Result<Self::Held<'_>, Self::Error>;

    /// A point of one's own, as those of vertices come.
    fn hold<'a>(point: &'a PointOf<Self, N>) -> Self::Held<'a>
    where
        Self: 'a;
}

/// What the vertices of a triangulation have as points.
pub type PointOf<T, const N: usize> = <<T as Embedded<N>>::Geometry as Geometry<N>>::Point;

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Embedded<N> for Triangulation<G, N, V, C> {
    type Geometry = G;
    type Complex = Tds<N, V, C>;
    type Error = Infallible;
    type Held<'a>
        = &'a G::Point
    where
        Self: 'a;

    #[inline(always)]
    fn geometry(&self) -> &G {
        &self.geometry
    }

    #[inline(always)]
    fn complex(&self) -> &Tds<N, V, C> {
        &self.tds
    }

    #[inline(always)]
    fn point(&self, vertex: VertexId) -> Result<&G::Point, Infallible> {
        Ok(&self.points[vertex.index()])
    }

    #[inline(always)]
    fn hold<'a>(point: &'a G::Point) -> &'a G::Point
    where
        Self: 'a,
    {
        point
    }
}
