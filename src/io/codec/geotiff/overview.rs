//! A raster with half as many columns and rows.

use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Window};
use crate::error::Result;

/// The raster of another one's cells in blocks of 2 x 2: each has the mean of those that have a
/// value. At the end of an odd number of columns or rows, blocks are smaller.
pub(super) struct Halved<S> {
    finer: S,
    frame: Frame,
}

impl<S: BlockSource> Halved<S> {
    pub(super) fn new(finer: S) -> Self {
        let mut frame = finer.frame();
        let [across, down] =
            [frame.width, frame.height].map(|cells| cells as f64 / cells.div_ceil(2) as f64);
        (frame.width, frame.height) = (frame.width.div_ceil(2), frame.height.div_ceil(2));
        // The same extent.
        for (k, ratio) in [(1, across), (2, down), (4, across), (5, down)] {
            frame.transform[k] *= ratio;
        }
        Halved { finer, frame }
    }
}

impl<S: BlockSource> BlockSource for Halved<S> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.finer.crs()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        self.frame.check_window(window, out.len())?;
        let Frame { width, height, .. } = self.finer.frame();
        let [column, row] = [2 * window.column, 2 * window.row];
        let (columns, rows) = (
            (2 * window.width).min(width - column),
            (2 * window.height).min(height - row),
        );
        let mut cells = vec![f32::NAN; columns * rows];
        self.finer.fill(
            Window {
                column,
                row,
                width: columns,
                height: rows,
            },
            &mut cells,
        )?;
        for (y, line) in out.chunks_exact_mut(window.width).enumerate() {
            for (x, mean) in line.iter_mut().enumerate() {
                let (mut sum, mut count) = (0.0, 0);
                for row in 2 * y..(2 * y + 2).min(rows) {
                    let line = &cells[row * columns..][2 * x..(2 * x + 2).min(columns)];
                    for cell in line.iter().filter(|cell| !cell.is_nan()) {
                        sum += f64::from(*cell);
                        count += 1;
                    }
                }
                // NaN if none has a value.
                *mean = (sum / f64::from(count)) as f32;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Grid;

    #[test]
    fn cells_are_the_means_of_those_that_have_a_value() {
        let gap = f64::NAN;
        #[rustfmt::skip]
        let values = vec![
            1.0, 2.0, gap, gap, 5.0,
            3.0, 6.0, gap, 8.0, 7.0,
            0.5, gap, gap, gap, gap,
        ];
        let frame = Frame::north_up(100.0, 200.0, 2.0, 5, 3);
        let halved = Halved::new(Grid {
            frame,
            crs: None,
            values,
        });
        assert_eq!(
            halved.frame,
            Frame {
                width: 3,
                height: 2,
                transform: [100.0, 10.0 / 3.0, 0.0, 200.0, 0.0, -3.0]
            }
        );
        let mut all = vec![0.0; 6];
        halved.fill(halved.frame.window(), &mut all).unwrap();
        assert_eq!(format!("{all:?}"), "[3.0, 8.0, 6.0, 0.5, NaN, NaN]");
        let mut part = vec![0.0; 2];
        halved
            .fill(
                Window {
                    column: 1,
                    row: 0,
                    width: 1,
                    height: 2,
                },
                &mut part,
            )
            .unwrap();
        assert_eq!(format!("{part:?}"), "[8.0, NaN]");
    }
}
