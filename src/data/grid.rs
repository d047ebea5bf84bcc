use super::{Frame, Window};
use crate::crs::Crs;
use crate::error::Result;

/// A raster of heights in memory. A cell without a value is NaN.
#[derive(Debug, Clone)]
pub struct Grid {
    /// Size and place.
    pub frame: Frame,
    /// Coordinate system, if known.
    pub crs: Option<Crs>,
    /// Row by row from the first, `frame.width * frame.height` values; NaN is nodata.
    pub values: Vec<f64>,
}

impl Grid {
    /// The value of a cell.
    pub fn value(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.frame.width + column]
    }
}

/// Something that can fill any block of a raster: a TIN, a grid, the hillshade of either.
///
/// Blocks are asked for in any order and from many threads; what a cell holds must not depend on
/// the block it is asked in.
pub trait BlockSource: Sync {
    /// Size and place of the whole raster.
    fn frame(&self) -> Frame;

    /// Coordinate system, if known.
    fn crs(&self) -> Option<&Crs>;

    /// Fills `out` (row by row, `window.width * window.height` values; NaN is nodata).
    ///
    /// # Errors
    /// Only if the source reads from somewhere that can fail.
    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()>;
}
