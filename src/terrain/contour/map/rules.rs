//! What is asked of contours for maps.

use super::relax::Relaxing;
use super::tube::Tube;
use crate::data::Bounds;
use crate::error::{Error, Plain, Result};
use crate::terrain::Levels;

/// How contours become those of a map. All lengths are in the unit of the heights, and plan and
/// heights have the same unit.
///
/// The default changes nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MapRules {
    /// The largest difference between the height of a line and the surface along it, if lines are
    /// smoothed: at most half of the interval.
    pub smooth: Option<f64>,
    /// How far a vertex that is left out may be from the line, if lines are simplified. Lines still
    /// stay as near to the surface as `smooth` says, or within half of the interval without it.
    pub simplify: Option<f64>,
    /// The least area in plan that a ring encloses, or another line cuts off at the rim; lines with
    /// less are left out, with all that is in there. A fifth suffices if the relief there is an
    /// interval. If it is below a tenth of that, 20 times as much is needed.
    pub min_area: f64,
    /// Lines that are shorter, once they are smoothed, are left out with what they enclose, unless
    /// a line of this length is in there.
    pub min_length: f64,
    /// Keeps depressions, whatever they enclose, unless a line around them is left out.
    pub keep_depressions: bool,
    /// Finds the areas between the lines, too.
    pub with_bands: bool,
}

/// The area below which lines are left out, in squares of the interval.
const AREA: f64 = 50.0;

/// How far vertices that are left out may be from a line, in intervals.
const SIMPLIFY: f64 = 0.05;

/// The relief that a line has to enclose, in intervals.
const LEAST_RELIEF: f64 = 0.1;

/// The share of the least area that suffices where a line encloses the relief of an interval.
const SMALL_AREA: f64 = 0.2;

/// How many times the least area a line encloses that is kept without any relief.
const LARGE_AREA: f64 = 20.0;

impl MapRules {
    /// Returns the rules of a printed map with this interval: lines within half of the interval,
    /// simplified within a twentieth, and none that encloses less than 50 times the square of it.
    pub fn cartographic(interval: f64) -> Self {
        MapRules {
            smooth: Some(0.5 * interval),
            simplify: Some(SIMPLIFY * interval),
            min_area: AREA * interval * interval,
            ..MapRules::default()
        }
    }

    /// Returns true if contours stay as they are: none is moved or left out.
    pub fn keeps_exact(&self) -> bool {
        let changes = self.smooth.is_some() || self.simplify.is_some();
        !changes && self.min_area <= 0.0 && self.min_length <= 0.0
    }

    /// Returns how far the height of a line may differ from that of the surface.
    pub fn tolerance(&self, levels: &Levels) -> f64 {
        self.smooth.unwrap_or(0.5 * levels.interval())
    }

    /// Returns true if coordinates within bounds have digits enough for what is promised of lines:
    /// with fewer, rounding moves a line by more than a millionth of the tolerance.
    pub fn has_digits(&self, levels: &Levels, bounds: &Bounds) -> bool {
        let largest = (0..3).map(|axis| bounds.largest(axis)).fold(0.0, f64::max);
        self.keeps_exact() || largest <= MOST_TOLERANCES * self.tolerance(levels)
    }

    /// Returns true if a line is kept that has an area and a relief on its small side, the relief
    /// in intervals.
    pub(super) fn keeps(&self, area: f64, relief: f64) -> bool {
        let is_large = area >= self.min_area && relief >= LEAST_RELIEF;
        let is_steep = area >= SMALL_AREA * self.min_area && relief >= 1.0;
        // A level pad, a dam or a lake.
        let is_vast = area >= LARGE_AREA * self.min_area;
        self.min_area <= 0.0 || is_large || is_steep || is_vast
    }

    /// Returns an error unless the rules make sense for some levels.
    ///
    /// # Errors
    /// If a length or area is negative or not finite, or lines would be farther from the surface
    /// than half of the interval.
    pub fn check(&self, levels: &Levels) -> Result<()> {
        let interval = levels.interval();
        let mut values = [
            self.smooth,
            self.simplify,
            Some(self.min_area),
            Some(self.min_length),
        ]
        .into_iter()
        .flatten();
        if let Some(value) = values.find(|value| !(value.is_finite() && *value >= 0.0)) {
            return Err(Error::usage(format!(
                "a length or area of the rules for contours is {value}, expected 0 or more"
            )));
        }
        if self.smooth == Some(0.0) {
            return Err(Error::usage(
                "smoothed lines may be off the surface by 0, expected a positive number",
            )
            .cure("leave out smoothing"));
        }
        match self.smooth {
            Some(smooth) if smooth > 0.5 * interval => Err(Error::usage(format!(
                "smoothed lines may be off the surface by {}, more than half of the interval {}: lines of two levels could meet",
                Plain(smooth),
                Plain(interval)
            ))
            .cure(format!(
                "use {} at most, or a larger interval",
                Plain(0.5 * interval)
            ))),
            _ => Ok(()),
        }
    }
}

/// The largest coordinate, in tolerances: 2^52 / 2^20.
const MOST_TOLERANCES: f64 = 4_294_967_296.0;

/// The radius of the smoothing of heights, in intervals.
const RADIUS: f64 = 8.0;

/// The largest move of a point in a pass, in intervals.
const LARGEST_MOVE: f64 = 1.5;

/// The side of the cells of the lattice, in intervals; at least as many units.
const CELL: f64 = 64.0;

/// What the recipe takes, in units of the plan and the heights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    /// The interval.
    pub(super) interval: f64,
    /// The least distance of heights from levels.
    pub(super) delta: f64,
    /// The half width of the corridor around each level, on the smoothed surface.
    pub(super) corridor: f64,
    /// How far heights are smoothed, if they are.
    pub(super) tube: Tube,
    /// How far lines are smoothed, if they are.
    pub(super) relaxing: Relaxing,
    /// The side of the cells of the lattice.
    pub(super) cell: f64,
}

/// The share of the tolerance that lines have; the surface has the rest.
const SHARE: f64 = 0.2;

/// What is kept for the rounding of heights along lines, relative to the tolerance.
const ROUNDING: f64 = 1e-6;

impl Scale {
    /// Returns what rules and levels ask for on a surface within bounds.
    pub(super) fn of(rules: &MapRules, levels: &Levels, bounds: &Bounds) -> Self {
        let interval = levels.interval();
        let whole = rules.tolerance(levels);
        let delta = (1e-4 * interval).min(whole / 8.0);
        let usable = (whole * (1.0 - ROUNDING) - 2.0 * delta).max(0.0);
        let corridor = match rules.smooth {
            Some(_) => SHARE * usable,
            None => usable,
        };
        let [width, depth] = [0, 1].map(|axis| bounds.max[axis] - bounds.min[axis]);
        let radius = RADIUS * interval;
        Scale {
            interval,
            delta,
            corridor,
            tube: Tube {
                radius,
                area: width * depth,
                largest: rules.smooth.map_or(0.0, |_| usable - corridor),
            },
            relaxing: Relaxing {
                half_width: radius / 2.0,
                largest_move: LARGEST_MOVE * interval,
            },
            // Larger where a surface is vast, so that their number stays in bounds.
            cell: (CELL * interval.max(1.0))
                .max(bounds.largest(0).max(bounds.largest(1)) * 2f64.powi(-40))
                .max(width.max(depth) * 2f64.powi(-16)),
        }
    }
}
