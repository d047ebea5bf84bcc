//! The kinds of triangulations: each owns a [`Triangulation`](super::Triangulation) and adds its
//! law.

pub(super) mod basic;
pub(super) mod constrained;
pub(super) mod delaunay;
pub(super) mod regular;

use crate::geometry::{Plane, Space, Weighted, WeightedSpace};

use super::ConstrainedDelaunay;
use basic::Basic;
use constrained::Constrained;
use delaunay::Delaunay;
use regular::Regular;

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
/// A constrained Delaunay triangulation of points `[x, y]`.
pub type ConstrainedDelaunay2<V = (), C = ()> = ConstrainedDelaunay<Plane, V, C>;
