//! The difference of two rasters, and where it is largest.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Window};
use crate::error::{Error, Result};

/// How many cells two [largest differences](largest_differences) are apart, at least, along one
/// axis.
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
    /// The value of the cell, in the unit of the raster.
    pub value: f64,
}

/// Returns the cells whose values are furthest from 0, the furthest first, of which no two are near
/// each other: at least 8 cells apart along one axis. Of equal cells, the first in the raster. At
/// most `count`, without cells that are 0 or NaN.
///
/// # Complexity
/// O(n + count log n) for n cells, with memory for n / 64.
pub fn largest_differences(frame: &Frame, cells: &[f64], count: usize) -> Vec<LargeDifference> {
    let width = frame.width;
    let squares = Squares {
        width,
        height: cells.len() / width.max(1),
        cells,
    };
    let mut extremes: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    // For each square, a cell that is at least as large as all of it that may still be found.
    let mut waiting: BinaryHeap<Candidate> = squares
        .all()
        .filter_map(|square| squares.largest(square, &[]))
        .collect();
    let mut found = Vec::new();
    while found.len() < count
        && let Some((_, Reverse(cell))) = waiting.pop()
    {
        let square = squares.of(cell);
        let around = neighbors(square);
        let near: Vec<usize> = around.filter_map(|n| extremes.get(&n).copied()).collect();
        if near.iter().any(|&extreme| squares.are_near(cell, extreme)) {
            waiting.extend(squares.largest(square, &near));
            continue;
        }
        // All of its square is near it.
        extremes.insert(square, cell);
        found.push(LargeDifference {
            at: frame.center(cell % width, cell / width),
            value: cells[cell],
        });
    }
    found
}

/// A cell by the bits of its amount, which have the order of amounts, and its number. Of equal
/// ones, the first cell is the largest.
type Candidate = (u64, Reverse<usize>);

/// A raster in squares as wide as two largest differences are apart at least.
struct Squares<'a> {
    width: usize,
    height: usize,
    cells: &'a [f64],
}

impl Squares<'_> {
    fn all(&self) -> impl Iterator<Item = [usize; 2]> {
        let columns = self.width.div_ceil(APART);
        (0..self.height.div_ceil(APART))
            .flat_map(move |row| (0..columns).map(move |column| [row, column]))
    }

    /// Returns the square that a cell is in.
    fn of(&self, cell: usize) -> [usize; 2] {
        [cell / self.width, cell % self.width].map(|at| at / APART)
    }

    fn are_near(&self, cell: usize, other: usize) -> bool {
        let is_near = |of: fn(usize, usize) -> usize| {
            of(cell, self.width).abs_diff(of(other, self.width)) < APART
        };
        is_near(|cell, width| cell / width) && is_near(|cell, width| cell % width)
    }

    /// Returns the largest cell of a square that is not near some extremes, if one is not 0 or NaN.
    fn largest(&self, square: [usize; 2], extremes: &[usize]) -> Option<Candidate> {
        let [rows, columns] = [0, 1].map(|axis| {
            let start = square[axis] * APART;
            start..(start + APART).min([self.height, self.width][axis])
        });
        let is_free = |cell: usize| !extremes.iter().any(|&other| self.are_near(cell, other));
        rows.flat_map(|row| columns.clone().map(move |column| row * self.width + column))
            .filter(|&cell| self.cells[cell].abs() > 0.0 && is_free(cell))
            .map(|cell| (self.cells[cell].abs().to_bits(), Reverse(cell)))
            .max()
    }
}

/// Returns a square and those around it.
fn neighbors([row, column]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    let around = |at: usize| at.saturating_sub(1)..=at + 1;
    around(row).flat_map(move |row| around(column).map(move |column| [row, column]))
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
            (40, f64::NAN),
        ] {
            cells[cell] = value;
        }
        let found = largest_differences(&frame, &cells, 9);
        let values: Vec<f64> = found.iter().map(|extreme| extreme.value).collect();
        // The others are near those at columns 7 and 15.
        assert_eq!(values, [-3.0, -3.0, 0.5]);
        assert_eq!(found[0].at, [115.0, 49.0]);
        assert_eq!(largest_differences(&frame, &cells, 1).len(), 1);
        assert!(largest_differences(&frame, &[f64::NAN; 90], 5).is_empty());
    }

    #[test]
    fn places_are_those_of_a_search_of_all_cells() {
        let mut random = testkit::random::Random(7);
        for round in 0..300 {
            let [width, height] = [0; 2].map(|_| 1 + random.index(40));
            let frame = Frame::north_up(0.0, 0.0, 1.0, width, height);
            let most = [1, 3, 1000][round % 3];
            let cells: Vec<f64> = (0..width * height)
                .map(|_| match random.index(9) {
                    0 => f64::NAN,
                    _ => random.around(most) as f64,
                })
                .collect();
            let mut expected: Vec<[usize; 2]> = Vec::new();
            loop {
                let is_free = |cell: &usize| {
                    let [row, column] = [cell / width, cell % width];
                    let is_near =
                        |[r, c]: &[usize; 2]| r.abs_diff(row) < 8 && c.abs_diff(column) < 8;
                    cells[*cell].abs() > 0.0 && !expected.iter().any(is_near)
                };
                let free = (0..cells.len()).filter(is_free);
                let before = |one: &usize, other: &usize| {
                    let amount = |cell: usize| cells[cell].abs();
                    let order = amount(*one).total_cmp(&amount(*other));
                    order.then(other.cmp(one))
                };
                match free.max_by(before) {
                    Some(cell) => expected.push([cell / width, cell % width]),
                    None => break,
                }
            }
            let expected: Vec<LargeDifference> = expected
                .into_iter()
                .map(|[row, column]| LargeDifference {
                    at: frame.center(column, row),
                    value: cells[row * width + column],
                })
                .collect();
            for count in [usize::MAX, 3] {
                let found = largest_differences(&frame, &cells, count);
                assert_eq!(found, expected[..count.min(expected.len())]);
            }
        }
        assert!(largest_differences(&Frame::north_up(0.0, 0.0, 1.0, 0, 0), &[], 5).is_empty());
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
        let mut cells = [0.0_f32; 2];
        difference.fill(a.frame.window(), &mut cells).unwrap();
        assert!(cells[0] == 1.5 && cells[1].is_nan());
        assert!(Difference::new(&a, &grid(1.0, vec![0.0; 2])).is_err());
    }
}
