//! The cells of a GeoTIFF for writers: each block is decoded once, although many windows touch it.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rustc_hash::FxHashMap;

use super::GeoTiffReader;
use super::image::tiles_at_once;
use super::layout::Span;
use super::read::overlap;
use super::tile::SIDE;
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Window};
use crate::error::Result;

/// The rows of cells of which all blocks are kept, besides those of the tiles that are packed at
/// once: those of a row of tiles, and one on each side.
const ROWS: usize = SIDE + 2;

/// The cells of a GeoTIFF, for windows that are requested row by row of windows: the blocks that
/// were decoded last are kept.
///
/// # Complexity
/// Memory: 4 bytes per cell, for about 260 rows of cells and two rows of blocks, and for the tiles
/// that all threads pack at once.
pub struct KeptBlocks<'a> {
    reader: &'a GeoTiffReader,
    most_cells: u64,
    kept: Mutex<Kept>,
}

/// A block, once it is decoded; `None` if it cannot be.
type KeptBlock = OnceLock<Option<Vec<f32>>>;

#[derive(Default)]
struct Kept {
    /// By the first row and column.
    blocks: FxHashMap<[usize; 2], Arc<KeptBlock>>,
    /// The blocks and their cells, in the order in which they were first needed.
    order: VecDeque<([usize; 2], u64)>,
    cells: u64,
}

impl<'a> KeptBlocks<'a> {
    /// Wraps a reader.
    pub fn new(reader: &'a GeoTiffReader) -> Self {
        let across = reader.frame().width.div_ceil(SIDE);
        KeptBlocks::with_rows(reader, ROWS + tiles_at_once().div_ceil(across) * SIDE)
    }

    fn with_rows(reader: &'a GeoTiffReader, rows: usize) -> Self {
        let [width, height] = reader.span_size();
        let across = reader.frame().width.div_ceil(width);
        let down = rows.div_ceil(height) + 1;
        KeptBlocks {
            reader,
            most_cells: (across * down) as u64 * (width * height) as u64,
            kept: Mutex::default(),
        }
    }

    /// Returns a block, which may still be decoded by another thread. The oldest ones are dropped.
    fn block(&self, span: &Span) -> Arc<KeptBlock> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let key = [span.first_row, span.first_column];
        if let Some(block) = kept.blocks.get(&key) {
            return Arc::clone(block);
        }
        kept.cells += span.cells();
        while kept.cells > self.most_cells
            && let Some((oldest, cells)) = kept.order.pop_front()
        {
            kept.cells -= cells;
            kept.blocks.remove(&oldest);
        }
        kept.order.push_back((key, span.cells()));
        Arc::clone(kept.blocks.entry(key).or_default())
    }
}

impl BlockSource for KeptBlocks<'_> {
    fn frame(&self) -> Frame {
        self.reader.frame()
    }

    fn crs(&self) -> Option<&Crs> {
        self.reader.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.frame().check_window(window, out.len())?;
        if out.is_empty() {
            return Ok(());
        }
        out.fill(self.reader.missing_value());
        for span in self.reader.spans(window)? {
            let block = self.block(&span);
            let again;
            let values = match block.get_or_init(|| self.reader.decoded(&span).ok()) {
                Some(values) => values,
                // For the error.
                None => {
                    again = self.reader.decoded(&span)?;
                    &again
                }
            };
            let whole = overlap(&span, self.frame().window());
            let part = overlap(&span, window);
            for row in part.row..part.row + part.height {
                let from = (row - whole.row) * whole.width + part.column - whole.column;
                let to = (row - window.row) * window.width + part.column - window.column;
                out[to..to + part.width].copy_from_slice(&values[from..from + part.width]);
            }
        }
        Ok(())
    }
}

impl std::fmt::Debug for KeptBlocks<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("KeptBlocks")
            .field("reader", &self.reader)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::geotiff;
    use std::path::Path;

    /// Windows in any order, with room for all blocks, for a few and for one.
    #[test]
    fn blocks_are_those_of_the_reader() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/dem.tif");
        let reader = geotiff::open(path).unwrap();
        let Frame { width, height, .. } = reader.frame();
        for rows in [ROWS, 1] {
            let kept = KeptBlocks::with_rows(&reader, rows);
            let mut read = 0;
            for size in [1, 7, 100, 300] {
                for row in (0..height).step_by(41) {
                    for column in (0..width).step_by(53) {
                        let window = Window {
                            column,
                            row,
                            width: size.min(width - column),
                            height: size.min(height - row),
                        };
                        let [mut expected, mut found] =
                            [0, 1].map(|_| vec![0.0; window.width * window.height]);
                        reader.fill(window, &mut expected).unwrap();
                        kept.fill(window, &mut found).unwrap();
                        let bits =
                            |cells: &[f32]| cells.iter().map(|c| c.to_bits()).collect::<Vec<_>>();
                        assert_eq!(bits(&found), bits(&expected), "{window:?}");
                        read += 1;
                    }
                }
            }
            assert!(read > 50);
            let kept = kept.kept.into_inner().unwrap();
            assert!(kept.cells <= kept.order.iter().map(|(_, cells)| cells).sum());
            assert_eq!(kept.blocks.len(), kept.order.len());
        }
    }
}
