//! Location and other queries, as functions over any [`Embedded`] structure; the
//! methods of the kinds and those of [`Compact`](crate::Compact) call them.
//!
//! | function | returns | requires |
//! |---|---|---|
//! | [`locate`] | the vertex or cell that a point lies on or in | a triangulation, of the plane or of space |
//! | [`along`] | what a segment meets | a triangulation of the plane |
//! | [`along_in_space`] | what a segment meets | a triangulation of space |
//! | [`faces_from`] | all faces, without a visited set | a triangulation of the plane |
//! | [`within_rectangle`] | the vertices in a rectangle | a triangulation of the plane |
//! | [`within_box`] | the vertices in a box | a triangulation of space |
//! | [`nearest`], [`nearest_first`], [`within`] | vertices by distance | a Delaunay triangulation, of the plane or of space |
//! | [`conflict_zone`] | what a new point would destroy | a Delaunay or regular triangulation, of the plane (perhaps with constraints) or of space |
//!
//! [`AlphaShapes`] are solids of cells in space, from
//! [`Delaunay::alpha_shapes`](crate::Delaunay::alpha_shapes).
//!
//! All of the functions walk from a cell nearby, which may be `None`. A structure of your own
//! implements two traits: [`Complex`](crate::tds::Complex), for the cells and their neighbors, and
//! [`Embedded`], for the points. The example `examples/own_structure.rs` uses an
//! array of triangles with indices of vertices.
//!
//! ```
//! use breakline_triangulation::geometry::Plane;
//! use breakline_triangulation::tds::CellId;
//! use breakline_triangulation::{Delaunay, Embedded, query};
//!
//! /// The vertices nearest to the points of a route, each search starting where the last one ended.
//! fn nearest_of_all<T: Embedded<3, Geometry = Plane>>(t: &T, route: &[[f64; 2]]) -> Result<Vec<usize>, T::Error> {
//!     let mut found = Vec::new();
//!     let mut near: Option<CellId> = None;
//!     for q in route {
//!         near = query::locate(t, q, near)?.cell_in(t.complex())?;
//!         found.extend(query::nearest(t, q, near)?.map(|vertex| vertex.index()));
//!     }
//!     Ok(found)
//! }
//!
//! let (t, v) = Delaunay::from_points(Plane::new(), &[[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]])?;
//! assert_eq!(nearest_of_all(&*t, &[[1.0, 1.0], [3.0, 0.0]]), Ok(vec![v[0].index(), v[1].index()]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod dual;
mod nearest;
mod plane;
mod space;
mod within_box;
mod zone;

pub use crate::locate::{SpacePassage, locate};
pub use dual::VoronoiEdge;
pub use nearest::{nearest, nearest_first, within};
pub use plane::{Mark, Passage, VoronoiCell, along, faces_from};
pub use space::{
    AlphaShape, AlphaShapes, AlphaState, Boundary, ConvexHull, VoronoiFacet, VoronoiSolid,
    along_in_space,
};
pub use within_box::{within_box, within_rectangle};
pub use zone::{ConflictZone, conflict_zone};

use std::borrow::Borrow;

use crate::embedded::Embedded;
use crate::geometry::Coordinates;
use crate::tds::VertexId;
use crate::triangulation::Triangulation;

/// Returns the coordinates of a point: two in the plane, three in space.
fn site_of<G: Coordinates<N>, const N: usize, const D: usize>(
    geometry: &G,
    p: &G::Point,
) -> [f64; D] {
    let coordinates = geometry.coordinates(p);
    std::array::from_fn(|k| coordinates.as_ref()[k])
}

/// Returns the coordinates of a finite vertex in the plane.
fn site<T: Embedded<3, Geometry: Coordinates<3>>>(
    t: &T,
    vertex: VertexId,
) -> Result<[f64; 2], T::Error> {
    Ok(site_of(t.geometry(), t.point(vertex)?.borrow()))
}

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns the coordinates of a finite vertex in the plane.
    fn site(&self, vertex: VertexId) -> [f64; 2] {
        let Ok(site) = site(self, vertex);
        site
    }
}

impl<G: Coordinates<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Returns the coordinates of a finite vertex in space.
    fn site(&self, vertex: VertexId) -> [f64; 3] {
        site_of(&self.geometry, self.point(vertex))
    }
}
