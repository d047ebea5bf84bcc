//! The square bins of a raster that a face may meet.

use std::ops::Range;

use super::placement::Placement;
use crate::data::lowest_and_highest;

/// Returns the rows and the columns of the cells whose centers the box around a face may contain;
/// `None` if there are none.
///
/// Corners are those in the plane of the scan.
#[inline]
pub(super) fn cells_of(
    corners: &[[f64; 3]; 3],
    placement: &Placement,
) -> Option<[Range<usize>; 2]> {
    let [low, high] = lowest_and_highest(corners.map(|corner| corner[1]));
    let rows = placement.rows.cells(low, high);
    if rows.is_empty() {
        return None;
    }
    let [left, right] = lowest_and_highest(corners.map(|corner| corner[0]));
    let columns = placement.columns.cells(left, right);
    if columns.is_empty() || corners.as_flattened().iter().any(|c| !c.is_finite()) {
        // Vertices near the end of the range of doubles overflow in a rotated raster.
        return None;
    }
    Some([rows, columns])
}

/// Calls `each` with row and column of each bin in which a face may contain the center of a cell:
/// in each row of bins, those between the leftmost and the rightmost point of the face.
///
/// `side` is the number of cells along a side of a bin. Corners are those in the plane of the scan.
#[inline]
pub(super) fn bins_of(
    corners: &[[f64; 3]; 3],
    placement: &Placement,
    side: usize,
    mut each: impl FnMut(usize, usize),
) {
    let Some([rows, columns]) = cells_of(corners, placement) else {
        return;
    };
    let bins = |cells: &Range<usize>| cells.start / side..=(cells.end - 1) / side;
    let (bin_rows, bin_columns) = (bins(&rows), bins(&columns));
    if bin_rows.start() == bin_rows.end() || bin_columns.start() == bin_columns.end() {
        for row in bin_rows {
            bin_columns.clone().for_each(|column| each(row, column));
        }
        return;
    }
    for row in bin_rows {
        // One more cell on both sides, to allow for rounding.
        let below = placement.rows.center((row * side).max(1) - 1);
        let above = placement.rows.center((row + 1) * side);
        let Some((left, right)) = extent_between(corners, below, above) else {
            continue;
        };
        let step = placement.columns.center(1) - placement.columns.center(0);
        let cells = placement.columns.cells(left - step, right + step);
        if !cells.is_empty() {
            bins(&cells).for_each(|column| each(row, column));
        }
    }
}

/// The smallest and the largest x of a triangle in the band `low..=high` of y.
fn extent_between(corners: &[[f64; 3]; 3], low: f64, high: f64) -> Option<(f64, f64)> {
    let mut extent: Option<(f64, f64)> = None;
    let mut add = |x: f64| {
        let (left, right) = extent.unwrap_or((x, x));
        extent = Some((left.min(x), right.max(x)));
    };
    for i in 0..3 {
        let (p, q) = (&corners[i], &corners[(i + 1) % 3]);
        if (low..=high).contains(&p[1]) {
            add(p[0]);
        }
        for y in [low, high] {
            if (p[1] < y) != (q[1] < y) {
                add(p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]));
            }
        }
    }
    extent
}
