/// A contour: a polyline at one level, with higher ground on its right.
#[derive(Debug, Clone, PartialEq)]
pub struct ContourLine {
    /// The height, in the units of the data.
    pub level: f64,
    /// The vertices in plan, in order; a closed line repeats its first vertex at the end.
    pub points: Vec<[f64; 2]>,
}

impl ContourLine {
    /// Returns the number of edges.
    pub fn edge_count(&self) -> u64 {
        self.points.len().saturating_sub(1) as u64
    }

    /// Returns true if the line ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.points.len() > 2 && self.points.first() == self.points.last()
    }
}
