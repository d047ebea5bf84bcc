//! Levels of a surface, each of tiles that fit together, for viewers of the earth.
//!
//! Each level is simplified from all heights of the surface, not from the next finer level: what is
//! promised of it holds for the heights that were measured.
//!
//! The borders of tiles come first, each by itself: their vertices are a function of the heights
//! along the border, so that both tiles at a border have the same ones. Then the vertices of each
//! tile are chosen as in [`simplify`](super::simplify()), rounded to steps, and triangulated again.
//! The triangles that viewers will see are measured against all heights, and what is too far off is
//! inserted.

mod lines;
#[cfg(test)]
mod tests;
mod tile;

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use rustc_hash::FxHashSet;

use self::lines::TileLines;
pub use self::tile::TileReport;
use crate::data::{AT_ONCE, Surface, TerrainTile, TilePosition, Tiling, corners};
use crate::error::{Error, Result, Setting, wording};
use crate::triangulation::kernel::RANGE;

/// The largest number of tiles of all levels together.
const MAX_TILES: usize = 1 << 22;

/// How many heights the tiles of the finest level have along a side, if nothing else is asked for.
const HEIGHTS_ALONG: f64 = 64.0;

/// The largest radius of the earth, in meters.
const RADIUS: f64 = 6_378_137.0;

/// The share of the bound that the curve of the earth may take: a triangle is flat.
const CURVE_SHARE: f64 = 1.0 / 8.0;

/// The finest step of heights, in meters.
const LEAST_STEP: f64 = 1.0 / 65_536.0;

/// Up to so many steps, heights are 32-bit floats without rounding.
const LARGEST_COUNT: f64 = 8_000_000.0;

/// The largest number of squares along a side in which a tile follows the curve of the earth.
const MAX_GRID: u32 = 256;

/// The levels of a surface that are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct PyramidRule {
    /// The division into tiles.
    pub tiling: Tiling,
    /// The finest level. `None` follows from the bound, or from how dense the heights are: the
    /// coarsest level with no more than 64 heights along the side of a tile.
    pub finest: Option<u8>,
    /// The bound of the finest level in meters; it doubles with each coarser level. `None` is
    /// [`Tiling::geometric_error`].
    pub max_error: Option<f64>,
    /// The height in meters around the surface. `None` is the lowest height of the surface.
    pub fill: Option<f64>,
}

/// A level of a pyramid.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Level {
    /// 0 for the level with the largest tiles.
    pub level: u8,
    /// No height of the surface is further from the triangles than this, in meters.
    pub bound: f64,
    /// What of the bound is left for heights: the rest is what the earth is curved within a
    /// triangle.
    pub allowance: f64,
    /// The size of a step of height, in meters; a power of two.
    pub step: f64,
    /// How many squares a tile has at least along each side, to follow the curve of the earth; a
    /// power of two.
    pub grid: u32,
    /// The tiles, in the order of columns, then rows.
    pub tiles: Vec<TilePosition>,
}

/// A surface that is to be written in levels of tiles.
pub struct Pyramid {
    rule: PyramidRule,
    /// In the order of their keys.
    points: Vec<[f64; 3]>,
    /// For each point, the position of the finest tile that owns it, on a curve through all of
    /// them that passes each tile of each level once.
    keys: Vec<u64>,
    lines: TileLines,
    fill: f64,
    finest: u8,
    levels: Vec<Level>,
}

impl PyramidRule {
    /// Returns an error if the rule makes no sense, whatever the surface is.
    ///
    /// # Errors
    /// Names the setting.
    pub fn check(&self) -> Result<()> {
        if let Some(level) = self.finest.filter(|&level| level > Tiling::MAX_LEVEL) {
            return Err(
                Error::usage(format!("there is no level {level}")).cure(wording![
                    "pass ",
                    Setting::MaxLevel.number("LEVEL"),
                    " with a level of 0 to 28"
                ]),
            );
        }
        if let Some(bound) = self.max_error
            && !(bound > 0.0 && RANGE.admits(bound))
        {
            return Err(Error::usage(format!(
                "{bound} is not a bound of errors: a height above 0 is needed"
            ))
            .cure(wording!["pass ", Setting::MaxError.number("HEIGHT")]));
        }
        match self.fill {
            Some(fill) if !fill.is_finite() => Err(Error::usage(format!(
                "{fill} is not a height around the surface"
            ))),
            _ => Ok(()),
        }
    }

    /// Returns the finest level: as asked for, or what the bound or the heights need.
    fn finest(&self, in_tiles: impl Fn(u8) -> f64) -> u8 {
        let all = 0..=Tiling::MAX_LEVEL;
        let found = match (self.finest, self.max_error) {
            (Some(level), _) => Some(level),
            (None, Some(bound)) => {
                (all.clone()).find(|&level| self.tiling.geometric_error(level) <= bound)
            }
            (None, None) => {
                (all.clone()).find(|&level| in_tiles(level) <= HEIGHTS_ALONG * HEIGHTS_ALONG)
            }
        };
        found.unwrap_or(Tiling::MAX_LEVEL)
    }

    /// Returns the bound of a level.
    fn bound(&self, level: u8, finest: u8) -> f64 {
        let of_finest = self
            .max_error
            .unwrap_or_else(|| self.tiling.geometric_error(finest));
        of_finest * f64::from(1_u32 << (finest - level))
    }

    /// Returns how many squares a tile needs along a side to follow the earth, and by how much the
    /// earth is still above their triangles.
    fn grid(&self, level: u8, bound: f64) -> (u32, f64) {
        let above = |cells: u32| {
            let diagonal = std::f64::consts::SQRT_2 * self.tiling.angle(level) / f64::from(cells);
            RADIUS * diagonal * diagonal / 8.0
        };
        let mut cells = 1;
        while above(cells) > bound * CURVE_SHARE && cells < MAX_GRID {
            cells *= 2;
        }
        (cells, above(cells).min(bound / 2.0))
    }
}

impl Pyramid {
    /// Plans the levels of a surface. `place` turns positions of the surface, some at a time, into
    /// those of the tiling, with heights in meters.
    ///
    /// # Errors
    /// If the rule makes no sense, a position cannot be placed or is beyond all tiles, there are no
    /// triangles, there would be too many tiles, or the run is canceled.
    ///
    /// # Complexity
    /// O(n log n) for n vertices, and linear in the tiles. 60 bytes for each vertex.
    pub fn new(
        surface: &dyn Surface,
        place: &(dyn Fn(&mut [[f64; 3]]) -> Result<()> + Sync),
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
            .try_for_each(|(positions, used)| placed(positions, used, rule.tiling, place))?;
        surface.ensure_intact()?;
        let faces = || corners(surface).map(|(_, face)| face.map(|v| positions[v as usize]));

        let area: f64 = faces().map(area).sum::<f64>() / 2.0;
        let count = used.iter().filter(|&&used| used).count();
        if count == 0 || area <= 0.0 {
            return Err(Error::format("the surface has no triangles"));
        }
        let in_tile = |level: u8| {
            let side = rule.tiling.side(level);
            count as f64 / area.max(f64::MIN_POSITIVE) * side * side
        };
        let finest = rule.finest(in_tile);
        let tiles = tiles_of(faces(), rule.tiling, finest)?;

        let points: Vec<[f64; 3]> = positions
            .iter()
            .zip(&used)
            .filter_map(|(p, used)| used.then_some(*p))
            .collect();
        let lowest = points.iter().fold(f64::INFINITY, |low, p| low.min(p[2]));
        let mut levels: Vec<Level> = tiles
            .into_iter()
            .zip(0..)
            .map(|(tiles, level)| {
                let bound = rule.bound(level, finest);
                let (grid, above) = rule.grid(level, bound);
                Level {
                    level,
                    bound,
                    allowance: bound - above,
                    step: 0.0,
                    grid,
                    tiles,
                }
            })
            .collect();
        let last_line = |level: &Level| level.level + level.grid.trailing_zeros() as u8;
        let finest_lines = levels.iter().map(last_line).max().unwrap_or(finest);
        let mut lines = TileLines::new(rule.tiling, finest_lines);
        for (number, face) in faces().enumerate() {
            if number % AT_ONCE == 0 && cancel.load(Ordering::Relaxed) {
                return Err(Error::canceled());
            }
            lines.add(face);
        }
        lines.finish();
        drop(positions);

        let mut keyed: Vec<(u64, [f64; 3])> = points
            .into_par_iter()
            .with_min_len(AT_ONCE)
            .map(|p| (key(position_of(p, rule.tiling, finest)), p))
            .collect();
        keyed.par_sort_unstable_by(|(a, p), (b, q)| {
            let axis = |k: usize| p[k].total_cmp(&q[k]);
            a.cmp(b).then(axis(0)).then(axis(1)).then(axis(2))
        });
        let (keys, points) = keyed.into_iter().unzip();
        let mut pyramid = Pyramid {
            rule: *rule,
            points,
            keys,
            lines,
            fill: rule.fill.unwrap_or(lowest),
            finest,
            levels: Vec::new(),
        };
        for level in &mut levels {
            level.step = pyramid.step(level)?;
        }
        pyramid.levels = levels;
        Ok(pyramid)
    }

    /// The levels, the coarsest first.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The division into tiles.
    pub fn tiling(&self) -> Tiling {
        self.rule.tiling
    }

    /// Returns the smallest x and y of the surface in the coordinates of the tiling, and the
    /// largest.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        let bounds = crate::data::Bounds::around(&self.points);
        [bounds.min, bounds.max].map(|[x, y, _]| [x, y])
    }

    /// Returns the lowest height and the highest, in meters, of the surface and around it.
    pub fn heights(&self) -> [f64; 2] {
        let bounds = crate::data::Bounds::around(&self.points);
        [bounds.min[2].min(self.fill), bounds.max[2].max(self.fill)]
    }

    /// Makes a tile of a level, and measures it against all heights in it.
    ///
    /// # Errors
    /// If the level does not exist, or the run is canceled.
    ///
    /// # Complexity
    /// O(n log n) for n heights in practice; about 200 bytes for each.
    pub fn tile(&self, at: TilePosition, cancel: &AtomicBool) -> Result<(TerrainTile, TileReport)> {
        if usize::from(at.level) >= self.levels.len() {
            return Err(Error::usage(format!("there is no level {}", at.level)));
        }
        tile::tile(self, at, cancel)
    }

    /// The points that a tile owns: those on its west and south side are its own, too.
    fn points_of(&self, at: TilePosition) -> &[[f64; 3]] {
        let shift = 2 * u32::from(self.finest - at.level);
        let first = key(at) << shift;
        let last = (key(at) + 1) << shift;
        let [first, last] = [first, last].map(|key| self.keys.partition_point(|&k| k < key));
        &self.points[first..last]
    }

    /// The step of a level: the smallest power of two by which the heights of each tile can be
    /// counted, and which 32-bit numbers keep.
    fn step(&self, level: &Level) -> Result<f64> {
        let range = |at: &TilePosition| {
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            let mut add = |z: f64| range = [range[0].min(z), range[1].max(z)];
            self.points_of(*at).iter().for_each(|p| add(p[2]));
            for far in 0..2 {
                for axis in 0..2 {
                    self.along(*at, axis, far).0.iter().for_each(|h| add(h[1]));
                }
            }
            for i in 0..=level.grid {
                (0..=level.grid).for_each(|j| add(self.height(level, *at, [i, j])));
            }
            range
        };
        let wide = |[low, high]: [f64; 2]| {
            let counted = (high - low) / f64::from(TerrainTile::STEPS - 1);
            counted.max(low.abs().max(high.abs()) / LARGEST_COUNT)
        };
        let ranges = level.tiles.par_iter().map(range).map(wide);
        let least = ranges.reduce(|| LEAST_STEP, f64::max);
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
    fn along(&self, at: TilePosition, axis: usize, far: u32) -> (&[[f64; 2]], [f64; 2]) {
        let [min, max] = self.rule.tiling.bounds(at);
        let ends = [min[1 - axis], max[1 - axis]];
        let number = [at.column, at.row][axis] + far;
        (self.lines.along(axis, at.level, number, ends), ends)
    }

    /// The height in a corner of the grid of a tile.
    fn height(&self, level: &Level, at: TilePosition, [i, j]: [u32; 2]) -> f64 {
        // Lines of the grid are lines between the tiles of a finer level.
        let finer = at.level + level.grid.trailing_zeros() as u8;
        let numbers = [at.column * level.grid + i, at.row * level.grid + j];
        self.lines.crossing(finer, numbers).unwrap_or(self.fill)
    }
}

/// The tile of a level that owns a position.
fn position_of([x, y, _]: [f64; 3], tiling: Tiling, level: u8) -> TilePosition {
    let last = tiling.size(level).map(|size| f64::from(size - 1));
    let [column, row] = [(x, 0), (y, 1)].map(|(c, axis)| {
        tiling
            .in_sides(axis, level, c)
            .floor()
            .clamp(0.0, last[axis]) as u32
    });
    TilePosition { level, column, row }
}

/// The position of a tile on a curve through all of its level: that of a tile of the next coarser
/// level is a quarter of it.
fn key(at: TilePosition) -> u64 {
    let spread = |number: u32| {
        (0..32).fold(0, |key, bit| {
            key | (u64::from(number >> bit & 1) << (2 * bit))
        })
    };
    spread(at.column) | spread(at.row) << 1
}

/// Twice the area of a triangle.
fn area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if turn.is_finite() { turn.abs() } else { 0.0 }
}

/// The tiles of each level up to the finest one that may have a part of the surface, and all of the
/// coarsest level.
fn tiles_of(
    faces: impl Iterator<Item = [[f64; 3]; 3]>,
    tiling: Tiling,
    finest: u8,
) -> Result<Vec<Vec<TilePosition>>> {
    let too_many = || {
        Error::limit(format!(
            "level {finest} has more than {MAX_TILES} tiles of the surface"
        ))
        .cure(wording![
            "pass a smaller ",
            Setting::MaxLevel,
            ", or a larger ",
            Setting::MaxError
        ])
    };
    let mut own: FxHashSet<TilePosition> = FxHashSet::default();
    for face in faces {
        let corners = face.map(|p| position_of(p, tiling, finest));
        let range = |of: fn(&TilePosition) -> u32| {
            let all = corners.iter().map(of);
            all.clone().min().unwrap_or(0)..=all.max().unwrap_or(0)
        };
        let (columns, rows) = (range(|at| at.column), range(|at| at.row));
        let count =
            |range: &std::ops::RangeInclusive<u32>| (range.end() - range.start()) as usize + 1;
        if count(&columns).saturating_mul(count(&rows)) > MAX_TILES {
            return Err(too_many());
        }
        for column in columns {
            own.extend(rows.clone().map(|row| TilePosition {
                level: finest,
                column,
                row,
            }));
        }
        if own.len() > MAX_TILES {
            return Err(too_many());
        }
    }
    let mut levels = Vec::new();
    for level in (0..=finest).rev() {
        if level == 0 {
            let [columns, rows] = tiling.size(0);
            let row = |row| (0..columns).map(move |column| TilePosition { level, column, row });
            own.extend((0..rows).flat_map(row));
        }
        let mut tiles: Vec<TilePosition> = own.iter().copied().collect();
        tiles.sort_unstable();
        own = tiles
            .iter()
            .map(|at| TilePosition {
                level: level.saturating_sub(1),
                column: at.column / 2,
                row: at.row / 2,
            })
            .collect();
        levels.push(tiles);
    }
    levels.reverse();
    Ok(levels)
}

/// Turns positions of a surface into those of a tiling, and checks them.
fn placed(
    positions: &mut [[f64; 3]],
    used: &[bool],
    tiling: Tiling,
    place: &(dyn Fn(&mut [[f64; 3]]) -> Result<()> + Sync),
) -> Result<()> {
    let mut own: Vec<[f64; 3]> = positions
        .iter()
        .zip(used)
        .filter_map(|(p, used)| used.then_some(*p))
        .collect();
    let before = own.clone();
    place(&mut own)?;
    let size = tiling.size(0);
    for (p, from) in own.iter().zip(before) {
        if p.iter().any(|c| !c.is_finite()) {
            return Err(Error::format(format!(
                "{from:?} has no position on the earth"
            )));
        }
        let is_inside = (0..2).all(|axis| {
            let at = tiling.in_sides(axis, 0, p[axis]);
            at >= 0.0 && at <= f64::from(size[axis])
        });
        if !is_inside {
            return Err(Error::format(format!(
                "{from:?} is beyond all tiles of EPSG:{}",
                tiling.epsg()
            )));
        }
    }
    let mut own = own.into_iter();
    for (p, _) in positions.iter_mut().zip(used).filter(|(_, used)| **used) {
        *p = own.next().unwrap_or(*p);
    }
    Ok(())
}
