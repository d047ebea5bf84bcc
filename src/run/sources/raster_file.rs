//! A raster whose cells are read when they are needed.

use crate::crs::Crs;
use crate::data::{BlockSource, Bounds, Frame, Grid, Window};
use crate::error::Result;
use crate::io::Watch;
use crate::io::geotiff::{GeoTiffReader, KeptBlocks};

/// Rows with about this many cells are in memory at a time (128 MB).
const CELLS: usize = 1 << 24;

/// A GeoTIFF that stays in its file.
#[derive(Debug)]
pub struct RasterFile {
    reader: GeoTiffReader,
    /// The lowest and the highest height, if there are any.
    heights: Option<[f64; 2]>,
    /// The number of rows that are read at a time.
    rows: usize,
}

impl RasterFile {
    /// Returns the raster of a reader, all of whose blocks are read once; their cells are counted.
    ///
    /// # Errors
    /// If a block is damaged, and that of the watch.
    pub(crate) fn new(reader: GeoTiffReader, watch: Watch) -> Result<Self> {
        let heights = reader.extremes_with(watch)?.range;
        Ok(RasterFile {
            rows: reader.rows_at_once(CELLS),
            reader,
            heights,
        })
    }

    /// Returns the size and georeference.
    pub fn frame(&self) -> Frame {
        self.reader.frame()
    }

    /// Returns the coordinate system, if it is known.
    pub fn crs(&self) -> Option<&Crs> {
        self.reader.crs()
    }

    pub(crate) fn set_crs(&mut self, crs: Option<Crs>) {
        self.reader.set_crs(crs);
    }

    /// Returns the box around all cells, with the lowest and the highest height if there are any.
    pub fn extent(&self) -> Bounds {
        let mut bounds = self.frame().extent();
        let [x, y, _] = bounds.min;
        self.heights
            .into_iter()
            .flatten()
            .for_each(|z| bounds.add([x, y, z]));
        bounds
    }

    /// Returns the cells for a writer.
    pub(crate) fn cells(&self) -> KeptBlocks<'_> {
        KeptBlocks::new(&self.reader)
    }

    /// Calls a function with some rows at a time, in order, and the number of the first of them.
    /// All but the first begin with the last row of those before. The grid has the transform of the
    /// raster.
    ///
    /// # Errors
    /// If a block is damaged, and those of the function.
    pub(crate) fn each_rows(&self, take: &mut dyn FnMut(&Grid, usize) -> Result<()>) -> Result<()> {
        let frame = self.frame();
        let mut last_row = Vec::new();
        for row in (0..frame.height).step_by(self.rows) {
            let window = Window {
                row,
                height: self.rows.min(frame.height - row),
                ..frame.window()
            };
            let mut values = self.reader.read_window(window)?;
            let first_row = row - usize::from(!last_row.is_empty());
            values.splice(0..0, last_row.drain(..));
            last_row.extend_from_slice(&values[values.len() - frame.width..]);
            let rows = Grid {
                frame: Frame {
                    height: row + window.height - first_row,
                    ..frame
                },
                crs: None,
                values,
            };
            take(&rows, first_row)?;
        }
        Ok(())
    }

    /// Reads fewer rows at a time.
    #[cfg(test)]
    pub(crate) fn with_rows(self, rows: usize) -> Self {
        RasterFile { rows, ..self }
    }
}
