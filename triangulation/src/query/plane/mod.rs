//! Queries of triangulations of the plane.

mod along;
mod crossed;
mod dual;
mod faces;
mod natural;
mod power;
mod svg;

pub use along::{Passage, along};
pub use dual::VoronoiCell;
pub use faces::faces_from;
pub use svg::Mark;
