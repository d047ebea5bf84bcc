//! The nearest cell with data of each cell.

use rayon::prelude::*;

/// Returns, for each cell, the index of the nearest cell that has data, itself if it has; cells are
/// in rows of `width`. Of several that are equally near, the one that is first found by columns.
/// Returns none if no cell has data.
///
/// By lower envelopes of parabolas (Felzenszwalb and Huttenlocher 2012), in time that is linear in
/// the number of cells.
pub(super) fn nearest(has: &[bool], width: usize) -> Option<Vec<u32>> {
    if !has.contains(&true) {
        return None;
    }
    let height = has.len() / width;
    // The nearest row with data of the same column.
    let mut rows = vec![u32::MAX; has.len()];
    for row in 0..height {
        for column in 0..width {
            let at = row * width + column;
            if has[at] {
                rows[at] = row as u32;
            } else if row > 0 {
                rows[at] = rows[at - width];
            }
        }
    }
    for row in (0..height.saturating_sub(1)).rev() {
        for column in 0..width {
            let at = row * width + column;
            let (above, below) = (rows[at], rows[at + width]);
            if below != u32::MAX
                && below as usize > row
                && (above == u32::MAX || below as usize - row < row - above as usize)
            {
                rows[at] = below;
            }
        }
    }
    let mut result = vec![0; has.len()];
    result
        .par_chunks_mut(width)
        .zip(rows.par_chunks(width))
        .enumerate()
        .for_each_init(Vec::new, |envelope, (row, (result, rows))| {
            along_row(row, rows, result, envelope);
        });
    Some(result)
}

/// Finds the nearest of the cells that are the nearest ones of the columns.
fn along_row(row: usize, rows: &[u32], result: &mut [u32], envelope: &mut Vec<(u32, f64)>) {
    let width = rows.len();
    if rows.iter().all(|&nearest| nearest as usize == row) {
        for (column, target) in result.iter_mut().enumerate() {
            *target = (row * width + column) as u32;
        }
        return;
    }
    let rise = |column: u32| {
        let distance = f64::from(rows[column as usize]) - row as f64;
        let column = f64::from(column);
        distance * distance + column * column
    };
    envelope.clear();
    for column in 0..width as u32 {
        if rows[column as usize] == u32::MAX {
            continue;
        }
        // Where the parabola of this column becomes the lowest.
        let mut from = f64::NEG_INFINITY;
        while let Some(&(last, start)) = envelope.last() {
            from = (rise(column) - rise(last)) / (2.0 * f64::from(column - last));
            if from > start {
                break;
            }
            envelope.pop();
            from = f64::NEG_INFINITY;
        }
        envelope.push((column, from));
    }
    let mut part = 0;
    for (column, target) in result.iter_mut().enumerate() {
        while part + 1 < envelope.len() && envelope[part + 1].1 < column as f64 {
            part += 1;
        }
        let nearest = envelope[part].0;
        *target = rows[nearest as usize] * width as u32 + nearest;
    }
}
