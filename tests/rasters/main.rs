//! Rasters: every real file against its facts, every broken one against its verdict, and what is
//! written against what is read.

mod damaged;
mod real;
mod written;

use breakline::crs::Crs;
use breakline::data::{BlockSource, Frame, Window};
use breakline::error::Result;
use breakline::io::geotiff::{self, CellFormat, RasterSummary, WriteOptions};

/// Heights with holes: some cells, and one tile of the larger sizes.
struct Hills {
    frame: Frame,
    is_empty: bool,
}

impl BlockSource for Hills {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        None
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        for (i, cell) in out.iter_mut().enumerate() {
            *cell = self.height(
                window.column + i % window.width,
                window.row + i / window.width,
            );
        }
        Ok(())
    }
}

impl Hills {
    fn new(width: usize, height: usize) -> Self {
        let transform = [500_000.25, 0.5, 0.0, 4_000_000.125, 0.0, -0.5];
        Hills {
            frame: Frame {
                width,
                height,
                transform,
            },
            is_empty: false,
        }
    }

    fn height(&self, column: usize, row: usize) -> f32 {
        let in_hole = (256..512).contains(&row) && column < 256;
        match (column * 31 + row * 17) % 53 {
            _ if self.is_empty || in_hole => f32::NAN,
            0 if column + row > 0 => f32::NAN,
            1 => f32::INFINITY,
            noise => {
                300.0 + (column as f32 * 0.05).sin() * 40.0 + row as f32 * 0.1 + noise as f32 * 0.01
            }
        }
    }
}

fn written(
    source: &dyn BlockSource,
    cells: CellFormat,
) -> (geotiff::GeoTiffReader, RasterSummary, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("out.tif");
    let summary = geotiff::write(
        &target,
        source,
        WriteOptions {
            cells,
            ..WriteOptions::default()
        },
    )
    .unwrap();
    let bytes = std::fs::read(&target).unwrap();
    let reader = geotiff::open(&target).unwrap();
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        1,
        "nothing is left beside the file"
    );
    (reader, summary, bytes)
}
