//! Queries of triangulations of space.

mod along;
mod alpha;
mod dual;
mod gabriel;
mod hull;
mod natural;
mod power;

pub use along::along_in_space;
pub use alpha::{AlphaShape, AlphaShapes, AlphaState, Boundary};
pub use dual::{VoronoiFacet, VoronoiSolid};
pub use hull::ConvexHull;
