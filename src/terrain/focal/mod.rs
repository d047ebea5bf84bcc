//! Rasters whose cells follow from 3 x 3 cells of another one.

mod quantity;
mod shade;

pub(crate) use self::quantity::direction;
pub use self::quantity::{Gradient, Quantity, QuantityMap, Ruggedness};
pub use self::shade::{Hillshade, Light, Shading};
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, ToPixels, Window};
use crate::error::Result;

/// A raster whose cells follow from the heights in the 3 x 3 cells around each of them, NaN where
/// there is no height.
///
/// At the edge of the data, and beside cells without a height, the surface is extrapolated
/// linearly: what follows from a plane is constant up to its edge.
pub struct Focal<S, R> {
    source: S,
    frame: Frame,
    to_pixels: ToPixels,
    rule: R,
}

/// How the value of a cell follows from the heights around it.
pub(super) trait Rule: Sync {
    /// Returns the value; NaN if there is none.
    fn value(&self, around: &Neighbors) -> f32;
}

/// The heights of 3 x 3 cells, none of which is missing.
pub(super) struct Neighbors<'a> {
    /// Row by row, as the raster has them.
    pub(super) heights: [f64; 9],
    pub(super) to_pixels: &'a ToPixels,
}

impl Neighbors<'_> {
    /// Returns the rise per unit of x and of y by Horn (1981): differences weighted 1, 2, 1, times
    /// a factor for heights.
    pub(super) fn gradient_by_horn(&self, z_factor: f64) -> [f64; 2] {
        let [nw, n, ne, w, _, e, sw, s, se] = self.heights;
        let per_column = ((ne + 2.0 * e + se) - (nw + 2.0 * w + sw)) / 8.0;
        let per_row = ((sw + 2.0 * s + se) - (nw + 2.0 * n + ne)) / 8.0;
        self.to_pixels
            .gradient(per_column * z_factor, per_row * z_factor)
    }
}

impl<S: BlockSource, R> Focal<S, R> {
    fn of_rule(source: S, rule: R) -> Result<Self> {
        let frame = source.frame().checked()?;
        Ok(Focal {
            source,
            frame,
            to_pixels: frame.inverse(),
            rule,
        })
    }
}

impl<S: BlockSource, R: Rule> BlockSource for Focal<S, R> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.source.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.frame.check_window(window, out.len())?;
        if out.is_empty() {
            return Ok(());
        }
        let around = Around::new(&self.source, &self.frame, window)?;
        for (row, line) in out.chunks_exact_mut(window.width).enumerate() {
            let [above, beside, below] = [0, 1, 2].map(|i| around.line(row + i).windows(3));
            let lines = above.zip(beside).zip(below);
            for (cell, ((above, beside), below)) in line.iter_mut().zip(lines) {
                let lines = [above, beside, below];
                let mut heights: [f64; 9] = std::array::from_fn(|i| f64::from(lines[i / 3][i % 3]));
                if heights[4].is_nan() {
                    *cell = f32::NAN;
                    continue;
                }
                // `PERF:` all nine without a branch, which is faster than to stop at the first.
                if heights.iter().fold(false, |any, z| any | z.is_nan()) {
                    continue_straight(&mut heights);
                }
                *cell = self.rule.value(&Neighbors {
                    heights,
                    to_pixels: &self.to_pixels,
                });
            }
        }
        Ok(())
    }
}

impl<S, R: std::fmt::Debug> std::fmt::Debug for Focal<S, R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Focal")
            .field("frame", &self.frame)
            .field("rule", &self.rule)
            .finish_non_exhaustive()
    }
}

/// Fills missing heights around the center of 3 x 3 cells by linear extrapolation: at the sides
/// from the opposite cell through the center, at the corners from the two cells next to them.
fn continue_straight(heights: &mut [f64; 9]) {
    let known = *heights;
    let center = known[4];
    for i in [1, 3, 5, 7] {
        if known[i].is_nan() {
            let opposite = known[8 - i];
            heights[i] = if opposite.is_nan() {
                center
            } else {
                2.0 * center - opposite
            };
        }
    }
    for (corner, beside) in [(0, [1, 3]), (2, [1, 5]), (6, [3, 7]), (8, [5, 7])] {
        if known[corner].is_nan() {
            heights[corner] = heights[beside[0]] + heights[beside[1]] - center;
        }
    }
}

/// A window of heights with one more cell on each side, NaN beyond the raster.
struct Around {
    width: usize,
    heights: Vec<f32>,
}

impl Around {
    fn new(source: &impl BlockSource, frame: &Frame, window: Window) -> Result<Self> {
        // The number of cells of the raster before and after the window, at most one.
        let before = [window.column.min(1), window.row.min(1)];
        let after = [
            (frame.width - window.column - window.width).min(1),
            (frame.height - window.row - window.height).min(1),
        ];
        let grown = Window {
            column: window.column - before[0],
            row: window.row - before[1],
            width: window.width + before[0] + after[0],
            height: window.height + before[1] + after[1],
        };
        let mut block = vec![0.0; grown.width * grown.height];
        source.fill(grown, &mut block)?;
        let width = window.width + 2;
        let mut heights = vec![f32::NAN; width * (window.height + 2)];
        for (row, line) in block.chunks_exact(grown.width).enumerate() {
            let first = (row + 1 - before[1]) * width + (1 - before[0]);
            heights[first..first + grown.width].copy_from_slice(line);
        }
        Ok(Around { width, heights })
    }

    fn line(&self, row: usize) -> &[f32] {
        &self.heights[row * self.width..][..self.width]
    }
}
