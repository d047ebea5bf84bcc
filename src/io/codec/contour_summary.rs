use crate::data::{Bounds, ContourLine, Shape, Value};

/// What a contour file contains, counted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContourSummary {
    /// Number of lines.
    pub lines: usize,
    /// Vertices of all lines; a closed line counts its first vertex again as its last.
    pub vertices: usize,
    /// Number of closed lines.
    pub closed: usize,
    /// Extent of all lines, in plan and in height.
    pub bounds: Bounds,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl ContourSummary {
    /// Adds a line to the counts, and returns its extent.
    pub(crate) fn add(&mut self, line: &ContourLine) -> Bounds {
        self.lines += 1;
        self.vertices += line.points.len();
        self.closed += usize::from(line.is_closed());
        let bounds = line.bounds();
        self.bounds.merge(&bounds);
        bounds
    }

    /// Returns the record of the line that was added last: its shape with heights, its number from
    /// 1, and its height.
    pub(crate) fn last_record(&self, line: &ContourLine) -> (Shape, [Value; 2]) {
        let vertices = line.points.iter().map(|&[x, y]| [x, y, line.level]);
        let shape = Shape::Lines(vec![vertices.collect()]);
        let values = [Value::Whole(self.lines as i64), Value::Number(line.level)];
        (shape, values)
    }
}
