use std::io::{Seek, SeekFrom, Write};
use std::ops::Range;

use rayon::prelude::*;

use super::cell_format::{CellFormat, NO_HEIGHT};
use super::directory::{self, Offsets, Values};
use super::tile::{SIDE, Scratch, Tile};
use super::{MAX_BLOCKS, tags};
use crate::crs::GeoKeys;
use crate::data::{BlockSource, Frame, Window};
use crate::error::{Error, Result};
use crate::io::{Destination, Output};

/// How a raster is written.
#[derive(Clone, Copy, Default)]
pub struct WriteOptions<'a> {
    /// What the cells contain.
    pub cells: CellFormat,
    /// Called from time to time with the number of cells done and the total number.
    pub progress: Option<&'a (dyn Fn(u64, u64) + Sync)>,
}

/// Options for these contents, without a report of progress.
impl From<CellFormat> for WriteOptions<'_> {
    fn from(cells: CellFormat) -> Self {
        WriteOptions { cells, progress: None }
    }
}

impl std::fmt::Debug for WriteOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WriteOptions").field("cells", &self.cells).finish_non_exhaustive()
    }
}

/// What a raster file contains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RasterSummary {
    /// Smallest value; NaN if there is none.
    pub min: f64,
    /// Largest value; NaN if there is none.
    pub max: f64,
    /// Number of cells with a value.
    pub valid: u64,
}

/// Writes a GeoTIFF: one band, DEFLATE, tiles of 256 x 256, PixelIsArea, with the coordinate system
/// of the source.
///
/// All cores compute and compress tiles, a few at a time, which are written in order. Memory stays
/// at some megabytes whatever the size of the raster, and the bytes do not depend on the number of
/// threads. Tiles without any value are left out (a sparse file, as with GDAL's SPARSE_OK). The
/// file is a BigTIFF if it might otherwise exceed 4 GiB. It appears at its target once it is
/// complete.
///
/// # Errors
/// If the raster has no cells or too many, the source fails, or the file cannot be written.
pub fn write<'a>(
    target: impl Into<Destination<'a>>,
    source: &dyn BlockSource,
    options: WriteOptions<'_>,
) -> Result<RasterSummary> {
    let target = target.into();
    let write = || {
        let tiles = Tiling::new(source.frame())?;
        write_tiles(target, source, options, &tiles, tiles.offsets(options.cells))
    };
    write().map_err(|e| e.in_file(target.path()))
}

/// The division of a raster into tiles.
#[derive(Debug)]
struct Tiling {
    frame: Frame,
    across: usize,
    count: usize,
}

impl Tiling {
    fn new(frame: Frame) -> Result<Self> {
        let Frame { width, height, .. } = frame;
        if width == 0 || height == 0 {
            return Err(Error::usage(format!("a raster of {width} x {height} cells has no cells")));
        }
        let across = width.div_ceil(SIDE);
        let count = across.saturating_mul(height.div_ceil(SIDE));
        if count as u64 > MAX_BLOCKS || u32::try_from(width.max(height)).is_err() {
            return Err(Error::limit(format!(
                "a raster of {width} x {height} cells exceeds the limit of {MAX_BLOCKS} tiles of {SIDE} x {SIDE} cells"
            ))
            .cure("choose a coarser resolution or a smaller part"));
        }
        Ok(Tiling { frame, across, count })
    }

    fn window(&self, tile: usize) -> Window {
        let (column, row) = (tile % self.across * SIDE, tile / self.across * SIDE);
        let (width, height) = (SIDE.min(self.frame.width - column), SIDE.min(self.frame.height - row));
        Window { column, row, width, height }
    }

    /// Returns 32-bit offsets if they are certain to suffice. DEFLATE adds at most 5 bytes to 16 kB
    /// of incompressible data; including the header, 1 % is ample.
    fn offsets(&self, cells: CellFormat) -> Offsets {
        let raw = (self.count * SIDE * SIDE) as u64 * u64::from(cells.bits() / 8);
        if raw + raw / 100 + (1 << 20) < 1 << 32 { Offsets::Bits32 } else { Offsets::Bits64 }
    }
}

fn write_tiles(
    target: Destination,
    source: &dyn BlockSource,
    options: WriteOptions<'_>,
    tiles: &Tiling,
    offsets: Offsets,
) -> Result<RasterSummary> {
    let mut out = Writer {
        out: Output::create_seekable(target.path())?,
        at: 0,
        places: vec![0; tiles.count],
        lengths: vec![0; tiles.count],
        summary: RasterSummary { min: f64::INFINITY, max: f64::NEG_INFINITY, valid: 0 },
    };
    let tags = |out: &Writer| directory::header(offsets, &all_tags(source, options.cells, tiles, out));
    let head = tags(&out);
    out.out.write_all(&head)?;
    out.at = head.len() as u64;

    let pack = |range: Range<usize>| -> Result<Vec<Tile>> {
        let pack = |scratch: &mut Scratch, tile| scratch.pack(source, tiles.window(tile), options.cells);
        range.into_par_iter().map_init(Scratch::default, pack).collect()
    };
    // One batch is computed while the previous one is written; 16 tiles per core keep all cores
    // busy.
    let batch = 16 * rayon::current_num_threads();
    let all_cells = tiles.frame.width as u64 * tiles.frame.height as u64;
    let mut done = 0;
    let mut ready = pack(0..batch.min(tiles.count))?;
    while !ready.is_empty() {
        let packed = done + ready.len();
        let next = packed..tiles.count.min(packed + batch);
        let (written, computed) = rayon::join(|| out.append(done, &ready), || pack(next));
        written?;
        done = packed;
        ready = computed?;
        if let Some(progress) = options.progress {
            progress(all_cells * done as u64 / tiles.count as u64, all_cells);
        }
    }
    let head = tags(&out);
    out.out.seek(SeekFrom::Start(0))?;
    out.out.write_all(&head)?;
    let mut summary = out.summary;
    if summary.valid == 0 {
        (summary.min, summary.max) = (f64::NAN, f64::NAN);
    }
    // Overviews and statistics of a previous raster would be attributed to this one.
    let beside = ["ovr", "aux.xml"].map(|extension| {
        let mut name = target.path().as_os_str().to_owned();
        name.push(".");
        name.push(extension);
        name.into()
    });
    target.put_all([], out.out, beside)?;
    Ok(summary)
}

/// The file written so far.
struct Writer {
    out: Output,
    at: u64,
    places: Vec<u64>,
    lengths: Vec<u32>,
    summary: RasterSummary,
}

impl Writer {
    fn append(&mut self, first: usize, tiles: &[Tile]) -> Result<()> {
        for (i, tile) in tiles.iter().enumerate().filter(|(_, tile)| tile.valid > 0) {
            self.out.write_all(&tile.bytes)?;
            self.places[first + i] = self.at;
            self.lengths[first + i] = tile.bytes.len() as u32;
            self.at += tile.bytes.len() as u64;
            self.summary.valid += tile.valid;
            self.summary.min = self.summary.min.min(f64::from(tile.min));
            self.summary.max = self.summary.max.max(f64::from(tile.max));
        }
        Ok(())
    }
}

fn all_tags(source: &dyn BlockSource, cells: CellFormat, tiles: &Tiling, out: &Writer) -> Vec<(u16, Values)> {
    let short = |value| Values::Short(vec![value]);
    let long = |value: usize| Values::Long(vec![value as u32]);
    let (predictor, sample_format, nodata) = match cells {
        CellFormat::Heights => (3, 3, format!("{NO_HEIGHT}")),
        CellFormat::Shades => (2, 1, "0".to_owned()),
    };
    let mut all = vec![
        (tags::IMAGE_WIDTH, long(tiles.frame.width)),
        (tags::IMAGE_LENGTH, long(tiles.frame.height)),
        (tags::BITS_PER_SAMPLE, short(cells.bits())),
        (tags::COMPRESSION, short(tags::COMPRESSION_DEFLATE)),
        // BlackIsZero.
        (tags::PHOTOMETRIC, short(1)),
        (tags::SAMPLES_PER_PIXEL, short(1)),
        (tags::PLANAR_CONFIGURATION, short(1)),
        (tags::PREDICTOR, short(predictor)),
        (tags::TILE_WIDTH, short(SIDE as u16)),
        (tags::TILE_LENGTH, short(SIDE as u16)),
        (tags::TILE_OFFSETS, Values::Offset(out.places.clone())),
        (tags::TILE_BYTE_COUNTS, Values::Long(out.lengths.clone())),
        (tags::SAMPLE_FORMAT, short(sample_format)),
    ];
    all.extend(directory::placement(&tiles.frame));
    all.extend(directory::geo_keys(source.crs().map(GeoKeys::from_crs).unwrap_or_default()));
    all.push((tags::GDAL_NODATA, Values::Text(nodata)));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Grid;

    struct Slope(Frame);

    impl BlockSource for Slope {
        fn frame(&self) -> Frame {
            self.0
        }

        fn crs(&self) -> Option<&crate::crs::Crs> {
            None
        }

        fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
            for (i, cell) in out.iter_mut().enumerate() {
                let (column, row) = (window.column + i % window.width, window.row + i / window.width);
                // Every seventh cell, and all of the second column of tiles, have no value.
                let is_hole = (column + row) % 7 == 0 || (SIDE..2 * SIDE).contains(&column);
                *cell = if is_hole { f32::NAN } else { column as f32 * 0.25 - row as f32 };
            }
            Ok(())
        }
    }

    fn written(offsets: Offsets) -> (Grid, bool) {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("slope.tif");
        let frame = Frame::north_up(1000.0, 2000.0, 0.5, 600, 300);
        let tiles = Tiling::new(frame).unwrap();
        write_tiles((&target).into(), &Slope(frame), WriteOptions::default(), &tiles, offsets).unwrap();
        let reader = crate::io::geotiff::open(&target).unwrap();
        (reader.read_grid().unwrap(), reader.info().is_big_tiff)
    }

    #[test]
    fn classic_and_big_files_hold_the_same() {
        let (small, is_big) = written(Offsets::Bits32);
        assert!(!is_big);
        let (big, is_big) = written(Offsets::Bits64);
        assert!(is_big);
        assert_eq!(small.frame, big.frame);
        assert!(small.values.iter().map(|v| v.to_bits()).eq(big.values.iter().map(|v| v.to_bits())));
        assert_eq!(small.value(1, 0), 0.25);
        assert!(small.value(300, 5).is_nan() && small.value(7, 0).is_nan());
    }

    #[test]
    fn offsets_are_wide_when_the_file_may_pass_four_gibibytes() {
        let offsets = |side, cells| Tiling::new(Frame::north_up(0.0, 0.0, 1.0, side, side)).unwrap().offsets(cells);
        assert_eq!(offsets(30_000, CellFormat::Heights), Offsets::Bits32);
        assert_eq!(offsets(33_000, CellFormat::Heights), Offsets::Bits64);
        assert_eq!(offsets(60_000, CellFormat::Shades), Offsets::Bits32);
        assert_eq!(offsets(66_000, CellFormat::Shades), Offsets::Bits64);
    }

    #[test]
    fn rasters_without_cells_or_with_too_many_are_refused() {
        for (width, height) in [(0, 5), (5, 0), (usize::MAX, 5), (5_000_000, 5_000_000)] {
            assert!(Tiling::new(Frame::north_up(0.0, 0.0, 1.0, width, height)).is_err());
        }
    }
}
