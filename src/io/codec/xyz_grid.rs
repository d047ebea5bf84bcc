//! XYZ grids: the center and the height of each cell, one per line.

use std::io::Write;

use super::cell_rows;
use super::geotiff::RasterSummary;
use crate::data::BlockSource;
use crate::error::Result;
use crate::io::Destination;
use crate::io::bytes::decimal::Decimal;

/// Writes cells with a height, row by row from the first: `x y z`, as points are written. Heights
/// have the fewest digits that read back as the same 32-bit floats.
///
/// # Errors
/// If the source fails, or the file cannot be written.
pub(crate) fn write(target: Destination, source: &dyn BlockSource) -> Result<RasterSummary> {
    let center = source.frame().centers();
    let mut output = target.create()?;
    let summary = cell_rows::write(&mut output, source, |row, cells| {
        let mut text = Vec::with_capacity(cells.len() * 32);
        for (column, z) in cells.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
            let [x, y] = center(column, row).map(Decimal);
            writeln!(text, "{x} {y} {z}")?;
        }
        Ok(text)
    })?;
    target.put(output)?;
    Ok(summary)
}
