//! Writes one image of a raster, whole or as an overview, to a temporary file.

use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;

use rayon::prelude::*;

use super::cell_format::CellFormat;
use super::directory::{self, Offsets, Values};
use super::tile::{SIDE, Tile, TileBuffers};
use super::{GeoTiffReader, MAX_BLOCKS, read, tags};
use crate::crs::GeoKeys;
use crate::data::{BlockSource, Frame, Window};
use crate::error::{Error, Result};
use crate::io::Watch;
use crate::io::bytes::output::Destination;

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

impl Default for RasterSummary {
    /// No values.
    fn default() -> Self {
        RasterSummary {
            min: f64::NAN,
            max: f64::NAN,
            valid: 0,
        }
    }
}

impl RasterSummary {
    /// Adds cells; NaN has no value.
    pub(crate) fn add(&mut self, cells: &[f32]) {
        for &value in cells.iter().filter(|value| !value.is_nan()) {
            self.valid += 1;
            self.min = self.min.min(f64::from(value));
            self.max = self.max.max(f64::from(value));
        }
    }
}

/// Bytes before a tile, and behind it.
const LEADER: usize = 4;

/// Bytes that are copied between two calls of a watch.
const COPIED_AT_ONCE: u64 = 1 << 23;

/// How many tiles are packed at once: 16 for each thread keep all of them busy.
pub(super) fn tiles_at_once() -> usize {
    16 * rayon::current_num_threads()
}

/// The division of an image into tiles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tiling {
    pub(super) frame: Frame,
    across: usize,
    count: usize,
}

impl Tiling {
    pub(super) fn new(frame: Frame) -> Result<Self> {
        let Frame { width, height, .. } = frame;
        if width == 0 || height == 0 {
            return Err(Error::usage(format!(
                "a raster of {width} x {height} cells has no cells"
            )));
        }
        let across = width.div_ceil(SIDE);
        let count = across.saturating_mul(height.div_ceil(SIDE));
        if count as u64 > MAX_BLOCKS || u32::try_from(width.max(height)).is_err() {
            return Err(Error::limit(format!(
                "a raster of {width} x {height} cells exceeds the limit of {MAX_BLOCKS} tiles of {SIDE} x {SIDE} cells"
            ))
            .cure("choose a coarser resolution or a smaller part"));
        }
        Ok(Tiling {
            frame,
            across,
            count,
        })
    }

    fn window(&self, tile: usize) -> Window {
        let (column, row) = (tile % self.across * SIDE, tile / self.across * SIDE);
        let (width, height) = (
            SIDE.min(self.frame.width - column),
            SIDE.min(self.frame.height - row),
        );
        Window {
            column,
            row,
            width,
            height,
        }
    }

    /// Returns the most bytes that the tiles can take. DEFLATE adds at most 5 bytes to 16 kB of
    /// incompressible data; 1 % is ample.
    pub(super) fn most_bytes(&self, cells: CellFormat) -> u64 {
        let raw = (self.count * SIDE * SIDE) as u64 * cells.cell_bytes() as u64;
        raw + raw / 100
    }
}

/// An image in a temporary file: a GeoTIFF of its own, whose tiles become part of the result.
#[derive(Debug)]
pub(super) struct Image {
    file: File,
    pub(super) packed: Packed,
}

/// The tiles of an image, and where they are in their file.
#[derive(Debug)]
pub(super) struct Packed {
    tiling: Tiling,
    /// For each tile, its position in the file and its length; 0 if nothing is stored of its cells.
    starts: Vec<u64>,
    lengths: Vec<u32>,
    /// Where the tiles begin, and where they end.
    tiles: Range<u64>,
    pub(super) summary: RasterSummary,
}

impl Image {
    /// Computes and packs all tiles, on all cores, in a file on the disk of `target`. `watch` gets
    /// the cells of each tile.
    pub(super) fn pack(
        target: &Destination,
        source: &dyn BlockSource,
        cells: CellFormat,
        watch: Watch,
    ) -> Result<Self> {
        let file = target.scratch()?;
        // Overviews are computed from the tiles: these are read as those of any other file.
        let mut out = BufWriter::with_capacity(1 << 18, file.try_clone()?);
        let packed = Packed::write(&mut out, source, cells, Offsets::Bits64, watch)?;
        out.flush()?;
        Ok(Image { file, packed })
    }

    /// Returns the cells as they will be read.
    pub(super) fn reader(&self, target: &Destination) -> Result<GeoTiffReader> {
        read::of_file(self.file.try_clone()?, target.path())
    }

    /// Appends all tiles to another file, some megabytes between two calls of `watch`.
    pub(super) fn copy_to(&mut self, out: &mut impl Write, watch: Watch) -> Result<()> {
        self.file.seek(SeekFrom::Start(self.packed.tiles.start))?;
        let mut left = self.packed.byte_count();
        while left > 0 {
            watch(0)?;
            let part = left.min(COPIED_AT_ONCE);
            std::io::copy(&mut (&self.file).take(part), out)?;
            left -= part;
        }
        Ok(())
    }
}

impl Packed {
    /// Writes a GeoTIFF of one image: computes and packs all tiles, on all cores, and puts the
    /// header before them, which is known last. `watch` gets the cells of each tile.
    pub(super) fn write(
        out: &mut (impl Write + Seek + Send),
        source: &dyn BlockSource,
        cells: CellFormat,
        offsets: Offsets,
        watch: Watch,
    ) -> Result<Self> {
        let tiling = Tiling::new(source.frame())?;
        let mut image = Packed {
            tiling,
            starts: vec![0; tiling.count],
            lengths: vec![0; tiling.count],
            tiles: 0..0,
            summary: RasterSummary::default(),
        };
        let head = |image: &Packed| {
            directory::header(offsets, &[image.tags(source, cells, image.tiles.start)])
        };
        let first = head(&image).len() as u64;
        image.tiles = first..first;
        out.seek(SeekFrom::Start(first))?;

        let pack = |range: Range<usize>| -> Result<Vec<Tile>> {
            let pack = |scratch: &mut TileBuffers, tile| -> Result<Tile> {
                let window = tiling.window(tile);
                let tile = scratch.pack(source, window, cells)?;
                watch(window.width as u64 * window.height as u64)?;
                Ok(tile)
            };
            range
                .into_par_iter()
                .map_init(TileBuffers::default, pack)
                .collect()
        };
        // One batch is computed while the previous one is written.
        let batch = tiles_at_once();
        let mut done = 0;
        let mut ready = pack(0..batch.min(tiling.count))?;
        while !ready.is_empty() {
            let packed = done + ready.len();
            let next = packed..tiling.count.min(packed + batch);
            let (written, computed) =
                rayon::join(|| image.append(done, &ready, out), || pack(next));
            written?;
            done = packed;
            ready = computed?;
        }
        out.seek(SeekFrom::Start(0))?;
        out.write_all(&head(&image))?;
        Ok(image)
    }

    fn append(&mut self, first: usize, tiles: &[Tile], out: &mut impl Write) -> Result<()> {
        let is_stored = |(_, tile): &(usize, &Tile)| !tile.bytes.is_empty();
        for (i, tile) in tiles.iter().enumerate().filter(is_stored) {
            // The length before, and the last bytes once more behind: so GDAL's COG driver does it.
            let length = tile.bytes.len() as u32;
            let behind = &tile.bytes[tile.bytes.len().saturating_sub(LEADER)..];
            out.write_all(&length.to_le_bytes())?;
            out.write_all(&tile.bytes)?;
            out.write_all(behind)?;
            self.starts[first + i] = self.tiles.end + LEADER as u64;
            self.lengths[first + i] = length;
            self.tiles.end += (LEADER + tile.bytes.len() + behind.len()) as u64;
            self.summary.valid += tile.valid;
            self.summary.min = self.summary.min.min(f64::from(tile.min));
            self.summary.max = self.summary.max.max(f64::from(tile.max));
        }
        Ok(())
    }

    /// Returns the bytes of all tiles.
    pub(super) fn byte_count(&self) -> u64 {
        self.tiles.end - self.tiles.start
    }

    /// Returns the tags of the image in a file that has its tiles from byte `first`.
    pub(super) fn tags(
        &self,
        source: &dyn BlockSource,
        cells: CellFormat,
        first: u64,
    ) -> Vec<(u16, Values)> {
        let moved = |&start: &u64| {
            if start == 0 {
                0
            } else {
                start - self.tiles.start + first
            }
        };
        let long = |value: usize| Values::Long(vec![value as u32]);
        let mut all = vec![
            (tags::IMAGE_WIDTH, long(self.tiling.frame.width)),
            (tags::IMAGE_LENGTH, long(self.tiling.frame.height)),
            (tags::COMPRESSION, short(tags::COMPRESSION_DEFLATE)),
            (tags::TILE_WIDTH, short(SIDE as u16)),
            (tags::TILE_LENGTH, short(SIDE as u16)),
            (
                tags::TILE_OFFSETS,
                Values::Offset(self.starts.iter().map(moved).collect()),
            ),
            (tags::TILE_BYTE_COUNTS, Values::Long(self.lengths.clone())),
        ];
        all.extend(cells.tags());
        all.extend(directory::placement(&self.tiling.frame));
        all.extend(directory::geo_keys(
            source.crs().map(GeoKeys::from_crs).unwrap_or_default(),
        ));
        all.sort_by_key(|(tag, _)| *tag);
        all
    }

    /// Like [`tags`](Self::tags), for an overview: what the whole image states is not repeated.
    pub(super) fn overview_tags(
        &self,
        source: &dyn BlockSource,
        cells: CellFormat,
        first: u64,
    ) -> Vec<(u16, Values)> {
        let mut all = self.tags(source, cells, first);
        all.retain(|(tag, _)| *tag <= tags::SAMPLE_FORMAT || *tag == tags::GDAL_NODATA);
        // A reduced image.
        all.insert(0, (tags::NEW_SUBFILE_TYPE, Values::Long(vec![1])));
        all
    }
}

fn short(value: u16) -> Values {
    Values::Short(vec![value])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rasters_without_cells_or_with_too_many_are_refused() {
        for (width, height) in [(0, 5), (5, 0), (usize::MAX, 5), (5_000_000, 5_000_000)] {
            assert!(Tiling::new(Frame::north_up(0.0, 0.0, 1.0, width, height)).is_err());
        }
    }
}
