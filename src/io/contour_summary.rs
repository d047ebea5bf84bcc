use crate::data::{Bounds, ContourLine};

/// What was written: contours, counted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContourSummary {
    /// Lines.
    pub lines: usize,
    /// Vertices of all lines; the last of a closed line counts.
    pub vertices: usize,
    /// Lines that end where they begin.
    pub closed: usize,
    /// In plan and in height.
    pub bounds: Bounds,
    /// What a user should be told.
    pub warnings: Vec<String>,
}

impl ContourSummary {
    /// Counts a line.
    pub(super) fn add(&mut self, line: &ContourLine) {
        self.lines += 1;
        self.vertices += line.points.len();
        self.closed += usize::from(line.is_closed());
        line.points.iter().for_each(|&[x, y]| self.bounds.add([x, y, line.level]));
    }
}
