use super::{Bounds, higher, lower};

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

    /// Returns the box around the line.
    ///
    /// `PERF:` half the instructions of [`Bounds::add`]. As there, a NaN changes nothing.
    pub(crate) fn bounds(&self) -> Bounds {
        if self.points.is_empty() {
            return Bounds::default();
        }
        let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in &self.points {
            for axis in 0..2 {
                min[axis] = lower(point[axis], min[axis]);
                max[axis] = higher(point[axis], max[axis]);
            }
        }
        Bounds {
            min: [min[0], min[1], self.level],
            max: [max[0], max[1], self.level],
        }
    }

    /// Returns true if the line ends where it begins.
    pub fn is_closed(&self) -> bool {
        self.points.len() > 2 && self.points.first() == self.points.last()
    }
}
