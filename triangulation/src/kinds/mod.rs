//! The kinds of triangulations: each owns a [`Triangulation`](crate::Triangulation) and adds its
//! law.

pub(crate) mod basic;
pub(crate) mod constrained;
pub(crate) mod delaunay;
mod hidden;
pub(crate) mod regular;

pub use basic::Basic;
pub use constrained::{Constrained, ConstraintError};
pub use delaunay::Delaunay;
pub use regular::Regular;

use crate::geometry::{Plane, Space, Weighted, WeightedSpace};

/// A triangulation without a law, of points `[x, y]`.
pub type Basic2<V = (), C = ()> = Basic<Plane, 3, V, C>;
/// A triangulation without a law, of points `[x, y, z]` in space.
pub type Basic3<V = (), C = ()> = Basic<Space, 4, V, C>;
/// A Delaunay triangulation of points `[x, y]`.
pub type Delaunay2<V = (), C = ()> = Delaunay<Plane, 3, V, C>;
/// A Delaunay triangulation of points `[x, y, z]` in space.
pub type Delaunay3<V = (), C = ()> = Delaunay<Space, 4, V, C>;
/// A regular triangulation of points `[x, y, weight]`.
pub type Regular2<V = (), C = ()> = Regular<Weighted, 3, V, C>;
/// A regular triangulation of points `[x, y, z, weight]` in space.
pub type Regular3<V = (), C = ()> = Regular<WeightedSpace, 4, V, C>;
/// A constrained triangulation of points `[x, y]`, without another law.
pub type Constrained2<V = (), C = ()> = Constrained<Plane, V, C>;
