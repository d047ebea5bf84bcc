//! Structures with points, and on which sides of their cells a point lies.

pub(crate) mod sides;

use std::borrow::Borrow;

use crate::geometry::{Coordinates, Geometry};
use crate::tds::{Complex, VertexId};

/// A complex whose vertices have points. [`Triangulation`](crate::Triangulation), the read-only
/// [`Compact`](crate::Compact) and structures of the user's own implement it. Location and the
/// other [queries](crate::query) are written once over this trait.
///
/// *Why it is as it is.* Some structures store points, others have to decode them: so a point is
/// returned as a [`PointRef`](Self::PointRef), a reference or a copy. The complex is a type of its
/// own, so that a structure may keep its cells in a [`Tds`](crate::tds::Tds). A structure in memory
/// that cannot be damaged has the error [`Infallible`](std::convert::Infallible), which leaves
/// nothing in the machine code.
///
/// # Laws
/// - Each finite vertex has a point, and the geometry [admits](Geometry::admits) it.
/// - Finite cells are positively oriented. They fill the convex hull of the points without overlap:
///   what is not convex is filled up.
/// - Across each facet of the hull there is an infinite cell.
///
/// # Models
/// [`Triangulation`](crate::Triangulation), [`Compact`](crate::Compact). A model of your own, with
/// points and a complex:
///
/// ```
/// use std::convert::Infallible;
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::tds::{Tds, TdsError, VertexId};
/// use breakline_triangulation::{Embedded, Location, query};
///
/// struct Sites { plane: Plane, points: Vec<[f64; 2]>, cells: Tds<3> }
///
/// impl Embedded<3> for Sites {
///     type Geometry = Plane;
///     type Complex = Tds<3>;
///     type Error = Infallible;
///     type PointRef<'a> = &'a [f64; 2];
///     fn geometry(&self) -> &Plane { &self.plane }
///     fn complex(&self) -> &Tds<3> { &self.cells }
///     fn point(&self, vertex: VertexId) -> Result<&[f64; 2], Infallible> { Ok(&self.points[vertex.index()]) }
///     fn point_ref<'a>(point: &'a [f64; 2]) -> &'a [f64; 2] where Self: 'a { point }
/// }
///
/// // Two triangles, and the four infinite ones around them.
/// let [a, b, c, d] = [0, 1, 2, 3].map(VertexId::new);
/// let far = VertexId::INFINITE;
/// let cells = [[a, b, c], [a, c, d], [b, a, far], [c, b, far], [d, c, far], [a, d, far]];
/// let cells = Tds::from_cells(vec![(); 4], &cells)?;
/// let square = Sites { plane: Plane::new(), points: vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]], cells };
/// assert_eq!(query::locate(&square, &[4.0, 4.0], None), Ok(Location::Vertex(c)));
/// assert_eq!(query::nearest(&square, &[1.0, 3.0], None), Ok(Some(d)));
/// # Ok::<(), TdsError>(())
/// ```
pub trait Embedded<const N: usize> {
    /// The geometry, which evaluates predicates on points.
    type Geometry: Geometry<N>;
    /// The cells and their neighbors.
    type Complex: Complex<N, Error = Self::Error>;
    /// The error for a broken link or an invalid point; [`Infallible`](std::convert::Infallible) if
    /// neither can occur.
    type Error;
    /// A reference to a point, or a copy of it.
    type PointRef<'a>: Borrow<PointOf<Self, N>> + Copy
    where
        Self: 'a;

    /// Returns the geometry.
    fn geometry(&self) -> &Self::Geometry;

    /// Returns the complex.
    fn complex(&self) -> &Self::Complex;

    /// Returns the point of a finite vertex.
    ///
    /// # Errors
    /// If the vertex does not exist, or the geometry does not admit its point.
    fn point(&self, vertex: VertexId) -> Result<Self::PointRef<'_>, Self::Error>;

    /// Converts a point from outside to the type in which points of vertices are returned.
    fn point_ref<'a>(point: &'a PointOf<Self, N>) -> Self::PointRef<'a>
    where
        Self: 'a;
}

/// The point type of a structure.
pub type PointOf<T, const N: usize> = <<T as Embedded<N>>::Geometry as Geometry<N>>::Point;

/// Returns the first two coordinates of a point in the plane and a zero, or the three of a point in
/// space.
#[inline]
pub(crate) fn position<G: Coordinates<N>, const N: usize>(geometry: &G, p: &G::Point) -> [f64; 3] {
    let coordinates = geometry.coordinates(p);
    let mut position = [0.0; 3];
    for (x, &coordinate) in position[..N - 1].iter_mut().zip(coordinates.as_ref()) {
        *x = coordinate;
    }
    position
}
