//! The cells that tasks have drawn: as they are written, and as one raster.

use std::marker::PhantomData;
use std::sync::{Arc, Mutex, PoisonError};

use rustc_hash::FxHashMap;

use super::bytes::{NumberReader, put_block, put_u64};
use super::task_file::{Block, TaskFile, TaskName, TaskWriter};
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Window};
use crate::error::Result;
use crate::terrain::{Canvas, CellValue, GradientSource};

/// Files that are kept open.
const MOST_OPEN: usize = 64;

/// A canvas whose blocks go to the file of a task when they become many.
pub(super) struct Drawing<V> {
    canvas: Canvas<V>,
    /// The column and the row from which those of blocks are counted.
    counted_from: [u64; 2],
    /// Column and row of the first cell of each block, and where its heights are.
    table: Vec<([u64; 2], Block)>,
}

/// Bytes of the blocks on a canvas before they are written.
const MOST_BYTES: usize = 1 << 25;

/// Rows of blocks that a triangle may meet before it is drawn row by row.
const MOST_ROWS: usize = 8;

impl<V: CellValue> Drawing<V> {
    /// Begins the section of cells. Blocks are counted from the first one after `blocks_before`,
    /// those that were added on the left and above since the job began.
    pub(super) fn new(
        frame: Frame,
        blocks_before: [u64; 2],
        writer: &mut TaskWriter,
    ) -> Result<Self> {
        writer.begin("cells");
        Ok(Drawing {
            canvas: Canvas::new(frame)?,
            counted_from: first_cell(blocks_before),
            table: Vec::new(),
        })
    }

    pub(super) fn draw(&mut self, corners: [[f64; 3]; 3], writer: &mut TaskWriter) -> Result<()> {
        // A large triangle meets more blocks than memory has room for: one row of them at a time.
        let rows = self.canvas.block_rows(corners);
        let step = if rows.len() > MOST_ROWS {
            1
        } else {
            rows.len().max(1)
        };
        for first in rows.clone().step_by(step) {
            self.canvas
                .draw_in(corners, first..(first + step).min(rows.end));
            if self.canvas.block_count() * Canvas::SIDE.pow(2) * V::BYTES > MOST_BYTES {
                self.write_blocks(writer)?;
            }
        }
        Ok(())
    }

    fn write_blocks(&mut self, writer: &mut TaskWriter) -> Result<()> {
        let mut bytes = Vec::new();
        for block in self.canvas.take_blocks() {
            bytes.clear();
            block.values.iter().for_each(|value| value.put(&mut bytes));
            let [column, row] = self.counted_from;
            // Those before it have negative numbers.
            let first = [
                (block.window.column as u64).wrapping_sub(column),
                (block.window.row as u64).wrapping_sub(row),
            ];
            self.table.push((first, writer.put_block(&bytes)?));
        }
        Ok(())
    }

    /// Writes the remaining blocks and their table.
    pub(super) fn finish(mut self, writer: &mut TaskWriter) -> Result<()> {
        self.write_blocks(writer)?;
        writer.begin("table");
        let mut bytes = Vec::new();
        for (first, block) in self.table {
            first.iter().for_each(|&at| put_u64(&mut bytes, at));
            put_block(&mut bytes, block);
        }
        writer.put(&bytes)
    }
}

/// Returns the column and the row after so many blocks.
fn first_cell(blocks: [u64; 2]) -> [u64; 2] {
    blocks.map(|count| count.saturating_mul(Canvas::SIDE as u64))
}

/// The heights or gradients that all tasks have drawn, as one raster.
///
/// Of tasks that have a value for the same cell [one counts](CellValue::or).
pub(super) struct DrawnCells<V> {
    /// The frame of the result.
    frame: Frame,
    /// The frame that was drawn in, and the column and row in it of the first cell of the result.
    drawn: Frame,
    first: [i64; 2],
    crs: Option<Crs>,
    tasks: Vec<TaskName>,
    /// For each block, by its column and row: the files that have it, and where.
    blocks: FxHashMap<[u32; 2], Vec<(u32, Block)>>,
    open: Mutex<FxHashMap<u32, Arc<Mutex<TaskFile>>>>,
    of: PhantomData<fn() -> V>,
}

impl<V: CellValue> DrawnCells<V> {
    /// Opens the cells of these tasks, which were drawn in a frame that was enlarged by some blocks
    /// on the left and above.
    ///
    /// # Errors
    /// If a file is missing or damaged.
    pub(super) fn open(
        tasks: Vec<TaskName>,
        (drawn, blocks_before): (Frame, [u64; 2]),
        frame: Frame,
        crs: Option<Crs>,
    ) -> Result<Self> {
        let mut blocks: FxHashMap<[u32; 2], Vec<(u32, Block)>> = FxHashMap::default();
        let counted_from = first_cell(blocks_before);
        for (number, name) in (0..).zip(&tasks) {
            let mut file = TaskFile::open_done(name)?;
            let table = file.section("table")?;
            let mut reader = NumberReader::new(&table);
            while !reader.is_empty() {
                let (Some(column), Some(row), Some(block)) =
                    (reader.u64(), reader.u64(), reader.block())
                else {
                    return Err(file.damaged());
                };
                let side = Canvas::SIDE as u64;
                let column = column.wrapping_add(counted_from[0]);
                let row = row.wrapping_add(counted_from[1]);
                let is_block = column < drawn.width as u64 && row < drawn.height as u64;
                if !is_block || column % side + row % side != 0 {
                    return Err(file.damaged());
                }
                let [width, height] = [drawn.width as u64 - column, drawn.height as u64 - row];
                let size = V::BYTES as u64 * side.min(width) * side.min(height);
                if block.length != size {
                    return Err(file.damaged());
                }
                blocks
                    .entry([column, row].map(|at| (at / side) as u32))
                    .or_default()
                    .push((number, block));
            }
        }
        let [column, row] = drawn
            .inverse()
            .apply(frame.transform[0], frame.transform[3]);
        let first = [column.round() as i64, row.round() as i64];
        Ok(DrawnCells {
            frame,
            drawn,
            first,
            crs,
            tasks,
            blocks,
            open: Mutex::default(),
            of: PhantomData,
        })
    }

    fn file(&self, number: u32) -> Result<Arc<Mutex<TaskFile>>> {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(file) = open.get(&number) {
            return Ok(Arc::clone(file));
        }
        let file = TaskFile::open_done(&self.tasks[number as usize])?;
        if open.len() >= MOST_OPEN {
            open.clear();
        }
        let file = Arc::new(Mutex::new(file));
        open.insert(number, Arc::clone(&file));
        Ok(file)
    }

    /// Reads the values of a block from one of the files.
    fn values_of(&self, number: u32, block: Block, bytes: &mut Vec<u8>) -> Result<()> {
        let file = self.file(number)?;
        file.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .read(block, bytes)
    }

    /// Fills `out` with the values of a window.
    fn values(&self, window: Window, out: &mut [V]) -> Result<()> {
        self.frame.check_window(window, out.len())?;
        out.fill(V::NONE);
        let side = Canvas::SIDE as i64;
        // Columns and rows of the drawn frame; beyond it no cell has a height.
        let from = [
            window.column as i64 + self.first[0],
            window.row as i64 + self.first[1],
        ];
        let size = [window.width as i64, window.height as i64];
        let limits = [self.drawn.width as i64, self.drawn.height as i64];
        let range = |k: usize| from[k].max(0)..(from[k] + size[k]).min(limits[k]);
        let (columns, rows) = (range(0), range(1));
        if columns.is_empty() || rows.is_empty() {
            return Ok(());
        }
        let mut bytes = Vec::new();
        for block_row in rows.start / side..=(rows.end - 1) / side {
            for block_column in columns.start / side..=(columns.end - 1) / side {
                let Some(parts) = self.blocks.get(&[block_column as u32, block_row as u32]) else {
                    continue;
                };
                let [width, height] = [
                    limits[0] - block_column * side,
                    limits[1] - block_row * side,
                ]
                .map(|n| n.min(side));
                for &(number, block) in parts {
                    self.values_of(number, block, &mut bytes)?;
                    for row in
                        rows.start.max(block_row * side)..rows.end.min(block_row * side + height)
                    {
                        let first = columns.start.max(block_column * side);
                        let end = columns.end.min(block_column * side + width);
                        let line = ((row - block_row * side) * width + first - block_column * side)
                            as usize;
                        let to = ((row - from[1]) * size[0] + first - from[0]) as usize;
                        let count = (end - first) as usize;
                        let values = bytes[V::BYTES * line..V::BYTES * (line + count)]
                            .chunks_exact(V::BYTES);
                        for (cell, value) in out[to..to + count].iter_mut().zip(values) {
                            *cell = cell.or(V::of_bytes(value));
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

impl BlockSource for DrawnCells<f32> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.values(window, out)
    }
}

impl GradientSource for DrawnCells<[f64; 2]> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn gradients(&self, window: Window, out: &mut [[f64; 2]]) -> Result<()> {
        self.values(window, out)
    }
}
