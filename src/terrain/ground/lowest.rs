//! The lowest point of each cell of a grid.

use super::raster::Raster;
use crate::error::{Error, Plain, Result};

/// No point is in a cell.
pub(super) const EMPTY: u32 = u32::MAX;

/// Cells of a part of a grid start at multiples of this number, so that what depends on the
/// parity of their numbers is that of the whole.
const ALIGNED: f64 = 32.0;

/// So many cells are always allowed ...
const CELLS: f64 = (1u32 << 24) as f64;

/// ... and so many for each point ...
const CELLS_FOR_EACH: f64 = 8.0;

/// ... but no more than this, because they are numbered with 32 bits.
const MOST_CELLS: f64 = (1u32 << 29) as f64;

/// Heights above the datum are at most this, in meters, and no less than its negative.
const HEIGHTS: f64 = 1e6;

/// Square cells in plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cells {
    /// The corner of the grid with the least coordinates, and a height near those of the points.
    origin: [f64; 3],
    /// The first column and row, whole numbers.
    first: [f64; 2],
    pub(super) side: f64,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Cells {
    /// Returns the cells of a grid that cover points; there is one at least.
    ///
    /// # Errors
    /// If there were too many of them for their points.
    pub(super) fn around(points: &[[f64; 3]], origin: [f64; 3], side: f64) -> Result<Cells> {
        let [x, y, z] = origin;
        let mut cells = Cells {
            origin: [x - side / 2.0, y - side / 2.0, z],
            first: [0.0; 2],
            side,
            width: 1,
            height: 1,
        };
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let number = |axis: usize, value: f64| ((value - cells.origin[axis]) / side).floor();
        let first = [0, 1].map(|axis| (number(axis, low[axis]) / ALIGNED).floor() * ALIGNED);
        let counts = [0, 1].map(|axis| number(axis, high[axis]) - first[axis] + 1.0);
        if counts[0] * counts[1]
            > CELLS
                .max(CELLS_FOR_EACH * points.len() as f64)
                .min(MOST_CELLS)
        {
            let [across, down] = [0, 1].map(|axis| Plain((high[axis] - low[axis]).round()));
            return Err(Error::limit(format!(
                "{} points over {across} by {down} m are too far apart for cells of {side:.2} m",
                points.len()
            ))
            .cure("leave out points far from all others, or filter parts of the area apart"));
        }
        cells.first = first;
        [cells.width, cells.height] = counts.map(|count| count.max(1.0) as usize);
        Ok(cells)
    }

    /// Returns a position in cells; centers of cells are at whole numbers.
    pub(super) fn position(&self, point: [f64; 3]) -> [f64; 2] {
        [0, 1].map(|axis| (point[axis] - self.origin[axis]) / self.side - self.first[axis] - 0.5)
    }

    /// Returns the height of a point above the datum.
    pub(super) fn above_datum(&self, point: [f64; 3]) -> f32 {
        (point[2] - self.origin[2]).clamp(-HEIGHTS, HEIGHTS) as f32
    }

    fn cell(&self, point: [f64; 3]) -> usize {
        let [x, y] = self.position(point).map(|at| (at + 0.5).max(0.0) as usize);
        y.min(self.height - 1) * self.width + x.min(self.width - 1)
    }
}

/// Returns the index of the lowest point of each cell; of equally low ones, that with the least
/// coordinates.
pub(super) fn lowest(points: &[[f64; 3]], cells: &Cells) -> Vec<u32> {
    let mut result = vec![EMPTY; cells.width * cells.height];
    for (index, point) in points.iter().enumerate() {
        let lowest = &mut result[cells.cell(*point)];
        if *lowest == EMPTY || rank(point) < rank(&points[*lowest as usize]) {
            *lowest = index as u32;
        }
    }
    result
}

fn rank(point: &[f64; 3]) -> (f64, f64, f64) {
    (point[2], point[0], point[1])
}

/// Returns the heights of the lowest points above the datum, in their cells.
pub(super) fn heights(points: &[[f64; 3]], lowest: &[u32], cells: &Cells) -> Raster {
    let values = lowest.iter().map(|&index| match index {
        EMPTY => f32::NAN,
        index => cells.above_datum(points[index as usize]),
    });
    Raster {
        width: cells.width,
        height: cells.height,
        values: values.collect(),
    }
}
