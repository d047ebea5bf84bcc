//! The longest edge at the rim, and what it is by default.

use crate::data::Bounds;
use crate::run::context::Journal;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;
use crate::run::sources::file_extent::FileExtent;
use crate::terrain::{LostAtRim, LostCaps};

/// The default longest edge at the rim, and width of the buffer around bounds.
const DEFAULT_MAX_EDGE_METRES: f64 = 100.0;

/// How many mean distances between points the longest edge at the rim has with
/// [`EdgeLimit::Auto`]. In real ground points, the largest empty disks inside of an area have radii
/// of 60 to 80 mean distances: under buildings and over water.
const AUTO_EDGE_SPACINGS: f64 = 100.0;

/// Lines may reach so many mean distances between points beyond these without a notice.
const USUAL_REACH: f64 = 2.0;

/// The default longest edge looks wrong if it is less than so many, or more than so many, mean
/// distances between points.
const USUAL_SPACINGS: std::ops::Range<f64> = 10.0..1000.0;

/// With ground points, no more than these shares of the area and of the points are left out with
/// caps.
const USUAL_SHARE_OF_CAPS: f64 = 0.05;
const USUAL_SHARE_OF_POINTS: f64 = 0.01;

/// No more than this share of the convex hull is left out at the rim of most surveys.
const USUAL_SHARE_OF_HULL: f64 = 0.5;

/// The longest edge that a triangle at the rim may have in plan. Triangles that can be reached from
/// outside across longer edges are left out; breaklines are not crossed.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub enum EdgeLimit {
    /// 100 metres, in units of the coordinate system; 100 units if none is known. Also left out are
    /// [caps](crate::terrain::TinBuilder::leave_out_caps): triangles with an angle over 165 degrees
    /// that can be reached from outside over their longest edge.
    #[default]
    Standard,
    /// No limit: the whole convex hull is kept.
    Unlimited,
    /// 100 times the mean distance between points, rounded to two digits. The distance follows
    /// from the number of all points and the extents of all inputs, as their headers state them:
    /// so it is the same for a part of the area, and for any classes.
    Auto,
    /// This length, in the units of the coordinate system.
    Length(f64),
}

impl EdgeLimit {
    /// Returns the length in the units of the coordinate system; `None` if there is no limit.
    /// `spacing` is the mean distance between points. While that is not known, [`Auto`](Self::Auto)
    /// is no limit.
    pub(crate) fn length(self, spacing: Option<f64>, units: &Units) -> Option<f64> {
        match self {
            EdgeLimit::Unlimited => None,
            EdgeLimit::Auto => {
                spacing.map(|spacing| rounded_to_two_digits(AUTO_EDGE_SPACINGS * spacing))
            }
            EdgeLimit::Length(length) => Some(length),
            EdgeLimit::Standard => Some(units.of_metres(DEFAULT_MAX_EDGE_METRES)),
        }
    }

    /// Returns true if caps are left out, too.
    pub(crate) fn leaves_out_caps(self) -> bool {
        self == EdgeLimit::Standard
    }

    /// Returns the notice about the limit, given its length.
    pub(crate) fn notice(self, length: Option<f64>, units: &Units) -> Notice {
        match length.map(|length| units.length(length)) {
            None => Notice::NoEdgeLimit,
            Some(length) if self.leaves_out_caps() => Notice::StandardEdgeLimit(length),
            Some(length) => Notice::EdgeLimit(length),
        }
    }

    /// Returns how far lines may extend the surface beyond the points without a notice.
    pub(crate) fn usual_reach(self, spacing: Option<f64>, units: &Units) -> f64 {
        match (self, spacing) {
            (EdgeLimit::Length(length), _) => length,
            (_, Some(spacing)) => USUAL_REACH * spacing,
            (_, None) => self.buffer(units),
        }
    }

    /// Returns how far outside of bounds points are used at first, and how far lines may be from
    /// the points without a notice.
    pub(crate) fn buffer(self, units: &Units) -> f64 {
        self.length(None, units)
            .unwrap_or_else(|| units.of_metres(DEFAULT_MAX_EDGE_METRES))
    }

    /// Adds notices if much of a surface over so many sites was left out, or much with caps.
    pub(crate) fn note_lost(self, lost: &LostAtRim, sites: u64, journal: &Journal) {
        let LostCaps {
            faces,
            share,
            vertices,
        } = lost.caps;
        let is_much =
            share > USUAL_SHARE_OF_CAPS || vertices as f64 > USUAL_SHARE_OF_POINTS * sites as f64;
        if self.leaves_out_caps() && is_much {
            journal.add(Notice::CapsLost {
                faces,
                share,
                points: vertices,
            });
        }
        if lost.share > USUAL_SHARE_OF_HULL {
            journal.add(Notice::HullLost(lost.share));
        }
    }

    /// Returns a notice if the default looks wrong for points with this mean distance.
    pub(crate) fn unusual(self, spacing: Option<f64>, units: &Units) -> Option<Notice> {
        let (EdgeLimit::Standard, Some(limit), Some(spacing)) =
            (self, self.length(None, units), spacing)
        else {
            return None;
        };
        let is_usual = USUAL_SPACINGS.contains(&(limit / spacing));
        (!is_usual).then(|| Notice::EdgeLimitUnusual {
            limit: units.length(limit),
            spacing: units.length(spacing),
        })
    }
}

/// Returns the mean distance between points, from the number of all points and the extents of all
/// files; `None` if these have no area.
pub(crate) fn mean_distance(files: impl IntoIterator<Item = FileExtent>) -> Option<f64> {
    let area = |b: Bounds| {
        if b.is_empty() {
            0.0
        } else {
            (b.max[0] - b.min[0]) * (b.max[1] - b.min[1])
        }
    };
    let (mut points, mut all) = (0, 0.0);
    for file in files {
        points += file.points.unwrap_or(0);
        all += area(file.bounds.unwrap_or_default());
    }
    Some((all / points as f64).sqrt()).filter(|spacing| spacing.is_normal())
}

/// Returns a positive number, rounded to two significant digits: so it stays the same if a few
/// points change.
fn rounded_to_two_digits(number: f64) -> f64 {
    format!("{number:.1e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_automatic_limit_has_two_digits() {
        let limit = |spacing| EdgeLimit::Auto.length(Some(spacing), &Units::of(None));
        for (spacing, expected) in [
            (0.270_11, 27.0),
            (1.054_5, 110.0),
            (0.002_345, 0.23),
            (1e-308, 1e-306),
        ] {
            assert_eq!(limit(spacing), Some(expected));
        }
        assert_eq!(EdgeLimit::Auto.length(None, &Units::of(None)), None);
    }

    #[test]
    fn the_mean_distance_is_that_of_all_files_together() {
        let file = |points, side: f64| FileExtent {
            points: Some(points),
            bounds: Some(Bounds {
                min: [0.0; 3],
                max: [side, side, 1.0],
            }),
        };
        assert_eq!(mean_distance([file(60, 8.0), file(40, 6.0)]), Some(1.0));
        assert_eq!(mean_distance([file(9, 0.0)]), None);
        assert_eq!(mean_distance([]), None);
    }
}
