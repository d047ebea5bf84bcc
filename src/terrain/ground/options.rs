//! What is asked of the ground filter, and what it answers.

use super::GroundGrid;

/// How the ground is to be found.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct GroundOptions {
    /// What becomes of bridges; by default they are off the ground.
    pub bridges: Bridges,
    /// Whether points far below the ground and lone points in the air get classes of their own; by
    /// default not.
    pub noise: bool,
    /// The grid, if it is not to be derived from the points: that of the whole, where the points
    /// are those of a tile.
    pub grid: Option<GroundGrid>,
}

/// What becomes of bridges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Bridges {
    /// They are objects, and the terrain below them is the ground.
    #[default]
    OffGround,
    /// Those that join the ground at both ends are ground.
    Ground,
}

/// What a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointClass {
    /// On the terrain.
    Ground,
    /// Above or below it: a building, a plant, a vehicle, a bridge.
    Object,
    /// Far below the terrain, if noise was asked for.
    LowNoise,
    /// Alone in the air, if noise was asked for.
    HighNoise,
}
