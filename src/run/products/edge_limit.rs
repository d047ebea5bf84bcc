//! The longest edge at the rim, and what it is by default.

use crate::data::Bounds;
use crate::run::context::notice::Notice;
use crate::run::context::units::Units;

/// The default longest edge at the rim, and width of the buffer around bounds.
const DEFAULT_MAX_EDGE_METRES: f64 = 100.0;

/// Lines may reach so many mean distances between points beyond these without a notice.
const USUAL_REACH: f64 = 2.0;

/// The default longest edge looks wrong if it is less than so many, or more than so many, mean
/// distances between points.
const USUAL_SPACINGS: std::ops::Range<f64> = 10.0..1000.0;

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
    /// 100 times the mean distance between points, from the number of all points and the extents of
    /// all inputs.
    Auto,
    /// This length, in the units of the coordinate system.
    Length(f64),
}

impl EdgeLimit {
    /// Returns the length in the units of the coordinate system. `None` means that there is no
    /// limit, or that it is derived from the points.
    pub(crate) fn length(self, units: &Units) -> Option<f64> {
        match self {
            EdgeLimit::Unlimited | EdgeLimit::Auto => None,
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
        self.length(units)
            .unwrap_or_else(|| units.of_metres(DEFAULT_MAX_EDGE_METRES))
    }

    /// Returns a notice if the default looks wrong for points with this mean distance.
    pub(crate) fn unusual(self, spacing: Option<f64>, units: &Units) -> Option<Notice> {
        let (EdgeLimit::Standard, Some(limit), Some(spacing)) = (self, self.length(units), spacing)
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
/// inputs; `None` if these have no area.
pub(crate) fn mean_distance(read: u64, extents: impl IntoIterator<Item = Bounds>) -> Option<f64> {
    let area = |b: Bounds| {
        if b.is_empty() {
            0.0
        } else {
            (b.max[0] - b.min[0]) * (b.max[1] - b.min[1])
        }
    };
    let area: f64 = extents.into_iter().map(area).sum();
    Some((area / read as f64).sqrt()).filter(|spacing| spacing.is_normal())
}
