//! Questions to triangulations of the plane that go beyond location.

mod along;
mod nearest;
mod rectangle;
mod zone;

pub use along::Passage;
pub use zone::ConflictZone;
