//! The heights of a surface by the tiles that own them, along the lines between tiles, and around
//! the surface.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::blocks::{Block, blocks_of};
use super::keys::keys_of;
use super::lines::{Crossing, TileLines};
use super::rule::Level;
use crate::data::{Bounds, TerrainTile, TilePosition, Tiling};
use crate::error::{Error, Result};
use crate::terrain::records::{Record, RecordFile, SortedRecords};

/// The finest step of heights, in meters.
const LEAST_STEP: f64 = 1.0 / 65_536.0;

/// Up to so many steps, heights are 32-bit floats without rounding.
const LARGEST_COUNT: f64 = 8_000_000.0;

/// The largest number of heights from which the vertices of a tile are chosen at once.
///
/// PERF: 200 bytes each, on each thread.
const AT_ONCE: usize = 1 << 15;

/// The heights of a surface in the coordinates of a tiling. Those of single vertices are in a file.
pub(super) struct Heights {
    pub(super) tiling: Tiling,
    /// In the order of their keys.
    vertices: RecordFile<3>,
    /// Blocks of these, each in one tile of the finest level.
    blocks: Vec<Block>,
    /// See [`Triangles::edges`].
    edges: SortedRecords<6>,
    pub(super) bounds: Bounds,
    pub(super) lines: TileLines,
    /// The height around the surface at the coarsest level.
    pub(super) fill: f64,
    /// Heights of the next coarser level where the surface has none, in corners of the grids of the
    /// tiles of the level that comes next.
    pub(super) outside: FxHashMap<[u32; 2], f64>,
    /// The largest number of heights from which the vertices of a tile are chosen at once.
    pub(super) at_once: usize,
    /// See [`gather`](Self::gather).
    pub(super) few: FxHashMap<TilePosition, Vec<[f64; 3]>>,
}

impl Heights {
    /// `fill` is the lowest height if it is `None`.
    ///
    /// # Errors
    /// If the vertices cannot be read.
    pub(super) fn new(
        vertices: RecordFile<3>,
        lines: TileLines,
        edges: SortedRecords<6>,
        tiling: Tiling,
        finest: u8,
        fill: Option<f64>,
    ) -> Result<Self> {
        let blocks = blocks_of(&vertices, finest)?;
        let mut bounds = Bounds::default();
        blocks.iter().for_each(|block| bounds.merge(&block.bounds));
        Ok(Heights {
            tiling,
            vertices,
            blocks,
            edges,
            bounds,
            lines,
            fill: fill.unwrap_or(bounds.min[2]),
            outside: FxHashMap::default(),
            at_once: AT_ONCE,
            few: FxHashMap::default(),
        })
    }

    /// The blocks with heights of a tile; if it is of a level up to the finest one, these have no
    /// others.
    pub(super) fn blocks_of(&self, at: TilePosition) -> &[Block] {
        let [first, last] = keys_of(at);
        let start = self.blocks.partition_point(|block| block.keys[1] < first);
        let end = self.blocks.partition_point(|block| block.keys[0] <= last);
        &self.blocks[start..end.max(start)]
    }

    /// The number of heights of a tile; of one below the finest level, at most so many.
    pub(super) fn count_of(&self, at: TilePosition) -> usize {
        self.blocks_of(at).iter().map(|block| block.count).sum()
    }

    /// Returns the heights that a tile owns: those on its west and south side are its own, too.
    ///
    /// # Errors
    /// If they cannot be read.
    pub(super) fn heights_of(&self, at: TilePosition) -> Result<Vec<[f64; 3]>> {
        let blocks = self.blocks_of(at);
        let mut records = Vec::new();
        if let [first, ..] = blocks {
            let count = self.count_of(at) as u64;
            self.vertices
                .read(first.start..first.start + count, &mut records)?;
        }
        let [first, last] = keys_of(at);
        let own = records
            .iter()
            .filter(|(key, _)| (first..=last).contains(key));
        Ok(own.map(|(_, p)| *p).collect())
    }

    /// Replaces the records of a list by the heights of a block.
    ///
    /// # Errors
    /// If they cannot be read.
    pub(super) fn read(&self, block: &Block, records: &mut Vec<Record<3>>) -> Result<()> {
        let end = block.start + block.count as u64;
        self.vertices.read(block.start..end, records)
    }

    /// Returns the edges on lines of the surface that are in a tile of a level up to the finest
    /// one.
    ///
    /// # Errors
    /// If they cannot be read.
    pub(super) fn edges_of(&self, at: TilePosition) -> Result<Vec<Record<6>>> {
        let [first, last] = keys_of(at);
        let (first, last) = ((first, f64::NEG_INFINITY), (last, f64::INFINITY));
        self.edges.between(first, last)
    }

    /// The step of a level: the smallest power of two by which the heights of each tile can be
    /// counted, and which 32-bit numbers keep.
    pub(super) fn step(&self, level: &Level) -> Result<f64> {
        let range = |at: &TilePosition| -> Result<[f64; 2]> {
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            let mut add = |z: f64| range = [range[0].min(z), range[1].max(z)];
            for Block { bounds, .. } in self.blocks_of(*at) {
                [bounds.min[2], bounds.max[2]]
                    .into_iter()
                    .for_each(&mut add);
            }
            for far in 0..2 {
                for axis in 0..2 {
                    let (along, _) = self.along(*at, axis, far)?;
                    along.iter().for_each(|h| add(h[1]));
                }
            }
            for i in 0..=level.grid {
                (0..=level.grid).for_each(|j| add(self.height(level, *at, [i, j])));
            }
            Ok(range)
        };
        let wide = |range: Result<[f64; 2]>| {
            let [low, high] = range?;
            let counted = (high - low) / f64::from(TerrainTile::STEPS - 1);
            Ok::<f64, Error>(counted.max(low.abs().max(high.abs()) / LARGEST_COUNT))
        };
        let ranges = level.tiles.par_iter().map(range).map(wide);
        let least: f64 = ranges.try_reduce(|| LEAST_STEP, |a, b| Ok(a.max(b)))?;
        let mut step = LEAST_STEP;
        while step < least {
            step *= 2.0;
        }
        match step < 1.0e6 {
            true => Ok(step),
            false => Err(Error::limit("the heights are too large for tiles")),
        }
    }

    /// The heights along a side of a tile, with the ends of the side: that where an axis has its
    /// smallest coordinate, or the far one.
    ///
    /// # Errors
    /// If they cannot be read.
    pub(super) fn along(
        &self,
        at: TilePosition,
        axis: usize,
        far: u32,
    ) -> Result<(Vec<Crossing>, [f64; 2])> {
        let [min, max] = self.tiling.bounds(at);
        let ends = [min[1 - axis], max[1 - axis]];
        let number = [at.column, at.row][axis] + far;
        Ok((self.lines.along(axis, at.level, number, ends)?, ends))
    }

    /// The height in a corner of the grid of a tile.
    pub(super) fn height(&self, level: &Level, at: TilePosition, corner: [u32; 2]) -> f64 {
        let (numbers, known) = self.corner(level, at, corner);
        let outside = || self.outside.get(&numbers).copied();
        known.map(|[z, ..]| z).or_else(outside).unwrap_or(self.fill)
    }

    /// How the surface rises in a corner of the grid of a tile.
    pub(super) fn rise(&self, level: &Level, at: TilePosition, corner: [u32; 2]) -> [f64; 2] {
        let (_, known) = self.corner(level, at, corner);
        known.map_or([0.0; 2], |[_, x, y]| [x, y])
    }

    /// The numbers of the lines that cross in a corner of the grid of a tile, and the surface
    /// there.
    pub(super) fn corner(
        &self,
        level: &Level,
        at: TilePosition,
        [i, j]: [u32; 2],
    ) -> ([u32; 2], Option<[f64; 3]>) {
        let numbers = [at.column * level.grid + i, at.row * level.grid + j];
        (numbers, self.lines.crossing(level.of_lines(), numbers))
    }
}
