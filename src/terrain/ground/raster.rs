//! Cells in rows, with one height each.

/// Heights of cells, row by row; NaN where there is none.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Raster {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f32>,
}

impl Raster {
    /// Creates a raster of one value.
    pub(super) fn of(width: usize, height: usize, value: f32) -> Raster {
        Raster {
            width,
            height,
            values: vec![value; width * height],
        }
    }

    /// Returns the value at a column and a row.
    pub(super) fn at(&self, column: usize, row: usize) -> f32 {
        self.values[row * self.width + column]
    }

    /// Returns the value at a position in cells, bilinear between the centers of cells, which are
    /// at whole numbers; that of the nearest position inside the rim, if it is outside.
    pub(super) fn bilinear(&self, x: f64, y: f64) -> f32 {
        let (column, right, across) = between(x, self.width);
        let (row, below, down) = between(y, self.height);
        let upper = mixed(self.at(column, row), self.at(right, row), across);
        let lower = mixed(self.at(column, below), self.at(right, below), across);
        mixed(upper, lower, down)
    }

    /// Returns the gradient at a cell, in heights a cell: central differences, one-sided at the
    /// rim.
    pub(super) fn gradient(&self, column: usize, row: usize) -> [f32; 2] {
        let (left, right) = (column.saturating_sub(1), (column + 1).min(self.width - 1));
        let (upper, lower) = (row.saturating_sub(1), (row + 1).min(self.height - 1));
        let slope = |rise: f32, run: usize| if run == 0 { 0.0 } else { rise / run as f32 };
        [
            slope(self.at(right, row) - self.at(left, row), right - left),
            slope(
                self.at(column, lower) - self.at(column, upper),
                lower - upper,
            ),
        ]
    }
}

/// Returns the two cells around a position, and its distance from the first.
fn between(position: f64, count: usize) -> (usize, usize, f32) {
    let inside = position.clamp(0.0, (count - 1) as f64);
    let first = inside as usize;
    (
        first,
        (first + 1).min(count - 1),
        (inside - first as f64) as f32,
    )
}

fn mixed(a: f32, b: f32, share: f32) -> f32 {
    a + (b - a) * share
}
