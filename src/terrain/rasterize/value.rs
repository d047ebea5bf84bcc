//! What a raster has of the face at the center of a cell.

use super::scan::{Ink, heights_along};
use crate::terrain::face_gradient;

/// A value of a surface at the center of a cell: its height, or the gradient of its face.
pub trait CellValue: Copy + Send + Sync + 'static {
    /// The value where there is no surface.
    const NONE: Self;

    /// The number of bytes of a value.
    const BYTES: usize;

    /// Returns true if there is a surface.
    fn is_some(&self) -> bool;

    /// Returns the value of a cell that two faces have, whichever comes first.
    fn or(self, other: Self) -> Self;

    /// Appends the bytes of the value.
    fn put(self, bytes: &mut Vec<u8>);

    /// Returns the value with these bytes, of which there are [`BYTES`](Self::BYTES).
    fn of_bytes(bytes: &[u8]) -> Self;

    /// Returns what faces are drawn with.
    #[doc(hidden)]
    fn ink(cells: &mut [Self]) -> impl Ink + '_;
}

/// The height. Faces that share a cell agree on it.
impl CellValue for f32 {
    const NONE: Self = f32::NAN;
    const BYTES: usize = 4;

    fn is_some(&self) -> bool {
        !self.is_nan()
    }

    fn or(self, other: Self) -> Self {
        if other.is_nan() { self } else { other }
    }

    fn put(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_le_bytes());
    }

    fn of_bytes(bytes: &[u8]) -> Self {
        f32::from_le_bytes(std::array::from_fn(|i| bytes[i]))
    }

    fn ink(cells: &mut [Self]) -> impl Ink + '_ {
        Heights(cells)
    }
}

/// The gradient of the face: the rise per unit of x and of y. Of faces that share a cell the
/// steepest counts, as in a [`Sample`](crate::terrain::Sample).
impl CellValue for [f64; 2] {
    const NONE: Self = [f64::NAN; 2];
    const BYTES: usize = 16;

    fn is_some(&self) -> bool {
        !self[0].is_nan()
    }

    fn or(self, other: Self) -> Self {
        face_gradient::steeper(self, other)
    }

    fn put(self, bytes: &mut Vec<u8>) {
        self.iter()
            .for_each(|rise| bytes.extend_from_slice(&rise.to_le_bytes()));
    }

    fn of_bytes(bytes: &[u8]) -> Self {
        [0, 8].map(|first| f64::from_le_bytes(std::array::from_fn(|i| bytes[first + i])))
    }

    fn ink(cells: &mut [Self]) -> impl Ink + '_ {
        Gradients {
            cells,
            gradient: Self::NONE,
        }
    }
}

/// Writes heights.
#[derive(Debug)]
pub(super) struct Heights<'a>(pub(super) &'a mut [f32]);

impl Ink for Heights<'_> {
    #[inline]
    fn cell(&mut self, cell: usize, height: f64) {
        self.0[cell] = height as f32;
    }

    #[inline(always)]
    fn row(&mut self, start: usize, centers: &[f64], ends: [(f64, f64); 2]) {
        let cells = &mut self.0[start..start + centers.len()];
        for (cell, height) in cells.iter_mut().zip(heights_along(centers, ends)) {
            *cell = height;
        }
    }
}

/// Writes the gradients of faces.
#[derive(Debug)]
struct Gradients<'a> {
    cells: &'a mut [[f64; 2]],
    /// That of the face.
    gradient: [f64; 2],
}

impl Ink for Gradients<'_> {
    fn of_face(&mut self, _face: u32, corners: &[[f64; 3]; 3]) {
        self.gradient = face_gradient::of_face(*corners);
    }

    fn cell(&mut self, cell: usize, _height: f64) {
        self.cells[cell] = self.cells[cell].or(self.gradient);
    }

    fn row(&mut self, start: usize, centers: &[f64], _ends: [(f64, f64); 2]) {
        (start..start + centers.len()).for_each(|cell| self.cell(cell, 0.0));
    }
}
