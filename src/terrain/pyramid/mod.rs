//! Levels of a surface, each of tiles that fit together, for viewers of the earth.
//!
//! What is promised of a level holds for the heights that were measured: each tile is measured
//! against all of them. The vertices of a tile with many heights are chosen from few of them first,
//! by which finer tiles are simplified. All others are read from a file, as often as something is
//! too far off. Neither the surface nor its heights need fit into memory.
//!
//! Around the surface, and in its holes, a level has the heights of the next coarser one, and the
//! coarsest level has one height: so tiles of different levels fit together there, too.
//!
//! The borders of tiles come first, each by itself: their vertices are a function of the heights
//! along the border, so that both tiles at a border have the same ones. Then the vertices of each
//! tile are chosen as in [`simplify`](super::simplify()), rounded to steps, and triangulated again.
//! The triangles that viewers will see are measured against all heights and along the lines of the
//! surface, and what is too far off is inserted.

mod blocks;
mod few;
mod heights;
mod intake;
mod keys;
mod lines;
mod measure;
mod normals;
mod plan;
mod report;
mod rule;
#[cfg(test)]
mod tests;
mod tile;

use std::path::Path;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use self::heights::Heights;
pub use self::intake::SurfaceParts;
use self::intake::{Intake, Triangles};
pub use self::plan::ToEarth;
pub use self::report::TileReport;
pub(crate) use self::rule::is_height;
pub use self::rule::{Level, PyramidRule};
use self::tile::Outside;
use crate::data::{TerrainTile, Tiling};
use crate::error::Result;

/// A surface that is to be written in levels of tiles.
pub struct Pyramid {
    heights: Heights,
    levels: Vec<Level>,
}

impl Pyramid {
    /// Plans the levels of a surface. `parts` passes on its parts, and is called twice. `convert`
    /// turns their positions, some at a time, into those of the tiling, with heights in meters.
    /// Files without a name are created in `folder`, and vanish with the result.
    ///
    /// The result does not depend on how the surface is divided into parts.
    ///
    /// # Errors
    /// If the rule makes no sense, a position cannot be converted or is beyond all tiles, there are
    /// no triangles, there would be too many tiles, files cannot be written, or the run is
    /// canceled.
    ///
    /// # Complexity
    /// O(n log n) for n vertices, and linear in the tiles. About 100 bytes in files for each
    /// vertex; in memory a few bits of each, and 100 bytes for each tile.
    pub fn new(
        parts: &SurfaceParts,
        convert: &ToEarth,
        rule: &PyramidRule,
        folder: &Path,
        cancel: &AtomicBool,
    ) -> Result<Self> {
        rule.check()?;
        let tiling = rule.tiling;
        let intake = Intake {
            parts,
            convert,
            tiling,
            folder,
            cancel,
        };
        let vertices = intake.vertices()?;
        // The number of heights, if the surface has as many everywhere.
        let in_tile = |level: u8| {
            let side = 1.0 / f64::from(1_u32 << level);
            let count = vertices.file.count() as f64;
            count / vertices.area.max(f64::MIN_POSITIVE) * side * side
        };
        let finest = rule.finest(in_tile);
        let mut levels: Vec<Level> = (0..=finest)
            .map(|level| Level::new(rule, level, finest))
            .collect();
        let of_lines = levels.iter().map(Level::of_lines).max().unwrap_or(finest);
        let Triangles {
            tiles,
            lines,
            edges,
        } = intake.triangles(vertices.area, finest, of_lines)?;
        for (level, tiles) in levels.iter_mut().zip(tiles.of_levels()) {
            level.tiles = tiles;
        }
        Ok(Pyramid {
            heights: Heights::new(vertices.file, lines, edges, tiling, finest, rule.fill)?,
            levels,
        })
    }

    /// The levels, the coarsest first.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The division into tiles.
    pub fn tiling(&self) -> Tiling {
        self.heights.tiling
    }

    /// Returns the smallest longitude and latitude of the surface, and the largest.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let bounds = self.heights.bounds;
        [bounds.min, bounds.max].map(|[x, y, _]| [x, y])
    }

    /// Returns the lowest height and the highest, in meters, of the surface and around it.
    pub fn heights(&self) -> [f64; 2] {
        let bounds = self.heights.bounds;
        [
            bounds.min[2].min(self.heights.fill),
            bounds.max[2].max(self.heights.fill),
        ]
    }

    /// Makes the tiles of all levels, the coarsest level first, and measures them against all
    /// heights in them. `take` receives the tiles of a level from many threads, in any order, each
    /// with its level. `end` is called after each level with the sums of its tiles.
    ///
    /// # Errors
    /// Those of `take` and `end`, and if heights cannot be read or the run is canceled.
    ///
    /// # Complexity
    /// O(n log n) for n heights in practice at levels with up to 32768 heights in a tile, and a few
    /// passes over what is near to an edge at coarser ones. In memory are 200 bytes for each of so
    /// many heights on each thread, and 24 for each that coarser tiles are chosen from, which is
    /// one of some dozens.
    pub fn make(
        &mut self,
        take: &(dyn Fn(&Level, TerrainTile, &TileReport) -> Result<()> + Sync),
        end: &mut dyn FnMut(&Level, &TileReport) -> Result<()>,
        cancel: &AtomicBool,
    ) -> Result<()> {
        self.heights.outside.clear();
        self.heights.gather(&self.levels, cancel)?;
        for number in 0..self.levels.len() {
            self.levels[number].step = self.heights.step(&self.levels[number])?;
            let level = &self.levels[number];
            let finer = self.levels.get(number + 1);
            let tiles = level.tiles.par_iter().with_max_len(1).map(|&at| {
                let (tile, report, outside) = tile::tile(&self.heights, level, finer, at, cancel)?;
                take(level, tile, &report)?;
                Ok((report, outside))
            });
            let tiles: Vec<(TileReport, Outside)> = tiles.collect::<Result<_>>()?;
            let mut sums = TileReport::default();
            tiles.iter().for_each(|(report, _)| sums.merge(report));
            end(level, &sums)?;
            self.heights.outside = tiles.into_iter().flat_map(|(_, outside)| outside).collect();
        }
        Ok(())
    }
}
