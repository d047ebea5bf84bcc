//! Heights or gradients of triangles that come one by one, in blocks of cells.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::bins::bins_of;
use super::placement::{Centers, Placement};
use super::scan::{Ink, Scan};
use super::value::CellValue;
use crate::data::{Frame, Window};
use crate::error::Result;

/// Heights or gradients at the centers of the cells of a frame, drawn triangle by triangle.
///
/// A cell has the height that [`Dem`](super::Dem) gives it for a surface with the triangle, bit for
/// bit, or the gradient that [`GradientMap`](super::GradientMap) gives it. So parts of a surface
/// may be drawn on canvases of their own, in any order: where two have a height for a cell, it is
/// the same, and of two gradients [one counts](CellValue::or). Memory is needed for blocks of cells
/// that triangles meet, 16 kB each for heights, whatever the size of the frame.
#[derive(Debug)]
pub struct Canvas<V = f32> {
    frame: Frame,
    placement: Placement,
    blocks: Vec<Block<V>>,
    /// The index of each block, by its row and column.
    index: FxHashMap<[usize; 2], usize>,
    /// The block that was drawn into last: the next triangle is likely to meet it, too.
    recent: usize,
}

#[derive(Debug)]
struct Block<V> {
    at: [usize; 2],
    columns: Centers,
    rows: Centers,
    cells: Vec<V>,
}

/// A block of cells with values.
#[derive(Debug, Clone, PartialEq)]
pub struct CanvasBlock<V = f32> {
    /// Its cells in the frame.
    pub window: Window,
    /// The values of the cells, row by row; NaN where no triangle was drawn.
    pub values: Vec<V>,
}

impl Canvas {
    /// The number of cells along a side of a block.
    pub const SIDE: usize = 64;
}

impl<V: CellValue> Canvas<V> {
    /// Creates a canvas without values.
    ///
    /// # Errors
    /// Those of [`Frame::checked`].
    pub fn new(frame: Frame) -> Result<Self> {
        let frame = frame.checked()?;
        let placement = Placement::new(&frame);
        Ok(Canvas {
            frame,
            placement,
            blocks: Vec::new(),
            index: FxHashMap::default(),
            recent: 0,
        })
    }

    /// Returns the frame.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// Returns the number of blocks that triangles have met.
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// Draws a triangle. Its corners may be in any order.
    ///
    /// # Complexity
    /// Linear in the rows of cells that the triangle meets, and in the cells that it covers.
    pub fn draw(&mut self, corners: [[f64; 3]; 3]) {
        self.draw_in(corners, 0..usize::MAX);
    }

    /// Returns the rows of blocks, counted from the first, that a triangle may meet.
    pub fn block_rows(&self, corners: [[f64; 3]; 3]) -> Range<usize> {
        let ys = corners.map(|p| self.placement.to_plane(p)[1]);
        let cells = self
            .placement
            .rows
            .cells(ys[0].min(ys[1]).min(ys[2]), ys[0].max(ys[1]).max(ys[2]));
        cells.start / Canvas::SIDE..cells.end.div_ceil(Canvas::SIDE)
    }

    /// Draws what a triangle covers of some rows of blocks.
    pub fn draw_in(&mut self, corners: [[f64; 3]; 3], block_rows: Range<usize>) {
        let Canvas {
            frame,
            placement,
            blocks,
            index,
            recent,
        } = self;
        let in_plane = corners.map(|p| placement.to_plane(p));
        bins_of(&in_plane, placement, Canvas::SIDE, |row, column| {
            if !block_rows.contains(&row) {
                return;
            }
            let at = [row, column];
            if blocks.get(*recent).is_none_or(|block| block.at != at) {
                *recent = *index.entry(at).or_insert_with(|| {
                    blocks.push(Block::new(at, frame, placement));
                    blocks.len() - 1
                });
            }
            let Block {
                columns,
                rows,
                cells,
                ..
            } = &mut blocks[*recent];
            let (of_rows, of_columns) = (0..rows.values().len(), 0..columns.values().len());
            let mut ink = V::ink(cells);
            ink.of_face(0, &corners);
            Scan { columns, rows }.draw(in_plane, &of_rows, &of_columns, &mut ink);
        });
    }

    /// Removes the blocks that have a value, by rows and then by columns; the canvas is empty
    /// afterwards.
    pub fn take_blocks(&mut self) -> Vec<CanvasBlock<V>> {
        self.index.clear();
        let mut blocks = std::mem::take(&mut self.blocks);
        blocks.sort_unstable_by_key(|block| block.at);
        let has_value = |block: &Block<V>| block.cells.iter().any(CellValue::is_some);
        let window_of = |at| window(at, &self.frame);
        let taken = blocks.into_iter().filter(has_value);
        taken
            .map(|block| CanvasBlock {
                window: window_of(block.at),
                values: block.cells,
            })
            .collect()
    }
}

impl<V: CellValue> Block<V> {
    fn new(at: [usize; 2], frame: &Frame, placement: &Placement) -> Self {
        let Window {
            column,
            row,
            width,
            height,
        } = window(at, frame);
        Block {
            at,
            columns: Centers::new(placement.columns, column, width),
            rows: Centers::new(placement.rows, row, height),
            cells: vec![V::NONE; width * height],
        }
    }
}

fn window([row, column]: [usize; 2], frame: &Frame) -> Window {
    let (column, row) = (column * Canvas::SIDE, row * Canvas::SIDE);
    let (width, height) = (
        Canvas::SIDE.min(frame.width - column),
        Canvas::SIDE.min(frame.height - row),
    );
    Window {
        column,
        row,
        width,
        height,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{BlockSource, Surface};
    use crate::terrain::{Dem, TinBuilder};
    use testkit::random::Random;

    /// Points on centers of cells and beside them, frames of all directions, triangles larger and
    /// smaller than blocks, on two canvases.
    #[test]
    fn triangles_one_by_one_give_the_cells_of_the_whole() {
        let mut random = Random(17);
        for round in 0..40 {
            let size = [12.0, 150.0, 400.0][round % 3];
            let mut builder = TinBuilder::default();
            let points: Vec<[f64; 3]> = (0..20 + 10 * round)
                .map(|_| [0, 1, 2].map(|_| (random.unit() * size * 4.0).round() / 4.0))
                .collect();
            builder.add_owned_points(points);
            let tin = builder.build().unwrap();
            let side = size as usize;
            let transform = [
                [-1.0, 1.0, 0.0, size + 1.0, 0.0, -1.0],
                [size, -0.7, 0.0, 3.0, 0.0, 0.7],
                [size / 2.0, 0.6, -0.8, 0.0, 0.8, 0.6],
            ][round / 3 % 3];
            let frame = Frame {
                width: side + 5,
                height: side,
                transform,
            };
            let mut expected = vec![0.0; frame.width * frame.height];
            Dem::new(&tin, frame)
                .unwrap()
                .fill(frame.window(), &mut expected)
                .unwrap();

            let mut found = vec![f32::NAN; expected.len()];
            let mut canvases: [Canvas<f32>; 2] = [0, 1].map(|_| Canvas::new(frame).unwrap());
            for face in 0..tin.face_count() as u32 {
                let Some(corners) = tin.triangle(face) else {
                    continue;
                };
                let canvas = &mut canvases[random.index(2)];
                match face % 2 {
                    0 => canvas.draw(corners),
                    _ => canvas
                        .block_rows(corners)
                        .for_each(|row| canvas.draw_in(corners, row..row + 1)),
                }
            }
            for block in canvases.iter_mut().flat_map(Canvas::take_blocks) {
                let Window {
                    column, row, width, ..
                } = block.window;
                for (i, &height) in block
                    .values
                    .iter()
                    .enumerate()
                    .filter(|(_, height)| !height.is_nan())
                {
                    let cell = &mut found[(row + i / width) * frame.width + column + i % width];
                    assert!(cell.is_nan() || cell.to_bits() == height.to_bits());
                    *cell = height;
                }
            }
            assert_eq!(canvases[0].block_count(), 0);
            assert!(
                found
                    .iter()
                    .map(|z| z.to_bits())
                    .eq(expected.iter().map(|z| z.to_bits())),
                "round {round}"
            );
        }
    }
}
