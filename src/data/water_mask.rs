/// Where a square has water.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WaterMask {
    /// Nowhere.
    Land,
    /// Everywhere.
    Water,
    /// In some cells of a grid of [`SIDE`](Self::SIDE) rows, the northernmost first, each from west
    /// to east: true for water.
    Cells(Vec<bool>),
}

impl WaterMask {
    /// The number of cells along a side.
    pub const SIDE: usize = 256;

    /// Returns the mask of a grid of cells.
    pub fn of_cells(cells: Vec<bool>) -> Self {
        match cells.first() {
            None | Some(false) if !cells.contains(&true) => WaterMask::Land,
            Some(true) if !cells.contains(&false) => WaterMask::Water,
            _ => WaterMask::Cells(cells),
        }
    }
}
