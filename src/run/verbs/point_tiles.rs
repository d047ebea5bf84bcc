//! Points in tiles: a file for each square of the plan.
//!
//! Records are sorted by tiles in memory, and moved to a file without a name whenever they take too
//! much of it. Then one tile after the other is written, so that memory and open files do not grow
//! with the number of tiles.

use std::collections::{BTreeMap, HashSet};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use super::new_folder::NewFolder;
use super::targets::{Existing, identity};
use crate::data::{Bounds, PointBatch, PointFlags, PointInfo, PointSink, PointSummary};
use crate::error::{Error, Result, Setting, wording};
use crate::io::las::Detail;
use crate::io::{OutputSet, points, require_absent};
use crate::run::context::units::Units;
use crate::run::context::{Context, Stage};
use crate::run::products::points::{PointsReport, PointsRequest, transfer};

/// The most bytes of records in memory, of all tiles together.
const MOST_WAITING: usize = 1 << 26;

/// The most tiles of a run.
const MOST_TILES: usize = 100_000;

/// Tiles of points to write.
#[derive(Debug, Clone)]
pub struct PointTiles {
    /// The folder for the files. It is created if it does not exist, in a folder that exists.
    pub folder: PathBuf,
    /// The side of a tile. Tiles begin at multiples of it.
    pub size: PlanLength,
    /// The file of a tile also has the points of others that are no further from it than this,
    /// along each axis.
    pub buffer: PlanLength,
    /// Flags the points of the buffer as withheld; otherwise their flags are kept.
    pub flags_buffer: bool,
    /// What to do with files that exist.
    pub existing: Existing,
}

/// A length in plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlanLength {
    /// In the units of the coordinates.
    Units(f64),
    /// In meters.
    Metres(f64),
}

/// Reads a length as it is typed: `500`, `20m` or `1km`.
impl FromStr for PlanLength {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let number = |text: &str| {
            let number = text.trim_end().parse::<f64>().ok();
            let number = number.filter(|number| number.is_finite() && *number > 0.0);
            number.ok_or_else(|| "expected a length above zero, such as 500, 20m or 1km".to_owned())
        };
        match (text.strip_suffix("km"), text.strip_suffix('m')) {
            (Some(kilometres), _) => number(kilometres).map(|n| PlanLength::Metres(n * 1000.0)),
            (None, Some(metres)) => number(metres).map(PlanLength::Metres),
            (None, None) => number(text).map(PlanLength::Units),
        }
    }
}

impl PlanLength {
    /// Returns the length in the units of coordinates.
    ///
    /// # Errors
    /// If it is in meters, and coordinates are angles.
    fn of(self, units: &Units, setting: Setting) -> Result<f64> {
        match self {
            PlanLength::Units(length) => Ok(length),
            PlanLength::Metres(metres) if units.is_angular() => Err(Error::usage(wording![
                setting,
                format!(" is {metres} meters, and the coordinates are angles")
            ])
            .cure(wording![
                "give it in degrees, or reproject the points with ",
                Setting::TargetCrs
            ])),
            PlanLength::Metres(metres) => Ok(units.of_metres(metres)),
        }
    }
}

/// Writes the selected points of files to a file for each tile that has any. Returns the report,
/// which counts each point once, and the number of tiles. All files appear together, or none.
///
/// A file has the name `X_Y` of the tile's lower left corner, and is LAS if the first input is,
/// else LAZ. A point belongs to one tile: a tile has its lower and left borders. In a tile, points
/// have the order of the inputs, and those of the buffer are among them. Records are copied as in
/// [`write_points`](crate::run::write_points).
///
/// # Complexity
/// O(n log t) for n points, each as often as files have it, and t tiles. 64 MB of records are in
/// memory, and those of all points, uncompressed, on the disk of the folder.
///
/// # Errors
/// Those of [`write_points`](crate::run::write_points); if points are from files other than LAS and
/// LAZ; if a length is in meters and coordinates are angles; if the buffer is wider than a tile, or
/// there are more than 100 000 tiles; if a file exists and is not to be replaced, or is an input.
pub fn write_point_tiles(
    request: &PointsRequest,
    tiles: &PointTiles,
    context: &Context,
) -> Result<(PointsReport, usize)> {
    let folder = NewFolder::at(&tiles.folder)?;
    let set = OutputSet::default();
    let mut written = 0;
    let report = transfer(
        request,
        Detail::Records,
        Stage::WritingPoints,
        context,
        |infos| {
            let sorted = Sorted::new(request, tiles, infos, &set, &mut written, context)?;
            Ok(Box::new(sorted) as Box<dyn PointSink>)
        },
    );
    let report = report?;
    set.commit()?;
    folder.keep();
    Ok((report, written))
}

/// A tile while points are read.
#[derive(Default)]
struct Tile {
    /// The points that belong to it.
    own: u64,
    /// Records in memory, all of one source.
    waiting: Vec<u8>,
    /// The number of that source.
    source: usize,
    /// Where its other records are in the file without a name: the source, the position and the
    /// number of bytes.
    parts: Vec<(usize, u64, usize)>,
}

/// A sink that sorts records by tiles, and writes the tiles at its end.
struct Sorted<'a> {
    request: &'a PointsRequest,
    tiles: &'a PointTiles,
    set: &'a OutputSet,
    written: &'a mut usize,
    context: &'a Context<'a>,
    extension: &'static str,
    /// The side of a tile and the width of the buffer, in the units of the coordinates.
    size: f64,
    buffer: f64,
    infos: Vec<PointInfo>,
    /// The sources so far, in order.
    sources: Vec<PointInfo>,
    by_corner: BTreeMap<[i64; 2], Tile>,
    /// The bytes of records in memory, of all tiles.
    waiting: usize,
    /// The file without a name, and its length in bytes.
    scratch: File,
    scratch_bytes: u64,
}

impl<'a> Sorted<'a> {
    fn new(
        request: &'a PointsRequest,
        tiles: &'a PointTiles,
        infos: &[&PointInfo],
        set: &'a OutputSet,
        written: &'a mut usize,
        context: &'a Context<'a>,
    ) -> Result<Self> {
        let units = Units::of(infos.first().and_then(|info| info.crs.as_ref()));
        let size = tiles.size.of(&units, Setting::Tile)?;
        let buffer = tiles.buffer.of(&units, Setting::Buffer)?;
        if buffer > size {
            return Err(Error::usage(wording![
                Setting::Buffer,
                format!(" is {buffer}, wider than a tile, which is {size}")
            ])
            .cure("state larger tiles"));
        }
        let is_plain = request.files.first().and_then(|file| file.extension());
        let is_plain = is_plain.is_some_and(|known| known.eq_ignore_ascii_case("las"));
        let extension = if is_plain { "las" } else { "laz" };
        // Files that do not fit together are refused before points are read.
        let probe = tiles.folder.join("tile").with_extension(extension);
        drop(points::create(set.at(&probe), infos, request.rounding)?);
        Ok(Sorted {
            request,
            tiles,
            set,
            written,
            context,
            extension,
            size,
            buffer,
            infos: infos.iter().map(|&info| info.clone()).collect(),
            sources: Vec::new(),
            by_corner: BTreeMap::new(),
            waiting: 0,
            scratch: set.at(&probe).scratch()?,
            scratch_bytes: 0,
        })
    }

    /// Returns the number of the tile along an axis that a coordinate belongs to.
    fn number(&self, x: f64) -> Result<i64> {
        /// Beyond it, tiles have no exact corners.
        const LIMIT: f64 = (1_i64 << 52) as f64;
        let about = (x / self.size).floor();
        if about.is_nan() || about.abs() >= LIMIT {
            return Err(Error::limit(format!(
                "{x} is too far out for tiles of {}",
                self.size
            )));
        }
        // A rounded quotient may be at the next tile.
        let number = if about * self.size > x {
            about - 1.0
        } else {
            about
        };
        let is_beyond = (number + 1.0) * self.size <= x;
        Ok(if is_beyond { number + 1.0 } else { number } as i64)
    }

    /// Returns the numbers of the tiles along an axis whose files have a coordinate, by their
    /// buffers too, and the number of the tile that it belongs to.
    fn numbers(&self, x: f64) -> Result<(std::ops::RangeInclusive<i64>, i64)> {
        let own = self.number(x)?;
        let is_near = |number: i64| {
            let low = number as f64 * self.size - self.buffer;
            let high = (number + 1) as f64 * self.size + self.buffer;
            self.buffer > 0.0 && low <= x && x <= high
        };
        // A buffer as wide as a tile reaches the border of the second next one.
        let (mut first, mut last) = (own, own);
        while is_near(first - 1) {
            first -= 1;
        }
        while is_near(last + 1) {
            last += 1;
        }
        Ok((first..=last, own))
    }

    /// Adds a record to a tile, which may be that of the point or one whose buffer has it.
    fn add(
        &mut self,
        corner: [i64; 2],
        is_own: bool,
        record: &[u8],
        point_format: u8,
    ) -> Result<()> {
        let source = self.sources.len() - 1;
        if self.by_corner.len() == MOST_TILES && !self.by_corner.contains_key(&corner) {
            return Err(Error::limit(format!("more than {MOST_TILES} tiles"))
                .cure(wording!["state a larger ", Setting::Tile]));
        }
        let tile = self.by_corner.entry(corner).or_default();
        if tile.source != source {
            let before = std::mem::replace(&mut tile.source, source);
            self.waiting -= tile.waiting.len();
            keep(tile, before, &mut self.scratch, &mut self.scratch_bytes)?;
        }
        let start = tile.waiting.len();
        tile.waiting.extend_from_slice(record);
        tile.own += u64::from(is_own);
        self.waiting += record.len();
        if !is_own && self.tiles.flags_buffer {
            // Byte 15 has the class below the flags up to format 5, and from format 6 on flags
            // alone.
            let shift = if point_format < 6 { 5 } else { 0 };
            let withheld = PointFlags::WITHHELD << shift;
            tile.waiting[start + 15] |= withheld;
        }
        if self.waiting >= MOST_WAITING {
            self.keep_all()?;
        }
        Ok(())
    }

    /// Moves all records in memory to the file without a name.
    fn keep_all(&mut self) -> Result<()> {
        for tile in self.by_corner.values_mut() {
            keep(
                tile,
                tile.source,
                &mut self.scratch,
                &mut self.scratch_bytes,
            )?;
        }
        self.waiting = 0;
        Ok(())
    }

    fn path(&self, [x, y]: [i64; 2]) -> PathBuf {
        let [x, y] = [x, y].map(|number| number as f64 * self.size);
        self.tiles
            .folder
            .join(format!("{x}_{y}.{}", self.extension))
    }

    /// Returns an error if a tile would replace a file that should stay.
    fn require_room(&self) -> Result<()> {
        let inputs: HashSet<PathBuf> = self
            .request
            .files
            .iter()
            .map(|file| identity(file))
            .collect();
        for (&corner, _) in self.by_corner.iter().filter(|(_, tile)| tile.own > 0) {
            let path = self.path(corner);
            if inputs.contains(&identity(&path)) {
                return Err(Error::usage("a tile would replace an input")
                    .in_file(path)
                    .cure("write the tiles to another folder"));
            }
            if self.tiles.existing == Existing::Keep {
                require_absent(&path)?;
            }
        }
        Ok(())
    }

    /// Writes a tile, and returns the box around its points.
    fn write_tile(&mut self, path: &Path, tile: &Tile) -> Result<Bounds> {
        let infos: Vec<&PointInfo> = self.infos.iter().collect();
        let mut sink = points::create(self.set.at(path), &infos, self.request.rounding)?;
        let mut batch = PointBatch::default();
        for &(source, position, bytes) in &tile.parts {
            self.context.check()?;
            let info = &self.sources[source];
            sink.next_source(info)?;
            batch.records.resize(bytes, 0);
            self.scratch.seek(SeekFrom::Start(position))?;
            self.scratch.read_exact(&mut batch.records)?;
            // The writer of LAS copies records; of columns it needs only the length.
            let count = bytes.checked_div(stride(info)).unwrap_or(0);
            for column in [&mut batch.x, &mut batch.y, &mut batch.z] {
                column.resize(count, 0.0);
            }
            sink.write(&batch)?;
        }
        let bounds = sink.finish()?.bounds;
        self.set.close_staged()?;
        Ok(bounds)
    }
}

/// Moves the records of a tile from memory to a file.
fn keep(tile: &mut Tile, source: usize, to: &mut File, position: &mut u64) -> Result<()> {
    if tile.waiting.is_empty() {
        return Ok(());
    }
    to.write_all(&tile.waiting)?;
    tile.parts.push((source, *position, tile.waiting.len()));
    *position += tile.waiting.len() as u64;
    tile.waiting = Vec::new();
    Ok(())
}

/// Returns the number of bytes of a record of a source; 0 if it has no records.
fn stride(info: &PointInfo) -> usize {
    info.head
        .as_ref()
        .map_or(0, |head| usize::from(head.record_length))
}

impl PointSink for Sorted<'_> {
    fn next_source(&mut self, info: &PointInfo) -> Result<()> {
        self.sources.push(info.clone());
        Ok(())
    }

    fn write(&mut self, batch: &PointBatch) -> Result<()> {
        let Some(info) = self.sources.last() else {
            return Err(Error::usage("points of no source"));
        };
        let (Some(lattice), Some(head)) = (info.lattice, &info.head) else {
            return Err(Error::unsupported("points in tiles are LAS or LAZ")
                .cure("write the points to .laz first"));
        };
        let (length, point_format) = (stride(info), head.point_format);
        for record in batch.records.chunks_exact(length) {
            // The position in the record, which is rounded: readers of the tile see that one.
            let step = |at: usize| {
                let bytes = record.get(at..).and_then(|rest| rest.first_chunk());
                bytes.map_or(0, |bytes| i32::from_le_bytes(*bytes))
            };
            let [x, y, _] = lattice.point([0, 4, 8].map(step));
            let (columns, own_column) = self.numbers(x)?;
            let (rows, own_row) = self.numbers(y)?;
            for column in columns {
                for row in rows.clone() {
                    let is_own = (column, row) == (own_column, own_row);
                    self.add([column, row], is_own, record, point_format)?;
                }
            }
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<PointSummary> {
        self.keep_all()?;
        self.require_room()?;
        let mut summary = PointSummary::default();
        for (corner, tile) in std::mem::take(&mut self.by_corner) {
            // Points of a buffer alone make no file.
            if tile.own > 0 {
                let path = self.path(corner);
                let bounds = self
                    .write_tile(&path, &tile)
                    .map_err(|e| e.in_file(&path))?;
                summary.bounds.merge(&bounds);
                summary.count += tile.own;
                *self.written += 1;
            }
        }
        Ok(summary)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_may_have_a_unit() {
        let length = |text: &str| text.parse::<PlanLength>();
        assert_eq!(length("1km"), Ok(PlanLength::Metres(1000.0)));
        assert_eq!(length("0.5 m"), Ok(PlanLength::Metres(0.5)));
        assert_eq!(length("500"), Ok(PlanLength::Units(500.0)));
        for wrong in ["", "m", "-1m", "0", "1ft", "nan", "infm"] {
            assert!(length(wrong).is_err(), "{wrong}");
        }
    }
}
