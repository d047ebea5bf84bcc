//! The difference of two rasters, and where it is largest.

use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Window};
use crate::error::{Error, Result};

/// How many cells two [places](largest_differences) are apart, at least, along one axis.
const APART: usize = 8;

/// The cells of a raster minus those of another one with the same frame; NaN where either is.
#[derive(Debug)]
pub struct Difference<A, B> {
    of: A,
    minus: B,
}

impl<A: BlockSource, B: BlockSource> Difference<A, B> {
    /// Creates the difference.
    ///
    /// # Errors
    /// If the frames differ.
    pub fn new(of: A, minus: B) -> Result<Self> {
        match of.frame() == minus.frame() {
            true => Ok(Difference { of, minus }),
            false => Err(Error::usage("two rasters have different cells")
                .cure("sample one of them in the cells of the other")),
        }
    }
}

impl<A: BlockSource, B: BlockSource> BlockSource for Difference<A, B> {
    fn frame(&self) -> Frame {
        self.of.frame()
    }

    fn crs(&self) -> Option<&Crs> {
        self.of.crs().or(self.minus.crs())
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.of.fill(window, out)?;
        let mut minus = vec![0.0; out.len()];
        self.minus.fill(window, &mut minus)?;
        // The difference of two of these numbers is exact in an f64.
        let difference = |a: f32, b: f32| (f64::from(a) - f64::from(b)) as f32;
        out.iter_mut()
            .zip(minus)
            .for_each(|(cell, minus)| *cell = difference(*cell, minus));
        Ok(())
    }
}

/// A cell whose value is the largest around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargeDifference {
    /// The center of the cell.
    pub at: [f64; 2],
    /// Its value.
    pub value: f64,
}

/// Returns the cells whose values are furthest from 0, the furthest first, of which no two are near
/// each other: at least 8 cells apart along one axis. Of equal cells, the first in the raster. At
/// most `count`, without cells that are 0 or NaN.
///
/// # Complexity
/// O(n count) for n cells.
pub fn largest_differences(frame: &Frame, cells: &[f32], count: usize) -> Vec<LargeDifference> {
    let width = frame.width;
    let mut extremes: Vec<(usize, f32)> = Vec::new();
    while extremes.len() < count {
        let is_near = |cell: usize| {
            let (row, column) = (cell / width, cell % width);
            extremes.iter().any(|&(extreme, _)| {
                (extreme / width).abs_diff(row) < APART
                    && (extreme % width).abs_diff(column) < APART
            })
        };
        let mut largest: Option<(usize, f32)> = None;
        for (cell, &value) in cells.iter().enumerate() {
            if value.abs() > largest.map_or(0.0, |(_, other)| other.abs()) && !is_near(cell) {
                largest = Some((cell, value));
            }
        }
        match largest {
            Some(extreme) => extremes.push(extreme),
            None => break,
        }
    }
    extremes
        .into_iter()
        .map(|(cell, value)| LargeDifference {
            at: frame.center(cell % width, cell / width),
            value: f64::from(value),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Grid;

    #[test]
    fn places_are_apart_and_the_first_of_equal_ones() {
        let frame = Frame::north_up(100.0, 50.0, 2.0, 30, 3);
        let mut cells = vec![0.0; 90];
        for (cell, value) in [
            (0, 1.0),
            (7, -3.0),
            (14, 2.0),
            (15, -3.0),
            (29, 0.5),
            (40, f32::NAN),
        ] {
            cells[cell] = value;
        }
        let found = largest_differences(&frame, &cells, 9);
        let values: Vec<f64> = found.iter().map(|extreme| extreme.value).collect();
        // The others are near those at columns 7 and 15.
        assert_eq!(values, [-3.0, -3.0, 0.5]);
        assert_eq!(found[0].at, [115.0, 49.0]);
        assert_eq!(largest_differences(&frame, &cells, 1).len(), 1);
        assert!(largest_differences(&frame, &[f32::NAN; 90], 5).is_empty());
    }

    #[test]
    fn only_rasters_of_the_same_cells_have_a_difference() {
        let grid = |left: f64, cells: Vec<f64>| Grid {
            frame: Frame::north_up(left, 1.0, 1.0, 2, 1),
            crs: None,
            values: cells,
        };
        let (a, b) = (grid(0.0, vec![5.0, f64::NAN]), grid(0.0, vec![3.5, 1.0]));
        let difference = Difference::new(&a, &b).unwrap();
        let mut cells = [0.0; 2];
        difference.fill(a.frame.window(), &mut cells).unwrap();
        assert!(cells[0] == 1.5 && cells[1].is_nan());
        assert!(Difference::new(&a, &grid(1.0, vec![0.0; 2])).is_err());
    }
}
