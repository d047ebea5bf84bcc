//! An area in which two surfaces differ.

/// A part of the plan in which one surface is above another one by more than a height.
///
/// Lengths and heights are in the units of the data, as in a [`Volume`](crate::terrain::Volume).
#[derive(Debug, Clone, PartialEq)]
pub struct ChangedArea {
    /// The outer ring, clockwise, and the holes, counter-clockwise. Each repeats its first vertex
    /// at the end, and has no other vertex twice. Rings may touch in vertices.
    pub rings: Vec<Vec<[f64; 2]>>,
    /// The area in plan.
    pub area: f64,
    /// The volume between both surfaces.
    pub volume: f64,
    /// The largest difference of the heights, first minus second.
    pub largest: f64,
    /// The position of the largest difference; of several, the least by x and then y.
    pub at: [f64; 2],
}

impl ChangedArea {
    /// Returns true if the first surface is above the second one.
    pub fn is_raised(&self) -> bool {
        self.largest > 0.0
    }
}
