//! All cells of a raster, drawn by all threads.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::bins::cells_of;
use super::placement::{Centers, Placement};
use super::scan::{Ink, NO_FACE, Scan, heights_along};
use crate::data::{AT_ONCE, Frame, Surface, Window};

/// A raster is drawn at once if it has no more cells than this for each face of the surface: then
/// its cells need less memory than the triangulation did. Larger rasters would gain little, because
/// drawing is most of their work.
const CELLS_PER_FACE: usize = 2;

/// The number of triangles that are fetched at a time: few enough to stay in the nearest cache.
const TRIANGLES_AT_ONCE: usize = 1 << 8;

/// The face and the height of each cell of a raster.
///
/// Faces are drawn in their own order, without an index, so that any thread may come to any cell at
/// any time. A cell that several faces have, as on an edge, keeps the face with the highest number,
/// whichever is drawn first.
#[derive(Debug)]
pub(super) struct Drawing {
    width: usize,
    /// Row by row. The high half of a cell is one more than the number of its face, the low half
    /// the height; a cell without a face is 0.
    cells: Vec<AtomicU64>,
}

impl Drawing {
    /// Draws all faces; `None` if the raster has too many cells.
    ///
    /// # Complexity
    /// Linear in the faces and the cells. 8 bytes for each cell.
    pub(super) fn new<S: Surface + ?Sized>(
        surface: &S,
        placement: &Placement,
        frame: &Frame,
    ) -> Option<Self> {
        let Frame { width, height, .. } = *frame;
        let count = width.checked_mul(height)?;
        if count > CELLS_PER_FACE * surface.face_count() {
            return None;
        }
        let empty = (0..count).into_par_iter().with_min_len(AT_ONCE);
        let cells: Vec<AtomicU64> = empty.map(|_| AtomicU64::new(0)).collect();
        let columns = Centers::new(placement.columns, 0, width);
        let rows = Centers::new(placement.rows, 0, height);
        let scan = Scan {
            columns: &columns,
            rows: &rows,
        };
        let faces = surface.face_count();
        let ranges = (0..faces.div_ceil(TRIANGLES_AT_ONCE)).into_par_iter();
        ranges
            .with_min_len(AT_ONCE / TRIANGLES_AT_ONCE)
            .for_each_init(Vec::new, |triangles, range| {
                let start = range * TRIANGLES_AT_ONCE;
                let end = faces.min(start + TRIANGLES_AT_ONCE);
                triangles.clear();
                surface.triangles_in(start as u32..end as u32, triangles);
                let mut ink = Shared {
                    cells: &cells,
                    face: 0,
                };
                for &(face, corners) in &*triangles {
                    let in_plane = corners.map(|p| placement.to_plane(p));
                    let Some([rows, columns]) = cells_of(&in_plane, placement) else {
                        continue;
                    };
                    // PERF: every other face with one center in its box does not contain it.
                    let is_one = rows.len() == 1 && columns.len() == 1;
                    if is_one && scan.misses(&in_plane, rows.start, columns.start) {
                        continue;
                    }
                    ink.of_face(face, &corners);
                    scan.draw(in_plane, &rows, &columns, &mut ink);
                }
            });
        Some(Drawing { width, cells })
    }

    /// Copies the heights of a window, with NaN for cells without a face.
    pub(super) fn heights(&self, window: Window, out: &mut [f32]) {
        self.copy(window, out, |cell| match cell >> 32 {
            0 => f32::NAN,
            _ => f32::from_bits(cell as u32),
        });
    }

    /// Copies the numbers of the faces of a window, with [`NO_FACE`] for cells without one.
    pub(super) fn faces(&self, window: Window, out: &mut [u32]) {
        self.copy(window, out, |cell| match (cell >> 32) as u32 {
            0 => NO_FACE,
            next => next - 1,
        });
    }

    fn copy<T>(&self, window: Window, out: &mut [T], value: impl Fn(u64) -> T) {
        if out.is_empty() {
            return;
        }
        let rows = self.cells.chunks_exact(self.width).skip(window.row);
        for (row, line) in rows.zip(out.chunks_exact_mut(window.width)) {
            let cells = &row[window.column..window.column + window.width];
            for (out, cell) in line.iter_mut().zip(cells) {
                *out = value(cell.load(Ordering::Relaxed));
            }
        }
    }
}

/// Writes to cells that other threads write to, too.
struct Shared<'a> {
    cells: &'a [AtomicU64],
    face: u32,
}

impl Shared<'_> {
    #[inline]
    fn write(&self, cell: &AtomicU64, height: f32) {
        let value = (u64::from(self.face) + 1) << 32 | u64::from(height.to_bits());
        cell.fetch_max(value, Ordering::Relaxed);
    }
}

impl Ink for Shared<'_> {
    fn of_face(&mut self, face: u32, _corners: &[[f64; 3]; 3]) {
        self.face = face;
    }

    #[inline]
    fn cell(&mut self, cell: usize, height: f64) {
        self.write(&self.cells[cell], height as f32);
    }

    #[inline(always)]
    fn row(&mut self, start: usize, centers: &[f64], ends: [(f64, f64); 2]) {
        let cells = &self.cells[start..start + centers.len()];
        let heights = heights_along(centers, ends);
        cells
            .iter()
            .zip(heights)
            .for_each(|(cell, height)| self.write(cell, height));
    }
}
