//! Which levels a pyramid has, and how near they are to the surface.

use super::report::TileReport;
use crate::crs::SEMI_AXES;
use crate::data::{TilePosition, Tiling};
use crate::error::{Error, Result, Setting, wording};
use crate::triangulation::kernel::RANGE;

/// How many heights the tiles of the finest level have along a side, if nothing else is asked for.
const HEIGHTS_ALONG: f64 = 64.0;

/// The share of the bound that the curve of the earth may take: a triangle is flat.
const CURVE_SHARE: f64 = 1.0 / 8.0;

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
    /// The height in meters around the surface, at the coarsest level. `None` is the lowest height
    /// of the surface.
    pub fill: Option<f64>,
}

/// A level of a pyramid.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Level {
    /// 0 for the level with the largest tiles.
    pub level: u8,
    /// No height of the surface should be further from the triangles than this, in meters.
    pub bound: f64,
    /// The part of the bound that is left for heights, in meters. The rest, at most half, is for
    /// the curve of the earth within a triangle.
    pub allowance: f64,
    /// By how much the earth is above a triangle, at most, in meters. It may be more than the
    /// bound: a tile of the coarsest levels has only so many squares.
    pub curve: f64,
    /// The size of a step of height, in meters; a power of two. 0 until the level is made.
    pub step: f64,
    /// How many squares a tile has at least along each side, to follow the curve of the earth; a
    /// power of two.
    pub grid: u32,
    /// The tiles, in the order of columns, then rows.
    pub tiles: Vec<TilePosition>,
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
            Some(fill) if !is_height(fill) => Err(Error::usage(format!(
                "{fill} is not a height around the surface: one from -20000 to 20000 m is needed"
            ))
            .cure(wording!["pass ", Setting::Fill.number("METERS")])),
            _ => Ok(()),
        }
    }

    /// Returns the finest level: as asked for, or what the bound or the heights need.
    pub(super) fn finest(&self, in_tiles: impl Fn(u8) -> f64) -> u8 {
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
    pub(super) fn bound(&self, level: u8, finest: u8) -> f64 {
        let of_finest = self
            .max_error
            .unwrap_or_else(|| self.tiling.geometric_error(finest));
        of_finest * f64::from(1_u32 << (finest - level))
    }

    /// Returns how many squares a tile needs along a side to follow the earth, and by how much the
    /// earth is still above their triangles.
    pub(super) fn grid(&self, level: u8, bound: f64) -> (u32, f64) {
        let above = |cells: u32| {
            let diagonal = std::f64::consts::SQRT_2 * self.tiling.angle(level) / f64::from(cells);
            SEMI_AXES[0] * diagonal * diagonal / 8.0
        };
        let mut cells = 1;
        // Lines of the grid are lines between tiles of a finer level.
        let is_finest =
            |cells: u32| u32::from(level) + cells.trailing_zeros() >= u32::from(Tiling::MAX_LEVEL);
        while above(cells) > bound * CURVE_SHARE && cells < MAX_GRID && !is_finest(cells) {
            cells *= 2;
        }
        (cells, above(cells))
    }
}

impl Level {
    /// The level with a bound, of which the curve of the earth takes a part. It has no tiles yet.
    pub(super) fn new(rule: &PyramidRule, level: u8, finest: u8) -> Self {
        let bound = rule.bound(level, finest);
        let (grid, curve) = rule.grid(level, bound);
        Level {
            level,
            bound,
            allowance: bound - curve.min(bound / 2.0),
            curve,
            step: 0.0,
            grid,
            tiles: Vec::new(),
        }
    }

    /// The level whose lines between tiles are the lines of the grids of this one.
    pub(super) fn of_lines(&self) -> u8 {
        self.level + self.grid.trailing_zeros() as u8
    }

    /// Returns how far from the triangles the surface is at most, by what was measured of tiles:
    /// the bound, unless it does not hold.
    pub fn within(&self, measured: &TileReport) -> f64 {
        match measured.largest <= self.allowance && self.curve <= self.bound - self.allowance {
            true => self.bound,
            false => measured.largest.max(self.allowance) + self.curve,
        }
    }
}

/// Returns true if a number can be a height on the earth, in meters.
pub(crate) fn is_height(meters: f64) -> bool {
    meters.abs() <= 20_000.0
}
