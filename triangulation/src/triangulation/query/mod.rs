//! Questions to triangulations of the plane that go beyond location.

mod along;
mod crossed;
mod dual;
mod faces;
mod natural;
mod nearest;
mod power;
mod rectangle;
mod svg;
mod zone;

pub(super) use along::Along;
pub use along::Passage;
pub use dual::{VoronoiCell, VoronoiEdge};
pub(super) use faces::Faces;
pub(super) use nearest::{Candidate, NearestFirst, nearest};
pub(super) use rectangle::within_rectangle;
pub use svg::Mark;
pub use zone::ConflictZone;
pub(super) use zone::zone_at;

use std::borrow::Borrow;

use crate::geometry::Coordinates;
use crate::tds::VertexId;

use super::Triangulation;
use super::engine::embedded::Embedded;

/// Where a point lies in the plane.
fn place_of<G: Coordinates<3>>(geometry: &G, p: &G::Point) -> [f64; 2] {
    let coordinates = geometry.coordinates(p);
    [coordinates.as_ref()[0], coordinates.as_ref()[1]]
}

/// Where a finite vertex lies.
fn place<T: Embedded<3, Geometry: Coordinates<3>>>(t: &T, vertex: VertexId) -> Result<[f64; 2], T::Error> {
    Ok(place_of(t.geometry(), t.point(vertex)?.borrow()))
}

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Where a finite vertex lies.
    fn place(&self, vertex: VertexId) -> [f64; 2] {
        let Ok(place) = place(self, vertex);
        place
    }
}
