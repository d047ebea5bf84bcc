//! The ground among points that do not fit into memory: in tiles, on the grid of the whole.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use super::spacing::is_finite;
use super::{GroundGrid, GroundGridFinder, GroundOptions, PointClass, classify};
use crate::error::{Error, Result, Setting, wording};
use crate::terrain::records::{Record, SortedRecords, Sorter};

/// So many squares are the least reach of points.
const REACH: u32 = 4;

/// So many cells of the grid take as much memory as a point.
const CELLS: f64 = 6.0;

/// Tiles answer for points this many times nearer than the reach, too, to be compared.
const STRIP: f64 = 8.0;

/// Takes a batch of points.
pub type Take<'a> = dyn FnMut(&[[f64; 3]]) -> Result<()> + 'a;

/// What tiles may use.
#[derive(Debug, Clone, Copy)]
pub struct GroundTiles<'a> {
    /// The most points of a tile, with those around it. [`classify`] needs some 200 bytes for each.
    pub at_once: usize,
    /// For files without a name, of 40 bytes a point, twice. They vanish with the call.
    pub folder: &'a Path,
}

/// The classes of points that were filtered in tiles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TiledClasses {
    /// The class of each point, in the order of the points.
    pub classes: Vec<PointClass>,
    /// The number of tiles.
    pub tiles: usize,
    /// Where the ground depends on points that are further away than memory has room for.
    pub doubts: Vec<Doubt>,
}

/// A tile that two surroundings of it do not agree on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Doubt {
    /// The tile, in plan: its least and its greatest coordinates.
    pub tile: [[f64; 2]; 2],
    /// Points of it that have another class by the smaller surrounding.
    pub points: usize,
}

/// Returns the class of each point like [`classify`], for points that do not fit into memory.
///
/// `points` is called twice, and passes on all points, in meters, in batches and in the same order.
/// `decided` gets the number of points of each tile.
///
/// Tiles are squares, or several of them. Each is filtered with the points around it, as far as
/// [`GroundGrid::reach`] says, on the grid of the whole. A minimum cut is not local, so neighbors
/// are compared in a strip along their border; where they differ, both are filtered again with
/// twice the surrounding, until two in a row agree. What memory has no room for is a [`Doubt`].
/// The classes depend on the set of points and on `at_once`.
///
/// # Errors
/// If more points than `at_once` are within the reach of one square, `folder` has no room, a call
/// of `points` or `decided` fails, or the work is canceled.
///
/// # Complexity
/// That of [`classify`], for some more points, and O(n log n) to sort them. Memory: that of the
/// largest tile, one byte a point, and 24 for each point within an eighth of the reach of a border.
pub fn classify_in_tiles(
    points: &dyn Fn(&mut Take) -> Result<()>,
    options: &GroundOptions,
    limits: &GroundTiles,
    cancel: &AtomicBool,
    decided: &mut dyn FnMut(usize) -> Result<()>,
) -> Result<TiledClasses> {
    let mut finder = GroundGridFinder::default();
    points(&mut |batch| {
        finder.add(batch);
        Ok(())
    })?;
    let grid = options.grid.or_else(|| finder.grid());
    drop(finder);
    let mut found = TiledClasses::default();
    let Some(grid) = grid else {
        points(&mut |batch| {
            found
                .classes
                .resize(found.classes.len() + batch.len(), PointClass::Object);
            Ok(())
        })?;
        return Ok(found);
    };
    let options = GroundOptions {
        grid: Some(grid),
        ..*options
    };
    let squares = Squares::of(points, &grid, limits.folder, &mut found.classes)?;
    let tiles = squares.divided(limits.at_once)?;
    found.tiles = tiles.len();

    // Of each tile, what it says of points of its neighbors.
    let mut votes = Vec::with_capacity(tiles.len());
    for tile in &tiles {
        let filtered = squares.filter(tile, REACH, &options, cancel)?;
        for &(index, class) in &filtered.own {
            found.classes[index] = class;
        }
        votes.push(filtered.strip);
        decided(filtered.own.len())?;
    }
    let mut disputed = BTreeSet::new();
    for (voter, votes) in votes.iter().enumerate() {
        let is_other = |vote: &&Vote| found.classes[vote.index] != vote.class;
        for vote in votes.iter().filter(is_other) {
            let is_in = |tile: &Tile| tile.contains(vote.square);
            disputed.extend(tiles.iter().position(is_in));
            disputed.insert(voter);
        }
    }
    drop(votes);
    for tile in disputed.into_iter().map(|number| &tiles[number]) {
        let doubt = squares.agree(tile, &options, limits, cancel, &mut found.classes)?;
        found.doubts.extend(doubt);
    }
    Ok(found)
}

/// Columns and rows of squares.
#[derive(Debug, Clone, PartialEq)]
struct Tile {
    columns: Range<u32>,
    rows: Range<u32>,
}

impl Tile {
    fn contains(&self, [column, row]: [u32; 2]) -> bool {
        self.columns.contains(&column) && self.rows.contains(&row)
    }

    /// Returns the tile with so many squares around it.
    fn grown(&self, by: u32) -> Tile {
        let grown = |of: &Range<u32>| of.start.saturating_sub(by)..of.end.saturating_add(by);
        Tile {
            columns: grown(&self.columns),
            rows: grown(&self.rows),
        }
    }

    /// Returns the halves of the longer side; `None` for a square.
    fn halves(&self) -> Option<[Tile; 2]> {
        let halves = |of: &Range<u32>| {
            let middle = of.start + (of.end - of.start) / 2;
            [of.start..middle, middle..of.end]
        };
        let [across, down] = [self.columns.len(), self.rows.len()];
        match across.max(down) {
            ..2 => None,
            _ if across >= down => Some(halves(&self.columns).map(|columns| Tile {
                columns,
                rows: self.rows.clone(),
            })),
            _ => Some(halves(&self.rows).map(|rows| Tile {
                columns: self.columns.clone(),
                rows,
            })),
        }
    }
}

/// What a tile says of a point of its neighbor.
struct Vote {
    index: usize,
    square: [u32; 2],
    class: PointClass,
}

/// The points of a tile and near it, by their numbers.
struct Filtered {
    own: Vec<(usize, PointClass)>,
    strip: Vec<Vote>,
}

/// Points, in the order of the squares that they are in.
struct Squares {
    origin: [f64; 2],
    side: f64,
    /// The number of cells of the grid in a square.
    cells: f64,
    /// The number of points of each square that has some, by row and column.
    counts: BTreeMap<(u32, u32), usize>,
    records: SortedRecords<4>,
}

impl Squares {
    /// Sorts points; there is a class for each afterwards.
    fn of(
        points: &dyn Fn(&mut Take) -> Result<()>,
        grid: &GroundGrid,
        folder: &Path,
        classes: &mut Vec<PointClass>,
    ) -> Result<Self> {
        let [x, y, _] = grid.origin;
        let side = grid.reach() / f64::from(REACH);
        let mut counts = BTreeMap::new();
        let mut sorter = Sorter::new(folder);
        let mut batch_of_records: Vec<Record<4>> = Vec::new();
        points(&mut |batch| {
            let first = classes.len();
            classes.resize(first + batch.len(), PointClass::Object);
            let finite = batch
                .iter()
                .zip(first..)
                .filter(|(point, _)| is_finite(point));
            for (&[px, py, pz], index) in finite {
                let number = |value: f64, origin: f64| ((value - origin) / side) as u32;
                let (column, row) = (number(px, x), number(py, y));
                *counts.entry((row, column)).or_insert(0) += 1;
                let key = u64::from(row) << 32 | u64::from(column);
                batch_of_records.push((key, [px, py, pz, index as f64]));
            }
            sorter.extend(batch_of_records.drain(..))
        })?;
        Ok(Squares {
            origin: [x, y],
            side,
            cells: (side / grid.spacing.max(1.0)).powi(2),
            counts,
            records: SortedRecords::of(sorter)?,
        })
    }

    /// Returns tiles that have so many points at most, with those around them.
    fn divided(&self, at_once: usize) -> Result<Vec<Tile>> {
        let columns = self.counts.keys().map(|&(_, column)| column);
        let rows = self.counts.keys().map(|&(row, _)| row);
        let mut open = vec![Tile {
            columns: 0..columns.max().map_or(0, |last| last.saturating_add(1)),
            rows: 0..rows.max().map_or(0, |last| last.saturating_add(1)),
        }];
        let mut tiles = Vec::new();
        while let Some(tile) = open.pop() {
            if self.count(&tile) == 0 {
                continue;
            }
            let around = self.load(&tile.grown(REACH));
            match tile.halves() {
                _ if around <= at_once => tiles.push(tile),
                Some([first, second]) => open.extend([second, first]),
                None => return Err(self.too_dense(around, at_once)),
            }
        }
        Ok(tiles)
    }

    #[cold]
    fn too_dense(&self, around: usize, at_once: usize) -> Error {
        Error::limit(format!(
            "{around} points are within {} m of a square of {} m, and memory has room for {at_once}",
            self.side * f64::from(REACH),
            self.side
        ))
        .cure(wording!["give more memory, with ", Setting::Memory])
    }

    /// Returns how many points take the memory of a tile: of its points, or of its cells, if they
    /// are many.
    fn load(&self, tile: &Tile) -> usize {
        let mut bounds: Option<[Range<u32>; 2]> = None;
        let mut points = 0;
        for (&(row, column), count) in self.within(tile) {
            points += count;
            let [columns, rows] = bounds.get_or_insert([column..column + 1, row..row + 1]);
            columns.start = columns.start.min(column);
            columns.end = columns.end.max(column + 1);
            rows.end = row + 1;
        }
        let squares = bounds.map_or(0.0, |[columns, rows]| {
            f64::from(columns.end - columns.start) * f64::from(rows.end - rows.start)
        });
        points.max((squares * self.cells / CELLS) as usize)
    }

    fn count(&self, tile: &Tile) -> usize {
        self.within(tile).map(|(_, count)| count).sum()
    }

    /// Returns the squares of a tile that have points, by row and column, with their counts.
    fn within<'a>(&'a self, tile: &'a Tile) -> impl Iterator<Item = (&'a (u32, u32), &'a usize)> {
        let rows = (tile.rows.start, 0)..(tile.rows.end, 0);
        let squares = self.counts.range(rows);
        squares.filter(|((_, column), _)| tile.columns.contains(column))
    }

    /// Filters a tile with so many squares around it.
    fn filter(
        &self,
        tile: &Tile,
        around: u32,
        options: &GroundOptions,
        cancel: &AtomicBool,
    ) -> Result<Filtered> {
        let grown = tile.grown(around);
        let mut rows: Vec<u32> = self.within(&grown).map(|(&(row, _), _)| row).collect();
        rows.dedup();
        let mut points = Vec::new();
        let mut numbers = Vec::new();
        for row in rows {
            let key = |column: u32| u64::from(row) << 32 | u64::from(column);
            let first = (key(grown.columns.start), f64::NEG_INFINITY);
            let end = (key(grown.columns.end - 1), f64::INFINITY);
            for (key, [x, y, z, index]) in self.records.between(first, end)? {
                points.push([x, y, z]);
                numbers.push((index as usize, [key as u32, row]));
            }
        }
        let classes = classify(&points, options, cancel)?;
        let mut filtered = Filtered {
            own: Vec::new(),
            strip: Vec::new(),
        };
        let strip = self.side * f64::from(REACH) / STRIP;
        let [low, high] = self.extent(tile);
        let is_near = |point: &[f64; 3]| {
            (0..2).all(|k| point[k] >= low[k] - strip && point[k] < high[k] + strip)
        };
        for ((point, (index, square)), class) in points.iter().zip(numbers).zip(classes) {
            if tile.contains(square) {
                filtered.own.push((index, class));
            } else if is_near(point) {
                filtered.strip.push(Vote {
                    index,
                    square,
                    class,
                });
            }
        }
        Ok(filtered)
    }

    /// Returns the least and the greatest coordinates of a tile.
    fn extent(&self, tile: &Tile) -> [[f64; 2]; 2] {
        let at = |column: u32, row: u32| {
            let [x, y] = self.origin;
            [
                x + f64::from(column) * self.side,
                y + f64::from(row) * self.side,
            ]
        };
        [
            at(tile.columns.start, tile.rows.start),
            at(tile.columns.end, tile.rows.end),
        ]
    }

    /// Filters a tile again with ever more around it, until its classes stay.
    fn agree(
        &self,
        tile: &Tile,
        options: &GroundOptions,
        limits: &GroundTiles,
        cancel: &AtomicBool,
        classes: &mut [PointClass],
    ) -> Result<Option<Doubt>> {
        let mut around = REACH;
        let mut changed = None;
        while self.count(&tile.grown(around)) < self.counts.values().sum() {
            around *= 2;
            if self.load(&tile.grown(around)) > limits.at_once {
                // Before anything was filtered again, only a neighbor differs.
                return Ok(Some(Doubt {
                    tile: self.extent(tile),
                    points: changed.unwrap_or(0),
                }));
            }
            let own = self.filter(tile, around, options, cancel)?.own;
            let differ = own
                .iter()
                .filter(|&&(index, class)| classes[index] != class);
            let count = differ.count();
            for (index, class) in own {
                classes[index] = class;
            }
            if count == 0 {
                break;
            }
            changed = Some(count);
        }
        Ok(None)
    }
}
