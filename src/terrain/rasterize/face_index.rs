use std::ops::Range;

use rayon::prelude::*;

use super::bins::bins_of;
use super::placement::Placement;
use crate::data::{Surface, Window};

/// A spatial index that finds the faces which a rectangle of cells may meet.
///
/// The raster, or the window of it that a surface covers, is divided into square bins. A face is
/// listed in each bin where it may contain the center of a cell. If a surface is finer than the
/// raster, most faces contain none, and are not listed at all.
#[derive(Debug)]
pub(super) struct FaceIndex {
    /// Cells along a side of a bin.
    side: usize,
    /// The columns and rows of bins, counted from those of the whole raster.
    columns: Range<usize>,
    rows: Range<usize>,
    /// Where the faces of each bin begin, bins row by row; one more entry than there are bins.
    first: Vec<usize>,
    faces: Vec<u32>,
}

/// The average number of faces in a bin. Larger bins waste work in windows that cut them, smaller
/// ones list more faces twice: at 64, half of them.
const FACES_PER_BIN: f64 = 64.0;
const SMALLEST_BIN: f64 = 16.0;
/// The number of faces per parallel task.
const CHUNK: u32 = 1 << 15;

impl FaceIndex {
    /// Lists the faces in a window, beyond which there are none.
    ///
    /// # Complexity
    /// Linear in the faces and in the bins they meet. Takes 4 bytes for each face in each bin, and
    /// 12 during construction.
    pub(super) fn new<S: Surface + ?Sized>(
        surface: &S,
        placement: &Placement,
        window: Window,
    ) -> Self {
        let face_count = surface.face_count() as u32;
        let Window {
            column,
            row,
            width,
            height,
        } = window;
        let bins = (f64::from(face_count) / FACES_PER_BIN).max(1.0);
        let side = (width as f64 * height as f64 / bins)
            .sqrt()
            .max(SMALLEST_BIN)
            .ceil() as usize;
        let (columns, rows) = (
            column / side..(column + width).div_ceil(side),
            row / side..(row + height).div_ceil(side),
        );
        let number =
            |row: usize, column: usize| (row - rows.start) * columns.len() + column - columns.start;
        let chunks: Vec<Vec<(u32, u32)>> = (0..face_count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut found = Vec::new();
                for face in chunk * CHUNK..(chunk + 1).saturating_mul(CHUNK).min(face_count) {
                    let Some(corners) = surface.triangle(face) else {
                        continue;
                    };
                    let corners = corners.map(|p| placement.to_plane(p));
                    bins_of(&corners, placement, side, |row, column| {
                        if rows.contains(&row) && columns.contains(&column) {
                            found.push((number(row, column) as u32, face));
                        }
                    });
                }
                found
            })
            .collect();

        let count = columns.len() * rows.len();
        let mut first = vec![0; count + 1];
        for (bin, _) in chunks.iter().flatten() {
            first[*bin as usize + 1] += 1;
        }
        for bin in 0..count {
            first[bin + 1] += first[bin];
        }
        let mut faces = vec![0; first[count]];
        let mut next = first.clone();
        for chunk in chunks {
            for (bin, face) in chunk {
                let slot = &mut next[bin as usize];
                faces[*slot] = face;
                *slot += 1;
            }
        }
        FaceIndex {
            side,
            columns,
            rows,
            first,
            faces,
        }
    }

    /// The faces of each bin that meets a window, and the intersection of bin and window, as rows
    /// and columns of cells.
    pub(super) fn bins_in(
        &self,
        rows: Range<usize>,
        columns: Range<usize>,
    ) -> impl Iterator<Item = (&[u32], Range<usize>, Range<usize>)> {
        let common = |bin: usize, cells: &Range<usize>| {
            (bin * self.side).max(cells.start)..((bin + 1) * self.side).min(cells.end)
        };
        let bins = |cells: &Range<usize>, all: &Range<usize>| {
            (cells.start / self.side).max(all.start)..cells.end.div_ceil(self.side).min(all.end)
        };
        let (bin_rows, bin_columns) = (bins(&rows, &self.rows), bins(&columns, &self.columns));
        bin_rows.flat_map(move |row| {
            let (rows, columns) = (common(row, &rows), columns.clone());
            bin_columns.clone().map(move |column| {
                let bin =
                    (row - self.rows.start) * self.columns.len() + column - self.columns.start;
                let faces = &self.faces[self.first[bin]..self.first[bin + 1]];
                (faces, rows.clone(), common(column, &columns))
            })
        })
    }
}
