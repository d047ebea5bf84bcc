//! Rows of cells as text.

use std::io::Write;

use rayon::prelude::*;

use super::geotiff::RasterSummary;
use crate::data::{self, BlockSource};
use crate::error::Result;
use crate::io::Output;

/// Rows that are in memory at a time.
const BAND: usize = 64;

/// Writes the rows of a raster, from the first: `text_of` gets the number of a row and its cells,
/// and is called by all threads.
///
/// # Errors
/// If the source or `text_of` fails, or the output cannot be written.
pub(super) fn write(
    output: &mut Output,
    source: &dyn BlockSource,
    text_of: impl Fn(usize, &[f32]) -> Result<Vec<u8>> + Sync,
) -> Result<RasterSummary> {
    let frame = source.frame();
    let mut summary = RasterSummary::default();
    for first in (0..frame.height).step_by(BAND) {
        let values = data::cells_of_rows(source, first..frame.height.min(first + BAND))?;
        summary.add(&values);
        let rows = values.par_chunks(frame.width).enumerate();
        let texts = rows.map(|(row, cells)| text_of(first + row, cells));
        let texts: Vec<Result<Vec<u8>>> = texts.collect();
        for text in texts {
            output.write_all(&text?)?;
        }
    }
    Ok(summary)
}
