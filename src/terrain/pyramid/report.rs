//! What was measured of tiles.

/// How near a tile is to the surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TileReport {
    /// The number of vertices.
    pub vertices: usize,
    /// The number of triangles.
    pub triangles: usize,
    /// The number of heights of the surface that it was measured against.
    pub heights: usize,
    /// No such height and no line of the surface is further from the triangles than this, in
    /// meters. Heights that are certainly within the bound are not measured one by one, so it may
    /// be more than the largest distance, but not more than the bound if that holds.
    pub largest: f64,
    /// The number of heights that are further off than the bound, because steps are too large, and
    /// of bends of triangles under lines.
    pub beyond: usize,
}

impl TileReport {
    /// Adds the counts of another tile.
    pub fn merge(&mut self, other: &TileReport) {
        self.vertices += other.vertices;
        self.triangles += other.triangles;
        self.heights += other.heights;
        self.largest = self.largest.max(other.largest);
        self.beyond += other.beyond;
    }
}
