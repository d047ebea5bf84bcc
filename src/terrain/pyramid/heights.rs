//! The heights of a surface by the tiles that own them, along the lines between tiles, and around
//! the surface.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::lines::{Crossing, TileLines};
use super::rule::Level;
use crate::data::{AT_ONCE, TerrainTile, TilePosition, Tiling};
use crate::error::{Error, Result};
use crate::terrain::in_order::by_coordinates;
use crate::terrain::sample::on_curve;

/// The finest step of heights, in meters.
const LEAST_STEP: f64 = 1.0 / 65_536.0;

/// Up to so many steps, heights are 32-bit floats without rounding.
const LARGEST_COUNT: f64 = 8_000_000.0;

/// The heights of a surface in the coordinates of a tiling.
pub(super) struct Heights {
    pub(super) tiling: Tiling,
    /// In the order of their keys.
    points: Vec<[f64; 3]>,
    /// For each point, the position of the finest tile that owns it, on a curve through all of
    /// them that passes each tile of each level once.
    keys: Vec<u64>,
    finest: u8,
    pub(super) lines: TileLines,
    /// The height around the surface at the coarsest level.
    pub(super) fill: f64,
    /// Heights of the next coarser level where the surface has none, in corners of the grids of the
    /// tiles of the level that comes next.
    pub(super) outside: FxHashMap<[u32; 2], f64>,
}

impl Heights {
    /// Sorts the vertices of a surface by the tiles of its finest level. `fill` is their lowest
    /// height if it is `None`.
    pub(super) fn new(
        points: Vec<[f64; 3]>,
        lines: TileLines,
        tiling: Tiling,
        finest: u8,
        fill: Option<f64>,
    ) -> Self {
        let lowest = points.iter().fold(f64::INFINITY, |low, p| low.min(p[2]));
        let mut keyed: Vec<(u64, [f64; 3])> = points
            .into_par_iter()
            .with_min_len(AT_ONCE)
            .map(|p| (key(owner(p, tiling, finest)), p))
            .collect();
        keyed.par_sort_unstable_by(|(a, p), (b, q)| a.cmp(b).then_with(|| by_coordinates(p, q)));
        let (keys, points) = keyed.into_iter().unzip();
        Heights {
            tiling,
            points,
            keys,
            finest,
            lines,
            fill: fill.unwrap_or(lowest),
            outside: FxHashMap::default(),
        }
    }

    /// All vertices of the surface.
    pub(super) fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The points that a tile owns: those on its west and south side are its own, too.
    pub(super) fn points_of(&self, at: TilePosition) -> &[[f64; 3]] {
        let shift = 2 * u32::from(self.finest - at.level);
        let first = key(at) << shift;
        let last = (key(at) + 1) << shift;
        let [first, last] = [first, last].map(|key| self.keys.partition_point(|&k| k < key));
        &self.points[first..last]
    }

    /// The step of a level: the smallest power of two by which the heights of each tile can be
    /// counted, and which 32-bit numbers keep.
    pub(super) fn step(&self, level: &Level) -> Result<f64> {
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
    pub(super) fn along(&self, at: TilePosition, axis: usize, far: u32) -> (&[Crossing], [f64; 2]) {
        let [min, max] = self.tiling.bounds(at);
        let ends = [min[1 - axis], max[1 - axis]];
        let number = [at.column, at.row][axis] + far;
        (self.lines.along(axis, at.level, number, ends), ends)
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

/// The tile of a level that owns a position.
pub(super) fn owner([x, y, _]: [f64; 3], tiling: Tiling, level: u8) -> TilePosition {
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
    on_curve([at.column, at.row])
}
