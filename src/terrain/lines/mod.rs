//! Lines of all kinds, prepared for a triangulation.
//!
//! | kind | what it becomes |
//! |---|---|
//! | hard and soft lines | constraints with the heights of the line |
//! | [`Wall`] | two hard lines next to each other, the upper and the lower edge |
//! | [`Flat`] | the rings of its shore at one height; no points inside |
//! | [`River`] | two banks, and level lines across; no points inside |
//! | draped lines | nothing here: the finished surface is [cut](super::cut) along them |
//!
//! Where kinds meet, the first of these counts: flat, river, wall, hard, soft. After all lines are
//! inserted, [`areas`] gives every vertex in level water its height, whatever line it belongs to.

pub(super) mod areas;
mod densify;
pub(super) mod divided;
mod flat;
mod joints;
pub(super) mod kinds;
mod lake_levels;
mod offset;
pub(super) mod overlap;
mod river;
mod wall;

pub use densify::densified;
pub use flat::{Flat, FlatHeight};
pub use lake_levels::JoinedLake;
pub use overlap::WaterOverlap;
pub(super) use river::RiverWater;
pub use river::{River, RiverHeights, RiverLowering};
pub(super) use wall::narrowest;
pub use wall::{HighSide, Wall};
