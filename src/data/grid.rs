use std::ops::Range;

use rayon::prelude::*;

use super::{Bounds, Frame, Window, higher, lower};
use crate::crs::Crs;
use crate::error::{Error, Result};

/// The number of rows in a block when a whole raster is read.
const ROWS: usize = 64;

/// A raster of heights in memory.
#[derive(Debug, Clone)]
pub struct Grid {
    /// The size and georeference.
    pub frame: Frame,
    /// Coordinate system, if known.
    pub crs: Option<Crs>,
    /// The `frame.width * frame.height` values, row by row from the first; NaN is nodata.
    pub values: Vec<f64>,
}

impl Grid {
    /// Reads all cells of a source, with all cores.
    ///
    /// # Errors
    /// If the raster does not fit into memory, or the source fails.
    pub fn collect(source: &dyn BlockSource) -> Result<Self> {
        let values = collected(source)?;
        Ok(Grid {
            frame: source.frame(),
            crs: source.crs().cloned(),
            values,
        })
    }

    /// Returns the box around all cells, with the lowest and the highest height if there are any.
    ///
    /// # Complexity
    /// Linear.
    pub fn extent(&self) -> Bounds {
        let mut bounds = self.frame.extent();
        let [x, y, _] = bounds.min;
        let mut add = |z| bounds.add([x, y, z]);
        for some in self.values.chunks(1 << 10) {
            match range_of_finite(some) {
                Some(ends) => ends.into_iter().for_each(&mut add),
                None => some.iter().filter(|z| !z.is_nan()).for_each(|&z| add(z)),
            }
        }
        bounds
    }

    #[cold]
    fn too_short(&self) -> Error {
        let Frame { width, height, .. } = self.frame;
        Error::usage(format!(
            "a grid of {width} x {height} cells holds {} values",
            self.values.len()
        ))
    }

    /// Returns the value of a cell.
    ///
    /// # Panics
    /// If the cell is outside of the raster.
    pub fn value(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.frame.width + column]
    }
}

/// Reads all cells of a source, with all cores, row by row from the first; NaN is nodata.
///
/// # Errors
/// If the raster does not fit into memory, or the source fails.
pub fn cells(source: &dyn BlockSource) -> Result<Vec<f32>> {
    collected(source)
}

/// Like [`cells`], but of some rows.
///
/// # Errors
/// Those of [`cells`].
pub(crate) fn cells_of_rows(source: &dyn BlockSource, rows: Range<usize>) -> Result<Vec<f32>> {
    collected(&Rows { source, rows })
}

/// Some rows of a raster.
struct Rows<'a> {
    source: &'a dyn BlockSource,
    rows: Range<usize>,
}

impl BlockSource for Rows<'_> {
    fn frame(&self) -> Frame {
        Frame {
            height: self.rows.len(),
            ..self.source.frame()
        }
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        let row = self.rows.start + window.row;
        self.source.fill(Window { row, ..window }, out)
    }
}

/// Columns and rows of the blocks of which the range is found: the tiles of most files.
const SIDE: usize = 256;

/// Returns the lowest and the highest of all cells, with all cores; `None` if none has a finite
/// value.
///
/// # Errors
/// If the source fails.
///
/// # Complexity
/// Linear in the cells, of which some blocks are in memory at a time.
pub fn range_of(source: &dyn BlockSource) -> Result<Option<[f64; 2]>> {
    let Frame { width, height, .. } = source.frame();
    let across = width.div_ceil(SIDE);
    let none = [f32::INFINITY, f32::NEG_INFINITY];
    let [low, high] = (0..across * height.div_ceil(SIDE))
        .into_par_iter()
        .map(|block| -> Result<[f32; 2]> {
            let [column, row] = [block % across * SIDE, block / across * SIDE];
            let window = Window {
                column,
                row,
                width: SIDE.min(width - column),
                height: SIDE.min(height - row),
            };
            let mut cells = vec![f32::NAN; window.width * window.height];
            source.fill(window, &mut cells)?;
            let finite = cells.into_iter().filter(|cell| cell.is_finite());
            Ok(finite.fold(none, |[low, high], cell| [low.min(cell), high.max(cell)]))
        })
        .try_reduce(|| none, |a, b| Ok([a[0].min(b[0]), a[1].max(b[1])]))?;
    Ok((low <= high).then(|| [low, high].map(f64::from)))
}

fn collected<T: From<f32> + Copy + Send>(source: &dyn BlockSource) -> Result<Vec<T>> {
    let frame = source.frame();
    let count = frame.width.saturating_mul(frame.height);
    let mut values = Vec::new();
    if values.try_reserve_exact(count).is_err() {
        return Err(Error::limit(format!(
            "{} x {} cells do not fit into memory",
            frame.width, frame.height
        )));
    }
    values.resize(count, T::from(f32::NAN));
    values
        .par_chunks_mut((frame.width * ROWS).max(1))
        .enumerate()
        .try_for_each(|(i, strip)| {
            let window = Window {
                row: i * ROWS,
                height: strip.len() / frame.width,
                ..frame.window()
            };
            let mut block = vec![0.0; strip.len()];
            source.fill(window, &mut block)?;
            for (to, from) in strip.iter_mut().zip(block) {
                *to = T::from(from);
            }
            Ok::<(), Error>(())
        })?;
    Ok(values)
}

/// A source that can fill any block of a raster: a TIN, a grid, the hillshade of either.
///
/// Blocks are requested in any order and from many threads. The value of a cell must not depend on
/// the block in which it is requested.
pub trait BlockSource: Sync {
    /// The size and georeference of the whole raster.
    fn frame(&self) -> Frame;

    /// Coordinate system, if known.
    fn crs(&self) -> Option<&Crs>;

    /// Fills `out` with the `window.width * window.height` values of a window, row by row; NaN is
    /// nodata.
    ///
    /// # Errors
    /// Only if the source reads from something that can fail.
    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()>;
}

impl<S: BlockSource + ?Sized> BlockSource for &S {
    fn frame(&self) -> Frame {
        (**self).frame()
    }

    fn crs(&self) -> Option<&Crs> {
        (**self).crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        (**self).fill(window, out)
    }
}

impl<S: BlockSource + ?Sized> BlockSource for Box<S> {
    fn frame(&self) -> Frame {
        (**self).frame()
    }

    fn crs(&self) -> Option<&Crs> {
        (**self).crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        (**self).fill(window, out)
    }
}

impl BlockSource for Grid {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.frame.check_window(window, out.len())?;
        if out.is_empty() {
            return Ok(());
        }
        for (i, row) in out.chunks_exact_mut(window.width).enumerate() {
            let first = (window.row + i) * self.frame.width + window.column;
            let values = self
                .values
                .get(first..first + window.width)
                .ok_or_else(|| self.too_short())?;
            for (to, &from) in row.iter_mut().zip(values) {
                *to = from as f32;
            }
        }
        Ok(())
    }
}

/// Returns the lowest and the highest of some heights; `None` if one of them is not finite. Without
/// heights, infinity and its negative.
///
/// `PERF:` compiled to vector instructions.
pub(crate) fn range_of_finite(heights: &[f64]) -> Option<[f64; 2]> {
    const LANES: usize = 8;
    let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    // Stays 0 while all are finite.
    let mut nothing = [0.0; LANES];
    let mut add = |lane: usize, height: f64| {
        low[lane] = lower(height, low[lane]);
        high[lane] = higher(height, high[lane]);
        nothing[lane] += 0.0 * height;
    };
    let (chunks, rest) = heights.as_chunks::<LANES>();
    for chunk in chunks {
        (0..LANES).for_each(|lane| add(lane, chunk[lane]));
    }
    rest.iter().for_each(|&height| add(0, height));
    let is_complete = nothing.iter().sum::<f64>() == 0.0;
    let lowest = low.into_iter().fold(f64::INFINITY, f64::min);
    let highest = high.into_iter().fold(f64::NEG_INFINITY, f64::max);
    is_complete.then_some([lowest, highest])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_is_that_of_all_finite_cells_in_all_blocks() {
        let frame = Frame::north_up(0.0, 0.0, 1.0, 300, 270);
        let mut grid = Grid {
            frame,
            crs: None,
            values: vec![f64::NAN; 300 * 270],
        };
        assert_eq!(range_of(&grid).unwrap(), None);
        // In the first of four blocks, and in the last.
        for (at, value) in [(0, 5.0), (1, f64::INFINITY), (300 * 269 + 299, -2.5)] {
            grid.values[at] = value;
        }
        assert_eq!(range_of(&grid).unwrap(), Some([-2.5, 5.0]));
        grid.values[300 * 100 + 280] = 7.0;
        assert_eq!(range_of(&grid).unwrap(), Some([-2.5, 7.0]));
    }

    #[test]
    fn a_grid_gives_its_blocks_and_is_collected_from_them() {
        let (width, height) = (37, 150);
        let values: Vec<f64> = (0..width * height)
            .map(|i| f64::from(i as u32) / 2.0)
            .collect();
        let grid = Grid {
            frame: Frame::north_up(0.0, 0.0, 1.0, width, height),
            crs: None,
            values,
        };
        let mut block = vec![0.0; 6];
        grid.fill(
            Window {
                column: 35,
                row: 148,
                width: 2,
                height: 2,
            },
            &mut block[..4],
        )
        .unwrap();
        assert_eq!(
            &block[..2],
            [(148 * 37 + 35) as f32 / 2.0, (148 * 37 + 36) as f32 / 2.0]
        );
        assert_eq!(block[3], (150 * 37 - 1) as f32 / 2.0);
        assert_eq!(Grid::collect(&grid).unwrap().values, grid.values);
        assert!(
            cells(&grid)
                .unwrap()
                .into_iter()
                .map(f64::from)
                .eq(grid.values.iter().copied())
        );
        let beyond = Window {
            column: 35,
            row: 148,
            width: 3,
            height: 2,
        };
        assert!(grid.fill(beyond, &mut block).is_err());
        let short = Grid {
            values: vec![0.0; 37 * 149],
            ..grid
        };
        let error = Grid::collect(&short).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a grid of 37 x 150 cells holds 5513 values"
        );
    }
}
