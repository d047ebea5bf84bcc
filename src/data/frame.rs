/// The size and place of a raster.
///
/// `transform` is in GDAL's order and meaning: the outer corner of the first pixel is at
/// `(t[0], t[3])`, a step of one column adds `(t[1], t[4])`, a step of one row adds `(t[2], t[5])`.
/// A north-up raster has `t[2] = t[4] = 0` and `t[5] < 0`. Readers bring PixelIsPoint files to this
/// form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// From pixel corner to coordinates, see above.
    pub transform: [f64; 6],
}

/// A rectangle of cells in a raster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub column: usize,
    /// First row.
    pub row: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Frame {
    /// A north-up frame with its outer top left corner at `(left, top)` and square cells.
    pub fn north_up(left: f64, top: f64, resolution: f64, width: usize, height: usize) -> Self {
        Frame { width, height, transform: [left, resolution, 0.0, top, 0.0, -resolution] }
    }

    /// The coordinates of a place given in pixels (`column + 0.5` is a cell's centre).
    pub fn to_map(&self, column: f64, row: f64) -> [f64; 2] {
        let t = &self.transform;
        [t[0] + column * t[1] + row * t[2], t[3] + column * t[4] + row * t[5]]
    }

    /// The centre of a cell.
    pub fn centre(&self, column: usize, row: usize) -> [f64; 2] {
        self.to_map(column as f64 + 0.5, row as f64 + 0.5)
    }

    /// Whether rows run from north to south and columns from west to east, without rotation.
    pub fn is_north_up(&self) -> bool {
        let t = &self.transform;
        t[2] == 0.0 && t[4] == 0.0 && t[1] > 0.0 && t[5] < 0.0
    }
}
