//! Empty cells filled with a surface that is nearly harmonic.

use rayon::prelude::*;

use super::raster::Raster;

/// Sweeps on each level.
const SWEEPS: usize = 8;

/// Rows that one task of a sweep takes.
const ROWS: usize = 32;

/// Returns the raster with its empty cells filled; others keep their value. Without any value, all
/// become zero.
///
/// Means of 2 x 2 cells are filled first, and interpolated; then each empty cell is replaced by the
/// mean of its neighbors, a few times over. So gaps of any width are filled in time that is linear
/// in the number of cells.
pub(super) fn filled(raster: &Raster) -> Raster {
    if raster.values.iter().all(|value| !value.is_nan()) {
        return raster.clone();
    }
    let (width, height) = (raster.width, raster.height);
    if width.max(height) <= 2 {
        let (sum, count) = raster
            .values
            .iter()
            .filter(|value| !value.is_nan())
            .fold((0.0, 0u64), |(sum, count), &value| {
                (sum + f64::from(value), count + 1)
            });
        let mean = (sum / count.max(1) as f64) as f32;
        let mut result = raster.clone();
        for value in result.values.iter_mut().filter(|value| value.is_nan()) {
            *value = mean;
        }
        return result;
    }
    let coarse = filled(&halved(raster));
    let mut result = raster.clone();
    result
        .values
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(row, values)| doubled(&coarse, row, values));
    relax(&mut result, raster);
    result
}

/// Returns the means of the values of 2 x 2 cells.
fn halved(raster: &Raster) -> Raster {
    let (width, height) = (raster.width.div_ceil(2), raster.height.div_ceil(2));
    let mut coarse = Raster::of(width, height, f32::NAN);
    coarse
        .values
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(row, values)| {
            for (column, value) in values.iter_mut().enumerate() {
                let (mut sum, mut count) = (0.0, 0.0);
                for below in 2 * row..(2 * row + 2).min(raster.height) {
                    for right in 2 * column..(2 * column + 2).min(raster.width) {
                        let fine = raster.at(right, below);
                        if !fine.is_nan() {
                            sum += fine;
                            count += 1.0;
                        }
                    }
                }
                if count > 0.0 {
                    *value = sum / count;
                }
            }
        });
    coarse
}

/// Fills the empty cells of a row from a raster of half the resolution.
fn doubled(coarse: &Raster, row: usize, values: &mut [f32]) {
    // A cell's center is a quarter of a coarse cell from that of the coarse cell it is in.
    let sides = |at: usize, count: usize| {
        let near = at / 2;
        let far = match at % 2 {
            0 => near.saturating_sub(1),
            _ => (near + 1).min(count - 1),
        };
        (near, far)
    };
    let (near_row, far_row) = sides(row, coarse.height);
    for (column, value) in values.iter_mut().enumerate() {
        if value.is_nan() {
            let (near, far) = sides(column, coarse.width);
            let along = |row| 0.75 * coarse.at(near, row) + 0.25 * coarse.at(far, row);
            *value = 0.75 * along(near_row) + 0.25 * along(far_row);
        }
    }
}

/// Replaces the cells that were empty by the mean of their neighbors, those of one color of a
/// checkerboard after those of the other.
fn relax(result: &mut Raster, raster: &Raster) {
    let width = result.width;
    let half = width.div_ceil(2);
    // The colors are apart, so that each can be changed while the other is read.
    let mut colors = [0, 1].map(|color| {
        let mut cells = vec![0f32; half * result.height];
        cells
            .par_chunks_mut(half)
            .zip(result.values.par_chunks(width))
            .enumerate()
            .for_each(|(row, (cells, values))| {
                let start = (row + color) % 2;
                for (cell, value) in cells.iter_mut().zip(values[start..].iter().step_by(2)) {
                    *cell = *value;
                }
            });
        cells
    });
    let empty: Vec<Vec<u32>> = raster
        .values
        .par_chunks(width)
        .map(|row| {
            (0..width as u32)
                .filter(|&column| row[column as usize].is_nan())
                .collect()
        })
        .collect();
    for sweep in 0..2 * SWEEPS {
        let [first, second] = &mut colors;
        let (color, target, other) = match sweep % 2 {
            0 => (0, first, second),
            _ => (1, second, first),
        };
        target
            .par_chunks_mut(half)
            .with_min_len(ROWS)
            .enumerate()
            .for_each(|(row, cells)| {
                let start = (row + color) % 2;
                for &column in &empty[row] {
                    let column = column as usize;
                    if column % 2 == start {
                        cells[column / 2] =
                            mean_of_neighbors(other, result.width, result.height, column, row);
                    }
                }
            });
    }
    result
        .values
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(row, values)| {
            for &column in &empty[row] {
                let color = (row + column as usize) % 2;
                values[column as usize] = colors[color][row * half + column as usize / 2];
            }
        });
}

/// Returns the mean of the neighbors of a cell, from the cells of the other color.
fn mean_of_neighbors(other: &[f32], width: usize, height: usize, column: usize, row: usize) -> f32 {
    let half = width.div_ceil(2);
    let at = row * half + column / 2;
    // In a row, cells of one color alternate with those of the other.
    let odd = column % 2;
    if row > 0 && row + 1 < height && column > 0 && column + 1 < width {
        let (above, below) = (other[at - half], other[at + half]);
        return 0.25 * (above + below + other[at + odd - 1] + other[at + odd]);
    }
    let (mut sum, mut count) = (0.0, 0.0);
    let mut add = |exists: bool, at: usize| {
        if exists {
            sum += other[at];
            count += 1.0;
        }
    };
    add(row > 0, at.wrapping_sub(half));
    add(row + 1 < height, at + half);
    add(column > 0, (at + odd).wrapping_sub(1));
    add(column + 1 < width, at + odd);
    sum / count
}
