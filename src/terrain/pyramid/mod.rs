//! Levels of a surface, each of tiles that fit together, for viewers of the earth.
//!
//! Each level is simplified from all heights of the surface, not from the next finer level: what is
//! promised of it holds for the heights that were measured.
//!
//! Around the surface, and in its holes, a level has the heights of the next coarser one, and the
//! coarsest level has one height: so tiles of different levels fit together there, too.
//!
//! The borders of tiles come first, each by itself: their vertices are a function of the heights
//! along the border, so that both tiles at a border have the same ones. Then the vertices of each
//! tile are chosen as in [`simplify`](super::simplify()), rounded to steps, and triangulated again.
//! The triangles that viewers will see are measured against all heights, and what is too far off is
//! inserted.

mod heights;
mod lines;
mod normals;
mod plan;
mod report;
mod rule;
#[cfg(test)]
mod tests;
mod tile;

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use self::heights::Heights;
use self::lines::TileLines;
use self::plan::{tiles_of, to_earth};
pub use self::report::TileReport;
pub(crate) use self::rule::is_height;
pub use self::rule::{Level, PyramidRule};
use self::tile::Outside;
use crate::data::{AT_ONCE, Bounds, Surface, TerrainTile, Tiling, area_of, corners};
use crate::error::{Error, Result};

/// A surface that is to be written in levels of tiles.
pub struct Pyramid {
    heights: Heights,
    levels: Vec<Level>,
}

impl Pyramid {
    /// Plans the levels of a surface. `convert` turns positions of the surface, some at a time,
    /// into those of the tiling, with heights in meters.
    ///
    /// # Errors
    /// If the rule makes no sense, a position cannot be converted or is beyond all tiles, there are
    /// no triangles, there would be too many tiles, or the run is canceled.
    ///
    /// # Complexity
    /// O(n log n) for n vertices, and linear in the tiles. 60 bytes for each vertex.
    pub fn new(
        surface: &dyn Surface,
        convert: &(dyn Fn(&mut [[f64; 3]]) -> Result<()> + Sync),
        rule: &PyramidRule,
        cancel: &AtomicBool,
    ) -> Result<Self> {
        rule.check()?;
        let used = surface.census().used;
        let mut positions: Vec<[f64; 3]> = (0..used.len() as u32)
            .into_par_iter()
            .with_min_len(AT_ONCE)
            .map(|vertex| match used[vertex as usize] {
                true => surface.position(vertex),
                false => [f64::NAN; 3],
            })
            .collect();
        positions
            .par_chunks_mut(AT_ONCE)
            .zip(used.par_chunks(AT_ONCE))
            .try_for_each(|(positions, used)| to_earth(positions, used, rule.tiling, convert))?;
        surface.ensure_intact()?;
        let faces = || corners(surface).map(|(_, face)| face.map(|v| positions[v as usize]));

        // In tiles of the coarsest level.
        let in_tiles = |[x, y, z]: [f64; 3]| {
            let [x, y] = [(x, 0), (y, 1)].map(|(c, axis)| rule.tiling.in_sides(axis, 0, c));
            [x, y, z]
        };
        let area: f64 = faces()
            .map(|face| area_of(face.map(in_tiles)).abs())
            .filter(|area| area.is_finite())
            .sum();
        let count = used.iter().filter(|&&used| used).count();
        if count == 0 || area <= 0.0 {
            return Err(Error::format("the surface has no triangles"));
        }
        let in_tile = |level: u8| {
            let side = 1.0 / f64::from(1_u32 << level);
            count as f64 / area.max(f64::MIN_POSITIVE) * side * side
        };
        let finest = rule.finest(in_tile);
        let tiles = tiles_of(faces(), rule.tiling, finest)?;

        let points: Vec<[f64; 3]> = positions
            .iter()
            .zip(&used)
            .filter_map(|(p, used)| used.then_some(*p))
            .collect();
        let levels: Vec<Level> = tiles
            .into_iter()
            .zip(0..)
            .map(|(tiles, level)| Level::new(rule, level, finest, tiles))
            .collect();
        let finest_lines = levels.iter().map(Level::of_lines).max().unwrap_or(finest);
        let mut lines = TileLines::new(rule.tiling, finest_lines);
        for (number, face) in faces().enumerate() {
            if number % AT_ONCE == 0 && cancel.load(Ordering::Relaxed) {
                return Err(Error::canceled());
            }
            lines.add(face);
        }
        lines.finish();
        drop(positions);
        Ok(Pyramid {
            heights: Heights::new(points, lines, rule.tiling, finest, rule.fill),
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
        let bounds = Bounds::around(self.heights.points());
        [bounds.min, bounds.max].map(|[x, y, _]| [x, y])
    }

    /// Returns the lowest height and the highest, in meters, of the surface and around it.
    pub fn heights(&self) -> [f64; 2] {
        let bounds = Bounds::around(self.heights.points());
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
    /// Those of `take` and `end`, and if the run is canceled.
    ///
    /// # Complexity
    /// O(n log n) for n heights at each level in practice; about 200 bytes for each height of a
    /// tile.
    pub fn make(
        &mut self,
        take: &(dyn Fn(&Level, TerrainTile, &TileReport) -> Result<()> + Sync),
        end: &mut dyn FnMut(&Level, &TileReport) -> Result<()>,
        cancel: &AtomicBool,
    ) -> Result<()> {
        self.heights.outside.clear();
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
