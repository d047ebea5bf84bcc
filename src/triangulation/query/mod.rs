//! Questions to triangulations of the plane that go beyond location.

mod along;
mod dual;
mod natural;
mod nearest;
mod power;
mod rectangle;
mod svg;
mod zone;

pub use along::Passage;
pub use dual::{VoronoiCell, VoronoiEdge};
pub use svg::Mark;
pub use zone::ConflictZone;

use crate::geometry::Coordinates;
use crate::tds::VertexId;

use super::Triangulation;

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Where a point lies in the plane.
    fn place_of(&self, p: &G::Point) -> [f64; 2] {
        let coordinates = self.geometry.coordinates(p);
        [coordinates.as_ref()[0], coordinates.as_ref()[1]]
    }

    /// Where a finite vertex lies.
    fn place(&self, vertex: VertexId) -> [f64; 2] {
        self.place_of(self.point(vertex))
    }
}
