//! XYZ grids: the center and the height of each cell, one per line.

use std::io::Write;

use rayon::prelude::*;

use super::geotiff::RasterSummary;
use crate::data::{self, BlockSource};
use crate::error::Result;
use crate::io::Destination;
use crate::io::bytes::decimal::Decimal;

/// Rows that are in memory at a time.
const BAND: usize = 64;

/// Writes cells with a height, row by row from the first: `x y z`, as points are written. Heights
/// have the fewest digits that read back as the same 32-bit floats.
///
/// # Errors
/// If the source fails, or the file cannot be written.
pub(crate) fn write(target: Destination, source: &dyn BlockSource) -> Result<RasterSummary> {
    let frame = source.frame();
    let center = frame.centers();
    let mut output = target.create()?;
    let mut summary = RasterSummary::default();
    for first in (0..frame.height).step_by(BAND) {
        let values = data::cells_of_rows(source, first..frame.height.min(first + BAND))?;
        summary.add(&values);
        let lines = |(row, cells): (usize, &[f32])| {
            let mut text = Vec::with_capacity(cells.len() * 32);
            for (column, z) in cells.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
                let [x, y] = center(column, first + row).map(Decimal);
                writeln!(text, "{x} {y} {z}")?;
            }
            Ok(text)
        };
        let rows = values.par_chunks(frame.width).enumerate();
        let texts: Vec<Result<Vec<u8>>> = rows.map(lines).collect();
        for text in texts {
            output.write_all(&text?)?;
        }
    }
    target.put(output)?;
    Ok(summary)
}
